// A stub of a Crazyflie's firmware: see stub.h. Whenever the app waits, it tells a simulator
// what the app wants and hears what its sensors say, over two pipes of the host.

#include "stub.h"

#include "board.h"

#include <stdarg.h>
#include <string.h>

enum { PACKETS = 16, SYS_OPEN = 1, SYS_WRITE = 5, SYS_READ = 6 };

typedef struct {
    uint8_t size, data[P2P_MAX_DATA_SIZE];
} Packet;

// What goes over the pipes, little-endian; `cargo xtask` has the other side.
typedef struct {
    uint32_t delay, known, stack;
    float target[4], duration;
    uint8_t command, state, stop, count;
    uint32_t id;
} Request;
enum { NOTHING, TAKE_OFF, GO, LAND };
typedef struct {
    uint32_t now;
    float pose[3], angles[3], ranges[4], volts;
    uint8_t go, count, unused[2];
} Reply;
_Static_assert(sizeof(Request) == 40 && sizeof(Reply) == 52, "as the simulator has them");

static Request request;
static Reply reply;
static Packet outgoing[PACKETS], incoming[PACKETS];
static void (*callback)(P2PPacket *packet);
static uintptr_t to_simulator, from_simulator;

extern const StubVariable stub_log_explore[], stub_param_explore[];

static uint32_t logged(const char *name) {
    for (const StubVariable *it = stub_log_explore; it->name != NULL; it++) {
        if (strcmp(it->name, name) == 0) {
            switch (it->type) {
            case LOG_UINT8:
                return *(uint8_t *)it->address;
            case LOG_UINT16:
            case LOG_INT16:
                return *(uint16_t *)it->address;
            default:
                return *(uint32_t *)it->address;
            }
        }
    }
    board_print("no such log\n");
    board_exit(false);
}

static void set(const char *name, uint8_t value) {
    for (const StubVariable *it = stub_param_explore; it->name != NULL; it++) {
        if (strcmp(it->name, name) == 0) {
            *(uint8_t *)it->address = value;
            return;
        }
    }
    board_print("no such parameter\n");
    board_exit(false);
}

static uintptr_t open(const char *name, uintptr_t mode) {
    uintptr_t arguments[] = {(uintptr_t)name, mode, strlen(name)};
    return board_semihosting(SYS_OPEN, (uintptr_t)arguments);
}

static void write(const void *bytes, uint32_t length) {
    uintptr_t arguments[] = {to_simulator, (uintptr_t)bytes, length};
    if (board_semihosting(SYS_WRITE, (uintptr_t)arguments) != 0) {
        board_exit(false);
    }
}

static void read(void *bytes, uint32_t length) {
    while (length > 0) {
        uintptr_t arguments[] = {from_simulator, (uintptr_t)bytes, length};
        uintptr_t missing = board_semihosting(SYS_READ, (uintptr_t)arguments);
        if (missing >= length) {
            // The simulator has seen enough.
            board_exit(true);
        }
        bytes = (uint8_t *)bytes + (length - missing);
        length = missing;
    }
}

// The stack of the app's task, painted: what lost its paint was used.
extern uint32_t app_stack[], app_stack_top[];
enum { PAINT = 0x5aa55aa5 };

static uint32_t used(void) {
    const uint32_t *at = app_stack;
    while (at < app_stack_top && *at == PAINT) {
        at++;
    }
    return (uint32_t)(app_stack_top - at) * sizeof *at;
}

void vTaskDelay(TickType_t ticks) {
    request.delay = ticks;
    request.known = logged("known");
    request.state = (uint8_t)logged("state");
    request.stop = (uint8_t)logged("stop");
    request.id = logged("id");
    request.stack = used();
    write(&request, sizeof request);
    write(outgoing, request.count * sizeof *outgoing);
    request.command = NOTHING;
    request.count = 0;
    read(&reply, sizeof reply);
    read(incoming, reply.count * sizeof *incoming);
    set("go", reply.go);
    // In another task than the app's.
    for (uint8_t i = 0; i < reply.count && callback != NULL; i++) {
        static P2PPacket packet;
        packet.size = incoming[i].size;
        memcpy(packet.data, incoming[i].data, sizeof packet.data);
        callback(&packet);
    }
}

TickType_t xTaskGetTickCount(void) {
    return reply.now;
}

QueueHandle_t xQueueCreateStatic(uint32_t length, uint32_t size, uint8_t *items, StaticQueue_t *queue) {
    *queue = (StaticQueue_t){items, length, size, 0, 0};
    return queue;
}

BaseType_t xQueueSend(QueueHandle_t queue, const void *item, TickType_t wait) {
    (void)wait;
    if (queue->count == queue->length) {
        return 0;
    }
    uint32_t at = (queue->first + queue->count++) % queue->length;
    memcpy(queue->items + at * queue->size, item, queue->size);
    return pdTRUE;
}

BaseType_t xQueueReceive(QueueHandle_t queue, void *item, TickType_t wait) {
    (void)wait;
    if (queue->count == 0) {
        return 0;
    }
    memcpy(item, queue->items + queue->first * queue->size, queue->size);
    queue->first = (queue->first + 1) % queue->length;
    queue->count--;
    return pdTRUE;
}

// Knows %s and nothing else.
void stub_print(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    for (; *format != 0; format++) {
        if (strncmp(format, "%s", 2) == 0) {
            board_print(va_arg(arguments, const char *));
            format++;
        } else {
            board_print((char[]){*format, 0});
        }
    }
    va_end(arguments);
}

enum { VARIABLES = 6 };
logVarId_t logGetVarId(const char *group, const char *name) {
    static const char *const NAMES[VARIABLES][2] = {
        {"stateEstimate", "x"}, {"stateEstimate", "y"}, {"stateEstimate", "z"},
        {"stabilizer", "roll"}, {"stabilizer", "pitch"}, {"stabilizer", "yaw"},
    };
    for (logVarId_t i = 0; i < VARIABLES; i++) {
        if (strcmp(group, NAMES[i][0]) == 0 && strcmp(name, NAMES[i][1]) == 0) {
            return i;
        }
    }
    return 0xffff;
}

float logGetFloat(logVarId_t variable) {
    return variable < 3 ? reply.pose[variable] : variable < VARIABLES ? reply.angles[variable - 3] : 0;
}

void p2pRegisterCB(void (*registered)(P2PPacket *packet)) {
    callback = registered;
}

bool radiolinkSendP2PPacketBroadcast(P2PPacket *packet) {
    if (request.count == PACKETS || packet->size > P2P_MAX_DATA_SIZE) {
        return false;
    }
    Packet *out = &outgoing[request.count++];
    out->size = packet->size;
    memcpy(out->data, packet->data, sizeof out->data);
    return true;
}

uint64_t configblockGetRadioAddress(void) {
    return 0xe7e7e7e7e7; // As every one of them leaves the factory.
}

float rangeGet(rangeDirection_t direction) {
    return direction <= rangeRight ? reply.ranges[direction] : 32.767f;
}

float pmGetBatteryVoltage(void) {
    return reply.volts;
}

bool supervisorIsTumbled(void) {
    return false;
}

static int command(uint8_t what, float x, float y, float z, float yaw, float duration) {
    request.command = what;
    memcpy(request.target, (float[]){x, y, z, yaw}, sizeof request.target);
    request.duration = duration;
    return 0;
}

int crtpCommanderHighLevelTakeoff(float height, float duration) {
    return command(TAKE_OFF, 0, 0, height, 0, duration);
}

int crtpCommanderHighLevelLand(float height, float duration) {
    return command(LAND, 0, 0, height, 0, duration);
}

int crtpCommanderHighLevelGoTo(float x, float y, float z, float yaw, float duration, bool relative) {
    (void)relative;
    return command(GO, x, y, z, yaw, duration);
}

// The 900 words that the app's task has, of a stack of their own.
__asm__(".section .bss.app_stack,\"aw\",%nobits\n.balign 8\n"
        ".global app_stack\napp_stack: .space 3600\n"
        ".global app_stack_top\napp_stack_top:\n.text\n");

int main(void) {
    to_simulator = open("/dev/stdout", 5 /* write, binary */);
    from_simulator = open("/dev/stdin", 1 /* read, binary */);
    for (uint32_t *at = app_stack; at < app_stack_top; at++) {
        *at = PAINT;
    }
    __asm__ volatile("msr psp, %0\n"
                     "movs r0, #2\n"
                     "msr control, r0\n"
                     "isb\n" ::"r"(app_stack_top)
                     : "r0", "memory");
    appMain();
    board_print("the app ended\n");
    return 1;
}
