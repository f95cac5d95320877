// What the example needs of a board, by semihosting.
#pragma once

#include <stdbool.h>
#include <stdint.h>

// An operation of semihosting, and its argument: a value or the address of several.
uintptr_t board_semihosting(uintptr_t operation, uintptr_t argument);
void board_print(const char *text);
_Noreturn void board_exit(bool success);
