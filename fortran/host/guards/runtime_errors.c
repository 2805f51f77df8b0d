// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Errors that the compiler's own checks find in user code (an index out of bounds in a debug build, ALLOCATE of what is
// allocated in any) end the call, and not the process: user files are linked with --wrap for these procedures of libgfortran.

#include <ctype.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

void uel_host_note(int32_t level, const char *text, int32_t length);
void uel_host_place(char routine[16], int32_t place[4]);
void uel_host_escape(void);

// where: "At line 12 of file path/name.for", or "" where it is not known
static void end_call(const char *where, const char *format, va_list arguments)
{
    char reason[1024], text[1400], routine[17] = "", file[256] = "";
    int32_t place[4];
    int line = 0;
    vsnprintf(reason, sizeof reason, format, arguments);
    reason[0] = (char)tolower((unsigned char)reason[0]);
    uel_host_place(routine, place);
    const int known = sscanf(where, "At line %d of file %255[^\n]", &line, file) == 2 ||
                      sscanf(where, "In file '%255[^']', around line %d", file, &line) == 2;
    const char *folder = strrchr(file, '/');
    const int named = (int)strcspn(routine, " ");
    const int length = known ? snprintf(text, sizeof text, "in %.*s, %s line %d: %s", named, routine,
                                        folder ? folder + 1 : file, line, reason)
                             : snprintf(text, sizeof text, "in %.*s: %s", named, routine, reason);
    uel_host_note(-3, text, length);
    uel_host_escape();
}

#define WRAPPED(name, where, ...)                                                                                        \
    void __wrap__gfortran_##name(__VA_ARGS__, ...)                                                                       \
    {                                                                                                                    \
        va_list arguments;                                                                                               \
        va_start(arguments, format);                                                                                     \
        end_call(where, format, arguments);                                                                              \
    }

WRAPPED(runtime_error_at, where, const char *where, const char *format)
WRAPPED(os_error_at, where, const char *where, const char *format)
WRAPPED(runtime_error, "", const char *format)
