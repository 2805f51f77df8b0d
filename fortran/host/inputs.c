// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finds what a user element changes of the arguments that Abaqus passes in only: a routine with the arguments of UEL that
// calls the real one between a copy and a comparison. The driver calls it in place of the real one while a check asks for it.
// JPROPS, which is no array of the driver's workspace, is passed with room behind it, which holds what a check asks for.

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// stack.c
void uel_host_scribble(void);

enum {
    RHS, AMATRX, SVARS, ENERGY, NDOFEL, NRHS, NSVARS, PROPS, NPROPS, COORDS, MCRD, NNODE, U, DU, V, A, JTYPE, TIME, DTIME,
    KSTEP, KINC, JELEM, PARAMS, NDLOAD, JDLTYP, ADLMAG, PREDEF, NPREDF, LFLAGS, MLVARX, DDLMAG, MDLOAD, PNEWDT, JPROPS,
    NJPROP, PERIOD, MATERIALLIB, ARGUMENTS
};

typedef void uel_t(void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                   void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                   void *, void *, void *, void *, void *, void *, void *, void *, void *, void *);
typedef void uelmat_t(void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                      void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                      void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                      void *);

static uel_t *uel;
static uelmat_t *uelmat;
static unsigned char *copies;   // of all inputs, one behind the other, with room for doubles
static int32_t changed[ARGUMENTS];
static double values[ARGUMENTS][2];
static int32_t *jprops;
static int32_t beyond;          // what lies behind JPROPS

enum { ROOM = 100 };            // integers behind JPROPS

static int is_real(int argument)
{
    switch (argument) {
    case PROPS: case COORDS: case U: case DU: case V: case A: case TIME: case DTIME: case PARAMS: case ADLMAG: case PREDEF:
    case DDLMAG: case PERIOD:
        return 1;
    default:
        return 0;
    }
}

static size_t entries(int argument, void *const *given)
{
#define COUNT(number) ((size_t)*(const int32_t *)given[number])
    switch (argument) {
    case RHS: case AMATRX: case SVARS: case ENERGY: case PNEWDT:
        return 0;   // the element's to change
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

// The first entry of each argument that is another one now; earlier findings stay.
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

static void *with_room(const int32_t *given, const int32_t *length)
{
    jprops = realloc(jprops, (size_t)(*length + ROOM) * sizeof *jprops);
    memcpy(jprops, given, (size_t)*length * sizeof *jprops);
    for (int k = *length; k < *length + ROOM; k++)
        jprops[k] = beyond;
    return jprops;
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
    a33 = with_room(a33, a34);
    void *const given[] = {GIVEN};
    size_t length[ARGUMENTS];
    keep(given, MATERIALLIB, length);
    uel_host_scribble();
    uel(GIVEN);
    compare(given, MATERIALLIB, length);
}

static void watched_uelmat(PARAMETERS, void *a36)
{
    a33 = with_room(a33, a34);
    void *const given[] = {GIVEN, a36};
    size_t length[ARGUMENTS];
    keep(given, ARGUMENTS, length);
    uel_host_scribble();
    uelmat(GIVEN, a36);
    compare(given, ARGUMENTS, length);
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

void uel_host_beyond(int32_t number) { beyond = number; }

// Entry of each argument that was changed, from 1 (0: none), with its value before and after; forgets them.
void uel_host_take_changes(int32_t entry[ARGUMENTS], double value[ARGUMENTS][2])
{
    memcpy(entry, changed, sizeof changed);
    memcpy(value, values, sizeof values);
    memset(changed, 0, sizeof changed);
}
