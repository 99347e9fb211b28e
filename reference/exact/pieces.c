/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/pieces.h"

#include <math.h>
#include <string.h>

#include "reference/exact/legendre.h"

enum br_status br_pieces_init(struct br_pieces *p, double length, size_t count, const double *end,
                              const size_t *terms, struct br_error *err)
{
    *p = (struct br_pieces){.length = length, .count = count};
    p->end = br_allocate(count + 1, sizeof *p->end);
    p->terms = br_allocate(count, sizeof *p->terms);
    p->first = br_allocate(count + 1, sizeof *p->first);
    if (!p->end || !p->terms || !p->first)
        return br_no_memory(err, "the elements");
    memcpy(p->end, end, (count + 1) * sizeof *end);
    memcpy(p->terms, terms, count * sizeof *terms);
    for (size_t e = 0; e < count; e++)
        p->first[e + 1] = p->first[e] + terms[e];
    return BR_OK;
}

enum br_status br_pieces_whole(struct br_pieces *p, double length, size_t terms,
                               struct br_error *err)
{
    return br_pieces_init(p, length, 1, (const double[]){0, length}, &terms, err);
}

void br_pieces_clear(struct br_pieces *p)
{
    free(p->end);
    free(p->terms);
    free(p->first);
    *p = (struct br_pieces){0};
}

size_t br_pieces_find(const struct br_pieces *p, double x)
{
    size_t low = 0, high = p->count; /* end[low] < x <= end[high], but at the ends */
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (p->end[middle] < x)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double br_pieces_integral(const struct br_pieces *p, size_t extra, const double *c)
{
    double sum = 0;
    for (size_t e = 0; e < p->count; e++)
        sum += sqrt(br_pieces_width(p, e)) * c[br_pieces_at(p, e, extra)];
    return sum;
}

/* Inside of an element by Legendre's recurrence; what it gathers is handed to all elements to
 * its right as a constant. */
void br_pieces_integrate(const struct br_pieces *p, size_t extra, double *c)
{
    for (size_t e = p->count; e-- > 1;)
        memmove(&c[br_pieces_at(p, e, extra + 1)], &c[br_pieces_at(p, e, extra)],
                (p->terms[e] + extra) * sizeof *c);
    double value = 0; /* of the integral, at the element's left end */
    for (size_t e = 0; e < p->count; e++) {
        const double width = br_pieces_width(p, e), one = sqrt(width); /* 1 = one p_0 / sqrt(h) */
        double *here = &c[br_pieces_at(p, e, extra + 1)];
        const double gain = one * here[0];
        br_legendre_integrate(p->terms[e] + extra, here);
        for (size_t k = 0; k <= p->terms[e] + extra; k++)
            here[k] *= width;
        here[0] += one * value;
        value += gain;
    }
}
