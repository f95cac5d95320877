// A robot in C: explores a small built-in map and checks that mistakes are
// answered. Runs on an emulated STM32F405; `cargo xtask test --only c-example`.

#include "board.h"
#include "planner.h"

#include <math.h>
#include <string.h>

// All memory that the planner ever takes. Sizes are known when this is compiled.
static Planner robot;
_Static_assert(sizeof(Planner) <= 29044, "the limit of fixtures/budget.txt for an image of 128x128 cells");
_Static_assert(PLANNER_MAX_FRAME <= 60, "a packet of the Crazyflie's peer-to-peer radio");

static const char *const WORLD[] = {
    "########################",
    "#..........#...........#",
    "#..........#...........#",
    "#..........#....####...#",
    "#..........#....#..#...#",
    "#...............#..#...#",
    "#..........#....#..#...#",
    "#######.####....#..#...#",
    "#..........#...........#",
    "#..........#...........#",
    "#..........#...........#",
    "########################",
};
enum { WIDTH = 24, HEIGHT = 12, CELL_MM = 100 };

// What a radio's driver takes.
typedef struct {
    uint8_t length;
    uint8_t bytes[PLANNER_MAX_FRAME];
} Packet;

static bool is_blocked(int x, int y) {
    return x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT || WORLD[y][x] == '#';
}

static void check(bool holds, const char *what) {
    if (!holds) {
        board_print("failed: ");
        board_print(what);
        board_print("\n");
        board_exit(false);
    }
}

// What the driver of a VL53L1X tells, and what it tells it of.
typedef struct {
    uint8_t status;
    uint16_t millimetres;
} Ranging;
enum { RANGE_VALID = 0, SIGMA_FAIL = 1, SIGNAL_FAIL = 2 };

// Four of them: ahead, right, back, left.
enum { SENSORS = 4 };
static PlannerBeam beams[SENSORS];

// Even a black wall answers from here, so no answer means that there is none.
static const float MAX_RANGE = 3;
// Not below the largest range: nothing within reach.
static const float NOTHING = 3;
// Negative: no measurement.
static const float NO_MEASUREMENT = -1;

static void mount_sensors(void) {
    for (int i = 0; i < SENSORS; i++) {
        beams[i].bearing = planner_bearing((float)i * 1.5707963f);
    }
}

// Stands for the hardware: a white wall answers from 1.3 m; now and then it is too noisy.
static Ranging measure(PlannerCell at, int sensor) {
    static const int DX[] = {1, 0, -1, 0}, DY[] = {0, 1, 0, -1};
    static unsigned calls;
    int cells = 0;
    while (!is_blocked(at.x + (cells + 1) * DX[sensor], at.y + (cells + 1) * DY[sensor])) {
        cells++;
    }
    int millimetres = cells * CELL_MM + CELL_MM / 2;
    if (millimetres > 1300) {
        return (Ranging){SIGNAL_FAIL, 0};
    }
    return (Ranging){++calls % 7 == 0 ? SIGMA_FAIL : RANGE_VALID, (uint16_t)millimetres};
}

// An obstacle at a distance, nothing within reach, or no measurement: three things.
static float range_of(Ranging ranging) {
    switch (ranging.status) {
    case RANGE_VALID:
        return (float)ranging.millimetres / CELL_MM;
    case SIGNAL_FAIL:
        return NOTHING;
    default:
        return NO_MEASUREMENT;
    }
}

// From near the middle of a cell: a robot on wheels gives the pose of its odometry.
static void look(PlannerCell at, int tick) {
    for (int i = 0; i < SENSORS; i++) {
        beams[i].range = range_of(measure(at, i));
    }
    float aside = 0.05f * sinf((float)tick);
    PlannerPose pose = {(float)at.x + 0.5f + aside, (float)at.y + 0.5f, 0};
    PlannerResult result =
        planner_observe_scan(&robot, &pose, MAX_RANGE, PLANNER_TOLERANCE, beams, SENSORS);
    check(result == PLANNER_RESULT_OK, "observe");
}

static void mistakes_are_answered(const PlannerConfig *config) {
    PlannerAction action;
    Planner *crooked = (Planner *)((char *)&robot + 1);
    check(planner_tick(&robot, &action) == PLANNER_RESULT_NOT_CREATED, "not created");
    check(planner_create(NULL, sizeof(Planner), config) == PLANNER_RESULT_NULL, "no planner");
    check(planner_create(&robot, sizeof(Planner), NULL) == PLANNER_RESULT_NULL, "no configuration");
    check(planner_create(crooked, sizeof(Planner), config) == PLANNER_RESULT_MISALIGNED, "misaligned");
    PlannerConfig wrong = *config;
    wrong.cell_mm = 0;
    check(planner_create(&robot, sizeof(Planner), &wrong) == PLANNER_RESULT_CELL_SIZE, "cells of 0 mm");
    wrong = *config;
    wrong.start.x = WIDTH;
    check(planner_create(&robot, sizeof(Planner), &wrong) == PLANNER_RESULT_EXTENT, "starts off the grid");
    check(planner_tick(&robot, &action) == PLANNER_RESULT_NOT_CREATED, "still not created");
}

int main(void) {
    PlannerCell at = {1, 1};
    const PlannerConfig config = {
        .id = 0,
        .width = WIDTH,
        .height = HEIGHT,
        .start = at,
        .cell_mm = 100,
        .bytes_per_tick = PLANNER_MAX_FRAME,
    };
    mount_sensors();
    mistakes_are_answered(&config);
    check(planner_create(&robot, sizeof(Planner), &config) == PLANNER_RESULT_OK, "create");
    bool is_mute;
    check(planner_is_mute(&robot, &is_mute) == PLANNER_RESULT_OK && !is_mute, "talks");

    for (int tick = 0; tick < 2000; tick++) {
        look(at, tick);
        PlannerAction action;
        check(planner_tick(&robot, &action) == PLANNER_RESULT_OK, "tick");
        if (action.kind == PLANNER_ACTION_KIND_STOP) {
            board_print(planner_stop_is_complete(action.stop) ? "complete\n" : "gave up\n");
            return action.stop == PLANNER_STOP_COMPLETE ? 0 : 1;
        }
        if (action.kind == PLANNER_ACTION_KIND_WAIT) {
            // These sensors look into all four directions; a robot whose sensors do not is
            // turned to `action.look`.
            board_print(planner_wait_text(action.wait));
            board_print("\n");
        }
        if (action.kind == PLANNER_ACTION_KIND_MOVE) {
            static const int8_t DX[] = {1, 0, -1, 0}, DY[] = {0, 1, 0, -1};
            int x = at.x + DX[action.direction], y = at.y + DY[action.direction];
            if (is_blocked(x, y)) {
                check(planner_report(&robot, PLANNER_BLOCKED) == PLANNER_RESULT_OK, "report");
            } else {
                at = (PlannerCell){(int16_t)x, (int16_t)y};
                check(planner_report(&robot, PLANNER_MOVED) == PLANNER_RESULT_OK, "report");
            }
        }
        uint8_t frame[PLANNER_MAX_FRAME];
        size_t length;
        check(planner_transmit(&robot, frame, &length) == PLANNER_RESULT_OK, "transmit");
        // Its own frame says nothing to a robot; a real one would broadcast the packet.
        static Packet packet;
        packet.length = (uint8_t)length;
        memcpy(packet.bytes, frame, length);
        if (length > 0) {
            check(planner_receive(&robot, packet.bytes, packet.length) == PLANNER_RESULT_FRAME_OWN,
                  "receive");
        }
    }
    board_print("not complete\n");
    return 1;
}
