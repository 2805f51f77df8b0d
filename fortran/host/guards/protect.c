// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// XIT ends the analysis from any depth of user code. Here it must end only the running block call, so that Python can
// say which element stopped. Fortran has no non-local exit; sigsetjmp and siglongjmp cross Fortran frames safely as
// long as those frames hold nothing that needs undoing (at worst, what the user's file had allocated stays allocated).
// A signal that user code raises (a wrong address, a division of integers by zero) and a call that does not return leave
// it in the same way. After abort, which usually means that the heap is damaged, the process cannot continue: it says where
// it was and ends.
//
// A call that is left inside a statement of input or output keeps the lock of its unit, and the next one of the unit waits
// for ever: the host then touches the units only through uel_host_attempt. Another process that shares the slate sees where
// user code is, whatever state this one is in.
//
// Several threads may call elements at once (host/driver/team.f90). Each has a seat: where it lands when its call is left. Nothing is
// told of such a call, since one thread repeats it.

#define _GNU_SOURCE
#include <fenv.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

// host/driver/messages.f90
void uel_host_fault(const char *text);
void uel_host_place(char routine[16], int32_t place[4]);

// frames.c
void uel_host_prepare_frames(void);
void uel_host_keep_frames(const void *context);

// sanitizer.c
void uel_host_clear_stack(const char *from, const char *to);

// mutexes.c
void uel_host_new_mutexes(void);

// exceptions.c
void uel_host_watch_exceptions(void);

// As harness/uel/shared_progress.py has it.
struct slate {
    int64_t calls;         // of user routines so far: the clock sees by it whether one is still the same
    int32_t within;        // one of the three below
    int32_t left;          // calls that did not end by returning
    int32_t place[4];      // element, step, increment, iteration
    char routine[16];      // filled up with blanks
    char reason[256];      // why the last one was left, or the process ends
};
enum { OUTSIDE, IN_CALL, LOADING };

static struct slate own;
static struct slate *slate = &own;

enum { STACK = 1000, INVALID, DIVISION, OVERFLOW, OVERRUN };

enum { SEATS = 64 };   // as in host/guards/protect.f90
static struct seat {
    pthread_t thread;
    volatile sig_atomic_t armed;     // it runs a call
    volatile sig_atomic_t late;      // its call has taken too long
    sigjmp_buf landing;
    char *stack_at_entry;
    volatile int reason;             // the signal, or one of the enumeration above; 0 for XIT
    volatile int64_t calls, watched; // calls so far; the one that the clock saw last
    volatile double waited;          // how long it has seen it
    char handler_stack[1 << 16];
} seats[SEATS];                      // the first is that of all that runs on one thread
static volatile sig_atomic_t armed = 0;
static int together = 0;            // several threads have seats
static char overrun[256];           // what AddressSanitizer has found in the call; '' for nothing
static int registered = 0;          // at_exit is

static const int caught[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM};
enum { CAUGHT = sizeof caught / sizeof *caught };
static struct sigaction before[CAUGHT];

static double limit = 0;            // seconds for one call; 0: none
static double allowed;              // seconds for what runs now; 0: any
static const double patience = 3;   // seconds for statements of the host on units that may be locked
static int lost = 0;                // the units are
static const double tick = 0.25;

static void describe(int signal, char *text, size_t size)
{
    switch (signal) {
    case SIGSEGV:
    case SIGBUS:
        snprintf(text, size, "segmentation fault: it reads or writes an invalid address, usually because of an index outside "
                             "an array or an argument of the wrong type or rank");
        break;
    case STACK:
        snprintf(text, size, "segmentation fault: the stack is full, because of endless recursion or large local arrays");
        break;
    case SIGFPE:
        snprintf(text, size, "division of an integer by zero");
        break;
    case INVALID:
        snprintf(text, size, "floating-point exception: the result is not a number (0/0, the square root of a negative "
                             "number), or an uninitialised variable is used");
        break;
    case DIVISION:
        snprintf(text, size, "floating-point exception: division by zero");
        break;
    case OVERFLOW:
        snprintf(text, size, "floating-point exception: the result is too large to represent");
        break;
    case SIGILL:
        snprintf(text, size, "illegal instruction: an index outside an array or a null pointer in C or C++ with run-time "
                             "checks, a library for another processor, or a jump to a wrong address");
        break;
    case SIGALRM:
        snprintf(text, size, "the call did not return within %g s, the limit for one call (--call-limit)", limit);
        break;
    case OVERRUN:
        snprintf(text, size, "%s", overrun);
        break;
    default:
        snprintf(text, size, "XIT or STOP");
    }
}

static void note_place(void) { uel_host_place(slate->routine, slate->place); }

void uel_host_begin(int32_t seat, int32_t element)
{
    seats[seat].calls++;
    if (seat > 0)
        return;
    slate->calls++;
    slate->place[0] = element;
}

// Why the process ends: for the one that watches it, or on the terminal if none does.
static void say_end(const char *what)
{
    note_place();
    snprintf(slate->reason, sizeof slate->reason, "%s", what);
    if (slate != &own)
        return;
    char text[512];
    const int length = snprintf(text, sizeof text, "uel: in %.*s for element %d, step %d, increment %d, iteration %d: %s\n",
                                (int)strcspn(slate->routine, " "), slate->routine, (int)slate->place[0],
                                (int)slate->place[1], (int)slate->place[2], (int)slate->place[3], what);
    const ssize_t written = write(STDERR_FILENO, text, (size_t)length);
    (void)written;
}

static void unguard(void)
{
    for (int k = 0; k < CAUGHT; k++)
        sigaction(caught[k], &before[k], NULL);
}

// The seat of this thread, NULL if it has none.
static struct seat *own_seat(void)
{
    for (struct seat *seat = seats; seat < seats + SEATS; seat++)
        if (seat->armed && pthread_equal(seat->thread, pthread_self()))
            return seat;
    return NULL;
}

// A tick of the clock: wakes the threads whose calls have taken too long.
static void look_at_clock(void)
{
    for (struct seat *seat = seats; seat < seats + SEATS; seat++) {
        if (!seat->armed)
            continue;
        if (seat->watched != seat->calls) {
            seat->watched = seat->calls;
            seat->waited = 0;
        }
        seat->waited += tick;
        if (allowed > 0 && seat->waited > allowed && !seat->late) {
            seat->late = 1;
            pthread_kill(seat->thread, SIGALRM);
        }
    }
}

static void catch(int signal, siginfo_t *info, void *context)
{
    if (!armed)
        return;
    if (signal == SIGABRT) {
        say_end("abort: memory is damaged, usually by a write outside an array");
        return;  // abort() goes on and ends the process
    }
    struct seat *seat = own_seat();
    if (signal == SIGALRM && !(seat && seat->late)) {
        look_at_clock();
        return;
    }
    if (!seat) {
        // the call is not on the stack of a thread of the user's, or of a library
        if (signal != SIGALRM) {
            char text[sizeof slate->reason];
            describe(signal, text, sizeof text);
            say_end(text);
            unguard();
        }
        return;
    }
    if (signal == SIGFPE && info->si_code != FPE_INTDIV)
        signal = info->si_code == FPE_FLTDIV ? DIVISION : info->si_code == FPE_FLTOVF ? OVERFLOW : INVALID;
    if (signal == SIGSEGV) {
        struct rlimit size;
        const char *address = info->si_addr;
        getrlimit(RLIMIT_STACK, &size);
        if (address < seat->stack_at_entry && size.rlim_cur != RLIM_INFINITY &&
            (uintptr_t)(seat->stack_at_entry - address) + (1 << 22) > size.rlim_cur &&
            (uintptr_t)(seat->stack_at_entry - address) < size.rlim_cur + (1 << 24))
            signal = STACK;
    }
    if (!overrun[0] && !together)
        uel_host_keep_frames(context);
    seat->reason = signal;
    siglongjmp(seat->landing, 1);
}

// A finding of AddressSanitizer ends the call; from within its runtime, which cannot be left, where it returns.
void uel_host_overrun(const char *text, int at_once)
{
    if (!armed || !slate->within || overrun[0])
        return;
    snprintf(overrun, sizeof overrun, "%s", text);
    uel_host_keep_frames(NULL);
    struct seat *seat = own_seat();
    if (at_once && seat)
        siglongjmp(seat->landing, 1);
}

static void guard(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_sigaction = catch;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_RESTART;
    for (int k = 0; k < CAUGHT; k++)
        sigaction(caught[k], &action, &before[k]);
}

static void set_clock(double seconds)
{
    const struct timeval step = {.tv_usec = (suseconds_t)(seconds * 1e6)};
    const struct itimerval timer = {.it_interval = step, .it_value = step};
    setitimer(ITIMER_REAL, &timer, NULL);
}

// A debug build, of the host or of a user's file, stops at the operation that makes a NaN or an infinity: gfortran's
// -ffpe-trap asks the main program, which is Python's here. The quiet NaNs that the driver puts into the arrays trap nothing.
#ifdef UEL_TRAP_FPE
static int trapping = 1;
#else
static int trapping = 0;
#endif

static void trap(int on)
{
    const int traps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    if (!trapping)
        return;
    feclearexcept(traps);
    if (on)
        feenableexcept(traps);
    else
        fedisableexcept(traps);
}

// Whether calls stop there from now on; returns the old setting.
int32_t uel_host_trap(int32_t on)
{
    const int32_t before = trapping;
    trapping = on;
    return before;
}

static void leave(void)
{
    armed = 0;
    trap(0);
    set_clock(0);
    unguard();
}

// The Fortran library ends the process if an input or output statement fails, as exit does: say where that was.
static void at_exit(void)
{
    if (armed && slate->within)
        say_end("the process ends");
}

void uel_host_limit(double seconds) { limit = seconds; }

// From now on what is on the slate is in a file that another process reads; 0, or 1 if it cannot be.
int uel_host_share(int file)
{
    void *shared = mmap(NULL, sizeof *slate, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (shared == MAP_FAILED)
        return 1;
    slate = shared;
    return 0;
}

// The library of user routines is loaded from now on, which runs its constructors, or has been.
void uel_host_loading(int begins)
{
    memset(slate->routine, ' ', sizeof slate->routine);
    memset(slate->place, 0, sizeof slate->place);
    slate->within = begins ? LOADING : OUTSIDE;
    uel_host_watch_exceptions();
}

// The runtime of AddressSanitizer does that itself only where the stack is small.
static void clear_stack(void)
{
    struct rlimit size;
    getrlimit(RLIMIT_STACK, &size);
    char *entry = seats[0].stack_at_entry;
    if (size.rlim_cur != RLIM_INFINITY && size.rlim_cur < (uintptr_t)entry)
        uel_host_clear_stack(entry - size.rlim_cur, entry);
}

// Runs routine(context) on this thread, which takes the seat; 0 if it returned, 1 if it was left.
int uel_host_on_seat(int32_t number, void (*routine)(void *), void *context)
{
    char here;
    struct seat *seat = &seats[number];
    const stack_t own = {.ss_sp = seat->handler_stack, .ss_size = sizeof seat->handler_stack};
    stack_t before_it;
    seat->stack_at_entry = &here;
    seat->reason = 0;
    seat->watched = -1;
    seat->waited = 0;
    seat->late = 0;
    seat->thread = pthread_self();
    sigaltstack(&own, &before_it);
    const int left = sigsetjmp(seat->landing, 1);
    if (!left) {
        seat->armed = 1;
        routine(context);
    }
    seat->armed = 0;
    sigaltstack(&before_it, NULL);
    return left;
}

// Signals are caught, and calls may take so many seconds (0: any).
static void arm(double seconds)
{
    overrun[0] = 0;
    allowed = seconds;
    uel_host_prepare_frames();
    guard();
    armed = 1;
    trap(slate->within);
    if (seconds > 0)
        set_clock(tick);
}

// Runs routine(context) for so many seconds; 0 if it returned, 1 if it was left.
static int run(void (*routine)(void *), void *context, double seconds)
{
    arm(seconds);
    const int left = uel_host_on_seat(0, routine, context);
    leave();
    if (left)
        clear_stack();
    if (overrun[0])
        seats[0].reason = OVERRUN;
    return left || overrun[0];
}

static void begin_calls(void)
{
    if (!registered)
        registered = atexit(at_exit) == 0;
    note_place();
    slate->within = IN_CALL;
}

// Runs routine(context); 0 if it returned, 1 if it was left, with a message in the queue unless by XIT, 2 if that was
// because a call did not return.
int uel_host_protect(void (*routine)(void *), void *context)
{
    begin_calls();
    const int left = run(routine, context, limit), reason = seats[0].reason;
    if (left) {
        // before anything that may wait for a lock
        note_place();
        describe(reason, slate->reason, sizeof slate->reason);
        slate->left++;
    }
    slate->within = OUTSIDE;
    if (left && reason)
        uel_host_fault(slate->reason);
    return left && reason == SIGALRM ? 2 : left;
}

// Runs routine(context), in which several threads take seats.
void uel_host_on_threads(void (*routine)(void *), void *context)
{
    begin_calls();
    uel_host_new_mutexes();
    together = 1;
    arm(limit);
    routine(context);
    leave();
    together = 0;
    slate->within = OUTSIDE;
}

int uel_host_together(void) { return together; }

// libgfortran closes its units when the process ends, and would wait for their locks.
static void leave_units(int code, void *none)
{
    (void)none;
    _exit(code);
}

// Runs routine(context), statements of the host on units 6 and 7; 0, or 1 where a call that was left has them locked.
int uel_host_attempt(void (*routine)(void *), void *context)
{
    if (!lost && !slate->left)
        routine(context);
    else if (!lost && run(routine, context, patience)) {
        lost = 1;
#ifdef __GLIBC__
        on_exit(leave_units, NULL);
#endif
    }
    return lost;
}

int uel_host_in_call(void) { return armed && slate->within; }

void uel_host_escape(void)
{
    struct seat *seat = armed ? own_seat() : NULL;
    if (seat)
        siglongjmp(seat->landing, 1);
    fputs("XIT was called outside a call of the host; the process ends\n", stderr);
    exit(EXIT_FAILURE);
}

void uel_host_go_alone(void)
{
    if (together)
        uel_host_escape();
}
