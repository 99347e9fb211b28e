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

#include "solver/lq.h"
#include "solver/sweep_kernel.h"

enum {
    MOST = BR_LQ_MOST,
    /* Elements of a piece: what a group of pieces works on fits the first level of the cache. */
    LEAST_LENGTH = 8,
    MOST_LENGTH = 56,
};

/* One join, by rows, d by d. */
struct join {
    double pass[MOST][MOST];     /* M Phi */
    double gain[MOST][MOST];     /* M */
    double yield[MOST][MOST];    /* M Z */
    double costate[MOST][MOST];  /* C */
    double transfer[MOST][MOST]; /* Phi'C M */
};

/* BR_LANES pieces of one length. */
struct group {
    size_t first, lanes; /* its pieces */
    size_t length;
    struct br_sweep_table table;
    double *state; /* length * 2 d * BR_LANES */
    double *load;  /* lanewise sigma, length * d * BR_LANES */
    double *end;   /* d * BR_LANES each of: right, left, q, z, load's q, load's z, then the
                      influence of a unit force on right and left, and the velocity and the
                      displacement across the pieces */
};
enum { RIGHT, LEFT, Q, Z, LOAD_Q, LOAD_Z, FORCE_RIGHT, FORCE_LEFT, VELOCITY, DISPLACEMENT, ENDS };

struct pieces {
    struct br_field field;
    const struct br_kernel *kernel;
    int d;
    double k, alpha, r[MOST];
    size_t pieces, groups;
    size_t length, odd, longest; /* elements: of a piece, of the first one if that is another, and
                                    of the longer of the two */
    struct group *group;
    struct join *join;                  /* pieces */
    double *gain, *weight, *odd_weight; /* tables */
    double *shared_load;                /* sigma, where it is the same in all pieces; length * d */
    double *scratch, *arena;
    bool loaded, lanewise;
    double factor, tip_load[MOST]; /* of the last node, for a factor of 1 */
    double tip_increment[MOST], force_increment[MOST];
    double tip_velocity, compliance;
};

/* ---- where things are ---- */

static double *end_of(const struct pieces *s, size_t piece, int which, int c)
{
    const size_t odd = s->odd > 0;
    const size_t i = odd && piece == 0 ? 0 : odd + (piece - odd) / BR_LANES;
    const struct group *g = &s->group[i];
    return &g->end[((size_t)(which * s->d + c)) * BR_LANES + (piece - g->first)];
}

/* A component of the state of element e, counted from the right end of a lane of a group. */
static double *state_of(const struct pieces *s, const struct group *g, size_t lane, size_t e, int c)
{
    return &g->state[(e * (size_t)(2 * s->d) + (size_t)c) * BR_LANES + lane];
}

/* ---- tables ---- */

typedef br_real block[MOST][MOST];

static void add_product(int d, const block a, const block b, block c)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            for (int l = 0; l < d; l++)
                c[i][j] += a[i][l] * b[l][j];
}

static void transpose(int d, const block a, block b)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            b[j][i] = a[i][j];
}

static void set_identity(int d, block a)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            a[i][j] = i == j;
}

static void keep(int d, const block a, double to[MOST][MOST])
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            to[i][j] = (double)a[i][j];
}

/* What a piece of some length does as a whole. */
struct whole {
    block phi, z, p;
};

/* Fills the gains; P of every length goes into `p`, longest + 1 of them. */
static bool fill_gains(struct pieces *s, const struct br_lq *lq, struct br_lq_gain *gain, block *p)
{
    const int d = s->d;
    memset(p[0], 0, sizeof *p);
    for (size_t e = 0; e < s->longest; e++) {
        memcpy(p[e + 1], p[e], sizeof *p);
        if (!br_lq_step(lq, p[e + 1], &gain[e]))
            return false;
        double *to = s->gain + e * (size_t)(4 * d * d);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++) {
                to[i * d + j] = (double)gain[e].closed[j][i];
                to[d * d + i * d + j] = (double)-(gain[e].feedback[j][i] * lq->r[j]);
                to[2 * d * d + i * d + j] = (double)-gain[e].inverse[i][j];
                to[3 * d * d + i * d + j] = (double)-gain[e].feedback[i][j];
            }
    }
    return true;
}

/* The responses to unit y_l and unit c of a piece of `length` elements, times R, and what the piece
 * does as a whole. costate: workspace, length of them. */
static void fill_weights(const struct pieces *s, const struct br_lq *lq,
                         const struct br_lq_gain *gain, size_t length, block *costate,
                         double *weight, struct whole *whole)
{
    const int d = s->d;
    block pi, gt, y = {{0}}, from_left;
    set_identity(d, pi);
    set_identity(d, from_left);
    transpose(d, lq->g, gt);
    for (size_t e = 0; e < length; e++) { /* costate[e] = S^-1 G' pi */
        block q = {{0}}, at, next = {{0}};
        add_product(d, gt, pi, q);
        memset(costate[e], 0, sizeof *costate);
        add_product(d, gain[e].inverse, q, costate[e]);
        transpose(d, gain[e].closed, at);
        add_product(d, at, pi, next);
        memcpy(pi, next, sizeof pi);
    }
    for (size_t e = length; e-- > 0;) {
        block by_left = {{0}}, by_right, ky = {{0}}, gk = {{0}}, next = {{0}};
        add_product(d, gain[e].feedback, from_left, by_left);
        add_product(d, gain[e].feedback, y, ky);
        double *to = weight + e * (size_t)(2 * d * d);
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++) {
                by_right[i][j] = -(ky[i][j] + costate[e][i][j]);
                to[j * d + i] = (double)(lq->r[i] * by_right[i][j]);
                to[d * d + j * d + i] = (double)-(lq->r[i] * by_left[i][j]);
            }
        add_product(d, lq->g, by_right, gk);
        add_product(d, lq->t, y, gk);
        memcpy(y, gk, sizeof y);
        add_product(d, gain[e].closed, from_left, next);
        memcpy(from_left, next, sizeof from_left);
    }
    memcpy(whole->phi, from_left, sizeof whole->phi);
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            whole->z[i][j] = -y[i][j];
}

/* (I + Z C)^-1; its determinant is at least 1. */
static void join_inverse(int d, const block z, const block ph, block m)
{
    block a;
    set_identity(d, a);
    add_product(d, z, ph, a);
    if (d == 1) {
        m[0][0] = 1 / a[0][0];
        return;
    }
    const br_real det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    m[0][0] = a[1][1] / det;
    m[0][1] = -a[0][1] / det;
    m[1][0] = -a[1][0] / det;
    m[1][1] = a[0][0] / det;
}

/* From the tip to the clamped end; ph: of the right end, becomes that of the left end. */
static void fill_join(int d, const struct whole *w, block ph, struct join *join)
{
    block m, pass = {{0}}, yield = {{0}}, phi_t, phi_t_ph = {{0}}, transfer = {{0}}, next;
    join_inverse(d, w->z, ph, m);
    add_product(d, m, w->phi, pass);
    add_product(d, m, w->z, yield);
    transpose(d, w->phi, phi_t);
    add_product(d, phi_t, ph, phi_t_ph);
    add_product(d, phi_t_ph, m, transfer);
    keep(d, m, join->gain);
    keep(d, pass, join->pass);
    keep(d, yield, join->yield);
    keep(d, ph, join->costate);
    keep(d, transfer, join->transfer);
    memcpy(next, w->p, sizeof next);
    add_product(d, transfer, w->phi, next);
    for (int i = 0; i < d; i++) /* symmetric but for round-off */
        for (int j = 0; j < d; j++)
            ph[i][j] = (next[i][j] + next[j][i]) / 2;
}

static enum br_status fill_tables(struct pieces *s, struct br_error *err)
{
    const struct br_lq lq = br_lq_of_field(&s->field);
    const size_t longest = s->longest;
    s->alpha = (double)lq.alpha;
    for (int i = 0; i < s->d; i++)
        s->r[i] = (double)lq.r[i];
    struct br_lq_gain *gain = br_allocate(longest, sizeof *gain);
    block *p = br_allocate(2 * longest + 1, sizeof *p);
    enum br_status status = gain && p ? BR_OK : br_no_memory(err, "the tables of a solver");
    if (!status && !fill_gains(s, &lq, gain, p))
        status = br_fail(err, BR_SINGULAR, "%s: the step is not positive definite",
                         s->field.kind == BR_AXIAL ? "axial" : "bending");
    if (!status) {
        struct whole regular, odd;
        fill_weights(s, &lq, gain, s->length, p + longest + 1, s->weight, &regular);
        memcpy(regular.p, p[s->length], sizeof regular.p);
        if (s->odd) {
            fill_weights(s, &lq, gain, s->odd, p + longest + 1, s->odd_weight, &odd);
            memcpy(odd.p, p[s->odd], sizeof odd.p);
        }
        block ph = {{0}};
        for (size_t i = s->pieces; i-- > 0;)
            fill_join(s->d, i == 0 && s->odd ? &odd : &regular, ph, &s->join[i]);
    }
    free(gain);
    free(p);
    return status;
}

/* ---- the joins ---- */

#define INLINE static inline __attribute__((always_inline)) /* d is then a constant */

INLINE void add_times(int d, const double a[MOST][MOST], const double *x, double *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[i][j] * x[j];
}

INLINE void add_transposed_times(int d, const double a[MOST][MOST], const double *x, double *sum)
{
    for (int i = 0; i < d; i++)
        for (int j = 0; j < d; j++)
            sum[i] += a[j][i] * x[j];
}

/* z or q of a piece, its load included: *value = state's + factor * load's */
INLINE void read_end(int d, const struct pieces *s, const double *end, int state, int load,
                     double *value)
{
    for (int c = 0; c < d; c++)
        value[c] = end[(state * d + c) * BR_LANES] + s->factor * end[(load * d + c) * BR_LANES];
}

/* h from the tip to the clamped end; what each piece has at its right end stays in RIGHT. */
INLINE void join_left(int d, const struct pieces *s, bool influence, double *h)
{
    const int right = influence ? FORCE_RIGHT : RIGHT;
    const struct join *join = s->join + s->pieces;
    for (size_t i = s->groups; i-- > 0;)
        for (size_t lane = s->group[i].lanes; lane-- > 0;) {
            double *end = s->group[i].end + lane;
            double next[MOST] = {0}, z[MOST] = {0};
            join--;
            if (!influence) {
                read_end(d, s, end, Z, LOAD_Z, z);
                read_end(d, s, end, Q, LOAD_Q, next);
            }
            add_times(d, join->transfer, z, next);
            add_transposed_times(d, join->pass, h, next);
            for (int c = 0; c < d; c++) {
                end[(right * d + c) * BR_LANES] = h[c];
                h[c] = next[c];
            }
        }
}

/* The increments from the clamped end to the tip, and the costates. */
INLINE void join_right(int d, const struct pieces *s, bool influence, double *y)
{
    const int right = influence ? FORCE_RIGHT : RIGHT, left = influence ? FORCE_LEFT : LEFT;
    const struct join *join = s->join;
    for (size_t i = 0; i < s->groups; i++)
        for (size_t lane = 0; lane < s->group[i].lanes; lane++, join++) {
            double *end = s->group[i].end + lane;
            double next[MOST] = {0}, z[MOST] = {0}, h[MOST];
            if (!influence)
                read_end(d, s, end, Z, LOAD_Z, z);
            for (int c = 0; c < d; c++) {
                h[c] = -end[(right * d + c) * BR_LANES];
                end[(left * d + c) * BR_LANES] = y[c];
            }
            add_times(d, join->gain, z, next);
            add_times(d, join->yield, h, next);
            add_times(d, join->pass, y, next);
            double costate[MOST] = {0};
            add_times(d, join->costate, next, costate);
            for (int c = 0; c < d; c++) {
                y[c] = next[c];
                end[(right * d + c) * BR_LANES] = costate[c] - h[c];
            }
        }
}

/* Solves for the ends of all pieces, given z and q (influence: zeros) and the tip's costate; the
 * tip's increment goes into tip. */
static void solve_joins(const struct pieces *s, bool influence, const double *tip_costate,
                        double *tip)
{
    double h[MOST], y[MOST] = {0};
    memcpy(h, tip_costate, sizeof h);
    if (s->d == 1) {
        join_left(1, s, influence, h);
        join_right(1, s, influence, y);
    } else {
        join_left(2, s, influence, h);
        join_right(2, s, influence, y);
    }
    memcpy(tip, y, sizeof y);
}

/* ---- the load ---- */

/* sigma and what it adds to q and z, of one piece; node: the load at the left node of element e,
 * counted from the right, is node[-(e + 1) * d] ... of its right end. Strides in doubles. */
static void load_piece(const struct pieces *s, size_t length, const double *right_node,
                       double *sigma, size_t stride, double *q, double *z)
{
    const int d = s->d;
    const double g[2][2] = {{d == 1 ? 1 : 0.5, -1.0 / 6}, {1, 0}};
    double p[MOST] = {0}, y[MOST] = {0};
    for (size_t e = 0; e < length; e++) {
        const double *gain = s->gain + e * (size_t)(4 * d * d);
        const double *node = right_node - (e + 1) * (size_t)d;
        double next[MOST];
        for (int i = 0; i < d; i++) {
            double sum = 0;
            for (int j = 0; j < d; j++)
                sum += g[j][i] * p[j];
            sigma[(e * (size_t)d + (size_t)i) * stride] = sum;
            next[i] = -node[i];
            for (int j = 0; j < d; j++)
                next[i] += gain[i * d + j] * p[j];
        }
        memcpy(p, next, sizeof p);
    }
    memcpy(q, p, (size_t)d * sizeof *q);
    for (size_t e = length; e-- > 0;) {
        const double *gain = s->gain + e * (size_t)(4 * d * d) + 2 * d * d;
        double kappa[MOST] = {0};
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                kappa[i] += gain[i * d + j] * sigma[(e * (size_t)d + (size_t)j) * stride] +
                            gain[d * d + i * d + j] * y[j];
        y[0] += d == 1 ? kappa[0] : y[1] + (g[0][0] * kappa[0] + g[0][1] * kappa[1]);
        if (d == 2)
            y[1] += kappa[0];
    }
    memcpy(z, y, (size_t)d * sizeof *z);
}

/* Whether all nodes but the clamped and the last one have one load. */
static bool is_uniform(const struct pieces *s, const double *vector)
{
    const size_t d = (size_t)s->d;
    for (size_t i = 2; i < s->field.n; i++)
        if (memcmp(vector + i * d, vector + d, d * sizeof *vector) != 0)
            return false;
    return true;
}

static size_t right_node_of(const struct pieces *s, size_t piece)
{
    return s->odd ? s->odd + piece * s->length : (piece + 1) * s->length;
}

static void set_load(struct pieces *s, const double *vector)
{
    const size_t d = (size_t)s->d;
    s->loaded = vector != NULL;
    s->lanewise = vector && !is_uniform(s, vector);
    memset(s->tip_load, 0, sizeof s->tip_load);
    if (vector)
        memcpy(s->tip_load, vector + s->field.n * d, d * sizeof *vector);
    for (size_t i = 0; i < s->groups; i++)
        for (size_t lane = 0; lane < s->group[i].lanes; lane++) {
            const struct group *g = &s->group[i];
            double q[MOST] = {0}, z[MOST] = {0};
            if (vector)
                load_piece(s, g->length, vector + right_node_of(s, g->first + lane) * d,
                           s->lanewise
                               ? g->load + lane
                               : s->shared_load, /* that of a shorter piece is its beginning */
                           s->lanewise ? BR_LANES : 1, q, z);
            for (int c = 0; c < s->d; c++) {
                *end_of(s, g->first + lane, LOAD_Q, c) = q[c];
                *end_of(s, g->first + lane, LOAD_Z, c) = z[c];
            }
        }
}

/* ---- the solver ---- */

static void pieces_free(void *self)
{
    struct pieces *s = self;
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
static void choose_pieces(struct pieces *s)
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
static size_t lay_out(struct pieces *s, double *arena)
{
    const size_t d = (size_t)s->d;
    size_t used = 0;
    s->gain = take(arena, &used, s->longest * 4 * d * d);
    s->weight = take(arena, &used, s->length * 2 * d * d);
    s->odd_weight = take(arena, &used, s->odd * 2 * d * d);
    s->shared_load = take(arena, &used, s->longest * d);
    s->scratch = take(arena, &used, s->longest * d * BR_LANES);
    for (size_t i = 0; i < s->groups; i++) {
        struct group *g = &s->group[i];
        g->table = (struct br_sweep_table){s->gain, s->odd && i == 0 ? s->odd_weight : s->weight};
        g->end = take(arena, &used, ENDS * d * BR_LANES);
        g->state = take(arena, &used, g->length * 2 * d * BR_LANES);
        g->load = take(arena, &used, g->length * d * BR_LANES);
    }
    return used;
}

static enum br_status allocate(struct pieces *s, struct br_error *err)
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
    (void)options;
    struct pieces *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "a solver");
    s->field = *field;
    s->kernel = br_kernel_best();
    s->d = field->kind == BR_AXIAL ? 1 : 2;
    s->k = field->k;
    choose_pieces(s);
    enum br_status status = allocate(s, err);
    if (!status)
        status = fill_tables(s, err);
    if (status)
        return status;
    const double unit[MOST] = {1, 0};
    solve_joins(s, true, unit, s->force_increment);
    s->compliance = -s->force_increment[0];
    return BR_OK;
}

static double pieces_compliance(const void *self)
{
    return ((const struct pieces *)self)->compliance;
}

static struct br_sweep sweep_of(const struct pieces *s, const struct group *g)
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
        .right = g->end + RIGHT * entry,
        .left = g->end + LEFT * entry,
        .q = g->end + Q * entry,
        .z = g->end + Z * entry,
        .velocity = g->end + VELOCITY * entry,
        .displacement = g->end + DISPLACEMENT * entry,
    };
}

/* The tip's value, by carrying what has been found across each piece over all of them: T^length y +
 * it. */
static double carry_to_tip(const struct pieces *s, int which)
{
    double y[MOST] = {0};
    for (size_t i = 0; i < s->groups; i++) {
        const struct group *g = &s->group[i];
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
    struct pieces *s = self;
    const size_t d = (size_t)s->d;
    for (size_t i = 0; i < s->groups; i++)
        for (size_t lane = 0; lane < s->group[i].lanes; lane++) {
            const struct group *g = &s->group[i];
            double q[MOST] = {0}, z[MOST] = {0};
            for (size_t e = 0; e < g->length; e++) {
                const size_t node = right_node_of(s, g->first + lane) - e - 1;
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
                *end_of(s, g->first + lane, Q, c) = q[c];
                *end_of(s, g->first + lane, Z, c) = z[c];
            }
        }
    s->tip_velocity = velocity[s->field.n * d];
    for (size_t i = 0; i < s->groups; i++) {
        const struct br_sweep sweep = sweep_of(s, &s->group[i]);
        s->kernel->carry(&sweep, sweep.displacement);
    }
}

/* kappa_w and kappa_v of an element, from the clamped end. */
static void element_of(const struct pieces *s, size_t element, double *w, double *v)
{
    const size_t piece = s->odd && element < s->odd ? 0
                         : s->odd                   ? 1 + (element - s->odd) / s->length
                                                    : element / s->length;
    const size_t odd = s->odd > 0;
    const struct group *g = &s->group[odd && piece == 0 ? 0 : odd + (piece - odd) / BR_LANES];
    const size_t e = right_node_of(s, piece) - 1 - element;
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
    const struct pieces *s = self;
    const size_t d = (size_t)s->d, bytes = d * sizeof(double);
    double w[MOST] = {0}, v[MOST] = {0};
    for (size_t i = 0; i <= s->field.n; i++) {
        double kw[MOST], kv[MOST];
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
    const struct pieces *s = self;
    for (size_t i = 0; i < s->field.n; i++) {
        double w[MOST];
        element_of(s, i, w, rate + i * (size_t)s->d);
    }
}

static enum br_status pieces_predict(void *self, const struct br_drive *drive, double *velocity,
                                     struct br_error *err)
{
    (void)err;
    struct pieces *s = self;
    if (drive->changed)
        set_load(s, drive->vector);
    s->factor = drive->factor;
    double costate[MOST] = {0};
    for (int c = 0; c < s->d; c++)
        costate[c] = -(s->factor * s->tip_load[c] + drive->tip[c]);
    solve_joins(s, false, costate, s->tip_increment);
    *velocity = s->tip_velocity + s->tip_increment[0];
    return BR_OK;
}

static double pieces_finish(void *self, double force)
{
    struct pieces *s = self;
    const size_t entry = (size_t)s->d * BR_LANES;
    for (size_t i = 0; i < s->groups; i++) {
        double *end = s->group[i].end;
        for (size_t j = 0; j < entry; j++) {
            end[RIGHT * entry + j] += force * end[FORCE_RIGHT * entry + j];
            end[LEFT * entry + j] += force * end[FORCE_LEFT * entry + j];
        }
        const struct br_sweep sweep = sweep_of(s, &s->group[i]);
        s->kernel->step(&sweep);
    }
    s->tip_velocity = carry_to_tip(s, VELOCITY);
    return s->tip_velocity;
}

static double pieces_tip_displacement(const void *self)
{
    const struct pieces *s = self;
    for (size_t i = 0; i < s->groups && s->d == 2; i++) { /* the laws do not need it every step */
        const struct br_sweep sweep = sweep_of(s, &s->group[i]);
        s->kernel->carry(&sweep, sweep.displacement);
    }
    return carry_to_tip(s, DISPLACEMENT);
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
