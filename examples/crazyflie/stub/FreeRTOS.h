#include "stub.h" // A stub: not the firmware.
