/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/extremes/count.h"

#include <ctype.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- tallies ---- */

static void tally(const struct br_extreme_map *m, struct br_extreme_tally *t, int bin)
{
    for (size_t i = 0; i < m->cases; i++)
        if (!t->axis || t->axis->bin(&m->one[i]) == bin) {
            t->cases++;
            t->count[m->verdict[i].which]++;
        }
}

/* Fills the list, or counts what there is where it is NULL. */
static size_t list_tallies(const struct br_extreme_map *m, struct br_extreme_tally *list)
{
    struct br_extreme_tally t = {.label = "all"};
    size_t count = 0;
    tally(m, &t, 0);
    if (list)
        list[count] = t;
    count++;
    for (const struct br_extreme_axis *const *a = br_extreme_axes; *a; a++)
        for (int bin = 0;; bin++) {
            t = (struct br_extreme_tally){.axis = *a};
            if (!(*a)->label(bin, t.label, sizeof t.label))
                break;
            tally(m, &t, bin);
            if (list && t.cases)
                list[count] = t;
            count += t.cases > 0;
        }
    return count;
}

/* ---- reasons ---- */

static bool starts_number(const char *c, const char *text)
{
    const bool inside = c > text && (isalnum((unsigned char)c[-1]) || c[-1] == '_');
    return !inside && isdigit((unsigned char)c[*c == '-' || *c == '+']);
}

/* Numbers become #, so that reasons of different cases are alike; what follows a colon of a place
 * in a scene stays. */
static void generalise(const char *why, char text[150])
{
    size_t used = 0;
    for (const char *c = why; *c && used < 149;) {
        if (starts_number(c, why)) {
            text[used++] = '#';
            char *end;
            strtod(c, &end);
            c = end > c ? end : c + 1;
        } else {
            text[used++] = *c++;
        }
    }
    text[used] = '\0';
}

static void add_reason(struct br_extreme_counts *counts, const struct br_extreme_verdict *v,
                       size_t index)
{
    struct br_extreme_reason found = {.which = v->which, .cases = 1, .first = index};
    generalise(v->why, found.text);
    for (size_t i = 0; i < counts->reasons; i++) {
        struct br_extreme_reason *r = &counts->reason[i];
        if (r->which == found.which && strcmp(r->text, found.text) == 0) {
            r->cases++;
            return;
        }
    }
    counts->reason[counts->reasons++] = found;
}

static int by_class_and_count(const void *a, const void *b)
{
    const struct br_extreme_reason *x = a, *y = b;
    if (x->which != y->which)
        return x->which > y->which ? -1 : 1;
    if (x->cases != y->cases)
        return x->cases < y->cases ? 1 : -1;
    return (x->first > y->first) - (x->first < y->first);
}

enum br_status br_extreme_count(const struct br_extreme_map *m, struct br_extreme_counts *counts,
                                struct br_error *err)
{
    *counts = (struct br_extreme_counts){.tallies = list_tallies(m, NULL)};
    counts->tally = br_allocate(counts->tallies, sizeof *counts->tally);
    counts->reason = br_allocate(m->cases, sizeof *counts->reason);
    if (!counts->tally || !counts->reason)
        return br_no_memory(err, "the map's counts");
    list_tallies(m, counts->tally);
    for (size_t i = 0; i < m->cases; i++)
        if (*m->verdict[i].why)
            add_reason(counts, &m->verdict[i], i);
    qsort(counts->reason, counts->reasons, sizeof *counts->reason, by_class_and_count);
    return BR_OK;
}

void br_extreme_counts_clear(struct br_extreme_counts *counts)
{
    free(counts->tally);
    free(counts->reason);
    *counts = (struct br_extreme_counts){0};
}

/* ---- rates ---- */

struct br_extreme_rate br_extreme_rate(const struct br_extreme_map *m)
{
    struct br_extreme_rate r = {.wrong = m->count[BR_EXTREME_WRONG]};
    for (size_t i = 0; i < m->cases; i++) {
        const enum br_extreme_class which = m->verdict[i].which;
        if (which == BR_EXTREME_REFUSED || which == BR_EXTREME_UNJUDGED)
            continue;
        r.answers++;
        r.unstated += !m->verdict[i].known;
        r.unstated_unstable += !m->verdict[i].known && which == BR_EXTREME_UNSTABLE;
    }
    const double x = (double)r.wrong, rest = (double)(r.answers - r.wrong);
    r.low = x > 0 ? gsl_cdf_beta_Pinv(0.025, x, rest + 1) : 0;
    r.high = rest > 0 ? gsl_cdf_beta_Pinv(0.975, x + 1, rest) : 1;
    return r;
}

/* ---- planes ---- */

/* The cell along one coordinate; -1: not in the plane. */
static int place(const struct br_extreme_coordinate *c, const struct br_extreme_case *one)
{
    const double decade = log10(c->value(one));
    if (!isfinite(decade))
        return -1;
    const double cell = floor((decade - c->low) / (c->high - c->low) * (double)c->cells);
    return (int)fmax(0, fmin(cell, (double)c->cells - 1));
}

static double cell_class(const struct br_extreme_map *m, const struct br_extreme_plane *p, int x,
                         int y)
{
    size_t count[BR_EXTREME_CLASSES] = {0};
    double most = NAN;
    for (size_t i = 0; i < m->cases; i++)
        if (place(p->x, &m->one[i]) == x && place(p->y, &m->one[i]) == y)
            count[m->verdict[i].which]++;
    for (int which = 0; which < BR_EXTREME_CLASSES; which++)
        if (count[which] && (isnan(most) || count[which] > count[(int)most]))
            most = which;
    return count[BR_EXTREME_WRONG] ? BR_EXTREME_WRONG : most;
}

void br_extreme_plane_fill(const struct br_extreme_map *m, const struct br_extreme_plane *p,
                           double *cell)
{
    for (size_t y = 0; y < p->y->cells; y++)
        for (size_t x = 0; x < p->x->cells; x++)
            cell[y * p->x->cells + x] = cell_class(m, p, (int)x, (int)y);
}
