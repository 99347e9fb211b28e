/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a load adds to the recursions of the pieces; see pieces.h. */
#include <string.h>

#include "solver/pieces_state.h"

/* Whether all nodes but the clamped and the last one have one load. */
static bool is_uniform(const struct br_pieces *s, const double *vector)
{
    const size_t d = (size_t)s->d;
    for (size_t i = 2; i < s->field.n; i++)
        if (memcmp(vector + i * d, vector + d, d * sizeof *vector) != 0)
            return false;
    return true;
}

/* The load at the left node of each element, over R. */
static void spread(const struct br_pieces *s, struct br_strand *t, const double *vector)
{
    const size_t d = (size_t)s->d, length = br_span_length(t);
    for (size_t e = 0; e < length; e++)
        for (size_t c = 0; c < d; c++)
            for (size_t lane = 0; lane < t->strip.lanes; lane++)
                t->strip.load[(e * d + c) * BR_LANES + lane] =
                    vector[(t->first + lane * length + e) * d + c] / s->r;
}

/* A place for loads that differ from node to node. */
static enum br_status allocate(struct br_pieces *s, struct br_error *err)
{
    const size_t entry = (size_t)s->d * BR_LANES;
    size_t entries = 0;
    for (int i = 0; i < s->strands; i++)
        entries += br_span_length(&s->strand[i]);
    s->loads = br_allocate_aligned(entries * entry, sizeof *s->loads);
    return s->loads ? BR_OK : br_no_memory(err, "the load of a solver");
}

enum br_status br_pieces_set_load(struct br_pieces *s, const double *vector, struct br_error *err)
{
    const size_t d = (size_t)s->d;
    const bool even = !vector || is_uniform(s, vector);
    const enum br_status status = !even && !s->loads ? allocate(s, err) : BR_OK;
    if (status)
        return status;
    for (size_t c = 0; c < d; c++) {
        s->drive.uniform[c] = vector && even && s->field.n > 1 ? vector[d + c] / s->r : 0;
        s->tip_load[c] = vector ? vector[s->field.n * d + c] / s->r : 0;
    }
    double *next = s->loads;
    for (int i = 0; i < s->strands; i++) {
        struct br_strand *t = &s->strand[i];
        t->strip.load = even ? NULL : next;
        if (!even) {
            spread(s, t, vector);
            next += br_span_length(t) * d * BR_LANES;
        }
        s->kernel->charge(&t->strip, s->drive.uniform);
    }
    return BR_OK;
}
