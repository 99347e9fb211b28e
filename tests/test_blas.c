/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whatever calls LAPACK or UMFPACK has one BLAS thread, and the number that the process had is set
 * again. This program is its own OpenBLAS: it has the two calls by which threads are chosen. */
#include <lapacke.h>
#include <pthread.h>
#include <suitesparse/umfpack.h>

#include "solver/scene.h"
#include "study/grid/sweep.h"
#include "support.h"

enum { GIVEN = 7 };
static int threads = GIVEN;
enum { GESDD, GEQRF, NUMERIC, FUNCTIONS };
static size_t calls[FUNCTIONS], wrong; /* wrong: with several threads */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

int openblas_get_num_threads(void);
int openblas_get_num_threads(void)
{
    return threads;
}

void openblas_set_num_threads(int count);
void openblas_set_num_threads(int count)
{
    threads = count;
}

static void count_call(int function)
{
    pthread_mutex_lock(&lock);
    calls[function]++;
    wrong += threads != 1;
    pthread_mutex_unlock(&lock);
}

#define COUNTED(function, type, name, arguments, ...) \
    type __real_##name arguments;                     \
    type __wrap_##name arguments;                     \
    type __wrap_##name arguments                      \
    {                                                 \
        count_call(function);                         \
        return __real_##name(__VA_ARGS__);            \
    }

COUNTED(GESDD, lapack_int, LAPACKE_dgesdd,
        (int layout, char job, lapack_int m, lapack_int n, double *a, lapack_int lda, double *s,
         double *u, lapack_int ldu, double *vt, lapack_int ldvt),
        layout, job, m, n, a, lda, s, u, ldu, vt, ldvt)
COUNTED(GEQRF, lapack_int, LAPACKE_dgeqrf,
        (int layout, lapack_int m, lapack_int n, double *a, lapack_int lda, double *tau), layout, m,
        n, a, lda, tau)
COUNTED(NUMERIC, int, umfpack_di_numeric,
        (const int columns[], const int rows[], const double values[], void *symbolic,
         void **numeric, const double control[], double info[]),
        columns, rows, values, symbolic, numeric, control, info)

/* The number of threads is right while two of ours are at work, too. */
TEST(test_one_thread)
{
    OWNED(br_scene) scene = br_test_bundled("example2");
    struct br_study s =
        br_test_study(&scene, &br_reference_exact, 2, (size_t[]){4, 8}, 2, (size_t[]){20, 50});
    s.method = br_test_method("umfpack", NULL, NULL);
    MUST(br_study_run(&s, 1, 2, NULL, &err));
    br_study_clear(&s);
    for (int i = 0; i < FUNCTIONS; i++)
        assert_true(calls[i] > 0);
    assert_int_equal(wrong, 0);
    assert_int_equal(threads, GIVEN);
}
