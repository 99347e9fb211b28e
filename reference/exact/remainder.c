/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/remainder.h"

#include <lapacke.h>
#include <string.h>

enum br_status br_remainder_init(struct br_remainder *m, size_t columns, size_t block,
                                 struct br_error *err)
{
    *m = (struct br_remainder){.columns = columns, .block = block};
    m->a = br_allocate((columns + block) * columns, sizeof *m->a);
    m->tau = br_allocate(columns, sizeof *m->tau);
    return m->a && m->tau ? BR_OK : br_no_memory(err, "a projection");
}

void br_remainder_clear(struct br_remainder *m)
{
    free(m->a);
    free(m->tau);
    *m = (struct br_remainder){0};
}

double *br_remainder_r(const struct br_remainder *m, size_t row, size_t column)
{
    return &m->a[column * (m->columns + m->block) + row];
}

double *br_remainder_block(const struct br_remainder *m, size_t row, size_t column)
{
    return br_remainder_r(m, m->columns + row, column);
}

enum br_status br_remainder_add(struct br_remainder *m, struct br_error *err)
{
    const size_t rows = m->columns + m->block;
    if (!m->block)
        return BR_OK;
    const lapack_int info = LAPACKE_dgeqrf(LAPACK_COL_MAJOR, (lapack_int)rows,
                                           (lapack_int)m->columns, m->a, (lapack_int)rows, m->tau);
    for (size_t k = 0; k < m->columns; k++) /* the reflectors below the diagonal are not needed */
        memset(br_remainder_r(m, k + 1, k), 0, (rows - k - 1) * sizeof(double));
    if (info == LAPACK_WORK_MEMORY_ERROR)
        return br_no_memory(err, "a projection's remainder");
    return info ? br_fail(err, BR_SINGULAR, "a projection's remainder failed (%d)", (int)info)
                : BR_OK;
}
