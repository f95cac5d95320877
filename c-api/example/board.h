// What the example needs of a board, by semihosting.
#pragma once

#include <stdbool.h>

void board_print(const char *text);
_Noreturn void board_exit(bool success);
