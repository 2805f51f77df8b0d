// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finds which input arguments of Abaqus a user element changes: a routine with the arguments of UEL that calls the real one
// between a copy and a comparison. The driver calls it in place of the real one while a check asks for it. The guards of the
// driver's workspace find writes outside its arrays. All other arguments are passed with room around them, which holds what
// a check asks for and is checked as well.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "../driver/arguments.h"

// stack.c
void uel_host_scribble(void);

static uel_t *uel;
static uelmat_t *uelmat;
static unsigned char *copies;   // of all inputs, one behind the other, with room for doubles
static int32_t changed[ARGUMENTS];
static double values[ARGUMENTS][2];
static double around[ARGUMENTS];        // what lies around an argument
static int32_t damaged[ARGUMENTS];      // entry, from 1, that a call wrote outside of an argument
static int32_t outside[ARGUMENTS];      // whether it did
static unsigned char *guarded;          // arguments with room around them, one behind the other

enum { ROOM = 100 };                    // entries on either side of an argument

static int is_real(int argument)
{
    switch (argument) {
    case PROPS: case COORDS: case U: case DU: case V: case A: case TIME: case DTIME: case PARAMS: case ADLMAG: case PREDEF:
    case DDLMAG: case PERIOD: case PNEWDT: case SVARS:
        return 1;
    default:
        return 0;
    }
}

static size_t entries(int argument, void *const *given)
{
#define COUNT(number) ((size_t)*(const int32_t *)given[number])
    switch (argument) {
    case RHS: case AMATRX: case ENERGY: case PNEWDT:
        return 0;   // the element's to change
    case SVARS: {
        // in calls for a mass matrix (4) or a residual (5) alone they are no state to be kept
        const int32_t request = ((const int32_t *)given[LFLAGS])[2];
        return request == 4 || request == 5 ? COUNT(NSVARS) : 0;
    }
    case PROPS:
        return COUNT(NPROPS);
    case COORDS:
        return COUNT(MCRD) * COUNT(NNODE);
    case U: case V: case A:
        return COUNT(NDOFEL);
    case DU:
        return COUNT(MLVARX) * COUNT(NRHS);
    case TIME:
        return 2;
    case PARAMS:
        return 3;
    case JDLTYP: case ADLMAG: case DDLMAG:
        return 2 * COUNT(MDLOAD);
    case PREDEF:
        return 2 * COUNT(NPREDF) * COUNT(NNODE);
    case LFLAGS:
        return 7;
    case JPROPS:
        return COUNT(NJPROP);
    default:
        return 1;
    }
#undef COUNT
}

static double number(const void *from, int argument, size_t entry)
{
    return is_real(argument) ? ((const double *)from)[entry] : ((const int32_t *)from)[entry];
}

static size_t width(int argument) { return is_real(argument) ? sizeof(double) : sizeof(int32_t); }

// Copies of the inputs, whose numbers of entries are kept too: an element may change what they are counted by.
static void keep(void *const *given, int count, size_t *length)
{
    size_t total = 0;
    for (int k = 0; k < count; k++) {
        length[k] = entries(k, given);
        total += length[k];
    }
    copies = realloc(copies, total * sizeof(double));
    unsigned char *to = copies;
    for (int k = 0; k < count; to += length[k++] * sizeof(double))
        memcpy(to, given[k], length[k] * width(k));
}

// The first entry of each argument that has changed; earlier findings stay.
static void compare(void *const *given, int count, const size_t *length)
{
    const unsigned char *before = copies;
    for (int k = 0; k < count; before += length[k++] * sizeof(double))
        for (size_t n = 0; n < length[k] && !changed[k]; n++)
            if (memcmp(before + n * width(k), (const unsigned char *)given[k] + n * width(k), width(k))) {
                changed[k] = (int32_t)n + 1;
                values[k][0] = number(before, k, n);
                values[k][1] = number(given[k], k, n);
            }
}

static int in_workspace(int argument)
{
    switch (argument) {
    case RHS: case AMATRX: case SVARS: case ENERGY: case PROPS: case COORDS: case U: case DU: case V: case A: case PREDEF:
        return 1;
    default:
        return 0;
    }
}

static size_t size_of(int argument, void *const *given)
{
    return argument == PNEWDT ? 1 : entries(argument, given);
}

static void put(void *to, int argument, size_t entry, double value)
{
    if (width(argument) == sizeof(double))
        ((double *)to)[entry] = value;
    else
        ((int32_t *)to)[entry] = (int32_t)value;
}

// Copies of the arguments with room around them; `given` then holds their addresses.
static void surround(void **given, int count)
{
    size_t length[ARGUMENTS], total = 0;
    for (int k = 0; k < count; k++) {
        length[k] = size_of(k, given);
        total += in_workspace(k) ? 0 : (length[k] + 2 * ROOM) * sizeof(double);
    }
    unsigned char *to = guarded = realloc(guarded, total);
    for (int k = 0; k < count; k++) {
        if (in_workspace(k))
            continue;
        const size_t all = length[k] + 2 * ROOM;
        for (size_t n = 0; n < all; n++)
            if (n < ROOM || n >= ROOM + length[k])
                put(to, k, n, around[k]);
        given[k] = memcpy(to + ROOM * width(k), given[k], length[k] * width(k));
        to += all * sizeof(double);
    }
}

// The first entry in the room around each argument that has changed; earlier findings stay.
static void look_around(void *const *given, int count, const size_t *length)
{
    for (int k = 0; k < count; k++) {
        if (in_workspace(k) || outside[k])
            continue;
        const size_t many = k == PNEWDT ? 1 : length[k];
        const unsigned char *first = (const unsigned char *)given[k] - ROOM * width(k);
        double expected = 0;
        put(&expected, k, 0, around[k]);
        for (size_t n = 0; n < many + 2 * ROOM && !outside[k]; n++)
            if ((n < ROOM || n >= ROOM + many) && memcmp(first + n * width(k), &expected, width(k))) {
                outside[k] = 1;
                damaged[k] = (int32_t)n - ROOM + 1;
            }
    }
}

// Bytes that are allocated now; negative if the C library does not tell.
int64_t uel_host_allocated(void)
{
    size_t (*sanitizers)(void) = dlsym(RTLD_DEFAULT, "__sanitizer_get_current_allocated_bytes");
    if (sanitizers)
        return (int64_t)sanitizers();
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
    const struct mallinfo2 now = mallinfo2();
    return (int64_t)(now.uordblks + now.hblkhd);
#else
    return -1;
#endif
}

#define PARAMETERS                                                                                                       \
    void *a0, void *a1, void *a2, void *a3, void *a4, void *a5, void *a6, void *a7, void *a8, void *a9, void *a10,       \
        void *a11, void *a12, void *a13, void *a14, void *a15, void *a16, void *a17, void *a18, void *a19, void *a20,    \
        void *a21, void *a22, void *a23, void *a24, void *a25, void *a26, void *a27, void *a28, void *a29, void *a30,    \
        void *a31, void *a32, void *a33, void *a34, void *a35
#define GIVEN                                                                                                            \
    a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15, a16, a17, a18, a19, a20, a21, a22, a23, a24,   \
        a25, a26, a27, a28, a29, a30, a31, a32, a33, a34, a35

static void watched_uel(PARAMETERS)
{
    void *g[] = {GIVEN};
    double *pnewdt = g[PNEWDT];
    size_t length[ARGUMENTS];
    surround(g, MATERIALLIB);
    keep(g, MATERIALLIB, length);
    uel_host_scribble();
    uel(EACH_OF_UEL(g));
    look_around(g, MATERIALLIB, length);
    compare(g, MATERIALLIB, length);
    *pnewdt = *(double *)g[PNEWDT];
}

static void watched_uelmat(PARAMETERS, void *a36)
{
    void *g[] = {GIVEN, a36};
    double *pnewdt = g[PNEWDT];
    size_t length[ARGUMENTS];
    surround(g, ARGUMENTS);
    keep(g, ARGUMENTS, length);
    uel_host_scribble();
    uelmat(EACH_OF_UEL(g), g[MATERIALLIB]);
    look_around(g, ARGUMENTS, length);
    compare(g, ARGUMENTS, length);
    *pnewdt = *(double *)g[PNEWDT];
}

// Address of a routine that calls UEL, or UELMAT if with_material, at an address and watches it.
int64_t uel_host_watch(int64_t address, int32_t with_material)
{
    if (with_material) {
        uelmat = (uelmat_t *)(intptr_t)address;
        return (int64_t)(intptr_t)watched_uelmat;
    }
    uel = (uel_t *)(intptr_t)address;
    return (int64_t)(intptr_t)watched_uel;
}

// Swap the values around an argument in watched calls.
void uel_host_around(int32_t argument, double *number)
{
    const double before = around[argument];
    around[argument] = *number;
    *number = before;
}

// Whether (1 or 0) something was written outside of each argument, and the entry of the first such write, from 1; clears it.
void uel_host_take_outside(int32_t found[ARGUMENTS], int32_t entry[ARGUMENTS])
{
    memcpy(found, outside, sizeof outside);
    memcpy(entry, damaged, sizeof damaged);
    memset(outside, 0, sizeof outside);
}

// Entry of each argument that was changed, from 1 (0: none), with its value before and after; clears them.
void uel_host_take_changes(int32_t entry[ARGUMENTS], double value[ARGUMENTS][2])
{
    memcpy(entry, changed, sizeof changed);
    memcpy(value, values, sizeof values);
    memset(changed, 0, sizeof changed);
}
