/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/blas.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

/* OpenBLAS's own calls, which FlexiBLAS has as well. NULL: another BLAS is loaded. */
static int (*get_threads)(void);
static void (*set_threads)(int);

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static size_t inside;
static int threads_before;

static void look_up(const char *name, void *function)
{
    void *found = dlsym(RTLD_DEFAULT, name);
    memcpy(function, &found,
           sizeof found); /* C has no cast of an object's address to a function's */
}

static void find_calls(void)
{
    look_up("openblas_get_num_threads", &get_threads);
    look_up("openblas_set_num_threads", &set_threads);
}

void br_blas_enter(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, find_calls);
    if (!get_threads || !set_threads)
        return;
    pthread_mutex_lock(&lock);
    if (inside++ == 0)
        threads_before = get_threads();
    set_threads(1); /* with OpenMP it counts for the calling thread alone */
    pthread_mutex_unlock(&lock);
}

void br_blas_leave(void)
{
    if (!get_threads || !set_threads)
        return;
    pthread_mutex_lock(&lock);
    if (--inside == 0)
        set_threads(threads_before);
    pthread_mutex_unlock(&lock);
}
