// A Crazyflie that explores with others: an app of its firmware, for one with a multi-ranger
// and a flow deck (or Lighthouse, which does not drift). The parameter `explore.go` starts
// it; it lands when everything is known, when the battery is low, or when told by a 0.

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "FreeRTOS.h"
#include "app.h"
#include "configblock.h"
#include "crtp_commander_high_level.h"
#include "debug.h"
#include "log.h"
#include "param.h"
#include "planner.h"
#include "pm.h"
#include "queue.h"
#include "radiolink.h"
#include "range.h"
#include "static_mem.h"
#include "supervisor.h"
#include "task.h"

// 19 m × 19 m around the place where the frame of the estimate begins.
enum { CELLS = 64, CELL_MM = 300 };
static const float HALF_M = CELLS * CELL_MM / 2000.0f;

static const float HEIGHT_M = 0.5f;
static const float STEP_S = 1.2f;
// What is nearer in the direction of flight ends the step.
static const float TOO_NEAR_M = 0.10f;
// From the middle of a cell: a wall next to it is nearer than this, another robot in the
// middle of the next cell nearer than that.
static const float WALL_M = 0.19f, ROBOT_M = 0.33f;
// Even a black wall answers from here; farther, no answer may be a black wall.
static const float MAX_RANGE_M = 1.0f;
// What the driver says for "nothing there" and for "invalid" alike: 32.767.
static const float NO_ANSWER_M = 32.0f;
static const float LOW_V = 3.2f;
// (20 mm of range, 20 mm of place, 1 m × 1.5° of heading) / 300 mm
static const float TOLERANCE = 0.22f;

static Planner planner;
static PlannerConfig config = {
    .width = CELLS,
    .height = CELLS,
    .cell_mm = CELL_MM,
    .origin_x_mm = -CELLS * CELL_MM / 2,
    .origin_y_mm = CELLS * CELL_MM / 2,
    .bytes_per_tick = 2 * PLANNER_MAX_FRAME,
    .sensor = PLANNER_SENSOR_RANGERS,
};
static bool is_created;

// What a client shows and sets.
enum { WAITS, CALLS_ROLL, FLIES, LANDS, LANDED, FAILED };
static uint8_t go, state, stop, result, others_of_my_id;
static int16_t at_x, at_y;
static uint32_t known, frontiers;
static PlannerStatus status;

LOG_GROUP_START(explore)
LOG_ADD(LOG_UINT8, state, &state)
LOG_ADD(LOG_UINT8, stop, &stop)
LOG_ADD(LOG_UINT8, result, &result)
LOG_ADD(LOG_UINT8, id, &config.id)
LOG_ADD(LOG_UINT8, sameId, &others_of_my_id)
LOG_ADD(LOG_INT16, x, &at_x)
LOG_ADD(LOG_INT16, y, &at_y)
LOG_ADD(LOG_UINT32, known, &known)
LOG_ADD(LOG_UINT32, frontiers, &frontiers)
LOG_ADD(LOG_UINT16, against, &status.contradictions)
LOG_GROUP_STOP(explore)

PARAM_GROUP_START(explore)
PARAM_ADD(PARAM_UINT8, go, &go)
PARAM_GROUP_STOP(explore)

// The state of the estimator, by the names that its logs have.
static struct {
    logVarId_t x, y, z, roll, pitch, yaw;
} estimate;

static void find_estimate(void) {
    estimate.x = logGetVarId("stateEstimate", "x");
    estimate.y = logGetVarId("stateEstimate", "y");
    estimate.z = logGetVarId("stateEstimate", "z");
    estimate.roll = logGetVarId("stabilizer", "roll");
    estimate.pitch = logGetVarId("stabilizer", "pitch");
    estimate.yaw = logGetVarId("stabilizer", "yaw");
}

static float radians(float degrees) {
    return degrees * 0.017453293f;
}

// Notes what a call came to; false, and the log `result` says why, if it failed.
static bool did(PlannerResult came_to) {
    if (came_to != PLANNER_RESULT_OK) {
        result = came_to;
    }
    return came_to == PLANNER_RESULT_OK;
}

static PlannerPose pose(void) {
    PlannerPose made = {0, 0, 0};
    did(planner_pose_from_metres(&config, logGetFloat(estimate.x), logGetFloat(estimate.y),
                                 radians(logGetFloat(estimate.yaw)), &made));
    return made;
}

static PlannerCell cell_of(PlannerPose at) {
    return (PlannerCell){(int16_t)floorf(at.x), (int16_t)floorf(at.y)};
}

static bool is_same(PlannerCell a, PlannerCell b) {
    return a.x == b.x && a.y == b.y;
}

// Radio. Packets come in another task, so they wait in a queue for this one.

STATIC_MEM_QUEUE_ALLOC(inbox, 16, sizeof(P2PPacket));
static QueueHandle_t inbox;

static void packet_came(P2PPacket *packet) {
    // Where it is full the packet is lost, as others are in the air.
    xQueueSend(inbox, packet, 0);
}

// All Crazyflies leave the factory with one address, which would be their id. Before they
// take off they tell each other id and a number by lot; of two with one id, the one with
// the smaller number takes another. Frames of the planner are longer than this.
typedef struct {
    uint8_t id;
    uint8_t lot[4];
} RollCall;
enum { ROLL_CALL_MS = 4000 };
static uint32_t lot;
static TickType_t id_since;

// By what differs between two robots and between two flights: the noise of the sensors.
static uint32_t draw_lot(void) {
    const float noise[] = {
        logGetFloat(estimate.x),  logGetFloat(estimate.y), logGetFloat(estimate.roll),
        rangeGet(rangeFront),     rangeGet(rangeLeft),     rangeGet(rangeBack),
        logGetFloat(estimate.yaw), pmGetBatteryVoltage(),
    };
    uint32_t hash = 2166136261u ^ xTaskGetTickCount();
    uint8_t bytes[sizeof noise];
    memcpy(bytes, noise, sizeof noise);
    for (unsigned i = 0; i < sizeof bytes; i++) {
        hash = (hash ^ bytes[i]) * 16777619u;
    }
    return hash;
}

static void call_roll(void) {
    static P2PPacket packet;
    RollCall mine = {.id = config.id};
    memcpy(mine.lot, &lot, sizeof lot);
    packet.port = 0;
    packet.size = sizeof mine;
    memcpy(packet.data, &mine, sizeof mine);
    radiolinkSendP2PPacketBroadcast(&packet);
}

static void hear_roll(const P2PPacket *packet) {
    RollCall call;
    uint32_t theirs;
    memcpy(&call, packet->data, sizeof call);
    memcpy(&theirs, call.lot, sizeof theirs);
    if (call.id != config.id || theirs == lot) {
        return;
    }
    if (is_created) {
        // In the air nobody changes. Whoever calls is late, and hears of it.
        lot = UINT32_MAX;
        call_roll();
    } else if (lot < theirs) {
        config.id = (uint8_t)((config.id + 1 + lot % 200) % 255);
        lot = lot * 1664525u + 1013904223u;
        id_since = xTaskGetTickCount();
    }
}

// Where the others are and which cell they want, so that no two fly to one. Frames of the
// planner tell no steps, and come too late for this.
typedef struct {
    uint8_t id, flies;
    PlannerCell at, to;
} Claim;
enum { OTHERS = 8, CLAIM_MS = 3000 };
static struct {
    Claim claim;
    TickType_t heard;
} others[OTHERS];

// What this robot tells of itself, again and again, whenever it waits.
static Claim mine;

static void claim(PlannerCell at, PlannerCell to, bool flies) {
    mine = (Claim){config.id, flies, at, to};
}

static void tell_claim(void) {
    static P2PPacket packet;
    packet.port = 0;
    packet.size = sizeof mine;
    memcpy(packet.data, &mine, sizeof mine);
    radiolinkSendP2PPacketBroadcast(&packet);
}

static void hear_claim(const P2PPacket *packet) {
    Claim heard;
    memcpy(&heard, packet->data, sizeof heard);
    int place = 0;
    for (int i = 0; i < OTHERS; i++) {
        if (others[i].heard != 0 && others[i].claim.id == heard.id) {
            place = i;
            break;
        }
        if (others[i].heard < others[place].heard) {
            place = i;
        }
    }
    others[place].claim = heard;
    others[place].heard = xTaskGetTickCount();
}

// Whether another robot is in the cell, flies there, or wants to and goes first.
static bool is_taken(PlannerCell cell) {
    for (int i = 0; i < OTHERS; i++) {
        const Claim *other = &others[i].claim;
        bool goes_first = other->flies || other->id < config.id;
        if (others[i].heard != 0 && xTaskGetTickCount() - others[i].heard < M2T(CLAIM_MS)
            && (is_same(cell, other->at) || (is_same(cell, other->to) && goes_first))) {
            return true;
        }
    }
    return false;
}

static void take_in(const P2PPacket *packet) {
    if (packet->size == sizeof(RollCall)) {
        hear_roll(packet);
    } else if (packet->size == sizeof(Claim)) {
        hear_claim(packet);
    } else if (is_created) {
        PlannerResult heard = planner_receive(&planner, packet->data, packet->size);
        if (heard == PLANNER_RESULT_FRAME_SAME_ID) {
            others_of_my_id++;
        }
    }
}

// Waits, takes in what others say meanwhile, and tells them where this one is.
static void pass(uint32_t milliseconds) {
    enum { SLICE_MS = 100 };
    while (milliseconds > 0) {
        uint32_t slice = milliseconds < SLICE_MS ? milliseconds : SLICE_MS;
        milliseconds -= slice;
        if (is_created) {
            tell_claim();
        }
        vTaskDelay(M2T(slice));
        static P2PPacket packet;
        while (xQueueReceive(inbox, &packet, 0) == pdTRUE) {
            take_in(&packet);
        }
    }
}

static void tell_others(void) {
    static P2PPacket packet;
    size_t length = 1;
    for (int frames = 0; frames < 4 && length > 0; frames++) {
        if (did(planner_transmit(&planner, packet.data, &length)) && length > 0) {
            packet.port = 0;
            packet.size = (uint8_t)length;
            radiolinkSendP2PPacketBroadcast(&packet);
        }
    }
}

// Sensors.

enum { SIDES = 4 };
static const rangeDirection_t SIDE[SIDES] = {rangeFront, rangeLeft, rangeBack, rangeRight};
static PlannerBeam beams[SIDES];

static void mount_sensors(void) {
    for (int i = 0; i < SIDES; i++) {
        // Counter-clockwise here, clockwise there.
        beams[i].bearing = planner_bearing(-1.5707963f * (float)i);
    }
}

// How far a beam goes that leans as the robot does, before it meets the floor.
static float reach(void) {
    float roll = fabsf(logGetFloat(estimate.roll)), pitch = fabsf(logGetFloat(estimate.pitch));
    float lean = sinf(radians(roll > pitch ? roll : pitch));
    float height = logGetFloat(estimate.z);
    return lean * NO_ANSWER_M > height ? height / lean : NO_ANSWER_M;
}

// In cells, for the planner: a wall, nothing within MAX_RANGE_M, or no measurement (-1).
static float range_of(rangeDirection_t side, float floor) {
    float measured = rangeGet(side);
    float believed = floor - 0.2f;
    if (measured > 0 && measured < believed) {
        return measured * 1000 / CELL_MM;
    }
    return measured >= NO_ANSWER_M && believed >= MAX_RANGE_M ? INFINITY : -1;
}

static void look(void) {
    PlannerPose at = pose();
    float floor = reach();
    for (int i = 0; i < SIDES; i++) {
        beams[i].range = range_of(SIDE[i], floor);
    }
    const float max_range = MAX_RANGE_M * 1000 / CELL_MM;
    did(planner_observe_scan(&planner, &at, max_range, TOLERANCE, beams, SIDES));
}

// Flight. The nose points to the east of the grid, but for a turn.

static void fly_to(PlannerCell cell, float yaw, float seconds) {
    float x = 0, y = 0;
    did(planner_middle_in_metres(&config, cell, &x, &y));
    crtpCommanderHighLevelGoTo(x, y, HEIGHT_M, yaw, seconds, false);
}

static float range_towards(PlannerDirection direction) {
    static const rangeDirection_t TOWARDS[] = {
        [PLANNER_DIRECTION_EAST] = rangeFront,
        [PLANNER_DIRECTION_SOUTH] = rangeRight,
        [PLANNER_DIRECTION_WEST] = rangeBack,
        [PLANNER_DIRECTION_NORTH] = rangeLeft,
    };
    return rangeGet(TOWARDS[direction]);
}

// Ends a step. Wherever that is, the next look says: what counts is whether the robot has
// left its cell.
static uint8_t arrive(PlannerCell from, uint8_t otherwise) {
    PlannerCell at = cell_of(pose());
    claim(at, at, false);
    return is_same(at, from) ? otherwise : PLANNER_MOVED;
}

// One step, tried twice.
static uint8_t step(PlannerDirection direction) {
    static const int8_t DX[] = {1, 0, -1, 0}, DY[] = {0, 1, 0, -1};
    PlannerCell from = cell_of(pose());
    PlannerCell to = {(int16_t)(from.x + DX[direction]), (int16_t)(from.y + DY[direction])};
    claim(from, to, false);
    pass(300);
    float range = range_towards(direction);
    if (is_taken(to) || (range > WALL_M && range < ROBOT_M)) {
        return arrive(from, PLANNER_HELD);
    }
    if (range < WALL_M) {
        return arrive(from, PLANNER_BLOCKED);
    }
    claim(from, to, true);
    for (int attempt = 0; attempt < 2; attempt++) {
        fly_to(to, 0, STEP_S);
        for (float flown = 0; flown < STEP_S + 0.2f; flown += 0.1f) {
            pass(100);
            bool is_there = is_same(cell_of(pose()), to);
            if (is_taken(to) || (!is_there && range_towards(direction) < TOO_NEAR_M)) {
                fly_to(from, 0, STEP_S / 2);
                pass(800);
                return arrive(from, is_taken(to) ? PLANNER_HELD : PLANNER_BLOCKED);
            }
        }
        if (!is_same(cell_of(pose()), from)) {
            break;
        }
    }
    return arrive(from, PLANNER_BLOCKED);
}

// Looks from another angle, and turns back.
static void turn_to_look(PlannerDirection direction) {
    PlannerCell here = cell_of(pose());
    fly_to(here, planner_yaw((uint8_t)direction), 1);
    pass(1200);
    look();
    fly_to(here, 0, 1);
    pass(1200);
}

// Looks, decides, and does what was decided; false when that is to land.
static bool explore(void) {
    look();
    PlannerAction action;
    if (!did(planner_tick(&planner, &action)) || !did(planner_status(&planner, &status))) {
        return false;
    }
    claim(status.position, status.position, false);
    at_x = status.position.x;
    at_y = status.position.y;
    known = status.known;
    frontiers = status.frontiers;
    tell_others();
    switch (action.kind) {
    case PLANNER_ACTION_KIND_MOVE:
        did(planner_report(&planner, step(action.direction)));
        break;
    case PLANNER_ACTION_KIND_WAIT:
        if (action.wait == PLANNER_WAIT_LOOK) {
            turn_to_look(action.look);
        } else {
            // To the middle of the cell: from its edge beams show little.
            fly_to(cell_of(pose()), 0, 0.4f);
            pass(500);
        }
        break;
    case PLANNER_ACTION_KIND_STOP:
        stop = action.stop;
        DEBUG_PRINT("%s\n", planner_stop_text(action.stop));
        return false;
    }
    return go != 0 && pmGetBatteryVoltage() > LOW_V && !supervisorIsTumbled();
}

static bool prepare(void) {
    find_estimate();
    mount_sensors();
    config.id = (uint8_t)configblockGetRadioAddress();
    state = CALLS_ROLL;
    lot = draw_lot();
    id_since = xTaskGetTickCount();
    while (xTaskGetTickCount() - id_since < M2T(ROLL_CALL_MS)) {
        pass(100 + lot % 64);
        call_roll();
    }
    PlannerPose at = pose();
    config.start = cell_of(at);
    if (fabsf(logGetFloat(estimate.x)) > HALF_M || fabsf(logGetFloat(estimate.y)) > HALF_M) {
        result = PLANNER_RESULT_OFF_GRID;
        return false;
    }
    claim(config.start, config.start, false);
    is_created = did(planner_create(&planner, sizeof planner, &config));
    return is_created;
}

void appMain(void) {
    inbox = STATIC_MEM_QUEUE_CREATE(inbox);
    p2pRegisterCB(packet_came);
    while (go == 0) {
        pass(100);
    }
    if (prepare()) {
        state = FLIES;
        crtpCommanderHighLevelTakeoff(HEIGHT_M, 1.5f);
        pass(2000);
        while (explore()) {
        }
        state = LANDS;
        crtpCommanderHighLevelLand(0, 2);
        pass(2500);
        state = LANDED;
    } else {
        DEBUG_PRINT("explore: %s\n", planner_result_text(result));
        state = FAILED;
    }
    // On the ground it goes on telling the others what it knows.
    for (;;) {
        pass(500);
        PlannerAction action;
        if (is_created && did(planner_tick(&planner, &action))) {
            tell_others();
        }
    }
}
