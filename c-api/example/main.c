// A robot in C: explores a small built-in map and checks that mistakes are
// answered. Runs on an emulated STM32F405; `cargo xtask test --only c-example`.

#include "board.h"
#include "planner.h"

// All memory that the planner ever takes. Sizes are known when this is compiled.
static Planner robot;
_Static_assert(sizeof(Planner) <= 29044, "the Crazyflie's default build leaves 29,044 bytes");
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
enum { WIDTH = 24, HEIGHT = 12, RANGE = 2 };

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

// What a real robot's sensor would tell: the cells around it.
static void look(PlannerCell at) {
    PlannerSeen seen[(2 * RANGE + 1) * (2 * RANGE + 1)];
    size_t count = 0;
    for (int y = -RANGE; y <= RANGE; y++) {
        for (int x = -RANGE; x <= RANGE; x++) {
            PlannerCell cell = {(int16_t)(at.x + x), (int16_t)(at.y + y)};
            // Behind a wall next to the robot nothing is seen.
            bool hidden = is_blocked(at.x + x / 2, at.y + y / 2) && (x / 2 != 0 || y / 2 != 0);
            if (!hidden) {
                seen[count++] = (PlannerSeen){cell, is_blocked(cell.x, cell.y)};
            }
        }
    }
    check(planner_observe_cells(&robot, at, seen, count) == PLANNER_RESULT_OK, "observe");
}

static void mistakes_are_answered(const PlannerConfig *config) {
    PlannerAction action;
    Planner *crooked = (Planner *)((char *)&robot + 1);
    check(planner_tick(&robot, &action) == PLANNER_RESULT_NOT_CREATED, "not created");
    check(planner_create(NULL, config) == PLANNER_RESULT_NULL, "no planner");
    check(planner_create(&robot, NULL) == PLANNER_RESULT_NULL, "no configuration");
    check(planner_create(crooked, config) == PLANNER_RESULT_MISALIGNED, "misaligned");
    PlannerConfig wrong = *config;
    wrong.cell_mm = 0;
    check(planner_create(&robot, &wrong) == PLANNER_RESULT_CELL_SIZE, "cells of 0 mm");
    wrong = *config;
    wrong.start.x = WIDTH;
    check(planner_create(&robot, &wrong) == PLANNER_RESULT_EXTENT, "starts off the grid");
    check(planner_tick(&robot, &action) == PLANNER_RESULT_NOT_CREATED, "still not created");
}

// Says why the robot stands still. This sensor sees all around; one that does not is
// turned to `action->look`.
static void explain(const PlannerAction *action) {
    static const char *const REASONS[] = {
        [PLANNER_WAIT_NONE] = "",
        [PLANNER_WAIT_SIGHT] = "waits for a look\n",
        [PLANNER_WAIT_POSE] = "waits for a place on the grid\n",
        [PLANNER_WAIT_SEARCH] = "searches the map\n",
        [PLANNER_WAIT_CLOSED] = "waits for a cell that refused a step\n",
        [PLANNER_WAIT_LOOK] = "looks again\n",
    };
    board_print(REASONS[action->wait]);
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
    mistakes_are_answered(&config);
    check(planner_create(&robot, &config) == PLANNER_RESULT_OK, "create");
    bool is_mute;
    check(planner_is_mute(&robot, &is_mute) == PLANNER_RESULT_OK && !is_mute, "talks");

    for (int tick = 0; tick < 2000; tick++) {
        look(at);
        PlannerAction action;
        check(planner_tick(&robot, &action) == PLANNER_RESULT_OK, "tick");
        if (action.kind == PLANNER_ACTION_KIND_STOP) {
            board_print(planner_stop_is_complete(action.stop) ? "complete\n" : "gave up\n");
            return action.stop == PLANNER_STOP_COMPLETE ? 0 : 1;
        }
        if (action.kind == PLANNER_ACTION_KIND_WAIT) {
            explain(&action);
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
        // Its own frame says nothing to a robot; a real one would broadcast it.
        if (length > 0) {
            check(planner_receive(&robot, frame, length) == PLANNER_RESULT_FRAME_OWN, "receive");
        }
    }
    board_print("not complete\n");
    return 1;
}
