/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/past_states.h"

#include <string.h>

typedef long double real;

static void add(double *to, real factor, const double *from, size_t size)
{
    for (size_t i = 0; i < size && factor != 0; i++)
        to[i] = (double)((real)to[i] + factor * (real)from[i]);
}

/* Z = sum of past_j Y_{n-1-j} */
static void start_differences(struct br_past_states *f, const struct br_textbook *t)
{
    for (int j = 0; j < t->back; j++) {
        add(f->start.displacement, t->past[j], f->past[j].displacement, f->size);
        add(f->start.velocity, t->past[j], f->past[j].velocity, f->size);
    }
}

/* Z = Y_{n-1} + k sum of a_ij Y'_j; the rate of a displacement is the velocity itself. */
static void start_row(struct br_past_states *f, const struct br_textbook *t, int row, real k)
{
    add(f->start.displacement, 1, f->past[0].displacement, f->size);
    add(f->start.velocity, 1, f->past[0].velocity, f->size);
    for (int j = 0; j < row; j++) {
        const struct br_nodal *y = t->c[j] == 0 ? &f->past[0] : &f->row[j];
        add(f->start.displacement, k * t->a[row][j], y->velocity, f->size);
        add(f->start.velocity, k * t->a[row][j], y->acceleration, f->size);
    }
}

real br_start_of_row(struct br_past_states *f, const struct br_textbook *t, int row, real k)
{
    memset(f->start.displacement, 0, f->size * sizeof(double));
    memset(f->start.velocity, 0, f->size * sizeof(double));
    if (t->rows == 0)
        start_differences(f, t);
    else
        start_row(f, t, row, k);
    return k * (t->rows == 0 ? t->beta : t->a[row][row]);
}

double br_tip_path_at(const struct br_tip_path *p, double time)
{
    for (int i = 0; i < p->count; i++)
        if (p->time[i] == time)
            return p->u[i];
    const real s = ((real)time - p->from) / p->k, d = (real)p->u_to - p->u_from;
    const real a = (real)p->k * p->v_from - d, b = d - (real)p->k * p->v_to;
    return (double)(p->u_from + s * d + s * (1 - s) * ((1 - s) * a + s * b));
}
