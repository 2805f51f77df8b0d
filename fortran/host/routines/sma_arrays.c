// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Allocatable arrays that user routines share by number (Abaqus User Subroutines Guide, Allocatable arrays):
// SMA[Local]IntArray* and SMA[Local]FloatArray*. Integers are 4 bytes, floats 4 or 8 by the type of the initial value.
// Local arrays differ from global ones between threads only, and calls that use arrays run on one; their numbers are separate.

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void uel_host_fail(const char *routine, int32_t id, const char *reason);
void uel_host_go_alone(void);   // protect.c

enum kind { INT_GLOBAL, FLOAT_GLOBAL, INT_LOCAL, FLOAT_LOCAL };

struct array {
    struct array *next;
    enum kind kind;
    int32_t id;
    int32_t size;
    size_t width;
    void *data;
};

static struct array *first = NULL;

static struct array *find(enum kind kind, int32_t id)
{
    uel_host_go_alone();
    for (struct array *a = first; a; a = a->next)
        if (a->kind == kind && a->id == id)
            return a;
    return NULL;
}

static void *access_array(enum kind kind, const int32_t *id, const char *routine)
{
    struct array *a = find(kind, *id);
    if (!a)
        uel_host_fail(routine, *id, "there is no array with this number");
    return a->data;
}

static int32_t size_of_array(enum kind kind, const int32_t *id, const char *routine)
{
    struct array *a = find(kind, *id);
    if (!a)
        uel_host_fail(routine, *id, "there is no array with this number");
    return a->size;
}

static void delete_array(enum kind kind, const int32_t *id)
{
    uel_host_go_alone();
    for (struct array **link = &first; *link; link = &(*link)->next) {
        struct array *a = *link;
        if (a->kind == kind && a->id == *id) {
            *link = a->next;
            free(a->data);
            free(a);
            return;
        }
    }
}

// An array that exists is resized: what it holds stays, and what is new gets the initial value.
static void *create(enum kind kind, const int32_t *id, const int32_t *size, const void *value, size_t width,
                    const char *routine)
{
    struct array *a = find(kind, *id);
    if (*size < 0 || (a && a->width != width))
        uel_host_fail(routine, *id, *size < 0 ? "the size is negative" : "the array exists with another precision");
    if (!a) {
        a = calloc(1, sizeof *a);
        if (!a)
            uel_host_fail(routine, *id, "out of memory");
        *a = (struct array){.next = first, .kind = kind, .id = *id, .width = width};
        first = a;
    }
    void *data = realloc(a->data, (size_t)*size * width + 1);
    if (!data)
        uel_host_fail(routine, *id, "out of memory");
    a->data = data;
    for (int32_t i = a->size; i < *size; ++i) {
        if (value)
            memcpy((char *)data + (size_t)i * width, value, width);
        else
            memset((char *)data + (size_t)i * width, 0, width);
    }
    a->size = *size;
    return data;
}

// A new job starts without arrays.
void uel_host_clear_arrays(void)
{
    while (first) {
        struct array *a = first;
        first = a->next;
        free(a->data);
        free(a);
    }
}

#define INT_ROUTINES(prefix, kind)                                                                                     \
    void *prefix##intarraycreate_(const int32_t *id, const int32_t *size, const int32_t *value)                        \
    {                                                                                                                  \
        return create(kind, id, size, value, sizeof(int32_t), #prefix "IntArrayCreate");                              \
    }                                                                                                                  \
    void *prefix##intarrayaccess_(const int32_t *id) { return access_array(kind, id, #prefix "IntArrayAccess"); }      \
    int32_t prefix##intarraysize_(const int32_t *id) { return size_of_array(kind, id, #prefix "IntArraySize"); }       \
    void prefix##intarraydelete_(const int32_t *id) { delete_array(kind, id); }

#define FLOAT_ROUTINES(prefix, kind)                                                                                   \
    void *prefix##floatarraycreatesp_(const int32_t *id, const int32_t *size, const float *value)                     \
    {                                                                                                                  \
        return create(kind, id, size, value, sizeof(float), #prefix "FloatArrayCreate");                              \
    }                                                                                                                  \
    void *prefix##floatarraycreatedp_(const int32_t *id, const int32_t *size, const double *value)                    \
    {                                                                                                                  \
        return create(kind, id, size, value, sizeof(double), #prefix "FloatArrayCreate");                             \
    }                                                                                                                  \
    void *prefix##floatarraycreate_(const int32_t *id, const int32_t *size, const double *value)                      \
    {                                                                                                                  \
        return create(kind, id, size, value, sizeof(double), #prefix "FloatArrayCreate");                             \
    }                                                                                                                  \
    void *prefix##floatarrayaccess_(const int32_t *id) { return access_array(kind, id, #prefix "FloatArrayAccess"); }  \
    int32_t prefix##floatarraysize_(const int32_t *id) { return size_of_array(kind, id, #prefix "FloatArraySize"); }   \
    void prefix##floatarraydelete_(const int32_t *id) { delete_array(kind, id); }

INT_ROUTINES(sma, INT_GLOBAL)
INT_ROUTINES(smalocal, INT_LOCAL)
FLOAT_ROUTINES(sma, FLOAT_GLOBAL)
FLOAT_ROUTINES(smalocal, FLOAT_LOCAL)
