// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// XIT ends the analysis from any depth of user code. Here it must end only the running block call, so that Python can
// say which element stopped. Fortran has no non-local exit; sigsetjmp and siglongjmp cross Fortran frames safely as
// long as those frames hold nothing that needs undoing (at worst, what the user's file had allocated stays allocated).
// A signal that user code raises (a wrong address, a division of integers by zero) and a call that does not return leave
// it in the same way. After abort, which mostly says that the heap is damaged, nothing can go on: the process says where
// it was and ends.

#define _GNU_SOURCE
#include <fenv.h>
#include <setjmp.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

// host_messages.f90
void uel_host_fault(const char *text);
void uel_host_place(char routine[16], int32_t place[4]);

// Calls that the driver has made; the clock sees by it whether one is still the same.
extern int64_t uel_host_calls;

enum { STACK = 1000, FLOATING };

static sigjmp_buf landing;
static volatile int reason;         // the signal, STACK or FLOATING; 0 for XIT
static volatile sig_atomic_t armed = 0;
static int registered = 0;          // at_exit is

static const int caught[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM};
enum { CAUGHT = sizeof caught / sizeof *caught };
static struct sigaction before[CAUGHT];
static stack_t stack_before;
static char handler_stack[1 << 16];

static char *stack_at_entry;
static double limit = 0;            // seconds for one call; 0: none
static volatile int64_t watched;    // the call that the clock saw last
static volatile double waited;      // how long it has seen it
static const double tick = 0.25;

static const char *describe(int signal)
{
    switch (signal) {
    case SIGSEGV:
    case SIGBUS:
        return "segmentation fault: it reads or writes where no memory is, mostly through an index outside an array or "
               "an argument of another type or rank";
    case STACK:
        return "segmentation fault: the stack is full, through endless recursion or large local arrays";
    case SIGFPE:
        return "division of an integer by zero";
    case FLOATING:
        return "floating-point exception";
    case SIGILL:
        return "illegal instruction: the library was made for another processor, or a call went astray";
    default:
        return "the call does not return, see the time limit for one call";
    }
}

static void say_place(const char *what)
{
    int32_t place[4];
    char text[256], routine[17] = "";
    uel_host_place(routine, place);
    const int length =
        snprintf(text, sizeof text, "uel: in %.*s for element %d, step %d, increment %d, iteration %d: %s\n",
                 (int)strcspn(routine, " "), routine, (int)place[0], (int)place[1], (int)place[2], (int)place[3], what);
    const ssize_t written = write(STDERR_FILENO, text, (size_t)length);
    (void)written;
}

static void catch(int signal, siginfo_t *info, void *context)
{
    (void)context;
    if (!armed)
        return;
    if (signal == SIGABRT) {
        say_place("abort: memory is damaged, mostly by a write outside an array");
        return;  // abort() goes on and ends the process
    }
    if (signal == SIGFPE && info->si_code != FPE_INTDIV)
        signal = FLOATING;
    if (signal == SIGALRM) {
        if (watched != uel_host_calls) {
            watched = uel_host_calls;
            waited = 0;
        }
        waited += tick;
        if (!(limit > 0 && waited > limit))
            return;
    }
    if (signal == SIGSEGV) {
        struct rlimit size;
        const char *address = info->si_addr;
        getrlimit(RLIMIT_STACK, &size);
        if (address < stack_at_entry && size.rlim_cur != RLIM_INFINITY &&
            (uintptr_t)(stack_at_entry - address) + (1 << 22) > size.rlim_cur &&
            (uintptr_t)(stack_at_entry - address) < size.rlim_cur + (1 << 24))
            signal = STACK;
    }
    reason = signal;
    siglongjmp(landing, 1);
}

static void guard(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_sigaction = catch;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_RESTART;
    const stack_t own = {.ss_sp = handler_stack, .ss_size = sizeof handler_stack};
    sigaltstack(&own, &stack_before);
    for (int k = 0; k < CAUGHT; k++)
        sigaction(caught[k], &action, &before[k]);
}

static void unguard(void)
{
    for (int k = 0; k < CAUGHT; k++)
        sigaction(caught[k], &before[k], NULL);
    sigaltstack(&stack_before, NULL);
}

static void set_clock(double seconds)
{
    const struct timeval step = {.tv_usec = (suseconds_t)(seconds * 1e6)};
    const struct itimerval timer = {.it_interval = step, .it_value = step};
    setitimer(ITIMER_REAL, &timer, NULL);
}

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

static void leave(void)
{
    armed = 0;
    trap(0);
    if (limit > 0)
        set_clock(0);
    unguard();
}

// The Fortran library ends the process where an input or output statement fails: say where that was.
static void at_exit(void)
{
    if (armed)
        say_place("the process ends");
}

void uel_host_limit(double seconds) { limit = seconds; }

// Runs routine(context); 0 if it returned, 1 if it was left, with a message in the queue unless by XIT, 2 if that was
// because a call did not return.
int uel_host_protect(void (*routine)(void *), void *context)
{
    char here;
    stack_at_entry = &here;
    reason = 0;
    watched = -1;
    if (sigsetjmp(landing, 1)) {
        leave();
        if (reason)
            uel_host_fault(describe(reason));
        return reason == SIGALRM ? 2 : 1;
    }
    if (!registered)
        registered = atexit(at_exit) == 0;
    guard();
    armed = 1;
    trap(1);
    if (limit > 0)
        set_clock(tick);
    routine(context);
    leave();
    return 0;
}

void uel_host_escape(void)
{
    if (armed)
        siglongjmp(landing, 1);
    fputs("XIT was called outside a call of the host; the process ends\n", stderr);
    exit(EXIT_FAILURE);
}
