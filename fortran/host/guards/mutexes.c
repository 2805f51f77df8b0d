// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Mutexes 1 to 100 (Abaqus User Subroutines Guide, Mutex). On one thread there is nothing to wait for, and a call that is left
// keeps nothing locked.

#include <pthread.h>
#include <stdint.h>

void uel_host_fail(const char *routine, int32_t id, const char *reason);   // stops.c
int uel_host_together(void);                                               // protect.c

enum { MUTEXES = 100 };
static pthread_mutex_t mutexes[MUTEXES];

// Several threads are about to call elements: all mutexes are open.
void uel_host_new_mutexes(void)
{
    for (int k = 0; k < MUTEXES; k++)
        mutexes[k] = (pthread_mutex_t)PTHREAD_MUTEX_INITIALIZER;
}

static pthread_mutex_t *find(const char *routine, int32_t id)
{
    if (id < 1 || id > MUTEXES)
        uel_host_fail(routine, id, "expected a number from 1 to 100");
    return &mutexes[id - 1];
}

void mutexinit_(const int32_t *id) { find("MutexInit", *id); }

void mutexlock_(const int32_t *id)
{
    pthread_mutex_t *mutex = find("MutexLock", *id);
    if (uel_host_together())
        pthread_mutex_lock(mutex);
}

void mutexunlock_(const int32_t *id)
{
    pthread_mutex_t *mutex = find("MutexUnlock", *id);
    if (uel_host_together())
        pthread_mutex_unlock(mutex);
}
