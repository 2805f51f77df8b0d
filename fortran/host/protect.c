// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// XIT ends the analysis from any depth of user code. Here it must end only the running block call, so that Python can
// say which element stopped. Fortran has no non-local exit; setjmp and longjmp cross Fortran frames safely as long as
// those frames hold nothing that needs undoing (at worst, what the user's file had allocated stays allocated).

#define _GNU_SOURCE
#include <fenv.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

static jmp_buf landing;
static int armed = 0;

// A debug build stops at the operation that makes a NaN or an infinity: gfortran's -ffpe-trap asks the main program,
// which is Python's here. The quiet NaNs that the driver puts into the arrays trap nothing.
static void trap(int on)
{
#ifdef UEL_TRAP_FPE
    const int traps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    feclearexcept(traps);
    if (on)
        feenableexcept(traps);
    else
        fedisableexcept(traps);
#else
    (void)on;
#endif
}

int uel_host_protect(void (*routine)(void *), void *context)
{
    if (setjmp(landing)) {
        armed = 0;
        trap(0);
        return 1;
    }
    armed = 1;
    trap(1);
    routine(context);
    trap(0);
    armed = 0;
    return 0;
}

void uel_host_escape(void)
{
    if (armed)
        longjmp(landing, 1);
    fputs("XIT was called outside a call of the host; the process ends\n", stderr);
    exit(EXIT_FAILURE);
}
