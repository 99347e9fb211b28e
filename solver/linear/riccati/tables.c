/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of a panel, of its joins and of those of the segments, in long double; see panels.h. One
 * Euler step of either field is the linear-quadratic problem of plain.h. Bending's second curvature
 * is divided by sqrt(3) here, so that R is a number; costates, P and loads are divided by R, so
 * that R becomes 1. */
#include <math.h>

#include "solver/linear/block.h"
#include "solver/linear/riccati/panels.h"

/* ---- an element ---- */

struct lq {
    int d;                      /* unknowns a node */
    struct block t, g;          /* y_{i+1} = T y_i + G kappa_i */
    struct block maa, mab, mbb; /* rho h / k times the element's mass, over R */
    wide r, alpha;              /* R: (c + k a) / h, bending: / h^3; a / (c + k a) */
};

/* The block of the element's mass that begins at a node (0: left, 1: right) by rows and columns. */
static struct block mass_of(int d, wide mass, int row, int column)
{
    struct block m = {{{0}}};
    if (d == 1)
        m.e[0][0] = mass * (row == column ? 2 : 1) / 6;
    else
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++)
                m.e[i][j] = mass * roundl(420 * br_bending_mass[2 * row + i][2 * column + j]) / 420;
    return m;
}

static struct lq lq_of_field(const struct br_field *field)
{
    static const struct block one = {{{1}}}, t = {{{1, 1}, {0, 1}}},
                              g = {{{0.5L, -BR_PANELS_ROOT3 / 6}, {1, 0}}};
    const bool rod = field->kind == BR_AXIAL;
    const int d = rod ? 1 : 2;
    const wide h = field->h, stiff = (wide)field->viscosity + (wide)field->k * field->stiffness;
    const wide r = rod ? stiff / h : stiff / (h * h * h);
    const wide mass = (wide)field->density * h / field->k / r;
    return (struct lq){
        .d = d,
        .t = rod ? one : t,
        .g = rod ? one : g,
        .maa = mass_of(d, mass, 0, 0),
        .mab = mass_of(d, mass, 0, 1),
        .mbb = mass_of(d, mass, 1, 1),
        .r = r,
        .alpha = field->stiffness / stiff,
    };
}

/* The gains of one element: A = T - G K, K and S^-1. */
struct gain {
    struct block closed, feedback, inverse;
};

/* One step of the Riccati recursion towards the clamped end: P_{i+1} becomes P_i. False where S is
 * not positive definite. */
static bool riccati_step(const struct lq *lq, struct block *p, struct gain *gain)
{
    const struct block gt = transpose(lq->g), q = plus(lq->mbb, *p); /* Q = Mbb + P_{i+1} */
    const struct block s = plus(times(gt, times(q, lq->g)), identity);
    if (!is_positive_definite(s))
        return false;
    gain->inverse = inverse_of(s);
    gain->inverse.e[1][0] = gain->inverse.e[0][1];
    const struct block h = times(gt, plus_times(transpose(lq->mab), q, lq->t)); /* G'(QT + Mab') */
    gain->feedback = times(gain->inverse, h);
    gain->closed = minus(lq->t, times(lq->g, gain->feedback));
    /* P = Maa + Mab A + (Mab A)' + A'QA + K'K: nothing is subtracted */
    const struct block mab_a = times(lq->mab, gain->closed);
    const struct block aqa = times(transpose(gain->closed), times(q, gain->closed));
    const struct block sum = plus_times(aqa, transpose(gain->feedback), gain->feedback);
    *p = plus(plus(plus(sum, lq->maa), mab_a), transpose(mab_a));
    return true;
}

/* The first d rows and columns as doubles, by rows, times 1 or -1. */
static void pack(int d, int sign, struct block from, double *to)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            to[i * d + j] = (double)(sign * from.e[i][j]);
}

/* The matrices of a panel or a segment as a whole (solver/README.md). */
struct whole {
    struct block phi, z, p;
};

/* ---- panels ---- */

/* The gains of the elements of a panel by their distance to its right end, and P at the right end
 * of each: longest + 1 of them, of which the first is 0. `gains`: the leftmost element's first. */
static bool fill_gains(const struct lq *lq, size_t longest, double *gains, struct gain *gain,
                       struct block *p)
{
    const int d = lq->d;
    for (size_t e = 0; e < longest; e++) {
        p[e + 1] = p[e];
        if (!riccati_step(lq, &p[e + 1], &gain[e]))
            return false;
        double *to = gains + (longest - 1 - e) * (size_t)(3 * d * d);
        pack(d, 1, gain[e].feedback, to);
        pack(d, 1, gain[e].inverse, to + d * d);
        pack(d, 1, gain[e].closed, to + 2 * d * d);
    }
    return true;
}

/* The weights of a panel, transposed responses of -kappa to c and of kappa to y_l; returns the
 * matrices of the panel without P. zeta: workspace, `length` of them. */
static struct whole fill_weights(const struct lq *lq, const struct gain *gain, size_t length,
                                 struct block *zeta, double *weight)
{
    const int d = lq->d;
    struct block y = {{{0}}}, from_left = identity, pi = identity;
    for (size_t e = 0; e < length; e++) { /* zeta = S^-1 G'pi, for pi = 1 at the right end */
        zeta[e] = times(gain[e].inverse, times(transpose(lq->g), pi));
        pi = times(transpose(gain[e].closed), pi);
    }
    for (size_t e = length; e-- > 0; weight += 2 * d * d) {
        const struct block to_right = plus(times(gain[e].feedback, y), zeta[e]); /* -kappa */
        pack(d, -1, transpose(to_right), weight);
        pack(d, -1, transpose(times(gain[e].feedback, from_left)), weight + d * d);
        y = minus(times(lq->t, y), times(lq->g, to_right)); /* T y + G kappa */
        from_left = times(gain[e].closed, from_left);
    }
    return (struct whole){.phi = from_left, .z = minus((struct block){{{0}}}, y)};
}

/* ---- joins ---- */

struct join {
    struct block of[BR_SEGMENT_JOINS];
};

/* The join of a panel or segment; c: C of the right end (in), and of the left end (out). (1 + Z
 * C)^-1 has a determinant of at least 1. */
static struct join join_of(const struct whole *w, struct block *c)
{
    const struct block phi_t = transpose(w->phi), m = inverse_of(plus_times(identity, w->z, *c));
    const struct join join = {.of = {
                                  [BR_JOIN_PASS] = times(m, w->phi),
                                  [BR_JOIN_GAIN] = m,
                                  [BR_JOIN_YIELD] = times(m, w->z),
                                  [BR_JOIN_COSTATE] = *c,
                                  [BR_JOIN_TRANSFER] = times(times(phi_t, *c), m),
                              }};
    const struct block next = plus_times(w->p, join.of[BR_JOIN_TRANSFER], w->phi);
    for (int i = 0; i < 2; i++) /* symmetric except for round-off */
        for (int j = 0; j < 2; j++)
            c->e[i][j] = (next.e[i][j] + next.e[j][i]) / 2;
    return join;
}

/* The joins of a segment; returns the matrices of the segment. */
static struct whole fill_segment(int d, const struct whole *panel, size_t panels, double *to)
{
    struct block c = {{{0}}}, ahead = identity, reach = identity, response = {{{0}}};
    for (size_t j = panels; j-- > 0;) {
        const struct join join = join_of(panel, &c);
        double *at = to + j * (size_t)(BR_JOINS * d * d);
        for (int which = 0; which < BR_SEGMENT_JOINS; which++)
            pack(d, 1, join.of[which], at + which * d * d);
        const struct block part = times(ahead, join.of[BR_JOIN_YIELD]);
        pack(d, 1, times(ahead, join.of[BR_JOIN_GAIN]), at + BR_JOIN_LEAD * d * d);
        pack(d, -1, part, at + BR_JOIN_LAG * d * d);
        pack(d, 1, reach, at + BR_JOIN_REACH * d * d);
        response = plus_times(response, part, reach);
        ahead = times(ahead, join.of[BR_JOIN_PASS]);
        reach = times(transpose(join.of[BR_JOIN_PASS]), reach);
    }
    return (struct whole){ahead, response, c};
}

/* The joins of the segments, from the tip to the clamped end. */
static void fill_ends(struct br_panels *s, const struct whole segment[BR_MOST_GROUPS])
{
    const int d = s->d, entries = BR_SEGMENT_JOINS * d * d;
    struct block c = {{{0}}};
    for (int i = s->groups; i-- > 0;)
        for (size_t lane = s->group[i].segments.lanes; lane-- > 0;) {
            const struct join join = join_of(&segment[i], &c);
            double packed[BR_SEGMENT_JOINS * 4];
            for (int which = 0; which < BR_SEGMENT_JOINS; which++)
                pack(d, 1, join.of[which], packed + which * d * d);
            for (int entry = 0; entry < entries; entry++)
                s->group[i].segments.segment_join[(size_t)entry * BR_LANES + lane] = packed[entry];
        }
}

enum br_status br_panels_tables(struct br_panels *s, struct br_error *err)
{
    const struct lq lq = lq_of_field(&s->field);
    const struct br_segments *of = &s->group[0].segments; /* the longest panels have all gains */
    if (s->group[s->groups - 1].segments.length > of->length)
        of = &s->group[s->groups - 1].segments;
    const size_t longest = of->length;
    s->r = (double)lq.r;
    struct gain *gain = br_allocate(longest, sizeof *gain);
    struct block *p = br_allocate(2 * longest + 1, sizeof *p);
    enum br_status status = gain && p ? BR_OK : br_no_memory(err, "the tables of a solver");
    if (!status && !fill_gains(&lq, longest, of->gain, gain, p))
        status = br_fail(err, BR_SINGULAR, "%s: the step is not positive definite",
                         br_field_names[s->field.kind]);
    struct whole segment[BR_MOST_GROUPS];
    for (int i = 0; i < s->groups && !status; i++) {
        struct br_segments *segments = &s->group[i].segments;
        segments->k = s->field.k;
        segments->alpha = (double)lq.alpha;
        struct whole panel =
            fill_weights(&lq, gain, segments->length, p + longest + 1, segments->weight);
        panel.p = p[segments->length];
        segment[i] = fill_segment(s->d, &panel, segments->panels, segments->join);
    }
    if (!status)
        fill_ends(s, segment);
    free(gain);
    free(p);
    return status;
}
