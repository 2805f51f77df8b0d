// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An uncaught C++ exception ends the call as XIT does, with its type and what it says. libstdc++ comes with
// the user's library and is not linked here: its procedures are looked up by their names in the C++ ABI.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unwind.h>

void uel_host_thrown(const char *text);   // stops.c; returns outside a call

typedef void (*handler)(void);

static void *library;
static handler before;

static void *find(const char *name) { return dlsym(library, name); }

// Defined by the ABI: the header before a thrown object, and the exceptions of a thread.
struct thrown {
    void *type, *destructor, *handlers[2];
    struct thrown *next;
    int counts[2];
    void *cached[4];
    struct _Unwind_Exception header;
};
struct globals {
    struct thrown *caught;
    unsigned uncaught;
};

// What std::exception::what returns for the object that was thrown; NULL where it is no std::exception. The third entry of
// the virtual table of an exception is `what`, the fifth of a type is `__do_catch`, both after two destructors.
static const char *what(void *type)
{
    struct globals *(*globals)(void) = find("__cxa_get_globals");
    void **base = find("_ZTISt9exception");
    struct thrown *thrown = globals ? globals()->caught : NULL;
    // a rethrown exception is stored elsewhere
    if (!base || !thrown || (thrown->header.exception_class & 0xff))
        return NULL;
    void *object = thrown + 1;
    bool (*catches)(const void *, const void *, void **, unsigned) = (*(void ***)base)[4];
    if (!catches(base, type, &object, 1))
        return NULL;
    const char *(*say)(const void *) = (*(void ***)object)[2];
    return say(object);
}

static void terminated(void)
{
    char text[512];
    void *(*current_type)(void) = find("__cxa_current_exception_type");
    char *(*demangle)(const char *, char *, size_t *, int *) = find("__cxa_demangle");
    void *type = current_type ? current_type() : NULL;
    if (type) {
        // the name follows the pointer to the virtual table, with an asterisk if it is local to one file
        const char *name = ((const char **)type)[1], *said = what(type);
        name += *name == '*';
        char *readable = demangle ? demangle(name, NULL, NULL, NULL) : NULL;
        snprintf(text, sizeof text, "an uncaught C++ exception: %s%s%.400s", readable ? readable : name,
                 said ? ": " : "", said ? said : "");
    } else {
        snprintf(text, sizeof text, "std::terminate without an exception");
    }
    uel_host_thrown(text);
    if (before)
        before();
    abort();
}

// To be called when a library of user routines is loaded.
void uel_host_watch_exceptions(void)
{
    library = dlopen("libstdc++.so.6", RTLD_LAZY | RTLD_NOLOAD);
    handler (*set)(handler) = library ? find("_ZSt13set_terminatePFvvE") : NULL;
    if (!set)
        return;
    const handler old = set(terminated);
    if (old != terminated)
        before = old;
}
