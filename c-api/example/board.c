// Start-up of an STM32F405 and semihosting.

#include "board.h"

#include <stdint.h>

extern uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;

int main(void);

uintptr_t board_semihosting(uintptr_t operation, uintptr_t argument) {
    register uintptr_t r0 __asm__("r0") = operation;
    register uintptr_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void board_print(const char *text) {
    board_semihosting(0x04 /* SYS_WRITE0 */, (uintptr_t)text);
}

_Noreturn void board_exit(bool success) {
    for (;;) {
        board_semihosting(0x18 /* SYS_EXIT */, success ? 0x20026 /* application exit */ : 0x20023);
    }
}

_Noreturn void reset(void) {
    // The floating-point unit is off after a reset: CPACR, full access to CP10 and CP11.
    *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20;
    for (uint32_t *to = &data_start, *from = &data_load; to < &data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = &bss_start; to < &bss_end;) {
        *to++ = 0;
    }
    board_exit(main() == 0);
}

static _Noreturn void fault(void) {
    board_print("fault\n");
    board_exit(false);
}

__attribute__((section(".vectors"), used)) static const void *const VECTORS[16] = {
    &stack_top, (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault, (void *)fault,
};
