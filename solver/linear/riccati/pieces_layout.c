/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the beam is cut, where everything lies, and the way from and to nodal values; see pieces.h.
 */
#include <math.h>
#include <string.h>

#include "solver/instruction_set.h"
#include "solver/linear/riccati/pieces.h"

enum {
    MOST_LENGTH = 32, /* elements of a piece: two of them fit the first level of the cache */
    JOIN_COST = 2,    /* of a piece in its span, in element loops */
    SPAN_COST = 16,   /* of all spans */
};

struct cut {
    size_t pieces, length, odd;
};

/* Element loops of a step. Elements of the odd rest have all vectors to themselves. */
static double cost_of(const struct cut *cut)
{
    return (double)(cut->pieces * (cut->length + JOIN_COST) + cut->odd) +
           (cut->pieces ? SPAN_COST : 0);
}

static struct cut choose_cut(size_t n)
{
    struct cut best = {.odd = n};
    for (size_t length = 1; length <= MOST_LENGTH && length * BR_LANES <= n; length++) {
        struct cut cut = {.pieces = n / (length * BR_LANES), .length = length};
        cut.odd = n - cut.pieces * length * BR_LANES;
        if (cost_of(&cut) < cost_of(&best))
            best = cut;
    }
    return best;
}

/* ns, of an AMD EPYC with AVX-512 at about 3 GHz: of a step, of an element of all spans, of the odd
 * rest and of its elements; and what a pass over the states adds to each. */
struct cost {
    double step, loop, rest, odd;
};

/* A beam that is all odd rest has nothing to join. */
static double price(const struct cost *of, const struct cut *cut)
{
    const double joins = cut->pieces ? of->step : 0, rest = cut->odd ? of->rest : 0;
    return joins + of->loop * (double)(cut->pieces * cut->length) + rest +
           of->odd * (double)cut->odd;
}

double br_pieces_cost(const struct br_field *field, double sums)
{
    static const struct cost axial = {260, 6.5, 55, 2.75}, axial_sum = {70, 1.6, 8, 3.1};
    static const struct cost bending = {450, 22, 115, 10.9}, bending_sum = {55, 7, 14, 6.5};
    static const double march = 140; /* of a step that has an odd rest alone */
    const struct cut cut = choose_cut(field->n);
    const bool rod = field->kind == BR_AXIAL;
    return (cut.pieces ? 0 : march) + price(rod ? &axial : &bending, &cut) +
           sums * price(rod ? &axial_sum : &bending_sum, &cut);
}

static double *take(double *arena, size_t *used, size_t doubles)
{
    double *p = arena ? arena + *used : NULL;
    *used += (doubles + BR_LANES - 1) / BR_LANES * BR_LANES;
    return p;
}

/* Lays out all arrays, or with no arena counts their doubles. */
static size_t lay_out(struct br_pieces *s, double *arena)
{
    const size_t d = (size_t)s->d, entry = d * BR_LANES;
    size_t used = 0, longest = 0;
    for (int i = 0; i < s->strands; i++) {
        struct br_strand *t = &s->strand[i];
        struct br_strip *strip = &t->strip;
        longest = strip->length > longest ? strip->length : longest;
        strip->end = take(arena, &used, strip->pieces * BR_ENDS * entry);
        strip->join = take(arena, &used, strip->pieces * BR_JOINS * d * d);
        strip->span_join = take(arena, &used, BR_SPAN_JOINS * d * entry);
        strip->weight = take(arena, &used, strip->length * 2 * d * d);
        double **const ends[] = {
            &t->q,          &t->z,         &t->force_right,   &t->force_left,
            &t->ends.right, &t->ends.left, &t->ends.velocity, &t->ends.displacement};
        for (size_t e = 0; e < sizeof ends / sizeof *ends; e++)
            *ends[e] = take(arena, &used, entry);
    }
    double *gain = take(arena, &used, longest * 3 * d * d);
    double *scratch = take(arena, &used, longest * entry);
    for (int i = 0; i < s->strands && arena; i++) { /* gains go by the distance to the right end */
        struct br_strip *strip = &s->strand[i].strip;
        strip->gain = gain + (longest - strip->length) * 3 * d * d;
        strip->scratch = scratch;
    }
    return used;
}

static void add_strand(struct br_pieces *s, size_t first, size_t lanes, const struct cut *cut)
{
    struct br_strand *t = &s->strand[s->strands++];
    t->first = first;
    t->strip.d = s->d;
    t->strip.lanes = lanes;
    t->strip.pieces = cut->pieces;
    t->strip.length = cut->length;
}

enum br_status br_pieces_lay_out(struct br_pieces *s, struct br_error *err)
{
    const struct cut cut = choose_cut(s->field.n);
    if (cut.odd)
        add_strand(s, 0, 1, &(struct cut){.pieces = 1, .length = cut.odd});
    if (cut.pieces)
        add_strand(s, cut.odd, BR_LANES, &cut);
    s->arena = br_allocate_aligned(lay_out(s, NULL), sizeof(double));
    if (!s->arena)
        return br_no_memory(err, "a solver");
    lay_out(s, s->arena);
    const enum br_status status = br_pieces_keep(s, 1, err);
    if (!status)
        br_pieces_point_at_first(s);
    return status;
}

/* kappa_w of an element, kappa_v after it. */
static double *state_at(const struct br_pieces *s, const struct br_strand *t, size_t lane, size_t e)
{
    return t->strip.state + e * 2 * (size_t)s->d * BR_LANES + lane;
}

/* ---- from nodal values ---- */

/* What deforms an element, in the units of lq.h. */
static void strain_of(int d, const double *node, double *strain)
{
    if (d == 1) {
        strain[0] = node[1] - node[0];
        return;
    }
    br_curvature(node, strain);
    strain[1] /= (double)BR_LQ_ROOT3;
}

static void set_element(const struct br_pieces *s, const struct br_strand *t, size_t lane, size_t e,
                        const double *displacement, const double *velocity)
{
    const size_t d = (size_t)s->d;
    const size_t node = t->first + lane * br_span_length(t) + e;
    double *to = state_at(s, t, lane, e), w[BR_LQ_MOST], v[BR_LQ_MOST];
    strain_of(s->d, displacement + node * d, w);
    strain_of(s->d, velocity + node * d, v);
    for (size_t c = 0; c < d; c++) {
        to[c * BR_LANES] = w[c];
        to[(d + c) * BR_LANES] = v[c];
    }
}

void br_pieces_set(void *self, const double *displacement, const double *velocity)
{
    struct br_pieces *s = self;
    for (int i = 0; i < s->strands; i++) {
        const struct br_strand *t = &s->strand[i];
        for (size_t lane = 0; lane < t->strip.lanes; lane++)
            for (size_t e = 0; e < br_span_length(t); e++)
                set_element(s, t, lane, e, displacement, velocity);
        s->kernel->weigh(&t->strip);
    }
    s->tip_bias = 0;
    s->stale_ends = s->advanced = false;
    s->tip_displacement = br_pieces_tip_displacement(s);
    s->tip_velocity = velocity[s->field.n * (size_t)s->d];
}

/* ---- to nodal values ---- */

/* What each span has at its left end, given what it is across each; y: at the left end of the first
 * (in), and at the right end of the last (out). */
static void find_left_ends(const struct br_pieces *s, const struct br_strand *t,
                           const double *across, double *y, double *left)
{
    for (size_t lane = 0; lane < t->strip.lanes; lane++) {
        for (int c = 0; c < s->d; c++)
            left[c * BR_LANES + (int)lane] = y[c];
        y[0] += across[lane];
        if (s->d == 1)
            continue;
        y[0] += (double)br_span_length(t) * y[1];
        y[1] += across[BR_LANES + lane];
    }
}

static void get_nodes(const struct br_pieces *s, bool rate, double *nodal)
{
    _Alignas(64) double across[BR_LQ_MOST * BR_LANES], left[BR_LQ_MOST * BR_LANES] = {0};
    const size_t d = (size_t)s->d;
    double y[BR_LQ_MOST] = {0};
    memcpy(nodal, y, d * sizeof *y);
    for (int i = 0; i < s->strands; i++) {
        const struct br_strand *t = &s->strand[i];
        if (!rate || !s->advanced)
            s->kernel->carry(&t->strip, rate, across);
        find_left_ends(s, t, rate && s->advanced ? t->ends.velocity : across, y, left);
        s->kernel->expand(&t->strip, rate, left, nodal + (t->first + 1) * d);
    }
}

void br_pieces_get(const void *self, double *displacement, double *velocity)
{
    if (displacement)
        get_nodes(self, false, displacement);
    if (velocity)
        get_nodes(self, true, velocity);
}

void br_pieces_strain_rate(const void *self, double *rate)
{
    const struct br_pieces *s = self;
    for (int i = 0; i < s->strands; i++) {
        const struct br_strand *t = &s->strand[i];
        for (size_t lane = 0; lane < t->strip.lanes; lane++)
            for (size_t e = 0; e < br_span_length(t); e++, rate += s->d) {
                const double *kappa = state_at(s, t, lane, e) + s->d * BR_LANES;
                rate[0] = kappa[0];
                if (s->d == 2)
                    rate[1] = (double)BR_LQ_ROOT3 * kappa[BR_LANES];
            }
    }
}

double br_pieces_at_tip(const struct br_pieces *s, const double *const across[BR_MOST_STRANDS])
{
    double y[BR_LQ_MOST] = {0}, left[BR_LQ_MOST * BR_LANES];
    for (int i = 0; i < s->strands; i++)
        find_left_ends(s, &s->strand[i], across[i], y, left);
    return y[0];
}

double br_pieces_tip_displacement(const void *self)
{
    const struct br_pieces *s = self;
    _Alignas(64) double across[BR_MOST_STRANDS][BR_LQ_MOST * BR_LANES];
    const double *of[BR_MOST_STRANDS];
    for (int i = 0; i < s->strands; i++) {
        s->kernel->carry(&s->strand[i].strip, false, across[i]);
        of[i] = across[i];
    }
    return br_pieces_at_tip(s, of);
}

/* ---- loads: what they add to the recursions of the pieces ---- */

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
BR_SWEEP
static void spread(const struct br_pieces *s, struct br_strand *t, const double *vector)
{
    const size_t entries = (size_t)s->d * br_span_length(t);
    const double *from = vector + t->first * (size_t)s->d, r = s->r;
    double *restrict to = t->strip.load;
    for (size_t lane = 0; lane < t->strip.lanes; lane++, from += entries)
        for (size_t i = 0; i < entries; i++)
            to[i * BR_LANES + lane] = from[i] / r;
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
