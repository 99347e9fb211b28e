/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/margins.h"

#include <math.h>

void br_margins_add(struct br_margins *m, double time, double margin)
{
    m->time[m->count] = time;
    m->margin[m->count++] = margin;
}

/* Lagrange's polynomial through all of them. */
static double interpolate(const struct br_margins *m, double time)
{
    double sum = 0;
    for (size_t i = 0; i < m->count; i++) {
        double weight = 1;
        for (size_t j = 0; j < m->count; j++)
            if (j != i)
                weight *= (time - m->time[j]) / (m->time[i] - m->time[j]);
        sum += weight * m->margin[i];
    }
    return sum;
}

static double first_negative(const struct br_margins *m)
{
    double first = 0;
    for (size_t i = 0; i < m->count; i++)
        if (m->time[i] > 0 && m->margin[i] < 0 && (first == 0 || m->time[i] < first))
            first = m->time[i];
    return first;
}

double br_margins_dip(const struct br_margins *m)
{
    enum { PLACES = 64 };
    const double round_off = 1e-13;
    double first = first_negative(m), begin = 1, largest = 0;
    for (size_t i = 0; i < m->count; i++) {
        begin = fmin(begin, m->time[i]);
        largest = fmax(largest, fabs(m->margin[i]));
    }
    if (first > 0)
        return first;
    double lowest = -round_off * largest;
    for (int i = 1; i < PLACES; i++) {
        const double time = begin + (1 - begin) * i / PLACES, margin = interpolate(m, time);
        if (margin < lowest) {
            lowest = margin;
            first = time;
        }
    }
    return first;
}
