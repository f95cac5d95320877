// The exploration planner for firmware in C.
//
// Written by `cargo xtask c-header` from c-api/src; do not edit.
//
// One robot is one Planner: memory of yours, for example a static variable. The
// library allocates nothing and keeps no state elsewhere. Calls for different
// planners may run at the same time, calls for one planner must not.

#ifndef PLANNER_H
#define PLANNER_H

#include <stddef.h>
#include <stdint.h>

// The robot is on the cell that it was sent to.
#define PLANNER_MOVED 0

// Something stood in the way; the robot is where it was.
#define PLANNER_BLOCKED 1

// Another robot stands there and goes first; the robot is where it was.
#define PLANNER_HELD 2

// Largest width and height of a grid, in cells.
#define PLANNER_MAX_CELLS 128

// The longest frame, in bytes.
#define PLANNER_MAX_FRAME 55

// Beams of one scan at most.
#define PLANNER_MAX_BEAMS 64

// Size of a planner in words of 8 bytes: the 28 KiB that an explorer may take by
// `fixtures/budget.txt`, and one word that tells that it is there.
#define PLANNER_WORDS 3585

// What came of a call.
typedef enum {
  // Done.
  PLANNER_RESULT_OK = 0,
  // A pointer is null.
  PLANNER_RESULT_NULL = 1,
  // A pointer is not aligned to its type.
  PLANNER_RESULT_MISALIGNED = 2,
  // There is no planner in this memory; call `planner_create` first.
  PLANNER_RESULT_NOT_CREATED = 3,
  // The grid is empty or larger than `PLANNER_MAX_CELLS`, or the robot starts
  // outside of it.
  PLANNER_RESULT_EXTENT = 4,
  // The scan's pose or its largest range is not a usable number.
  PLANNER_RESULT_SCAN = 5,
  // More values than a call takes.
  PLANNER_RESULT_TOO_MANY = 6,
  // The motion is none of the constants.
  PLANNER_RESULT_MOTION = 7,
  // The frame says nothing to this robot: damaged, its own, of another version
  // or about another grid.
  PLANNER_RESULT_FRAME = 8,
} PlannerResult;

// What the robot shall do.
typedef enum {
  // Go to the neighbouring cell in `direction`, then call `planner_report`.
  PLANNER_ACTION_KIND_MOVE = 0,
  // Stand still for this tick.
  PLANNER_ACTION_KIND_WAIT = 1,
  // Done, for the reason in `stop`. Final.
  PLANNER_ACTION_KIND_STOP = 2,
} PlannerActionKind;

// One of the four steps.
typedef enum {
  // x + 1
  PLANNER_DIRECTION_EAST = 0,
  // y + 1
  PLANNER_DIRECTION_SOUTH = 1,
  // x - 1
  PLANNER_DIRECTION_WEST = 2,
  // y - 1
  PLANNER_DIRECTION_NORTH = 3,
} PlannerDirection;

// Why the robot stopped.
typedef enum {
  // It has not.
  PLANNER_STOP_NONE = 0,
  // Every cell that can be reached is known.
  PLANNER_STOP_COMPLETE = 1,
  // The same; `frontiers` cells heard of from others lie behind walls.
  PLANNER_STOP_ENCLOSED = 2,
  // Gave up: the way stayed blocked at `at`, `frontiers` cells are left.
  PLANNER_STOP_BLOCKED = 3,
} PlannerStop;

// Memory for one planner. `planner_create` makes one in it. Do not copy it.
typedef struct {
  uint64_t words[PLANNER_WORDS];
} Planner;

// One cell of the grid.
typedef struct {
  // Column, growing to the east.
  int16_t x;
  // Row, growing to the south.
  int16_t y;
} PlannerCell;

// How a planner is set up. All robots of a fleet agree on everything but the
// id and the start.
typedef struct {
  // The robot's number; lower ones win ties.
  uint8_t id;
  // Width of the grid, in cells.
  uint16_t width;
  // Height of the grid, in cells.
  uint16_t height;
  // Where the robot stands.
  PlannerCell start;
  // Side of a cell in millimetres.
  uint16_t cell_mm;
  // Where cell 0,0 lies in the common frame, in millimetres.
  int32_t origin_x_mm;
  // The same along y.
  int32_t origin_y_mm;
  // Bytes that the robot may send a tick on average; 0: it only listens.
  uint16_t bytes_per_tick;
} PlannerConfig;

// Where the robot is, in cells: the cell x,y covers x to x + 1 and y to y + 1.
typedef struct {
  // Position along x, in cells.
  float x;
  // Position along y, in cells.
  float y;
  // Direction of bearing 0, in radians; grows from east to south.
  float heading;
} PlannerPose;

// One distance measured.
typedef struct {
  // Direction relative to the heading, in radians; grows from east to south.
  float bearing;
  // Distance to what was hit, in cells; infinite: nothing; negative: no
  // measurement.
  float range;
} PlannerBeam;

// One cell that was seen.
typedef struct {
  // Which one.
  PlannerCell cell;
  // 0: it is free. Anything else: it is blocked.
  uint8_t blocked;
} PlannerSeen;

// What a tick decided.
typedef struct {
  // What to do.
  PlannerActionKind kind;
  // Where to, for a move.
  PlannerDirection direction;
  // Why, for a stop.
  PlannerStop stop;
  // Frontier cells left, for a stop.
  uint32_t frontiers;
  // The cell that could not be entered, for `PlannerStop::Blocked`.
  PlannerCell at;
} PlannerAction;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Creates a planner in place, or starts it anew. Takes 1 KiB of stack.
PlannerResult planner_create(Planner *planner, const PlannerConfig *config);

// Takes in a range scan: a lidar, a multi-ranger, an 8×8 time-of-flight sensor.
// At most [`PLANNER_MAX_BEAMS`] beams; `max_range` in cells.
PlannerResult planner_observe_scan(Planner *planner,
                                   const PlannerPose *pose,
                                   float max_range,
                                   const PlannerBeam *beams,
                                   size_t count);

// Takes in cells that were seen from the cell `centre`, which is free.
PlannerResult planner_observe_cells(Planner *planner,
                                    PlannerCell centre,
                                    const PlannerSeen *cells,
                                    size_t count);

// Decides what the robot does now. Call it once a tick.
PlannerResult planner_tick(Planner *planner, PlannerAction *action);

// Says how the step of the last move went: [`PLANNER_MOVED`],
// [`PLANNER_BLOCKED`] or [`PLANNER_HELD`].
PlannerResult planner_report(Planner *planner, uint8_t motion);

// Writes the next frame for the other robots into `frame`, which holds
// [`PLANNER_MAX_FRAME`] bytes, and its length into `length`: 0 if there is
// nothing to send in this tick any more.
PlannerResult planner_transmit(Planner *planner, uint8_t *frame, size_t *length);

// Takes in a frame of another robot. [`PlannerResult::Frame`]: it says nothing to
// this robot, and nothing has changed.
PlannerResult planner_receive(Planner *planner, const uint8_t *frame, size_t length);

// Writes how many cells of the map are known, and how many of them are frontiers.
PlannerResult planner_known(Planner *planner, uint32_t *known, uint32_t *frontiers);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PLANNER_H */

// The library was compiled for enumerations of one byte, the default of
// arm-none-eabi-gcc; with others its structures do not look like these.
#if defined(__arm__) && !defined(__linux__)
#ifdef __cplusplus
static_assert(sizeof(PlannerAction) == 12, "compile with -fshort-enums");
static_assert(sizeof(PlannerResult) == 1, "compile with -fshort-enums");
static_assert(sizeof(Planner) == 8 * PLANNER_WORDS, "a planner has its own size");
#else
_Static_assert(sizeof(PlannerAction) == 12, "compile with -fshort-enums");
_Static_assert(sizeof(PlannerResult) == 1, "compile with -fshort-enums");
_Static_assert(sizeof(Planner) == 8 * PLANNER_WORDS, "a planner has its own size");
#endif
#endif
