// The exploration planner for firmware in C.
//
// Written by `cargo xtask c-header` from c-api/src; do not edit.
//
// One robot is one Planner, or one PlannerVoxelSurvey where it flies among voxels: memory of
// yours, for example a static variable. The
// library allocates nothing and keeps no state elsewhere. Calls for different
// planners may run at the same time, calls for one planner must not.
//
// `Stack:` is what a call takes at most on a Cortex-M4F, whatever its input: added up in
// the code itself, and checked.

#ifndef PLANNER_H
#define PLANNER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Largest width and height of a grid, in cells, and sizes of a planner and of a set of cells
// in words of 8 bytes.
// Define PLANNER_CELLS_32 or PLANNER_CELLS_64 for the object of that size.
#if defined(PLANNER_CELLS_32)
#define PLANNER_MAX_CELLS 32
#define PLANNER_WORDS 529
#define PLANNER_CELL_SET_WORDS 16
#elif defined(PLANNER_CELLS_64)
#define PLANNER_MAX_CELLS 64
#define PLANNER_WORDS 1153
#define PLANNER_CELL_SET_WORDS 64
#else
#define PLANNER_MAX_CELLS 128
#define PLANNER_WORDS 3630
#define PLANNER_CELL_SET_WORDS 256
#endif

// The tolerance of a range scan, in cells: for ranges in whole millimetres and a few
// millimetres of error on cells of 50 mm and more.
#define PLANNER_TOLERANCE 0.1f

// The robot is on the cell that it was sent to.
#define PLANNER_MOVED 0

// Something stood in the way; the robot is where it was.
#define PLANNER_BLOCKED 1

// Another robot stands there and goes first; the robot is where it was.
#define PLANNER_HELD 2

// The longest frame, in bytes.
#define PLANNER_MAX_FRAME 55

// Places that `planner_shut` names at most.
#define PLANNER_MAX_SHUT 8

// Largest width and depth of a box, in voxels.
#define PLANNER_VOXEL_MAX_SIDE 40

// Most levels of a box.
#define PLANNER_VOXEL_MAX_LEVELS 16

// Largest range of a sensor, in voxels.
#define PLANNER_VOXEL_MAX_RANGE 12

// Size of a planner among voxels in words of 8 bytes: what it may take by
// `fixtures/budget.txt`, and one that tells that it is there.
#define PLANNER_VOXEL_SURVEY_WORDS 3073

// Voxels that a sensor with 8×8 zones shows at most: 24 for each zone, and the robot's own.
#define PLANNER_VOXEL_ZONES_SEEN 1537

// Zones of a sensor.
#define PLANNER_ZONES 64

// Beams that they make: one for each column.
#define PLANNER_ZONE_BEAMS 8

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
  // The grid or the box is empty or larger than the header's largest, or the robot starts
  // off the grid; or a grid that moves would lie too far from the origin.
  PLANNER_RESULT_EXTENT = 4,
  // The scan's pose is not a number, its largest range is not a positive one, or its
  // tolerance is not between 0 and 0.25.
  PLANNER_RESULT_SCAN = 5,
  // More values than a call takes, or than there is room for.
  PLANNER_RESULT_TOO_MANY = 6,
  // The motion is none of the constants.
  PLANNER_RESULT_MOTION = 7,
  // `cell_mm` is 0.
  PLANNER_RESULT_CELL_SIZE = 9,
  // The cell that the robot is to go to lies off the grid, and nothing has changed. Or its
  // own place does, so nothing was learnt: the planner decides nothing and waits, for
  // `PLANNER_WAIT_POSE`, until a place lies on the grid again. Or the robot or its home
  // would lie off a grid that is to move, and nothing has changed.
  PLANNER_RESULT_OFF_GRID = 10,
  // No frame has this length: cut short, or followed by something else.
  PLANNER_RESULT_FRAME_LENGTH = 11,
  // The frame is written in another version of the format.
  PLANNER_RESULT_FRAME_VERSION = 12,
  // The frame is of a kind that this planner does not read.
  PLANNER_RESULT_FRAME_KIND = 13,
  // The frame's check bytes do not match: damaged, or not signed with the key.
  PLANNER_RESULT_FRAME_CHECK = 14,
  // The sender's map is of another origin, cell size or extent.
  PLANNER_RESULT_FRAME_OTHER_GRID = 15,
  // The frame is the robot's own.
  PLANNER_RESULT_FRAME_OWN = 16,
  // A field of the frame holds what it cannot.
  PLANNER_RESULT_FRAME_FIELD = 17,
  // Another robot has this robot's id: give each robot its own.
  PLANNER_RESULT_FRAME_SAME_ID = 18,
  // The sensor or the field is none of the constants, or the margin is above 3.
  PLANNER_RESULT_SENSOR = 19,
  // The memory is smaller than a planner of this library: the header was included for
  // another size than the library was built for.
  PLANNER_RESULT_MEMORY = 20,
  // The clearance is above 3.
  PLANNER_RESULT_CLEARANCE = 21,
  // The robot or its home lies in the cells that it is to keep out of, or its body would
  // reach into them there. Or it keeps out of cells of a grid that is to move.
  PLANNER_RESULT_KEPT_OUT = 22,
  // Nothing was saved there.
  PLANNER_RESULT_NO_SAVE = 23,
  // The save is of another version of the library.
  PLANNER_RESULT_SAVE_VERSION = 24,
  // The save is damaged or cut short.
  PLANNER_RESULT_SAVE_DAMAGED = 25,
  // The save is of a grid of another size, origin or size of cells.
  PLANNER_RESULT_SAVE_OTHER_GRID = 26,
  // The save is of a robot with another id.
  PLANNER_RESULT_SAVE_OTHER_ROBOT = 27,
  // The grid was moved 16 times since the robot stopped last.
  PLANNER_RESULT_TOO_OFTEN = 28,
  // The range is not 2 to `PLANNER_VOXEL_MAX_RANGE`, or not more than the clearance.
  PLANNER_RESULT_RANGE = 29,
  // The heading is above 7.
  PLANNER_RESULT_HEADING = 30,
  // The field of view of a sensor with zones is not above 0 and up to pi/2.
  PLANNER_RESULT_ZONE_FIELD_OF_VIEW = 31,
  // Its pitch is not between -pi/4 and pi/4; among voxels, -pi/2 and pi/2.
  PLANNER_RESULT_ZONE_PITCH = 32,
  // Its yaw is not finite.
  PLANNER_RESULT_ZONE_YAW = 33,
  // Not `floor_mm` < `height_mm` < `top_mm`.
  PLANNER_RESULT_ZONE_HEIGHTS = 34,
  // Its largest range or the side of a cell is 0.
  PLANNER_RESULT_ZONE_ZERO = 35,
} PlannerResult;

// What the robot shall do.
typedef enum {
  // Go to the neighbouring cell in `direction`, then call `planner_report`.
  PLANNER_ACTION_KIND_MOVE = 0,
  // Stand still for this tick, for the reason in `wait`.
  PLANNER_ACTION_KIND_WAIT = 1,
  // Done, for the reason in `stop`. Every later tick says the same, until
  // `planner_resume`.
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

// Why the robot stopped; `planner_stop_is_complete` tells whether it was done.
typedef enum {
  // It has not.
  PLANNER_STOP_NONE = 0,
  // Every cell that can be reached is known.
  PLANNER_STOP_COMPLETE = 1,
  // The same; no way leads to `frontiers` more frontiers, and part of the map was
  // heard from others.
  PLANNER_STOP_ENCLOSED = 2,
  // Gave up: the way stayed blocked at `at`, `frontiers` cells are left.
  PLANNER_STOP_BLOCKED = 3,
  // Of another planner than this interface has: gave up back at the start.
  PLANNER_STOP_BACK_AT_START = 4,
  // Of another planner than this interface has: gave up without a trace to follow.
  PLANNER_STOP_NO_TRACE = 5,
  // Every cell that can be reached within the map is known; the map ends at
  // `frontiers` free cells, and the world may go on.
  PLANNER_STOP_AT_EDGE = 6,
  // Every cell that can be reached is known; `frontiers` cells in sight lie where no
  // way leads.
  PLANNER_STOP_OUT_OF_REACH = 7,
  // Gave up: no look shows what is at `at`, `frontiers` cells are left.
  PLANNER_STOP_UNSEEN = 8,
  // Gave up: a robot stayed in the way at `at`, `frontiers` cells are left.
  PLANNER_STOP_HELD = 9,
  // Back where it started, as it was told or for its energy; `frontiers` cells are left.
  PLANNER_STOP_HOME = 10,
  // At the cell `at` that it was sent to; `frontiers` cells are left.
  PLANNER_STOP_ARRIVED = 11,
  // Gave up: over cells that are known to be free no way leads to `at`, where it was to
  // go; `frontiers` cells are left.
  PLANNER_STOP_NO_WAY = 12,
} PlannerStop;

// Why the robot waits.
typedef enum {
  // It does not.
  PLANNER_WAIT_NONE = 0,
  // It has seen nothing yet: call `planner_observe_scan` or `planner_observe_cells`.
  PLANNER_WAIT_SIGHT = 1,
  // Its place lies off the grid, or on a cell that it keeps out of: nothing is decided
  // until one lies elsewhere.
  PLANNER_WAIT_POSE = 2,
  // It searches the map.
  PLANNER_WAIT_SEARCH = 3,
  // What is left lies behind cells that refused a step. They are tried again later.
  PLANNER_WAIT_CLOSED = 4,
  // It asks for a look in the direction `look`: turn the sensor there, then observe.
  // A robot that sees all around need not turn.
  PLANNER_WAIT_LOOK = 5,
  // The last look saw the next cell of its way blocked, which its map calls free: it
  // looks again, a few times, and takes what stays for a refusal. (With rangers, where
  // the place before showed the cell free, it tries the step.)
  PLANNER_WAIT_OBSTRUCTED = 6,
  // Nothing is left. It will look again at places that were free and are walls now.
  PLANNER_WAIT_PATROL = 7,
  // Nothing seems to be left, but its last look showed a wall of its map free, near by:
  // it looks again, a few times, before it says so.
  PLANNER_WAIT_DOUBT = 8,
} PlannerWait;

// How far the looks of a sensor can be believed.
typedef enum {
  // A few range sensors, one look a step: three votes, each from another cell.
  PLANNER_SENSOR_RANGERS = 0,
  // A laser scanner, three looks or more a step: three votes.
  PLANNER_SENSOR_LIDAR = 1,
  // Never wrong: the first look decides. For simulations.
  PLANNER_SENSOR_TRUTHFUL = 2,
} PlannerSensor;

// What is known of a cell.
typedef enum {
  // Nothing.
  PLANNER_STATE_UNKNOWN = 0,
  // Free, and so are its neighbours, or known otherwise.
  PLANNER_STATE_FREE = 1,
  // Free, and beside a cell of which nothing is known.
  PLANNER_STATE_FRONTIER = 2,
  // Seen blocked, but not often enough to believe it.
  PLANNER_STATE_DOUBTFUL = 3,
  // An obstacle.
  PLANNER_STATE_OBSTACLE = 4,
} PlannerState;

// What of the voxels within range and in sight a look shows. All but the last also show what
// is within 2 voxels, or `clearance` + 1 if that is more, in every direction, as by range
// finders all round: give these voxels with every look.
typedef enum {
  // All of them.
  PLANNER_VOXEL_FIELD_ALL_ROUND = 0,
  // Those no higher than the robot.
  PLANNER_VOXEL_FIELD_DOWNWARD = 1,
  // Those of the robot's level: a lidar that turns in a plane.
  PLANNER_VOXEL_FIELD_LIDAR = 2,
  // Those in a cone of 90×60 degrees: a depth camera, turned to a heading.
  PLANNER_VOXEL_FIELD_CAMERA = 3,
  // Those within `up`, `down`, `side` and `near` of the configuration.
  PLANNER_VOXEL_FIELD_CUSTOM = 4,
} PlannerVoxelField;

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
// id, in which all differ, and the start.
typedef struct {
  // The robot's number, its own in the fleet; lower ones win ties.
  uint8_t id;
  // Width of the grid, in cells.
  uint16_t width;
  // Height of the grid, in cells.
  uint16_t height;
  // Where the robot stands, on the grid.
  PlannerCell start;
  // Side of a cell in millimetres, above 0.
  uint16_t cell_mm;
  // Where the grid's north-western corner, which is that of cell 0,0, lies in the
  // common frame, in millimetres.
  int32_t origin_x_mm;
  // The same along y. For a square grid around the place where poses in metres begin:
  // minus half of its side for x, plus half of it for y.
  int32_t origin_y_mm;
  // Bytes that the robot may send a tick on average; 0: it only listens, which
  // `planner_is_mute` tells. Less than `PLANNER_MAX_FRAME`: a frame every few ticks.
  uint16_t bytes_per_tick;
  // 0: frames are not signed, and only those without a signature are taken.
  // Anything else: they are signed with `key`, and only those signed with it are
  // taken. Without a key whoever is in reach of the radio can write into the map.
  uint8_t is_keyed;
  // The fleet's secret.
  uint8_t key[16];
  // How far looks are believed, one of [`PlannerSensor`].
  uint8_t sensor;
  // Votes by which one side leads before a cell is decided, 1 to 3; 0: as the sensor
  // has it.
  uint8_t margin;
  // How far from the robot looks can make a cell a wall, in cells; 0: as the sensor has
  // it. 2 for a sensor that sees things from afar that are not there.
  uint8_t sure_range;
  // Ticks after which a robot that is done looks again at places that were free and are
  // walls now, instead of stopping; 0: it stops.
  uint16_t patrol_ticks;
  // Cells that the robot's body reaches beyond the one of its centre, in a disc: 0 to 3,
  // the same for all robots. Looks have to show what is within `clearance` + 2 cells.
  uint8_t clearance;
  // Not 0: a robot that has explored goes home, to where it started, before it stops.
  uint8_t come_home;
} PlannerConfig;

// A direction relative to the heading, as a vector of length 1; `planner_bearing` makes
// it of an angle. A beam whose vector is longer or shorter by 0.001 says nothing.
typedef struct {
  // Its part along the heading: 1 is straight ahead.
  float ahead;
  // Its part to the right of the heading.
  float right;
} PlannerBearing;

// Where the robot is, in cells: the cell x,y covers x to x + 1 and y to y + 1.
typedef struct {
  // Position along x, in cells.
  float x;
  // Position along y, in cells.
  float y;
  // Direction of the bearing that is straight ahead, in radians; grows from east to
  // south.
  float heading;
} PlannerPose;

// One distance measured.
typedef struct {
  // Where it pointed to.
  PlannerBearing bearing;
  // Distance to what was hit, in cells. Infinite, or not below `max_range`: nothing
  // within reach, so what lies on the beam is free. Negative or not a number: no
  // measurement, which says nothing about any cell. Never give one for the other.
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
  // Frontier cells left, for a stop; free cells at the map's edge, for
  // `PLANNER_STOP_AT_EDGE`.
  uint32_t frontiers;
  // The cell that could not be entered, for `PLANNER_STOP_BLOCKED` and
  // `PLANNER_STOP_HELD`; or be seen, for `PLANNER_STOP_UNSEEN`; or that the robot was sent
  // to, for `PLANNER_STOP_ARRIVED` and `PLANNER_STOP_NO_WAY`.
  PlannerCell at;
  // Why, for a wait.
  PlannerWait wait;
  // Where to look, for `PLANNER_WAIT_LOOK`.
  PlannerDirection look;
} PlannerAction;

// Cells of a grid, a bit each. All zero there are none: make it with `= {0}`.
typedef struct {
  uint64_t words[PLANNER_CELL_SET_WORDS];
} PlannerCellSet;

// Where a robot is, what it knows, and what it has from others. Counts begin when the
// planner is created; those of 16 bits stay at their largest value.
typedef struct {
  // Where it stands.
  PlannerCell position;
  // Where it goes; where it stands, if it goes nowhere.
  PlannerCell goal;
  // Whether it goes somewhere: 0 or 1.
  uint8_t has_goal;
  // Cells of the map that are known.
  uint32_t known;
  // Those of them that are frontiers.
  uint32_t frontiers;
  // Cells that others told before the robot saw them.
  uint32_t heard_cells;
  // Cells that others told otherwise than the robot saw them. Where sensors are right
  // and all robots have the same origin and axes: none. A robot that takes left for
  // right shows here.
  uint16_t contradictions;
  // The robot that told most of them; 255: nobody told more than half.
  uint8_t contradicted_by;
  // Frames of another robot with this robot's id.
  uint16_t same_id;
  // Frames that were damaged, or not signed with the key.
  uint16_t refused;
} PlannerStatus;

// Memory for one planner among voxels. `planner_voxel_create` makes one in it. Do not copy
// it.
typedef struct {
  uint64_t words[PLANNER_VOXEL_SURVEY_WORDS];
} PlannerVoxelSurvey;

// How a planner among voxels is set up. All robots of a fleet agree on everything but the
// id, in which all differ.
typedef struct {
  // The robot's number, its own in the fleet; lower ones win ties.
  uint8_t id;
  // Width of the box, in voxels.
  uint16_t width;
  // Its depth from north to south, in voxels.
  uint16_t depth;
  // Its levels.
  uint8_t levels;
  // How far a look reaches, in voxels: 2 to `PLANNER_VOXEL_MAX_RANGE`, and more than
  // `clearance`.
  uint8_t range;
  // How far the robot's body reaches beyond the voxel of its middle: 0 to 3. With 0 it
  // stays in its voxel, with 1 those that share a face with it are kept free, then all
  // within so many voxels.
  uint8_t clearance;
  // Not 0: a robot that has surveyed all flies home, to where it was first, before it stops.
  uint8_t come_home;
  // Not 0: looks err now and then, and three in a row against the map change it. What is
  // occupied can be free again then, which others are told of, for good. 0: every look is
  // believed.
  uint8_t errs;
  // What a look shows: a `PlannerVoxelField`.
  uint8_t field;
  // For `PLANNER_VOXEL_FIELD_CUSTOM`, how far up it shows: the tangent of the highest
  // elevation, in 256ths; 65535: up to straight above.
  uint16_t up;
  // The same down.
  uint16_t down;
  // The tangent of half its width on the plan, in 256ths; 0: it shows all round.
  uint16_t side;
  // Distance in voxels within which it shows everything in all directions: `clearance` + 1
  // for a robot that is to fly everywhere. With less it flies only where its field itself
  // has shown room for its body: it may survey little, or not leave its start, and stop with
  // `PLANNER_STOP_OUT_OF_REACH`, which counts as complete.
  uint8_t near;
  // Side of a voxel in millimetres, above 0.
  uint16_t cell_mm;
  // Where the north-western corner of the lowest level lies in the common frame, in
  // millimetres.
  int32_t origin_x_mm;
  // The same along y.
  int32_t origin_y_mm;
  // Bytes that the robot may send a tick on average; 0: it only listens, which
  // `planner_voxel_status` tells.
  uint16_t bytes_per_tick;
  // As of `PlannerConfig`: 0 for frames without a signature, anything else for those that
  // are signed with `key`.
  uint8_t is_keyed;
  // The key of the fleet.
  uint8_t key[16];
} PlannerVoxelConfig;

// One voxel of the box.
typedef struct {
  // Column, growing to the east.
  int16_t x;
  // Row, growing to the south.
  int16_t y;
  // Level; 0 is the lowest.
  int16_t z;
} PlannerVoxel;

// One voxel that was seen.
typedef struct {
  // Which one.
  PlannerVoxel voxel;
  // 0: it is free. Anything else: something is there.
  uint8_t occupied;
} PlannerVoxelSeen;

// What a tick decided.
typedef struct {
  // What to do. Nothing is reported after a move: the next look tells where the robot is.
  PlannerActionKind kind;
  // For a move, where to fly: a voxel that shares a face with the robot's, and that has
  // room for its body. Otherwise where the robot is.
  PlannerVoxel to;
  // Where the sensor should be turned in the next look, which is 0 before the first tick:
  // eighths of a turn from the east over the south, 0 to 7. It may turn while the robot
  // flies.
  uint8_t heading;
  // Why, for a wait; `PLANNER_WAIT_NONE`: it chooses where to fly next, or turns.
  PlannerWait wait;
  // Why, for a stop.
  PlannerStop stop;
  // Free voxels beside unknown ones, for a stop.
  uint32_t frontiers;
  // The voxel that could not be entered, for `PLANNER_STOP_BLOCKED`, or be seen, for
  // `PLANNER_STOP_UNSEEN`; home, for `PLANNER_STOP_NO_WAY`.
  PlannerVoxel at;
} PlannerVoxelAction;

// Where a robot is, where it goes, what it knows, and what it has from others. Counts begin
// when the planner is created; those of 16 bits stay at their largest value.
typedef struct {
  // Where it is.
  PlannerVoxel position;
  // Where it flies to; where it is, if it flies nowhere.
  PlannerVoxel goal;
  // Whether it flies somewhere: 0 or 1.
  uint8_t has_goal;
  // Whether it has stopped: 0 or 1.
  uint8_t has_stopped;
  // Whether its configuration lets it send nothing: 0 or 1.
  uint8_t is_mute;
  // Voxels of the box that are known.
  uint32_t known;
  // Those of them that are free and beside unknown ones.
  uint32_t frontiers;
  // Voxels that others told before the robot saw them.
  uint32_t heard_voxels;
  // Frames of another robot with this robot's id.
  uint16_t same_id;
  // Frames that were damaged, or not signed with the key.
  uint16_t refused;
} PlannerVoxelStatus;

// Where a flying robot is, in voxels: the voxel x,y,z covers x to x + 1, y to y + 1 and z to
// z + 1.
typedef struct {
  // Position along x, in voxels.
  float x;
  // Position along y, in voxels.
  float y;
  // Height above the bottom of the lowest level, in voxels.
  float z;
  // Where the robot is turned, in radians; grows from east to south.
  float heading;
} PlannerVoxelPose;

// A sensor with 8×8 zones, and how it is mounted.
typedef struct {
  // 0: it tells distances along its axis, as the VL53L5CX, VL53L7CX and VL53L8CX do.
  // Anything else: distances to what was hit, of which the outer zones say more.
  uint8_t is_radial;
  // Angle in radians that its 8 columns, and its 8 rows, see together: above 0, up to
  // pi/2. pi/4 for the VL53L5CX, pi/3 for the VL53L7CX.
  float field_of_view;
  // Distance up to which every obstacle gives a measurement, black ones too.
  uint16_t max_range_mm;
  // Where it points to, in radians from the robot's heading; grows from east to south.
  float yaw;
  // How far it points up, in radians, -pi/4 to pi/4: that of the mounting and of a body
  // that tilts.
  float pitch;
  // How far it sits from the robot's middle, in the direction that it points to.
  int16_t ahead_mm;
  // How high it sits above the floor.
  uint16_t height_mm;
  // What lies lower may be the floor: below `height_mm`. Not less than the sensor's error
  // there, and the error of the pitch times the range.
  uint16_t floor_mm;
  // What lies higher is not in the robot's way: above `height_mm`.
  uint16_t top_mm;
  // Side of a cell: that of the planner's configuration.
  uint16_t cell_mm;
} PlannerZoneSensor;

// What one zone says.
typedef struct {
  // As the driver of a VL53L5CX, VL53L7CX or VL53L8CX tells it. 5 or 9: something is at
  // `distance_mm`, if that is above 0. 255: nothing is within `max_range_mm`; that driver
  // tells it if it is asked for the number of targets. Any other: no measurement, which
  // says nothing.
  uint8_t status;
  // How far away.
  int16_t distance_mm;
} PlannerZone;

// A look that sensors are added to, one after the other, for `planner_voxel_observe`.
typedef struct {
  // Memory of yours: an array of voxels.
  PlannerVoxelSeen *seen;
  // How many it has room for. 24 for each zone or ray, and one for the robot's own voxel,
  // always suffice: [`PLANNER_VOXEL_ZONES_SEEN`] for a sensor with 8×8 zones.
  size_t room;
  // How many of them are in the look: 0 before the first sensor.
  size_t count;
} PlannerVoxelLook;

// A vector in the frame of a robot that is level.
typedef struct {
  // Its part along the heading.
  float ahead;
  // Its part to the right of that.
  float right;
  // Its part upwards.
  float up;
} PlannerVector;

// One distance measured, by a range finder or a point of a depth image.
typedef struct {
  // Where the sensor sits, from the robot's middle, in voxels: less than one away.
  PlannerVector from;
  // Where it points to: a vector of length 1. With another length, by more than 0.001, the
  // ray says nothing.
  PlannerVector direction;
  // Distance to what was hit, in voxels, as of `PlannerBeam`.
  float range;
} PlannerRay;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Creates a planner in place, or starts it anew. `bytes` is `sizeof(Planner)`: a header
// and a library of different sizes are told by `PLANNER_RESULT_MEMORY`. After any result
// but `PLANNER_RESULT_OK` nothing has changed: memory without a planner has none, and a
// planner that runs goes on.
//
// Stack: 1024 bytes.
PlannerResult planner_create(Planner *planner, size_t bytes, const PlannerConfig *config);

// The direction `radians` from the robot's heading; grows from east to south. Make it
// once for each beam of a sensor: it takes a sine and a cosine. An angle that is not
// finite gives a direction whose beams say nothing.
//
// Stack: 256 bytes.
PlannerBearing planner_bearing(float radians);

// Takes in a range scan: a lidar, a multi-ranger, an 8×8 time-of-flight sensor (by
// `planner_zone_beams`). Work: at most 32 cells a beam. Any result but `PLANNER_RESULT_OK` and
// `PLANNER_RESULT_OFF_GRID` changes nothing.
//
// `max_range`: distance in cells up to which every obstacle gives a measurement.
//
// `tolerance`: how far, in cells, the end of a beam may lie from where it is reported,
// 0 to 0.25: (range error + position error + max_range × heading error) / side of a
// cell, rounding among the errors. `PLANNER_TOLERANCE` is the usual one.
//
// What the proof of completeness needs of looks, of scans and of cells: standing on a
// free cell, looks (after a turn where `wait` says `PLANNER_WAIT_LOOK`) must in the end
// show each of the four neighbours as free or blocked. A neighbour that no look shows
// (glass, matt black, a sensor that does not point there) is set aside after a few
// looks, and if nothing else is left the robot stops with `PLANNER_STOP_UNSEEN`. The
// cell that the robot stands on is free, whatever was seen of it from elsewhere.
//
// Stack: 4224 bytes.
PlannerResult planner_observe_scan(Planner *planner,
                                   const PlannerPose *pose,
                                   float max_range,
                                   float tolerance,
                                   const PlannerBeam *beams,
                                   size_t count);

// As `planner_observe_scan`, for a sensor that reaches more than 15 cells: its beams end at
// 31. Of what lies more than 15 cells away each way, only cells of which nothing is known
// count.
//
// Stack: 8448 bytes.
PlannerResult planner_observe_long_scan(Planner *planner,
                                        const PlannerPose *pose,
                                        float max_range,
                                        float tolerance,
                                        const PlannerBeam *beams,
                                        size_t count);

// Takes in cells that were seen from the cell `centre`, where the robot stands and
// which is free. Leave out the cells of which nothing was seen. `planner_observe_scan`
// says what looks must show.
//
// Stack: 3328 bytes.
PlannerResult planner_observe_cells(Planner *planner,
                                    PlannerCell centre,
                                    const PlannerSeen *cells,
                                    size_t count);

// Decides what the robot does now. Call it once a tick.
//
// Stack: 3328 bytes.
PlannerResult planner_tick(Planner *planner, PlannerAction *action);

// Goes on after a stop with the map at hand: somebody opened a door, carried the robot,
// or wants it to try again what it gave up. Without a stop, what refused a step or
// showed nothing is tried anew.
//
// Stack: 128 bytes.
PlannerResult planner_resume(Planner *planner);

// Sends the robot home, to where it started, also from a stop. It stops there with
// `PLANNER_STOP_HOME`, or says why not: `PLANNER_STOP_NO_WAY`, `PLANNER_STOP_BLOCKED` or
// `PLANNER_STOP_HELD`. `planner_resume` then goes on exploring.
//
// Stack: 128 bytes.
PlannerResult planner_go_home(Planner *planner);

// As `planner_go_home`, to any cell: it stops there with `PLANNER_STOP_ARRIVED`. Off the
// grid: `PLANNER_RESULT_OFF_GRID`, and nothing has changed.
//
// Stack: 128 bytes.
PlannerResult planner_go_to(Planner *planner, PlannerCell cell);

// Tells the planner how many more steps the robot's energy allows; each step that is
// reported as `PLANNER_MOVED` takes one off until it is told again. It turns back while that lasts for the shortest way home that it
// knows, and stops there with `PLANNER_STOP_HOME`; told more, `planner_resume` goes on
// exploring. Without this call there is no limit.
//
// Stack: 128 bytes.
PlannerResult planner_energy(Planner *planner,
                             uint32_t steps);

// Whether a robot that stopped for this reason, a `PlannerStop`, knows everything that
// it could reach within its map; otherwise it gave up.
//
// Stack: 128 bytes.
bool planner_stop_is_complete(uint8_t stop);

// Says how the step of the last move went: [`PLANNER_MOVED`],
// [`PLANNER_BLOCKED`] or [`PLANNER_HELD`].
//
// Stack: 384 bytes.
PlannerResult planner_report(Planner *planner, uint8_t motion);

// Writes the next frame for the other robots into `frame`, which holds
// [`PLANNER_MAX_FRAME`] bytes, and its length into `length`: 0 if there is
// nothing to send in this tick any more. A mute planner never has anything to send:
// see `planner_is_mute`.
//
// Stack: 1024 bytes.
PlannerResult planner_transmit(Planner *planner, uint8_t *frame, size_t *length);

// Whether the configuration lets the robot send nothing: its `bytes_per_tick` is 0.
//
// Stack: 128 bytes.
PlannerResult planner_is_mute(Planner *planner, bool *is_mute);

// Takes in a frame of another robot, at any time. A result from
// `PLANNER_RESULT_FRAME_LENGTH` on tells why it was not taken; nothing has changed then.
//
// Stack: 896 bytes.
PlannerResult planner_receive(Planner *planner, const uint8_t *frame, size_t length);

// Writes how many cells were free and are walls now (doors that somebody shut), and the
// last of them into `places`: at most `room` of at most [`PLANNER_MAX_SHUT`], the latest
// one last; `count` is how many. A stop with `planner_stop_is_complete` means complete as
// seen: what lies behind these is not part of it.
//
// Stack: 128 bytes.
PlannerResult planner_shut(Planner *planner,
                           uint32_t *cells,
                           PlannerCell *places,
                           size_t room,
                           size_t *count);

// Adds the rectangle between two opposite corners, both of them in it, as far as it lies on
// the grid. Work: a few instructions a cell.
//
// Stack: 128 bytes.
PlannerResult planner_add_rectangle(PlannerCellSet *set, PlannerCell corner, PlannerCell opposite);

// From now on the robot enters none of these cells, nor touches one with its body, and need
// not see them; null: it may enter all. "Complete" is then meant without them, and others
// are told nothing of them. A robot that had stopped goes on. The set stays yours, in RAM or
// flash: it must stay where it is, and as it is, until the next such call or
// `planner_create`. `PLANNER_RESULT_KEPT_OUT`: the robot or its home lies in them, and
// nothing has changed.
//
// Stack: 384 bytes.
PlannerResult planner_keep_out(Planner *planner, const PlannerCellSet *set);

// Moves the grid by so many tiles of 8 cells to the east and to the south, for a place that
// is larger than it: a stop for `PLANNER_STOP_AT_EDGE` asks for it. Every cell is called by
// a number 8 less for each, also in what you tell from now on. The robot goes on, and what
// comes in is unknown. What falls off is lost: read it before, by `planner_row`. A fleet
// moves by agreement, every robot by the same tiles: until all have, they do not hear each
// other. `PLANNER_RESULT_OFF_GRID`: the robot or its home would fall off (see
// `planner_settle`); `PLANNER_RESULT_KEPT_OUT`: call `planner_keep_out` without cells before,
// and with those of the new grid afterwards; `PLANNER_RESULT_TOO_OFTEN`: 16 times since the
// last stop. Then nothing has changed. Work: every tile, with its neighbours.
//
// Stack: 1024 bytes.
PlannerResult planner_recentre(Planner *planner, int8_t columns, int8_t rows);

// From now on the robot's home is where it stands.
//
// Stack: 128 bytes.
PlannerResult planner_settle(Planner *planner);

// Writes how many bytes a save takes: 1,604 for 64×64 cells.
//
// Stack: 128 bytes.
PlannerResult planner_saved_bytes(Planner *planner, size_t *bytes);

// Writes the bytes of a save from number `first` on into `bytes`, as many as there is `room`
// for or left, and how many into `written`; 0: the save is whole. So it goes to flash a page
// at a time. Make no other call between the pages, or the save is refused later as damaged.
// Kept are the map, where the robot and its home are, and the number of its next frame; not
// plans, nor what it heard of the others. Work: the whole save, about 100 instructions a
// byte.
//
// Stack: 640 bytes.
PlannerResult planner_save(Planner *planner,
                           size_t first,
                           uint8_t *bytes,
                           size_t room,
                           size_t *written);

// Goes on from a save, after `planner_create` with the same grid and id; what lies behind
// its last byte does not matter. The robot keeps out of what it did, if that is told before,
// and has no limit of energy until it is told. A result other than `PLANNER_RESULT_OK` says
// what is wrong with the save, and nothing has changed.
//
// Stack: 1024 bytes.
PlannerResult planner_restore(Planner *planner, const uint8_t *bytes, size_t count);

// The pose of a robot at `x`, `y` in metres, y to the left of x, whose `yaw` in radians
// grows counter-clockwise from x: the frame of ROS and of the Crazyflie. In the grid y
// and angles grow the other way, so angles of such a robot's sensors go to
// `planner_bearing` with their sign changed. `PLANNER_RESULT_CELL_SIZE`: the
// configuration's `cell_mm` is 0.
//
// Stack: 128 bytes.
PlannerResult planner_pose_from_metres(const PlannerConfig *config,
                                       float x,
                                       float y,
                                       float yaw,
                                       PlannerPose *pose);

// The middle of a cell in the same frame, in metres: where to go for a move to that cell.
//
// Stack: 128 bytes.
PlannerResult planner_middle_in_metres(const PlannerConfig *config,
                                       PlannerCell cell,
                                       float *x,
                                       float *y);

// A `PlannerDirection` as a yaw in radians, counter-clockwise from the east.
//
// Stack: 128 bytes.
float planner_yaw(uint8_t direction);

// Writes where the robot is, where it goes, what it knows, and what it has from others.
//
// Stack: 128 bytes.
PlannerResult planner_status(Planner *planner, PlannerStatus *status);

// Writes the farthest cell of the way that the robot can go to in a straight line, centre
// to centre, and whether there is one: every cell that the line touches is known to be
// passable. At most 19 cells away each way. A robot that steers there instead of making the
// step of the last move observes from any cell on its way, and reports only what stops it:
// places on the line, on the way or beside the way keep the plan. Work: 16 tiles, and 64
// lines of at most 20 rows each.
//
// Stack: 2048 bytes.
PlannerResult planner_waypoint(Planner *planner, bool *has_waypoint, PlannerCell *waypoint);

// Writes the cells of the way, from the next one on: at most `room` of at most 256, up to
// the goal or to where its rest is searched for; `count` is how many.
//
// Stack: 384 bytes.
PlannerResult planner_way(Planner *planner, PlannerCell *cells, size_t room, size_t *count);

// Writes the `PlannerState` of a cell. `PLANNER_RESULT_OFF_GRID`: there is no such cell.
//
// Stack: 128 bytes.
PlannerResult planner_cell(Planner *planner, PlannerCell cell, uint8_t *state);

// Writes the `PlannerState` of the cells of row `y`, from the west: at most `room`
// of them; `count` is how many. Work: one cell after the other.
//
// Stack: 256 bytes.
PlannerResult planner_row(Planner *planner, int16_t y, uint8_t *states, size_t room, size_t *count);

// A `PlannerResult` in words, for logs.
//
// Stack: 128 bytes.
const char *planner_result_text(uint8_t result);

// A `PlannerStop` in words.
//
// Stack: 128 bytes.
const char *planner_stop_text(uint8_t stop);

// A `PlannerWait` in words.
//
// Stack: 128 bytes.
const char *planner_wait_text(uint8_t wait);

// Creates a planner among voxels in place, or starts it anew. `bytes` is
// `sizeof(PlannerVoxelSurvey)`. After any result but `PLANNER_RESULT_OK` nothing has changed.
//
// One step of a robot is `planner_voxel_observe`; then `planner_voxel_transmit` until there is
// nothing to send, and `planner_voxel_receive`; then `planner_voxel_tick`.
//
// Stack: 1024 bytes.
PlannerResult planner_voxel_create(PlannerVoxelSurvey *survey,
                                   size_t bytes,
                                   const PlannerVoxelConfig *config);

// Takes in a look: where the robot is, where its sensor is turned (eighths of a turn from
// the east over the south; of no matter if it shows all round), and *every* voxel within
// range, in the field and in sight over free ones, each with whether something is there. One
// look is one call of an array of any length, at range 8 of 2,109 voxels at most and at range 12 of
// 7,153, and shows at least the robot's own voxel, which is free whatever the map
// said of it. A voxel is in sight if the straight line to it, from the middle of the robot's
// voxel to its own, passes free voxels alone, of the two beside an edge at least one, and
// about a corner two side by side. A voxel that a look should show and never does ends in
// `PLANNER_STOP_UNSEEN`. So do 100 looks in a row without a voxel of the box, or ticks without
// a look, as of a sensor that failed; the robot waits meanwhile, for `PLANNER_WAIT_SIGHT`, and
// before its first look for as long as there is none. Voxels outside of the box are passed
// over.
//
// A robot that is where it was, and not where the last move sent it, was kept from there;
// one that is elsewhere was pushed, and flies on. `PLANNER_RESULT_OFF_GRID`: it is not in the
// box; nothing is learnt and nothing decided until it is. Any other result but
// `PLANNER_RESULT_OK` changes nothing.
//
// Work: the voxels seen, and at most a ray for each voxel within range.
//
// Stack: 4352 bytes.
PlannerResult planner_voxel_observe(PlannerVoxelSurvey *survey,
                                    PlannerVoxel at,
                                    uint8_t heading,
                                    const PlannerVoxelSeen *seen,
                                    size_t count);

// Decides what the robot does now. Call it once a step. Work: at most about 8,000,000
// instructions.
//
// Stack: 9472 bytes.
PlannerResult planner_voxel_tick(PlannerVoxelSurvey *survey, PlannerVoxelAction *action);

// Goes on after a stop with the map at hand: what was given up is tried again. Without a
// stop it does only the latter.
//
// Stack: 128 bytes.
PlannerResult planner_voxel_resume(PlannerVoxelSurvey *survey);

// Sends the robot home, to where it was first, also from a stop. It stops there with
// `PLANNER_STOP_HOME`, or says why not: `PLANNER_STOP_NO_WAY` or `PLANNER_STOP_BLOCKED`.
// `planner_voxel_resume` then goes on surveying.
//
// Stack: 128 bytes.
PlannerResult planner_voxel_go_home(PlannerVoxelSurvey *survey);

// Tells the planner for how many ticks in the air the robot's energy lasts from now on; each
// that does not stop takes one off, in a wait too, until it is told again. The robot turns
// back in time for the shortest way home that it knows and the search for it, and stops there
// with `PLANNER_STOP_HOME`; told more, `planner_voxel_resume` goes on surveying. Without this
// call there is no limit.
//
// Stack: 128 bytes.
PlannerResult planner_voxel_energy(PlannerVoxelSurvey *survey, uint32_t ticks);

// Writes the next frame for the other robots into `frame`, which holds `PLANNER_MAX_FRAME`
// bytes, and its length into `length`: 0 if there is nothing to send any more. Work: 256
// words for each of at most 12 pieces of the map.
//
// Stack: 1024 bytes.
PlannerResult planner_voxel_transmit(PlannerVoxelSurvey *survey, uint8_t *frame, size_t *length);

// Takes in a frame of another robot among voxels, at any time. A result from
// `PLANNER_RESULT_FRAME_LENGTH` on tells why it was not taken; nothing has changed then.
//
// Stack: 1024 bytes.
PlannerResult planner_voxel_receive(PlannerVoxelSurvey *survey,
                                    const uint8_t *frame,
                                    size_t length);

// Takes in where robot `id` is, where it flies and whether it has stopped, as it was told by
// other means than frames, which tell it too; of `status` nothing else is read.
// `PLANNER_RESULT_FRAME_OWN`: the id is the robot's own. `PLANNER_RESULT_OFF_GRID`: the other
// robot or its goal is not in the box. Then nothing has changed.
//
// Stack: 384 bytes.
PlannerResult planner_voxel_hear(PlannerVoxelSurvey *survey,
                                 uint8_t id,
                                 const PlannerVoxelStatus *status);

// Writes where the robot is, where it flies, what it knows, and what it has from others.
// Work: 14 words for each of at most 400 tiles of voxels.
//
// Stack: 384 bytes.
PlannerResult planner_voxel_status(PlannerVoxelSurvey *survey, PlannerVoxelStatus *status);

// Writes the `PlannerState` of a voxel, none of which is doubtful.
// `PLANNER_RESULT_OFF_GRID`: there is no such voxel.
//
// Stack: 256 bytes.
PlannerResult planner_voxel_state(PlannerVoxelSurvey *survey, PlannerVoxel voxel, uint8_t *state);

// The pose of a robot at `x`, `y`, `z` in metres, y to the left of x and z above the bottom of
// the lowest level, whose `yaw` in radians grows counter-clockwise from x: the frame of ROS and
// of the Crazyflie. `PLANNER_RESULT_CELL_SIZE`: the configuration's `cell_mm` is 0.
//
// Stack: 128 bytes.
PlannerResult planner_voxel_pose_from_metres(const PlannerVoxelConfig *config,
                                             float x,
                                             float y,
                                             float z,
                                             float yaw,
                                             PlannerVoxelPose *pose);

// The voxel that a pose is in, and the nearest of the eight headings, for
// `planner_voxel_observe`. `PLANNER_RESULT_OFF_GRID`: the pose is not in the box, or not
// finite, and nothing is written.
//
// Stack: 128 bytes.
PlannerResult planner_voxel_at(const PlannerVoxelConfig *config,
                               const PlannerVoxelPose *pose,
                               PlannerVoxel *at,
                               uint8_t *heading);

// The middle of a voxel in the frame of `planner_voxel_pose_from_metres`, in metres: where to
// fly for a move to that voxel.
//
// Stack: 128 bytes.
PlannerResult planner_voxel_middle_in_metres(const PlannerVoxelConfig *config,
                                             PlannerVoxel voxel,
                                             float *x,
                                             float *y,
                                             float *z);

// A heading of `PlannerVoxelAction`, in eighths of a turn, as a yaw in radians,
// counter-clockwise from the east.
//
// Stack: 128 bytes.
float planner_voxel_yaw(uint8_t heading);

// Makes the field of a configuration `PLANNER_VOXEL_FIELD_CUSTOM`, of a sensor that shows so
// far up and down, and `side` to each side, in radians, 0 to pi/2; pi/2 up or down is all of
// it, and a `side` of 0 all round. pi/8 three times for a VL53L5CX that points ahead. `near`
// stays as it is. `PLANNER_RESULT_SENSOR`: there is no such angle, and nothing has changed.
//
// Stack: 384 bytes.
PlannerResult planner_voxel_set_field(PlannerVoxelConfig *config, float up, float down, float side);

// Adds the voxels to a look that a sensor with 8×8 zones shows: those that the middle line of a
// zone passes are free, the one that it ends in, or at the face of, is occupied, what is behind
// stays unknown; a zone without a target shows free voxels alone, up to `max_range_mm` or the
// range of the configuration. A voxel that one zone hits and another passes is occupied. In the
// look each voxel is once, the robot's own is one of them, and what lies more than
// `PLANNER_VOXEL_MAX_RANGE` away along an axis is dropped. `PLANNER_RESULT_TOO_MANY`: there is
// no room for all. `PLANNER_RESULT_SCAN`: the pose is not finite, or the tolerance not 0 to 0.25.
// After any result but `PLANNER_RESULT_OK` the look is as it was.
//
// `zones` are those of `planner_zone_beams`. Of `sensor` the heights and `cell_mm` are not
// read, and the pitch may be -pi/2 to pi/2: straight down to straight up. It sits `ahead_mm`
// from the robot's middle along its axis. `tolerance`: as of `planner_observe_scan`, in voxels.
// What is passed within it of a face, and what is hit in a corner, is left out: of the voxels
// in sight a look misses some, which others show.
//
// Work: 10 sines and cosines, at most 39 voxels for each zone, and 1,250 words.
//
// Stack: 8960 bytes.
PlannerResult planner_voxel_zones(const PlannerVoxelConfig *config,
                                  const PlannerVoxelPose *pose,
                                  const PlannerZoneSensor *sensor,
                                  float tolerance,
                                  const PlannerZone *zones,
                                  PlannerVoxelLook *look);

// The same for other sensors: the points of a depth image, or single range finders, as those
// that tell what is beside, above and behind the robot. `max_range`: distance in voxels, above
// 0, up to which every obstacle gives a measurement.
//
// Stack: 8320 bytes.
PlannerResult planner_voxel_rays(const PlannerVoxelConfig *config,
                                 const PlannerVoxelPose *pose,
                                 float max_range,
                                 float tolerance,
                                 const PlannerRay *rays,
                                 size_t count,
                                 PlannerVoxelLook *look);

// Makes beams for `planner_observe_scan` of what a sensor with 8×8 zones measured: one for
// each column, from left to right, from the robot's middle to the nearest thing that stands
// between the floor and the robot's height. Writes [`PLANNER_ZONE_BEAMS`] of them into
// `beams`, and how far they reach, in cells, into `max_range`. A scan with several sensors
// takes the beams of all, and the least of their ranges.
//
// `zones` are [`PLANNER_ZONES`], row by row, the topmost row first and each from left to
// right, as the robot sees them. In which order a driver gives them hangs on how the sensor
// is mounted: hold a hand before its upper left corner.
//
// Zones that see the floor or what is too high are left out. A column without an obstacle is
// free if one of its zones that see as far as `max_range` found nothing so far; else it says
// nothing. What is lower than the robot can be missed: from afar it fills little of a zone.
//
// A result from `PLANNER_RESULT_ZONE_FIELD_OF_VIEW` on tells which value of `sensor` cannot
// be; nothing is written then. Work: 18 sines and cosines, and 64 zones.
//
// Stack: 2048 bytes.
PlannerResult planner_zone_beams(const PlannerZoneSensor *sensor,
                                 const PlannerZone *zones,
                                 PlannerBeam *beams,
                                 float *max_range);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PLANNER_H */

// The library was compiled for enumerations of one byte, the default of
// arm-none-eabi-gcc; with others its structures do not look like these.
#if defined(__arm__) && !defined(__linux__)
#ifdef __cplusplus
static_assert(sizeof(PlannerAction) == 16, "compile with -fshort-enums");
static_assert(sizeof(PlannerResult) == 1, "compile with -fshort-enums");
static_assert(sizeof(Planner) == 8 * PLANNER_WORDS, "a planner has its own size");
static_assert(sizeof(PlannerVoxelAction) == 24, "compile with -fshort-enums");
static_assert(sizeof(PlannerVoxelSurvey) == 8 * PLANNER_VOXEL_SURVEY_WORDS, "a survey has its own size");
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
_Static_assert(sizeof(PlannerAction) == 16, "compile with -fshort-enums");
_Static_assert(sizeof(PlannerResult) == 1, "compile with -fshort-enums");
_Static_assert(sizeof(Planner) == 8 * PLANNER_WORDS, "a planner has its own size");
_Static_assert(sizeof(PlannerVoxelAction) == 24, "compile with -fshort-enums");
_Static_assert(sizeof(PlannerVoxelSurvey) == 8 * PLANNER_VOXEL_SURVEY_WORDS, "a survey has its own size");
#else // Before C11: an array of -1 is no array.
typedef char planner_compile_with_fshort_enums[sizeof(PlannerAction) == 16 ? 1 : -1];
typedef char planner_has_its_own_size[sizeof(Planner) == 8 * PLANNER_WORDS ? 1 : -1];
#endif
#endif
