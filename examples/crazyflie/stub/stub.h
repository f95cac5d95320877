// A stub of a Crazyflie's firmware: exactly the interfaces that the app uses, under their
// names, for a program in the emulator. It is not the firmware, and none of its text.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void appMain(void);

// FreeRTOS: one task, and a queue. Whatever waits talks with the simulator.
typedef uint32_t TickType_t;
typedef long BaseType_t;
typedef struct {
    uint8_t *items;
    uint32_t length, size, first, count;
} StaticQueue_t;
typedef StaticQueue_t *QueueHandle_t;
#define M2T(milliseconds) ((TickType_t)(milliseconds))
#define pdTRUE 1
void vTaskDelay(TickType_t ticks);
TickType_t xTaskGetTickCount(void);
QueueHandle_t xQueueCreateStatic(uint32_t length, uint32_t size, uint8_t *items, StaticQueue_t *queue);
BaseType_t xQueueSend(QueueHandle_t queue, const void *item, TickType_t wait);
BaseType_t xQueueReceive(QueueHandle_t queue, void *item, TickType_t wait);
#define STATIC_MEM_QUEUE_ALLOC(NAME, LENGTH, SIZE)     \
    static uint8_t stub_##NAME##_items[(LENGTH) * (SIZE)]; \
    static StaticQueue_t stub_##NAME##_queue;           \
    enum { stub_##NAME##_length = (LENGTH), stub_##NAME##_size = (SIZE) }
#define STATIC_MEM_QUEUE_CREATE(NAME) \
    xQueueCreateStatic(stub_##NAME##_length, stub_##NAME##_size, stub_##NAME##_items, &stub_##NAME##_queue)

__attribute__((format(printf, 1, 2))) void stub_print(const char *format, ...);
#define DEBUG_PRINT stub_print

// Logs and parameters: the stub's client reads and sets those of one group.
typedef struct {
    uint8_t type;
    const char *name;
    void *address;
} StubVariable;
enum { LOG_UINT8, LOG_UINT16, LOG_UINT32, LOG_INT16, PARAM_UINT8 };
#define LOG_GROUP_START(GROUP) const StubVariable stub_log_##GROUP[] = {
#define LOG_ADD(TYPE, NAME, ADDRESS) {TYPE, #NAME, ADDRESS},
#define LOG_GROUP_STOP(GROUP) {0, NULL, NULL}};
#define PARAM_GROUP_START(GROUP) const StubVariable stub_param_##GROUP[] = {
#define PARAM_ADD(TYPE, NAME, ADDRESS) {TYPE, #NAME, ADDRESS},
#define PARAM_GROUP_STOP(GROUP) {0, NULL, NULL}};
typedef uint16_t logVarId_t;
logVarId_t logGetVarId(const char *group, const char *name);
float logGetFloat(logVarId_t variable);

// Radio.
#define P2P_MAX_DATA_SIZE 61
typedef struct {
    uint8_t size, rssi, port;
    uint8_t data[P2P_MAX_DATA_SIZE];
} P2PPacket;
void p2pRegisterCB(void (*callback)(P2PPacket *packet));
bool radiolinkSendP2PPacketBroadcast(P2PPacket *packet);
uint64_t configblockGetRadioAddress(void);

// Sensors, in metres and volts.
typedef enum { rangeFront, rangeBack, rangeLeft, rangeRight, rangeUp, rangeDown } rangeDirection_t;
float rangeGet(rangeDirection_t direction);
float pmGetBatteryVoltage(void);
bool supervisorIsTumbled(void);

// Flight: metres, radians, seconds.
int crtpCommanderHighLevelTakeoff(float height, float duration);
int crtpCommanderHighLevelLand(float height, float duration);
int crtpCommanderHighLevelGoTo(float x, float y, float z, float yaw, float duration, bool relative);
