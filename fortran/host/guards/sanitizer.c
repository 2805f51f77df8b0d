// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// AddressSanitizer in debug builds of user files. Its runtime has to be in the process from the beginning
// (harness/uel/running/sanitizer.py) and is looked up by name. What it finds ends the call, in words of ours and not its own report.
// The guards around the arrays of a user element are out of bounds for such a build: it meets them reading, too.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// protect.c; at_once: not from within the runtime, which holds locks
void uel_host_overrun(const char *text, int at_once);

enum { FENCES = 11 };   // n_arrays of host/driver/workspace.f90

static struct fence {
    char name[16];
    const char *from, *array, *behind, *to;
} fences[FENCES];

static int on;
static char found[256];   // the last report of the runtime, as the end of a sentence

static void *find(const char *name) { return dlsym(RTLD_DEFAULT, name); }

// Whether the runtime is in this process.
int32_t uel_host_sanitizing(void) { return find("__asan_init") != NULL; }

static void poison(const char *from, const char *to, int closed)
{
    void (*set)(const volatile void *, size_t) =
        find(closed ? "__asan_poison_memory_region" : "__asan_unpoison_memory_region");
    if (set && to > from)
        set(from, (size_t)(to - from));
}

// Array number `slot`, from 0, has this many entries; those before and after it belong to nobody.
void uel_host_fence(int32_t slot, const char name[6], const double *array, int32_t entries, int32_t before, int32_t behind)
{
    if (!on)
        return;
    struct fence *fence = &fences[slot];
    snprintf(fence->name, sizeof fence->name, "%.*s", (int)strcspn(name, " ") < 6 ? (int)strcspn(name, " ") : 6, name);
    fence->array = (const char *)array;
    fence->behind = (const char *)(array + entries);
    fence->from = (const char *)(array - before);
    fence->to = (const char *)(array + entries + behind);
    poison(fence->from, fence->array, 1);
    poison(fence->array, fence->behind, 0);
    poison(fence->behind, fence->to, 1);
}

// The host looks at the guards, or writes them.
void uel_host_open_fences(void)
{
    if (!on)
        return;
    for (int k = 0; k < FENCES; k++)
        poison(fences[k].from, fences[k].to, 0);
    memset(fences, 0, sizeof fences);
}

// The stack below a call that was left is free again: its variables were fenced too.
void uel_host_clear_stack(const char *from, const char *to)
{
    if (on)
        poison(from, to, 0);
}

static const char *verb(int writes) { return writes ? "writes" : "reads"; }

static const char *inside_line(const char *text, const char *word)
{
    const char *at = strstr(text, word), *end = strchr(text, '\n');
    return at && (!end || at < end) ? at + strlen(word) : NULL;
}

// 'name' in a report as in the source: without the module, or the number that the compiler adds.
static void name_of(const char *quoted, char *name, size_t size)
{
    const char *end = strchr(quoted, '\''), *module = strstr(quoted, "_MOD_");
    if (module && end && module < end)
        quoted = module + 5;
    snprintf(name, size, "%.*s", (int)strcspn(quoted, "'."), quoted);
}

// What a report says, as the end of a sentence.
static void summarise(const char *report, char *text, size_t size)
{
    const char *kind = strstr(report, "AddressSanitizer: ");
    const int writes = strstr(report, "\nWRITE of size ") != NULL;
    char name[64];
    kind = kind ? kind + strlen("AddressSanitizer: ") : "memory error";
    if (!strncmp(kind, "heap-use-after-free", 19)) {
        snprintf(text, size, "it %s memory that has been freed", verb(writes));
        return;
    }
    if (!strncmp(kind, "attempting", 10)) {
        snprintf(text, size,
                 inside_line(kind, "double-free") ? "it frees memory twice" : "it frees memory that was never allocated");
        return;
    }
    for (const char *line = report; line; line = strchr(line, '\n'), line += line != NULL) {
        const char *global = inside_line(line, "global variable '"), *local = inside_line(line, "<== Memory access");
        const char *block = inside_line(line, "-byte region [");
        long bytes = 0;
        if (global) {
            const char *length = inside_line(global, " of size ");
            name_of(global, name, sizeof name);
            snprintf(text, size, "it %s outside the variable '%s' (%ld bytes)", verb(writes), name,
                     length ? atol(length) : 0);
            return;
        }
        if (local && (global = inside_line(line, ") '"))) {
            long first = 0, end = 0;
            name_of(global, name, sizeof name);
            sscanf(line, " [%ld, %ld)", &first, &end);
            snprintf(text, size, "it %s outside the variable '%s' (%ld bytes)", verb(writes), name, end - first);
            return;
        }
        if (block) {
            const char *number = block - strlen("-byte region [");
            while (number > line && number[-1] >= '0' && number[-1] <= '9')
                number--;
            bytes = atol(number);
            snprintf(text, size, "it %s outside an allocated array (%ld bytes)", verb(writes), bytes);
            return;
        }
    }
    const char *where =
        !strncmp(kind, "dynamic-stack", 13) ? "outside a local array" : "at an address that belongs to no variable";
    snprintf(text, size, "it %s %s", verb(writes), where);
}

// An entry of an array of the host at an address; false if it is in none of their guards.
static int beside_array(const char *address, int writes, char *text, size_t size)
{
    for (int k = 0; k < FENCES; k++) {
        const struct fence *fence = &fences[k];
        if (address < fence->from || address >= fence->to)
            continue;
        const long entry = (long)((address - fence->array) / (long)sizeof(double)) + (address >= fence->array);
        const long entries = (long)((fence->behind - fence->array) / (long)sizeof(double));
        snprintf(text, size, "it %s outside %s: entry %ld of %ld", verb(writes), fence->name, entry, entries);
        return 1;
    }
    return 0;
}

static const char *accessed;   // an address that a wrapper below has reported, and what was done there
static int written;

static void reported(const char *report)
{
    const char *at = strstr(report, " on address 0x");
    const char *address = accessed ? accessed : at ? (const char *)strtoull(at + strlen(" on address "), NULL, 16) : NULL;
    const int writes = accessed ? written : strstr(report, "\nWRITE of size ") != NULL;
    if (!on)
        return;
    if (!beside_array(address, writes, found, sizeof found))
        summarise(report, found, sizeof found);
    if (!accessed)
        uel_host_overrun(found, 0);
}

// From now on, a library built with AddressSanitizer is called, or no longer.
void uel_host_sanitize(int32_t begins)
{
    void (*call_back)(void (*)(const char *)) = find("__asan_set_error_report_callback");
    void (*print_to)(void *) = find("__sanitizer_set_report_fd");
    static int nowhere = -1;
    if (!call_back || !print_to)
        return;
    if (nowhere < 0 && (nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC)) >= 0)
        print_to((void *)(intptr_t)nowhere);
    call_back(reported);
    if (!begins)
        uel_host_open_fences();
    on = begins;
}

// The code that the compiler puts before each access comes here: user files are linked with --wrap for it.
static void report(const void *address, int writes, size_t size)
{
    void (*describe)(const void *, const void *, const void *, const void *, int, size_t, uint32_t) =
        find("__asan_report_error");
    if (!on || !describe)
        return;
    snprintf(found, sizeof found, "it %s at an address that belongs to no variable", verb(writes));
    accessed = address;
    written = writes;
    describe(__builtin_return_address(0), __builtin_frame_address(0), __builtin_frame_address(0), address, writes, size, 0);
    accessed = NULL;
    uel_host_overrun(found, 1);
}

#define FINDS(size)                                                                                                    \
    void __wrap___asan_report_load##size##_noabort(const void *address) { report(address, 0, size); }                  \
    void __wrap___asan_report_store##size##_noabort(const void *address) { report(address, 1, size); }

FINDS(1)
FINDS(2)
FINDS(4)
FINDS(8)
FINDS(16)

void __wrap___asan_report_load_n_noabort(const void *address, size_t size) { report(address, 0, size); }
void __wrap___asan_report_store_n_noabort(const void *address, size_t size) { report(address, 1, size); }
