// Programs in C that use the interface wrongly get an answer, and nothing else happens:
// compiled with sanitizers and run on the host by `cargo xtask test --only c-misuse`.
// Every block that the library gets is as large as its type and no larger.

#include "planner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

#define CHECK(what, wanted)                                                              \
    do {                                                                                 \
        int got = (int)(what);                                                           \
        if (got != (int)(wanted)) {                                                      \
            printf("line %d: %s is %d, not %d\n", __LINE__, #what, got, (int)(wanted));  \
            failures++;                                                                  \
        }                                                                                \
    } while (0)

static PlannerConfig usual(void) {
    return (PlannerConfig){.id = 1, .width = 20, .height = 20, .start = {5, 5}, .cell_mm = 100, .bytes_per_tick = 55, .sensor = PLANNER_SENSOR_TRUTHFUL};
}

static void look(Planner *planner, PlannerCell at) {
    PlannerSeen seen[4] = {
        {{(int16_t)(at.x + 1), at.y}, 0},
        {{at.x, (int16_t)(at.y + 1)}, 0},
        {{(int16_t)(at.x - 1), at.y}, 1},
        {{at.x, (int16_t)(at.y - 1)}, 1},
    };
    CHECK(planner_observe_cells(planner, at, seen, 4), PLANNER_RESULT_OK);
}

// Every call but create, on memory that holds no planner.
static void nothing_is_created(Planner *planner) {
    PlannerPose pose = {5.5f, 5.5f, 0};
    PlannerAction action;
    uint8_t frame[PLANNER_MAX_FRAME] = {0};
    size_t length;
    uint32_t known;
    bool is_mute;
    PlannerStatus status;
    PlannerResult wanted = PLANNER_RESULT_NOT_CREATED;
    CHECK(planner_observe_scan(planner, &pose, 5, PLANNER_TOLERANCE, NULL, 0), wanted);
    CHECK(planner_observe_cells(planner, (PlannerCell){5, 5}, NULL, 0), wanted);
    CHECK(planner_tick(planner, &action), wanted);
    CHECK(planner_report(planner, PLANNER_MOVED), wanted);
    CHECK(planner_resume(planner), wanted);
    CHECK(planner_go_home(planner), wanted);
    CHECK(planner_go_to(planner, (PlannerCell){5, 5}), wanted);
    CHECK(planner_energy(planner, 9), wanted);
    CHECK(planner_keep_out(planner, NULL), wanted);
    CHECK(planner_recentre(planner, 0, 0), wanted);
    CHECK(planner_settle(planner), wanted);
    CHECK(planner_saved_bytes(planner, &length), wanted);
    CHECK(planner_save(planner, 0, frame, sizeof frame, &length), wanted);
    CHECK(planner_restore(planner, frame, sizeof frame), wanted);
    CHECK(planner_transmit(planner, frame, &length), wanted);
    CHECK(planner_receive(planner, frame, 16), wanted);
    CHECK(planner_status(planner, &status), wanted);
    CHECK(planner_cell(planner, (PlannerCell){5, 5}, frame), wanted);
    CHECK(planner_row(planner, 5, frame, sizeof frame, &length), wanted);
    CHECK(planner_is_mute(planner, &is_mute), wanted);
    PlannerCell shut[PLANNER_MAX_SHUT];
    CHECK(planner_waypoint(planner, &is_mute, shut), wanted);
    CHECK(planner_way(planner, shut, PLANNER_MAX_SHUT, &length), wanted);
    CHECK(planner_shut(planner, &known, shut, PLANNER_MAX_SHUT, &length), wanted);
}

// Creates with what cannot be: the memory stays as it is, byte by byte.
static void refused(Planner *planner, PlannerConfig config, PlannerResult wanted) {
    Planner *before = malloc(sizeof *before);
    memcpy(before, planner, sizeof *before);
    PlannerConfig *given = malloc(sizeof *given);
    *given = config;
    CHECK(planner_create(planner, sizeof(Planner), given), wanted);
    CHECK(memcmp(before, planner, sizeof *before), 0);
    free(given);
    free(before);
}

static void all_refused(Planner *planner) {
    PlannerConfig config = usual();
    refused(planner, (PlannerConfig){0}, PLANNER_RESULT_EXTENT);
    config.width = 129;
    refused(planner, config, PLANNER_RESULT_EXTENT);
    config = usual();
    config.height = 0;
    refused(planner, config, PLANNER_RESULT_EXTENT);
    config = usual();
    config.start.x = 20;
    refused(planner, config, PLANNER_RESULT_EXTENT);
    config.start.x = -1;
    refused(planner, config, PLANNER_RESULT_EXTENT);
    config = usual();
    config.cell_mm = 0;
    refused(planner, config, PLANNER_RESULT_CELL_SIZE);
    config = usual();
    config.sensor = 3;
    refused(planner, config, PLANNER_RESULT_SENSOR);
    config.sensor = PLANNER_SENSOR_LIDAR;
    config.margin = 4;
    refused(planner, config, PLANNER_RESULT_SENSOR);
    config = usual();
    config.clearance = 4;
    refused(planner, config, PLANNER_RESULT_CLEARANCE);
}

static void a_failed_create_changes_nothing(Planner *planner) {
    for (int pattern = 0; pattern < 256; pattern += 5) {
        memset(planner, pattern, sizeof *planner);
        nothing_is_created(planner);
        all_refused(planner);
        nothing_is_created(planner);
    }
    PlannerConfig config = usual();
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    look(planner, config.start);
    all_refused(planner);
    CHECK(planner_create(planner, sizeof(Planner), NULL), PLANNER_RESULT_NULL);
    PlannerAction action;
    CHECK(planner_tick(planner, &action), PLANNER_RESULT_OK);
    CHECK(action.kind, PLANNER_ACTION_KIND_MOVE);
}

static void odd_pointers_and_counts(Planner *planner) {
    char *block = malloc(sizeof *planner + 16);
    PlannerConfig config = usual();
    for (int offset = 1; offset < 8; offset++) {
        Planner *crooked = (Planner *)(void *)(block + offset);
        CHECK(planner_create(crooked, sizeof(Planner), &config), PLANNER_RESULT_MISALIGNED);
        CHECK(planner_resume(crooked), PLANNER_RESULT_MISALIGNED);
    }
    free(block);
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    PlannerPose pose = {5.5f, 5.5f, 0};
    enum { BEAMS = 1000 };
    PlannerBeam *beams = calloc(BEAMS, sizeof *beams);
    PlannerSeen *seen = calloc(1, sizeof *seen);
    CHECK(planner_observe_scan(planner, &pose, 5, PLANNER_TOLERANCE, beams, BEAMS), PLANNER_RESULT_OK);
    CHECK(planner_observe_scan(planner, &pose, 5, PLANNER_TOLERANCE, beams, SIZE_MAX), PLANNER_RESULT_TOO_MANY);
    CHECK(planner_observe_scan(planner, &pose, 5, PLANNER_TOLERANCE, NULL, 3), PLANNER_RESULT_NULL);
    CHECK(planner_observe_cells(planner, config.start, seen, SIZE_MAX), PLANNER_RESULT_TOO_MANY);
    CHECK(planner_observe_cells(planner, config.start, NULL, 1), PLANNER_RESULT_NULL);
    CHECK(planner_receive(planner, (uint8_t *)seen, SIZE_MAX), PLANNER_RESULT_TOO_MANY);
    CHECK(planner_receive(planner, NULL, 0), PLANNER_RESULT_FRAME_LENGTH);
    CHECK(planner_report(planner, 3), PLANNER_RESULT_MOTION);
    free(seen);
    free(beams);
}

static void odd_numbers(Planner *planner) {
    static const float ODD[] = {NAN, INFINITY, -INFINITY, -1, 0, 1e38f, -1e38f, 1e-45f, 3e9f, 65536};
    PlannerConfig config = usual();
    for (size_t i = 0; i < sizeof ODD / sizeof *ODD; i++) {
        for (int field = 0; field < 9; field++) {
            PlannerPose pose = {5.5f, 5.5f, 0};
            PlannerBeam beams[3] = {{{1, 0}, 2}, {planner_bearing(1), 2}, {planner_bearing(2), 2}};
            float range = 5, tolerance = PLANNER_TOLERANCE, angle = 1;
            float *fields[9] = {&pose.x,         &pose.y,
                                &pose.heading,   &range,
                                &beams[1].range, &beams[1].bearing.ahead,
                                &beams[1].bearing.right, &angle,
                                &tolerance};
            *fields[field] = ODD[i];
            CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
            if (field == 7) {
                beams[1].bearing = planner_bearing(angle);
            }
            PlannerResult result = planner_observe_scan(planner, &pose, range, tolerance, beams, 3);
            bool is_off_grid = field < 2 && isfinite(ODD[i]) && (ODD[i] < 0 || ODD[i] >= 20);
            bool is_odd = field < 4 && !isfinite(ODD[i]);
            bool is_no_range = field == 3 && !(ODD[i] > 0);
            bool is_no_tolerance = field == 8 && !(ODD[i] >= 0 && ODD[i] <= 0.25f);
            CHECK(result, is_off_grid              ? PLANNER_RESULT_OFF_GRID
                          : is_odd || is_no_range || is_no_tolerance ? PLANNER_RESULT_SCAN
                                                                     : PLANNER_RESULT_OK);
            PlannerAction action;
            CHECK(planner_tick(planner, &action), PLANNER_RESULT_OK);
            if (result != PLANNER_RESULT_OK) {
                CHECK(action.kind, PLANNER_ACTION_KIND_WAIT);
            }
        }
    }
    static const PlannerCell OFF[] = {{INT16_MAX, INT16_MAX}, {INT16_MIN, INT16_MIN}, {-1, 5}, {20, 5}};
    for (size_t i = 0; i < sizeof OFF / sizeof *OFF; i++) {
        CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
        PlannerSeen seen = {OFF[i], 0};
        CHECK(planner_observe_cells(planner, OFF[i], &seen, 1), PLANNER_RESULT_OFF_GRID);
        PlannerAction action;
        CHECK(planner_tick(planner, &action), PLANNER_RESULT_OK);
        CHECK(action.kind, PLANNER_ACTION_KIND_WAIT);
    }
}

// Frames without sense are refused, and a key refuses those without it.
static void odd_frames(Planner *planner) {
    PlannerConfig config = usual();
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    uint32_t random = 1;
    int taken = 0;
    for (int i = 0; i < 100000; i++) {
        random = random * 1103515245u + 12345u;
        size_t length = random >> 16 & 63;
        uint8_t *frame = malloc(length > 0 ? length : 1);
        for (size_t j = 0; j < length; j++) {
            random = random * 1103515245u + 12345u;
            frame[j] = (uint8_t)(random >> 20);
        }
        taken += planner_receive(planner, frame, length) < PLANNER_RESULT_FRAME_LENGTH;
        free(frame);
    }
    CHECK(taken, 0);
    uint8_t *frame = malloc(PLANNER_MAX_FRAME);
    size_t *length = malloc(sizeof *length);
    look(planner, config.start);
    CHECK(planner_transmit(planner, frame, length), PLANNER_RESULT_OK);
    CHECK(planner_receive(planner, frame, *length), PLANNER_RESULT_FRAME_OWN);
    config.id = 2;
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    CHECK(planner_receive(planner, frame, *length), PLANNER_RESULT_OK);
    config.is_keyed = 1;
    memset(config.key, 7, sizeof config.key);
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    CHECK(planner_receive(planner, frame, *length) >= PLANNER_RESULT_FRAME_LENGTH, true);
    config.bytes_per_tick = 0;
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    bool *is_mute = malloc(sizeof *is_mute);
    CHECK(planner_is_mute(planner, is_mute), PLANNER_RESULT_OK);
    CHECK(*is_mute, true);
    free(is_mute);
    free(length);
    free(frame);
}

// A row that is longer than the memory for it is cut; one off the grid is none.
static void maps_are_read(Planner *planner) {
    PlannerConfig config = usual();
    CHECK(planner_create(planner, sizeof(Planner) - 8, &config), PLANNER_RESULT_MEMORY);
    CHECK(planner_create(planner, sizeof(Planner), &config), PLANNER_RESULT_OK);
    look(planner, config.start);
    size_t *count = malloc(sizeof *count);
    for (size_t room = 0; room <= 20; room++) {
        uint8_t *row = malloc(room + 1);
        CHECK(planner_row(planner, 5, row, room, count), PLANNER_RESULT_OK);
        CHECK(*count, room);
        free(row);
    }
    CHECK(planner_row(planner, 20, NULL, 9, count), PLANNER_RESULT_OFF_GRID);
    CHECK(planner_row(planner, 5, NULL, 9, count), PLANNER_RESULT_NULL);
    free(count);
    uint8_t state;
    CHECK(planner_cell(planner, config.start, &state), PLANNER_RESULT_OK);
    CHECK(state, PLANNER_STATE_FREE);
    CHECK(planner_cell(planner, (PlannerCell){-1, 0}, &state), PLANNER_RESULT_OFF_GRID);
    for (int code = 0; code < 256; code++) {
        CHECK(strlen(planner_result_text((uint8_t)code)) > 3, true);
        CHECK(strlen(planner_stop_text((uint8_t)code)) > 3, true);
        CHECK(strlen(planner_wait_text((uint8_t)code)) > 3, true);
    }
}

static PlannerVoxelConfig usual_box(void) {
    return (PlannerVoxelConfig){.id = 1, .width = 9, .depth = 8, .levels = 7, .range = 4, .clearance = 1, .cell_mm = 500, .bytes_per_tick = 550};
}

// Every call but create, on memory that holds no planner among voxels.
static void no_survey_is_created(PlannerVoxelSurvey *survey) {
    PlannerVoxel at = {4, 4, 3};
    PlannerVoxelAction action;
    PlannerVoxelStatus status = {0};
    uint8_t frame[PLANNER_MAX_FRAME] = {0};
    size_t length;
    PlannerResult wanted = PLANNER_RESULT_NOT_CREATED;
    CHECK(planner_voxel_observe(survey, at, 0, NULL, 0), wanted);
    CHECK(planner_voxel_tick(survey, &action), wanted);
    CHECK(planner_voxel_resume(survey), wanted);
    CHECK(planner_voxel_go_home(survey), wanted);
    CHECK(planner_voxel_energy(survey, 9), wanted);
    CHECK(planner_voxel_transmit(survey, frame, &length), wanted);
    CHECK(planner_voxel_receive(survey, frame, 16), wanted);
    CHECK(planner_voxel_hear(survey, 2, &status), wanted);
    CHECK(planner_voxel_status(survey, &status), wanted);
    CHECK(planner_voxel_state(survey, at, frame), wanted);
}

// Creates with what cannot be: the memory stays as it is, byte by byte.
static void boxes_are_refused(PlannerVoxelSurvey *survey) {
    struct { int width, depth, levels, range, field, cell_mm, wanted; } bad[] = {
        {0, 8, 7, 4, 0, 500, PLANNER_RESULT_EXTENT},
        {9, PLANNER_VOXEL_MAX_SIDE + 1, 7, 4, 0, 500, PLANNER_RESULT_EXTENT},
        {9, 8, PLANNER_VOXEL_MAX_LEVELS + 1, 4, 0, 500, PLANNER_RESULT_EXTENT},
        {9, 8, 0, 4, 0, 500, PLANNER_RESULT_EXTENT},
        {9, 8, 7, 4, 0, 0, PLANNER_RESULT_CELL_SIZE},
        {9, 8, 7, 1, 0, 500, PLANNER_RESULT_RANGE},
        {9, 8, 7, PLANNER_VOXEL_MAX_RANGE + 1, 0, 500, PLANNER_RESULT_RANGE},
        {9, 8, 7, 4, PLANNER_VOXEL_FIELD_CUSTOM + 1, 500, PLANNER_RESULT_SENSOR},
    };
    PlannerVoxelSurvey *before = malloc(sizeof *before);
    memcpy(before, survey, sizeof *before);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        PlannerVoxelConfig config = usual_box();
        config.width = (uint16_t)bad[i].width;
        config.depth = (uint16_t)bad[i].depth;
        config.levels = (uint8_t)bad[i].levels;
        config.range = (uint8_t)bad[i].range;
        config.field = (uint8_t)bad[i].field;
        config.cell_mm = (uint16_t)bad[i].cell_mm;
        CHECK(planner_voxel_create(survey, sizeof *survey, &config), bad[i].wanted);
    }
    CHECK(planner_voxel_create(survey, sizeof *survey, NULL), PLANNER_RESULT_NULL);
    PlannerVoxelConfig config = usual_box();
    CHECK(planner_voxel_create(survey, sizeof *survey - 8, &config), PLANNER_RESULT_MEMORY);
    CHECK(memcmp(before, survey, sizeof *before), 0);
    free(before);
}

// What a look shows where nothing is but a wall in the east.
static size_t look_around(PlannerVoxelSeen *seen, PlannerVoxel at) {
    size_t count = 0;
    for (int z = -1; z <= 1; z++) {
        for (int y = -1; y <= 1; y++) {
            for (int x = -1; x <= 1; x++) {
                PlannerVoxel voxel = {(int16_t)(at.x + x), (int16_t)(at.y + y), (int16_t)(at.z + z)};
                seen[count++] = (PlannerVoxelSeen){voxel, (uint8_t)(voxel.x >= 8 ? 200 : 0)};
            }
        }
    }
    return count;
}

static void among_voxels(void) {
    PlannerVoxelSurvey *survey = malloc(sizeof *survey);
    for (int pattern = 0; pattern < 256; pattern += 5) {
        memset(survey, pattern, sizeof *survey);
        no_survey_is_created(survey);
        boxes_are_refused(survey);
        no_survey_is_created(survey);
    }
    PlannerVoxelConfig config = usual_box();
    CHECK(planner_voxel_create(survey, sizeof *survey, &config), PLANNER_RESULT_OK);
    boxes_are_refused(survey);
    PlannerVoxelSeen *seen = malloc(27 * sizeof *seen);
    PlannerVoxel at = {4, 4, 3};
    size_t count = look_around(seen, at);
    CHECK(planner_voxel_observe(survey, at, 8, seen, count), PLANNER_RESULT_HEADING);
    CHECK(planner_voxel_observe(survey, at, 255, seen, count), PLANNER_RESULT_HEADING);
    CHECK(planner_voxel_observe(survey, at, 0, NULL, 1), PLANNER_RESULT_NULL);
    CHECK(planner_voxel_observe(survey, at, 0, seen, SIZE_MAX), PLANNER_RESULT_TOO_MANY);
    CHECK(planner_voxel_observe(survey, at, 7, seen, count), PLANNER_RESULT_OK);
    PlannerVoxelAction action;
    CHECK(planner_voxel_tick(survey, &action), PLANNER_RESULT_OK);
    // Places outside of the box, and looks from there or of there.
    static const PlannerVoxel OFF[] = {{INT16_MAX, INT16_MAX, INT16_MAX}, {INT16_MIN, INT16_MIN, INT16_MIN}, {9, 0, 0}, {0, 8, 0}, {0, 0, 7}, {-1, 0, 0}};
    for (size_t i = 0; i < sizeof OFF / sizeof *OFF; i++) {
        for (size_t j = 0; j < count; j++) {
            seen[j].voxel = OFF[i];
        }
        CHECK(planner_voxel_observe(survey, OFF[i], 0, seen, count), PLANNER_RESULT_OFF_GRID);
        CHECK(planner_voxel_tick(survey, &action), PLANNER_RESULT_OK);
        CHECK(action.wait, PLANNER_WAIT_POSE);
        CHECK(planner_voxel_observe(survey, at, 0, seen, count), PLANNER_RESULT_OK);
        CHECK(planner_voxel_tick(survey, &action), PLANNER_RESULT_OK);
        uint8_t state;
        CHECK(planner_voxel_state(survey, OFF[i], &state), PLANNER_RESULT_OFF_GRID);
        PlannerVoxelStatus told = {.position = OFF[i]};
        CHECK(planner_voxel_hear(survey, 2, &told), PLANNER_RESULT_OFF_GRID);
        told = (PlannerVoxelStatus){.position = at, .has_goal = 255, .goal = OFF[i]};
        CHECK(planner_voxel_hear(survey, 2, &told), PLANNER_RESULT_OFF_GRID);
        told.has_goal = 0;
        CHECK(planner_voxel_hear(survey, 2, &told), PLANNER_RESULT_OK);
        CHECK(planner_voxel_hear(survey, 1, &told), PLANNER_RESULT_FRAME_OWN);
    }
    // A robot that sees nothing but its neighbours flies until it has enough of it.
    int steps = 0;
    for (; steps < 20000; steps++) {
        count = look_around(seen, at);
        CHECK(planner_voxel_observe(survey, at, action.heading, seen, count), PLANNER_RESULT_OK);
        CHECK(planner_voxel_tick(survey, &action), PLANNER_RESULT_OK);
        if (action.kind == PLANNER_ACTION_KIND_STOP) {
            break;
        }
        at = action.to;
    }
    CHECK(action.kind, PLANNER_ACTION_KIND_STOP);
    uint8_t *frame = malloc(PLANNER_MAX_FRAME);
    size_t *length = malloc(sizeof *length);
    CHECK(planner_voxel_transmit(survey, frame, length), PLANNER_RESULT_OK);
    CHECK(*length > 0, true);
    CHECK(planner_voxel_receive(survey, frame, *length), PLANNER_RESULT_FRAME_OWN);
    CHECK(planner_voxel_receive(survey, frame, SIZE_MAX), PLANNER_RESULT_TOO_MANY);
    CHECK(planner_voxel_receive(survey, NULL, 0), PLANNER_RESULT_FRAME_LENGTH);
    config.id = 2;
    CHECK(planner_voxel_create(survey, sizeof *survey, &config), PLANNER_RESULT_OK);
    CHECK(planner_voxel_receive(survey, frame, *length), PLANNER_RESULT_OK);
    for (size_t cut = 0; cut < *length; cut++) {
        uint8_t *part = malloc(cut + 1);
        memcpy(part, frame, cut);
        CHECK(planner_voxel_receive(survey, part, cut) >= PLANNER_RESULT_FRAME_LENGTH, true);
        free(part);
    }
    free(length);
    free(frame);
    free(seen);
    free(survey);
}

// A sensor with zones whose values cannot be writes no beam; one with odd zones does.
static void zones_become_beams(void) {
    PlannerZoneSensor *front = malloc(sizeof *front);
    PlannerZone *zones = malloc(PLANNER_ZONES * sizeof *zones);
    PlannerBeam *beams = calloc(PLANNER_ZONE_BEAMS, sizeof *beams);
    float *range = calloc(1, sizeof *range);
    memset(zones, 0xa5, PLANNER_ZONES * sizeof *zones);
    *front = (PlannerZoneSensor){.field_of_view = 0.785f, .max_range_mm = 1000, .height_mm = 80, .floor_mm = 30, .top_mm = 120, .cell_mm = 100};
    PlannerZoneSensor usual = *front;
    front->field_of_view = NAN;
    CHECK(planner_zone_beams(front, zones, beams, range), PLANNER_RESULT_ZONE_FIELD_OF_VIEW);
    *front = usual;
    front->pitch = 1;
    CHECK(planner_zone_beams(front, zones, beams, range), PLANNER_RESULT_ZONE_PITCH);
    *front = usual;
    front->yaw = INFINITY;
    CHECK(planner_zone_beams(front, zones, beams, range), PLANNER_RESULT_ZONE_YAW);
    *front = usual;
    front->top_mm = 80;
    CHECK(planner_zone_beams(front, zones, beams, range), PLANNER_RESULT_ZONE_HEIGHTS);
    *front = usual;
    front->cell_mm = 0;
    CHECK(planner_zone_beams(front, zones, beams, range), PLANNER_RESULT_ZONE_ZERO);
    CHECK(planner_zone_beams(NULL, zones, beams, range), PLANNER_RESULT_NULL);
    CHECK(planner_zone_beams(&usual, NULL, beams, range), PLANNER_RESULT_NULL);
    CHECK(planner_zone_beams(&usual, zones, NULL, range), PLANNER_RESULT_NULL);
    CHECK(planner_zone_beams(&usual, zones, beams, NULL), PLANNER_RESULT_NULL);
    CHECK(*range > 0 || beams[0].range > 0, false);
    uint32_t random = 1;
    for (int i = 0; i < 1000; i++) {
        for (int zone = 0; zone < PLANNER_ZONES; zone++) {
            random = random * 1103515245u + 12345u;
            zones[zone].status = (random >> 16 & 1) ? 5 : (uint8_t)(random >> 24);
            zones[zone].distance_mm = (int16_t)(random >> 8);
        }
        CHECK(planner_zone_beams(&usual, zones, beams, range), PLANNER_RESULT_OK);
        CHECK(*range > 0, true);
    }
    free(range);
    free(beams);
    free(zones);
    free(front);
}

// Any zones and rays, into memory of just the size: no byte behind it is touched.
static void zones_become_looks(void) {
    PlannerVoxelConfig *config = calloc(1, sizeof *config);
    PlannerZone *zones = calloc(PLANNER_ZONES, sizeof *zones);
    PlannerVoxelSeen *seen = calloc(PLANNER_VOXEL_ZONES_SEEN, sizeof *seen);
    PlannerVoxelPose pose;
    config->width = config->depth = 40;
    config->levels = 16;
    config->range = 255;
    const PlannerZoneSensor front = {.field_of_view = 1.57f, .max_range_mm = 65535, .ahead_mm = 10};
    CHECK(planner_voxel_pose_from_metres(config, 1, -1, 1, 0, &pose), PLANNER_RESULT_CELL_SIZE);
    config->cell_mm = 50;
    CHECK(planner_voxel_pose_from_metres(config, 1, -1, 0.4f, 0, &pose), PLANNER_RESULT_OK);
    PlannerVoxel at;
    uint8_t heading;
    CHECK(planner_voxel_at(config, &pose, &at, &heading), PLANNER_RESULT_OK);
    uint32_t random = 1;
    for (int i = 0; i < 1000; i++) {
        for (int zone = 0; zone < PLANNER_ZONES; zone++) {
            random = random * 1103515245u + 12345u;
            zones[zone].status = (random >> 16 & 1) ? 255 : 5;
            zones[zone].distance_mm = (int16_t)(random >> 18 & 1023);
        }
        pose.heading = (float)i;
        PlannerVoxelLook look = {seen, PLANNER_VOXEL_ZONES_SEEN, 0};
        CHECK(planner_voxel_zones(config, &pose, &front, 0, zones, &look), PLANNER_RESULT_OK);
        CHECK(look.count > 0 && look.count <= look.room, true);
        look.room = look.count;
        const PlannerRay up = {{0, 0, 0}, {0, 0, 1}, (float)(i % 20) + 0.5f};
        PlannerResult result = planner_voxel_rays(config, &pose, 12, 0.1f, &up, 1, &look);
        CHECK(result == PLANNER_RESULT_OK || result == PLANNER_RESULT_TOO_MANY, true);
    }
    PlannerVoxelLook nowhere = {NULL, PLANNER_VOXEL_ZONES_SEEN, 0};
    CHECK(planner_voxel_zones(config, &pose, &front, 0, zones, &nowhere), PLANNER_RESULT_NULL);
    nowhere.count = (size_t)-1;
    CHECK(planner_voxel_zones(config, &pose, &front, 0, zones, &nowhere), PLANNER_RESULT_TOO_MANY);
    CHECK(planner_voxel_zones(config, &pose, &front, 0, zones, NULL), PLANNER_RESULT_NULL);
    CHECK(planner_voxel_rays(config, NULL, 12, 0, NULL, 0, &nowhere), PLANNER_RESULT_NULL);
    CHECK(planner_voxel_set_field(NULL, 1, 1, 1), PLANNER_RESULT_NULL);
    CHECK(planner_voxel_set_field(config, -1, 1, 1), PLANNER_RESULT_SENSOR);
    CHECK(planner_voxel_middle_in_metres(config, at, NULL, NULL, NULL), PLANNER_RESULT_NULL);
    CHECK(planner_voxel_yaw(255) < 4, true);
    free(seen);
    free(zones);
    free(config);
}

int main(void) {
    Planner *planner = malloc(sizeof *planner);
    a_failed_create_changes_nothing(planner);
    odd_pointers_and_counts(planner);
    odd_numbers(planner);
    odd_frames(planner);
    maps_are_read(planner);
    among_voxels();
    zones_become_beams();
    zones_become_looks();
    // Reasons by number, also those that do not exist.
    for (int stop = 0; stop < 256; stop++) {
        bool is_complete = stop == PLANNER_STOP_COMPLETE || stop == PLANNER_STOP_ENCLOSED
            || stop == PLANNER_STOP_AT_EDGE || stop == PLANNER_STOP_OUT_OF_REACH;
        CHECK(planner_stop_is_complete((uint8_t)stop), is_complete);
    }
    free(planner);
    printf("%d failures\n", failures);
    return failures != 0;
}
