// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A call of a user element: its arguments laid out, the call itself, and its state kept. Where everything is, host/driver/call.f90 says
// once for all elements of a block. What is left for each of them is short, for in the caches it shares the room with the code of
// the element, and the two take turns.

#include <stdint.h>
#include <string.h>

#include "arguments.h"

// protect.c
void uel_host_begin(int32_t seat, int32_t element);

// host/driver/workspace.f90
void uel_host_fill(int64_t n, int64_t bits, double *to);

// One copy of the code for all who call it: inlined, it takes the room that is short.
#define NOINLINE __attribute__((noinline))

// host/elements/adapter.f90: evaluate
typedef void built_in_t(void *);

typedef double pair __attribute__((vector_size(16), aligned(8)));

// As in host/driver/block.f90.
struct scalars {
    int32_t integers[16], lflags[7];
    double time[2], dtime, params[3], pnewdt, period;
};

// As in host/driver/call.f90.
struct layout {
    void (*routine)(void);
    int32_t with_material, loaded, moves, keeps;
    int64_t ndofel, rhs, svars, props, coords, predef, another, jprops;
    int64_t on_entry;      // bits of a number
    const int32_t *equations;
    const double *from_u, *from_du, *from_v, *from_a;
    const struct scalars *from_scalars;
    const int32_t *from_jprops;
    const double *from_props, *from_svars, *from_energy, *from_coords, *from_predef;
    struct scalars *to_scalars;
    double *to_svars, *to_energy;
    void *element;
    void *given[ARGUMENTS];
};

// Eight entries at a time, and the last eight may overlap with those before.
static NOINLINE void copy(int64_t n, const double *from, double *to)
{
    if (n < 8) {
        for (int64_t k = 0; k < n; k++)
            to[k] = from[k];
        return;
    }
    for (int64_t k = 0; k < n - 8; k += 8)
        memcpy(to + k, from + k, 8 * sizeof *to);
    memcpy(to + n - 8, from + n - 8, 8 * sizeof *to);
}

// Entries of two vectors of the system, two at a time.
static NOINLINE void gather(int64_t n, const int32_t *equations, const double *x, const double *y, double *to_x, double *to_y)
{
    int64_t i;
    x--;
    y--;
    for (i = 0; i < n - 1; i += 2) {
        const int32_t k = equations[i], l = equations[i + 1];
        *(pair *)(to_x + i) = (pair){x[k], x[l]};
        *(pair *)(to_y + i) = (pair){y[k], y[l]};
    }
    if (i < n) {
        to_x[i] = x[equations[i]];
        to_y[i] = y[equations[i]];
    }
}

static NOINLINE void call_uel(const struct layout *layout)
{
    ((uel_t *)layout->routine)(EACH_OF_UEL(layout->given));
}

static NOINLINE void call_uelmat(const struct layout *layout)
{
    ((uelmat_t *)layout->routine)(EACH_OF_UEL(layout->given), layout->given[MATERIALLIB]);
}

// Calls the element at a place in its block, from 0.
void uel_host_call(const struct layout *layout, int64_t place, int32_t seat, int32_t element)
{
    void *const *given = layout->given;
    const int64_t n = layout->ndofel;
    const int32_t *equations = layout->equations + place * n;
    uel_host_begin(seat, element);
    gather(n, equations, layout->from_u, layout->from_du, given[U], given[DU]);
    if (layout->moves)
        gather(n, equations, layout->from_v, layout->from_a, given[V], given[A]);
    else {
        uel_host_fill(n, 0, given[V]);
        uel_host_fill(n, 0, given[A]);
    }
    uel_host_fill(layout->rhs, layout->on_entry, given[RHS]);
    uel_host_fill(n * n, layout->on_entry, given[AMATRX]);
    copy(layout->svars, layout->from_svars + place * layout->svars, given[SVARS]);
    memcpy(given[ENERGY], layout->from_energy + place * 8, 8 * sizeof(double));
    copy(layout->props, layout->from_props, given[PROPS]);
    copy(layout->coords, layout->from_coords + place * layout->coords, given[COORDS]);
    copy(layout->predef, layout->from_predef + place * layout->another, given[PREDEF]);
    *layout->to_scalars = *layout->from_scalars;
    *(int32_t *)given[JELEM] = element;
    for (int64_t k = 0; k < layout->jprops; k++)
        ((int32_t *)given[JPROPS])[k] = layout->from_jprops[k];
    if (!layout->loaded) {
        memset(given[JDLTYP], 0, 2 * sizeof(int32_t));
        memset(given[ADLMAG], 0, 2 * sizeof(double));
        memset(given[DDLMAG], 0, 2 * sizeof(double));
    }
    if (layout->element)
        ((built_in_t *)layout->routine)(layout->element);
    else if (layout->with_material)
        call_uelmat(layout);
    else
        call_uel(layout);
    if (!layout->keeps)
        return;
    copy(layout->svars, given[SVARS], layout->to_svars + place * layout->svars);
    memcpy(layout->to_energy + place * 8, given[ENERGY], 8 * sizeof(double));
}
