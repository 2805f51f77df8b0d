// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where user code was when a signal came: the addresses of the calls on the stack, kept until Python asks for the source
// lines. Looking these up is too much for a signal handler.

#define _GNU_SOURCE
#include <stdint.h>
#include <string.h>
#include <ucontext.h>

#if __has_include(<execinfo.h>)
#include <execinfo.h>
#else
static int backtrace(void **address, int most)
{
    (void)address;
    (void)most;
    return 0;
}
#endif

enum { MOST = 64 };

static int64_t kept[MOST];
static int32_t count;

static intptr_t interrupted(const void *context)
{
    const ucontext_t *machine = context;
    if (!context)
        return 0;
#if defined(__x86_64__) && defined(__linux__)
    return (intptr_t)machine->uc_mcontext.gregs[REG_RIP];
#elif defined(__aarch64__) && defined(__linux__)
    return (intptr_t)machine->uc_mcontext.pc;
#else
    (void)machine;
    return 0;
#endif
}

// Clears what was kept. The first call loads a library, which a signal handler cannot do.
void uel_host_prepare_frames(void)
{
    static int prepared = 0;
    void *one[1];
    count = 0;
    if (!prepared)
        prepared = backtrace(one, 1) >= 0;
}

// Innermost first: where the signal came, then, an instruction back, what the calls around it return to. Without the context
// of a signal, the latter alone.
void uel_host_keep_frames(const void *context)
{
    void *address[MOST];
    const int found = backtrace(address, MOST);
    const intptr_t exact = interrupted(context);
    int first = 0;
    for (int k = 0; k < found; k++)
        if ((intptr_t)address[k] == exact)
            first = k;
    count = 0;
    for (int k = first; k < found; k++)
        kept[count++] = (intptr_t)address[k] - ((intptr_t)address[k] != exact);
}

// Those of the last signal, and their number; clears them.
void uel_host_take_frames(int64_t address[MOST], int32_t *many)
{
    memcpy(address, kept, sizeof kept);
    *many = count;
    count = 0;
}
