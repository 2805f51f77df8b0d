// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
// A spring that ends the process, or does not end, in the way that JPROPS(1) says; with ENDLESS, where it is loaded.
#include <aba_for_c.h>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

struct own_exception {};

void endless()
{
    for (volatile int k = 0;; k = k + 1) {
    }
}

struct Constructed {
    Constructed()
    {
#ifdef ENDLESS
        endless();
#endif
    }
} constructed;

}

extern "C" void FOR_NAME(uel, UEL)(double *rhs, double *amatrx, double *, double *, const int *, const int *, const int *,
    const double *, const int *, const double *, const int *, const int *, const double *u, const double *, const double *,
    const double *, const int *, const double *, const double *, const int *, const int *kinc, const int *, const double *,
    const int *, const int *, const double *, const double *, const int *, const int *, const int *, const double *,
    const int *, const double *, const int *jprops)
{
    rhs[0] = u[1] - u[0];
    rhs[1] = -rhs[0];
    amatrx[0] = amatrx[3] = 1;
    amatrx[1] = amatrx[2] = -1;
    if (*kinc != 2)
        return;
    sigset_t all;
    sigfillset(&all);
    switch (*jprops) {
    case 1:
        throw std::runtime_error("no such layer");
    case 2:
        throw own_exception();
    case 3:
        exit(0);
    case 4:
        _exit(0);
    case 5:
        syscall(SYS_exit_group, 0);
        break;
    case 6:
        // out of reach of the clock
        sigprocmask(SIG_BLOCK, &all, nullptr);
        endless();
        break;
    case 7:
        endless();
    }
}
