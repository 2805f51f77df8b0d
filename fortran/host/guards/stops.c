// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ends of the process that become ends of the call: user files are linked with --wrap for these procedures of libgfortran
// and libc, so a STOP in a user routine, or exit in C, comes here. Errors inside libgfortran (such as reading a missing
// file) still end the process.

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void uel_host_note(int32_t level, const char *text, int32_t length);
void uel_host_escape(void);
int uel_host_in_call(void);

static void fatal(const char *text)
{
    uel_host_note(-3, text, (int32_t)strlen(text));
    uel_host_escape();
}

void uel_host_thrown(const char *text)
{
    if (uel_host_in_call())
        fatal(text);
}

void uel_host_fail(const char *routine, int32_t id, const char *reason)
{
    char text[256];
    snprintf(text, sizeof text, "%s(%d): %s", routine, (int)id, reason);
    fatal(text);
}

static void stop_string(const char *statement, const char *string, size_t length)
{
    char text[1024];
    if (string && length)
        snprintf(text, sizeof text, "%s '%.*s'", statement, (int)(length < 900 ? length : 900), string);
    else
        snprintf(text, sizeof text, "%s", statement);
    fatal(text);
}

static void stop_number(const char *statement, int code)
{
    char text[64];
    snprintf(text, sizeof text, "%s %d", statement, code);
    fatal(text);
}

void __wrap__gfortran_stop_string(const char *string, size_t length, bool quiet)
{
    (void)quiet;
    stop_string("STOP", string, length);
}

void __wrap__gfortran_error_stop_string(const char *string, size_t length, bool quiet)
{
    (void)quiet;
    stop_string("ERROR STOP", string, length);
}

void __wrap__gfortran_stop_numeric(int code, bool quiet)
{
    (void)quiet;
    stop_number("STOP", code);
}

void __wrap__gfortran_error_stop_numeric(int code, bool quiet)
{
    (void)quiet;
    stop_number("ERROR STOP", code);
}

void __wrap__gfortran_exit_i4(const int32_t *code) { stop_number("CALL EXIT", code ? *code : 0); }

#define ENDS_CALL(name)                                                                                                \
    void __wrap_##name(int code)                                                                                       \
    {                                                                                                                  \
        char text[64];                                                                                                 \
        snprintf(text, sizeof text, #name "(%d)", code);                                                               \
        fatal(text);                                                                                                   \
    }

ENDS_CALL(exit)
ENDS_CALL(_exit)
ENDS_CALL(_Exit)
ENDS_CALL(quick_exit)

// Routines of Abaqus that the host does not supply. A file may refer to them in procedures that are never called here.
#define NOT_SUPPLIED(name, title)                                                                                      \
    void name(void) { fatal("it calls " title ", which the harness does not supply"); }

NOT_SUPPLIED(getvrn_, "GETVRN")
NOT_SUPPLIED(getvrmavgatnode_, "GETVRMAVGATNODE")
NOT_SUPPLIED(getinternal_, "GETINTERNAL")
NOT_SUPPLIED(getpartinfo_, "GETPARTINFO")
NOT_SUPPLIED(getelemnumberuser_, "GETELEMNUMBERUSER")
NOT_SUPPLIED(getnodetoelemconn_, "GETNODETOELEMCONN")
NOT_SUPPLIED(getwave_, "GETWAVE")
NOT_SUPPLIED(getmpicommunicator_, "GETMPICOMMUNICATOR")
NOT_SUPPLIED(posfil_, "POSFIL")
NOT_SUPPLIED(dbfile_, "DBFILE")
NOT_SUPPLIED(settablecollection_, "SETTABLECOLLECTION")
NOT_SUPPLIED(getparametertable_, "GETPARAMETERTABLE")
NOT_SUPPLIED(getpropertytable_, "GETPROPERTYTABLE")
NOT_SUPPLIED(material_lib_ht_, "MATERIAL_LIB_HT")
