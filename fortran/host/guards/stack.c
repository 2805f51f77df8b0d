// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What local variables of a user element hold before they get a value: the stack below the caller is filled with a number,
// so two calls with two numbers show whether an uninitialised variable is used.

#include <stdint.h>

enum { WORDS = 1 << 16 };   // half a mebibyte

static int32_t filled;
static double number;

void uel_host_fill_stack(int32_t on, double with)
{
    filled = on;
    number = with;
}

// Called from where the user element is called: its local variables will be where `room` is now.
__attribute__((noinline)) void uel_host_scribble(void)
{
    if (!filled)
        return;
    volatile double room[WORDS];
    for (int k = 0; k < WORDS; k++)
        room[k] = number;
}
