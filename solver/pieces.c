/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The recursions of riccati.h on pieces of equal length, side by side in the lanes of
 * vectors.
 *
 * Each piece has a Riccati recursion of its own that begins with P = 0 at its right end,
 * so all share one table of gains. For a piece with the increment y_l at its left end and
 * the costate c at its right one, a step gives
 *     y_r = Phi y_l - Z c + z,      c_l = P y_l + Phi'c + q,
 * where Phi, Z and P are tables, and z and q are sums over the piece of what its state g
 * and its load add: X'g and Y'g, the responses to unit c and y_l, times R. The joins are
 * exact, by a Riccati recursion over the pieces: with c = C y_r + h from the right,
 *     y_r = M (Phi y_l + z - Z h),  M = (I + Z C)^-1,
 *     C_l = P + Phi'C M Phi,        h_l = q + Phi'C M z + (M Phi)'h.
 * So a step is a pass over the joins (predict), which tells the tip's velocity, and one
 * pass over the elements (finish), which also sums z and q for the next step. The tip is
 * read off the field every step: what is only incremented drifts. */
#include "solver/pieces.h"

#include <math.h>
#include <string.h>

#include "solver/pieces_state.h"

enum {
    /* Elements of a piece: what a group of pieces works on fits the first level of the cache. */
    LEAST_LENGTH = 8,
    MOST_LENGTH = 56,
};

/* A component of the state of element e, counted from the right end of a lane of a group. */
static double *state_of(const struct br_pieces *s, const struct br_group *g, size_t lane, size_t e,
                        int c)
{
    return &g->state[(e * (size_t)(2 * s->d) + (size_t)c) * BR_LANES + lane];
}

static void pieces_free(void *self)
{
    struct br_pieces *s = self;
    if (!s)
        return;
    free(s->group);
    free(s->join);
    free(s->arena);
    free(s);
}

/* What a step costs with pieces of some length, in element loops of a group: its groups, the odd
 * piece, and the joins, which are about two element loops each. */
static double cost_of(size_t n, size_t length, size_t *regular)
{
    *regular = n / length / BR_LANES * BR_LANES;
    if (*regular == 0)
        return INFINITY;
    const size_t odd = n - *regular * length;
    return (double)(*regular / BR_LANES * length + odd + 2 * *regular);
}

/* How the elements are cut: whole groups of pieces of the cheapest length; a few elements make one
 * group that is not full. */
static void choose_pieces(struct br_pieces *s)
{
    const size_t n = s->field.n;
    double least = INFINITY;
    size_t regular = 0;
    for (size_t length = LEAST_LENGTH; length <= MOST_LENGTH; length++) {
        size_t pieces;
        const double cost = cost_of(n, length, &pieces);
        if (!(cost < least))
            continue;
        least = cost;
        s->length = length;
        regular = pieces;
    }
    if (regular == 0) {
        regular = n / LEAST_LENGTH > 1 ? n / LEAST_LENGTH : 1;
        s->length = n / regular;
    }
    s->odd = n - regular * s->length;
    s->pieces = regular + (s->odd > 0);
    s->longest = s->length > s->odd ? s->length : s->odd;
}

/* The next array of the arena, at the start of a vector; arena NULL: only counted. */
static double *take(double *arena, size_t *used, size_t doubles)
{
    double *p = arena ? arena + *used : NULL;
    *used += (doubles + BR_LANES - 1) / BR_LANES * BR_LANES;
    return p;
}

/* Lays out all arrays; returns their doubles. */
static size_t lay_out(struct br_pieces *s, double *arena)
{
    const size_t d = (size_t)s->d;
    size_t used = 0;
    s->gain = take(arena, &used, s->longest * 4 * d * d);
    s->weight = take(arena, &used, s->length * 2 * d * d);
    s->odd_weight = take(arena, &used, s->odd * 2 * d * d);
    s->shared_load = take(arena, &used, s->longest * d);
    s->scratch = take(arena, &used, s->longest * d * BR_LANES);
    for (size_t i = 0; i < s->groups; i++) {
        struct br_group *g = &s->group[i];
        g->table = (struct br_sweep_table){s->gain, s->odd && i == 0 ? s->odd_weight : s->weight};
        g->end = take(arena, &used, BR_ENDS * d * BR_LANES);
        g->state = take(arena, &used, g->length * 2 * d * BR_LANES);
        g->load = take(arena, &used, g->length * d * BR_LANES);
    }
    return used;
}

static enum br_status allocate(struct br_pieces *s, struct br_error *err)
{
    const size_t odd = s->odd > 0, regular = s->pieces - odd;
    s->groups = odd + (regular + BR_LANES - 1) / BR_LANES;
    s->group = br_allocate(s->groups, sizeof *s->group);
    s->join = br_allocate(s->pieces, sizeof *s->join);
    if (!s->group || !s->join)
        return br_no_memory(err, "a solver");
    for (size_t i = 0; i < s->groups; i++) {
        const size_t first = odd && i == 0 ? 0 : odd + (i - odd) * BR_LANES;
        const size_t left = odd && i == 0 ? 1 : s->pieces - first;
        s->group[i].first = first;
        s->group[i].lanes = left < BR_LANES ? left : BR_LANES;
        s->group[i].length = odd && i == 0 ? s->odd : s->length;
    }
    const size_t doubles = lay_out(s, NULL);
    s->arena = br_allocate_aligned(doubles, sizeof(double));
    if (!s->arena)
        return br_no_memory(err, "a solver");
    lay_out(s, s->arena);
    return BR_OK;
}

static enum br_status pieces_create(const struct br_field *field,
                                    const struct br_linear_options *options, void **self,
                                    struct br_error *err)
{
    struct br_pieces *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "a solver");
    s->field = *field;
    s->kernel = options->kernel ? options->kernel : br_kernel_best();
    if (!s->kernel->available())
        return br_fail(err, BR_BAD_INPUT, "kernel %s is not available on this machine",
                       s->kernel->name);
    s->d = field->kind == BR_AXIAL ? 1 : 2;
    s->k = field->k;
    choose_pieces(s);
    enum br_status status = allocate(s, err);
    if (!status)
        status = br_pieces_tables(s, err);
    if (status)
        return status;
    const double unit[BR_LQ_MOST] = {1, 0};
    br_pieces_join(s, true, unit, s->force_increment);
    s->compliance = -s->force_increment[0];
    return BR_OK;
}

static double pieces_compliance(const void *self)
{
    return ((const struct br_pieces *)self)->compliance;
}

static struct br_sweep sweep_of(const struct br_pieces *s, const struct br_group *g)
{
    const size_t entry = (size_t)s->d * BR_LANES;
    return (struct br_sweep){
        .d = s->d,
        .length = g->length,
        .table = g->table,
        .load = !s->loaded    ? NULL
                : s->lanewise ? g->load
                              : s->shared_load,
        .lanewise = s->lanewise,
        .factor = s->factor,
        .r = {s->r[0], s->r[1]},
        .alpha = s->alpha,
        .k = s->k,
        .state = g->state,
        .scratch = s->scratch,
        .right = g->end + BR_END_RIGHT * entry,
        .left = g->end + BR_END_LEFT * entry,
        .q = g->end + BR_END_Q * entry,
        .z = g->end + BR_END_Z * entry,
        .velocity = g->end + BR_END_VELOCITY * entry,
        .displacement = g->end + BR_END_DISPLACEMENT * entry,
    };
}

/* The tip's value, by carrying what has been found across each piece over all of them: T^length y +
 * it. */
static double carry_to_tip(const struct br_pieces *s, int which)
{
    double y[BR_LQ_MOST] = {0};
    for (size_t i = 0; i < s->groups; i++) {
        const struct br_group *g = &s->group[i];
        const double *own = g->end + (size_t)(which * s->d) * BR_LANES;
        for (size_t lane = 0; lane < g->lanes; lane++) {
            y[0] += (s->d == 2 ? (double)g->length * y[1] : 0) + own[lane];
            if (s->d == 2)
                y[1] += own[BR_LANES + lane];
        }
    }
    return y[0];
}

static void pieces_set(void *self, const double *displacement, const double *velocity)
{
    struct br_pieces *s = self;
    const size_t d = (size_t)s->d;
    for (size_t i = 0; i < s->groups; i++)
        for (size_t lane = 0; lane < s->group[i].lanes; lane++) {
            const struct br_group *g = &s->group[i];
            double q[BR_LQ_MOST] = {0}, z[BR_LQ_MOST] = {0};
            for (size_t e = 0; e < g->length; e++) {
                const size_t node = br_piece_right_node(s, g->first + lane) - e - 1;
                double w[2], v[2];
                if (d == 1) {
                    w[0] = displacement[node + 1] - displacement[node];
                    v[0] = velocity[node + 1] - velocity[node];
                } else {
                    br_curvature(displacement + 2 * node, w);
                    br_curvature(velocity + 2 * node, v);
                }
                const double *weight = g->table.weight + e * 2 * d * d;
                for (size_t c = 0; c < d; c++) {
                    const double strain = s->alpha * w[c] + v[c];
                    *state_of(s, g, lane, e, (int)c) = strain;
                    *state_of(s, g, lane, e, (int)(d + c)) = w[c];
                    for (size_t j = 0; j < d; j++) {
                        z[j] += weight[j * d + c] * strain;
                        q[j] += weight[d * d + j * d + c] * strain;
                    }
                }
            }
            for (int c = 0; c < s->d; c++) {
                *br_piece_end(s, g->first + lane, BR_END_Q, c) = q[c];
                *br_piece_end(s, g->first + lane, BR_END_Z, c) = z[c];
            }
        }
    s->tip_velocity = velocity[s->field.n * d];
    for (size_t i = 0; i < s->groups; i++) {
        const struct br_sweep sweep = sweep_of(s, &s->group[i]);
        s->kernel->carry(&sweep, sweep.displacement);
    }
}

/* kappa_w and kappa_v of an element, from the clamped end. */
static void element_of(const struct br_pieces *s, size_t element, double *w, double *v)
{
    const size_t piece = s->odd && element < s->odd ? 0
                         : s->odd                   ? 1 + (element - s->odd) / s->length
                                                    : element / s->length;
    const size_t odd = s->odd > 0;
    const struct br_group *g = &s->group[odd && piece == 0 ? 0 : odd + (piece - odd) / BR_LANES];
    const size_t e = br_piece_right_node(s, piece) - 1 - element;
    for (int c = 0; c < s->d; c++) {
        w[c] = *state_of(s, g, piece - g->first, e, s->d + c);
        v[c] = *state_of(s, g, piece - g->first, e, c) - s->alpha * w[c];
    }
}

static void carry_node(int d, double *y, const double *kappa)
{
    if (d == 1) {
        y[0] += kappa[0];
        return;
    }
    y[0] += y[1] + (0.5 * kappa[0] - kappa[1] / 6);
    y[1] += kappa[0];
}

static void pieces_get(const void *self, double *displacement, double *velocity)
{
    const struct br_pieces *s = self;
    const size_t d = (size_t)s->d, bytes = d * sizeof(double);
    double w[BR_LQ_MOST] = {0}, v[BR_LQ_MOST] = {0};
    for (size_t i = 0; i <= s->field.n; i++) {
        double kw[BR_LQ_MOST], kv[BR_LQ_MOST];
        if (displacement)
            memcpy(displacement + i * d, w, bytes);
        if (velocity)
            memcpy(velocity + i * d, v, bytes);
        if (i == s->field.n)
            break;
        element_of(s, i, kw, kv);
        carry_node(s->d, w, kw);
        carry_node(s->d, v, kv);
    }
}

static void pieces_strain_rate(const void *self, double *rate)
{
    const struct br_pieces *s = self;
    for (size_t i = 0; i < s->field.n; i++) {
        double w[BR_LQ_MOST];
        element_of(s, i, w, rate + i * (size_t)s->d);
    }
}

static enum br_status pieces_predict(void *self, const struct br_drive *drive, double *velocity,
                                     struct br_error *err)
{
    (void)err;
    struct br_pieces *s = self;
    if (drive->changed)
        br_pieces_set_load(s, drive->vector);
    s->factor = drive->factor;
    double costate[BR_LQ_MOST] = {0};
    for (int c = 0; c < s->d; c++)
        costate[c] = -(s->factor * s->tip_load[c] + drive->tip[c]);
    br_pieces_join(s, false, costate, s->tip_increment);
    *velocity = s->tip_velocity + s->tip_increment[0];
    return BR_OK;
}

static double pieces_finish(void *self, double force)
{
    struct br_pieces *s = self;
    const size_t entry = (size_t)s->d * BR_LANES;
    for (size_t i = 0; i < s->groups; i++) {
        double *end = s->group[i].end;
        for (size_t j = 0; j < entry; j++) {
            end[BR_END_RIGHT * entry + j] += force * end[BR_END_FORCE_RIGHT * entry + j];
            end[BR_END_LEFT * entry + j] += force * end[BR_END_FORCE_LEFT * entry + j];
        }
        const struct br_sweep sweep = sweep_of(s, &s->group[i]);
        s->kernel->step(&sweep);
    }
    s->tip_velocity = carry_to_tip(s, BR_END_VELOCITY);
    return s->tip_velocity;
}

static double pieces_tip_displacement(const void *self)
{
    const struct br_pieces *s = self;
    for (size_t i = 0; i < s->groups && s->d == 2; i++) { /* the laws do not need it every step */
        const struct br_sweep sweep = sweep_of(s, &s->group[i]);
        s->kernel->carry(&sweep, sweep.displacement);
    }
    return carry_to_tip(s, BR_END_DISPLACEMENT);
}

const struct br_field_solver br_pieces = {
    .create = pieces_create,
    .free = pieces_free,
    .tip_compliance = pieces_compliance,
    .set = pieces_set,
    .get = pieces_get,
    .strain_rate = pieces_strain_rate,
    .predict = pieces_predict,
    .finish = pieces_finish,
    .tip_displacement = pieces_tip_displacement,
};
