/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fast flexibility form: the layout of arrays, conversion from and to nodal values, and a step;
 * see panels.h. */
#include <fenv.h>
#include <math.h>
#include <string.h>

#include "solver/instruction_set.h"
#include "solver/linear/riccati/panels.h"

/* ---- where everything lies ---- */

static double *take(struct br_panels *s, size_t doubles)
{
    return br_store_take(&s->states.store, doubles, sizeof(double));
}

/* Elements of a segment. */
static size_t segment_length(const struct br_segment_group *t)
{
    return t->segments.panels * t->segments.length;
}

/* Numbers of a group's state in all lanes. */
static size_t group_size(const struct br_panels *s, const struct br_segment_group *t)
{
    return segment_length(t) * 2 * (size_t)s->d * BR_LANES;
}

static size_t all_groups(const struct br_panels *s)
{
    size_t size = 0;
    for (int i = 0; i < s->groups; i++)
        size += group_size(s, &s->group[i]);
    return size;
}

/* The numbers of a state after those of the groups. The bias is the mean difference between the
 * tip's increment in the field and that of the joins, m/s. */
enum { TIP_VELOCITY, TIP_DISPLACEMENT, TIP_BIAS, TIP_NUMBERS };

/* Points the groups and the tip at state 0. */
static void point_at_first(struct br_panels *s)
{
    double *at = s->states.of[0];
    for (int i = 0; i < s->groups; i++) {
        s->group[i].segments.state = at;
        at += group_size(s, &s->group[i]);
    }
    s->tip = at;
}

/* Takes the arrays of a group. */
static void lay_out(struct br_panels *s, struct br_segment_group *t)
{
    const size_t d = (size_t)s->d, entry = d * BR_LANES;
    struct br_segments *segments = &t->segments;
    double **const ends[] = {
        &t->q,          &t->z,         &t->force_right,   &t->force_left,
        &t->ends.right, &t->ends.left, &t->ends.velocity, &t->ends.displacement};
    segments->end = take(s, segments->panels * BR_ENDS * entry);
    segments->join = take(s, segments->panels * BR_JOINS * d * d);
    segments->segment_join = take(s, BR_SEGMENT_JOINS * d * entry);
    segments->weight = take(s, segments->length * 2 * d * d);
    for (size_t e = 0; e < sizeof ends / sizeof *ends; e++)
        *ends[e] = take(s, entry);
}

/* Cuts the beam and takes all arrays. */
static enum br_status lay_out_all(struct br_panels *s, struct br_error *err)
{
    const struct br_cut cut = br_choose_cut(s->field.n);
    const size_t d = (size_t)s->d, longest = cut.odd > cut.length ? cut.odd : cut.length;
    if (cut.odd)
        s->group[s->groups++] =
            (struct br_segment_group){.segments = {.lanes = 1, .panels = 1, .length = cut.odd}};
    if (cut.panels)
        s->group[s->groups++] = (struct br_segment_group){
            .first = cut.odd,
            .segments = {.lanes = BR_LANES, .panels = cut.panels, .length = cut.length}};
    double *gain = take(s, longest * 3 * d * d), *scratch = take(s, longest * d * BR_LANES);
    for (int i = 0; i < s->groups; i++)
        lay_out(s, &s->group[i]);
    const enum br_status status = br_states_add(&s->states, all_groups(s) + TIP_NUMBERS, 1, err);
    if (status)
        return status;
    for (int i = 0; i < s->groups; i++) { /* gains are indexed by the distance to the right end */
        struct br_segments *segments = &s->group[i].segments;
        segments->gain = gain + (longest - segments->length) * 3 * d * d;
        segments->scratch = scratch;
    }
    point_at_first(s);
    return BR_OK;
}

/* kappa_w of an element; its kappa_v follows. */
static double *state_at(const struct br_panels *s, const struct br_segment_group *t, size_t lane,
                        size_t e)
{
    return t->segments.state + e * 2 * (size_t)s->d * BR_LANES + lane;
}

/* ---- to nodal values ---- */

/* The values at each segment's left end, from the differences across the segments; y: at the left
 * end of the first segment (in), and at the right end of the last one (out). */
static void find_left_ends(const struct br_panels *s, const struct br_segment_group *t,
                           const double *across, double *y, double *left)
{
    for (size_t lane = 0; lane < t->segments.lanes; lane++) {
        for (int c = 0; c < s->d; c++)
            left[c * BR_LANES + (int)lane] = y[c];
        y[0] += across[lane];
        if (s->d == 1)
            continue;
        y[0] += (double)segment_length(t) * y[1];
        y[1] += across[BR_LANES + lane];
    }
}

static void get_nodes(const struct br_panels *s, bool rate, double *nodal)
{
    _Alignas(64) double across[2 * BR_LANES], left[2 * BR_LANES] = {0};
    const size_t d = (size_t)s->d;
    double y[2] = {0};
    memcpy(nodal, y, d * sizeof *y);
    for (int i = 0; i < s->groups; i++) {
        const struct br_segment_group *t = &s->group[i];
        if (!rate || !s->advanced)
            s->loops->carry(&t->segments, rate, across);
        find_left_ends(s, t, rate && s->advanced ? t->ends.velocity : across, y, left);
        s->loops->expand(&t->segments, rate, left, nodal + (t->first + 1) * d);
    }
}

static void panels_get(const void *self, double *displacement, double *velocity)
{
    if (displacement)
        get_nodes(self, false, displacement);
    if (velocity)
        get_nodes(self, true, velocity);
}

static void panels_strain_rate(const void *self, double *rate)
{
    const struct br_panels *s = self;
    for (int i = 0; i < s->groups; i++) {
        const struct br_segment_group *t = &s->group[i];
        for (size_t lane = 0; lane < t->segments.lanes; lane++)
            for (size_t e = 0; e < segment_length(t); e++, rate += s->d) {
                const double *kappa = state_at(s, t, lane, e) + s->d * BR_LANES;
                rate[0] = kappa[0];
                if (s->d == 2)
                    rate[1] = (double)BR_PANELS_ROOT3 * kappa[BR_LANES];
            }
    }
}

/* Sums the tip's displacement over the elements, m. */
static double find_tip_displacement(const struct br_panels *s)
{
    _Alignas(64) double across[2 * BR_LANES];
    double y[2] = {0}, left[2 * BR_LANES];
    for (int i = 0; i < s->groups; i++) {
        s->loops->carry(&s->group[i].segments, false, across);
        find_left_ends(s, &s->group[i], across, y, left);
    }
    return y[0];
}

/* ---- from nodal values ---- */

/* Writes an element's strain, in the units of tables.c, from its nodes into its lane. */
static void put_strain(int d, const double *node, double *to)
{
    double strain[2] = {node[1] - node[0]};
    if (d == 2) {
        br_curvature(node, strain);
        strain[1] /= (double)BR_PANELS_ROOT3;
    }
    for (int c = 0; c < d; c++)
        to[c * BR_LANES] = strain[c];
}

static void panels_set(void *self, const double *displacement, const double *velocity)
{
    struct br_panels *s = self;
    for (int i = 0; i < s->groups; i++) {
        const struct br_segment_group *t = &s->group[i];
        for (size_t lane = 0; lane < t->segments.lanes; lane++)
            for (size_t e = 0; e < segment_length(t); e++) {
                const size_t node = (t->first + lane * segment_length(t) + e) * (size_t)s->d;
                double *to = state_at(s, t, lane, e);
                put_strain(s->d, displacement + node, to);
                put_strain(s->d, velocity + node, to + s->d * BR_LANES);
            }
        s->loops->blend(&t->segments, 0, NULL, NULL);
    }
    s->tip[TIP_BIAS] = 0;
    s->stale_ends = s->advanced = false;
    s->tip[TIP_DISPLACEMENT] = find_tip_displacement(s);
    s->tip[TIP_VELOCITY] = velocity[s->field.n * (size_t)s->d];
}

/* ---- loads: what they add to the recursions of the panels ---- */

/* Whether all nodes have the same load, except the clamped and the last one. */
static bool is_uniform(const struct br_panels *s, const double *vector)
{
    const size_t d = (size_t)s->d;
    for (size_t i = 2; i < s->field.n; i++)
        if (memcmp(vector + i * d, vector + d, d * sizeof *vector) != 0)
            return false;
    return true;
}

/* The load at the left node of each element, over R. */
BR_SWEEP
static void spread(const struct br_panels *s, struct br_segment_group *t, const double *vector)
{
    const size_t entries = (size_t)s->d * segment_length(t);
    const double *from = vector + t->first * (size_t)s->d, r = s->r;
    double *restrict to = t->segments.load;
    for (size_t lane = 0; lane < t->segments.lanes; lane++, from += entries)
        for (size_t i = 0; i < entries; i++)
            to[i * BR_LANES + lane] = from[i] / r;
}

/* Sets another load vector, N; NULL: none. */
static enum br_status set_load(struct br_panels *s, const double *vector, struct br_error *err)
{
    const size_t d = (size_t)s->d;
    const bool even = !vector || is_uniform(s, vector);
    if (!even && !s->loads) {
        s->loads = take(s, all_groups(s) / 2);
        if (!s->loads)
            return br_no_memory(err, "the load of a solver");
    }
    for (size_t c = 0; c < d; c++) {
        s->drive.uniform[c] = vector && even && s->field.n > 1 ? vector[d + c] / s->r : 0;
        s->tip_load[c] = vector ? vector[s->field.n * d + c] / s->r : 0;
    }
    double *next = s->loads;
    for (int i = 0; i < s->groups; i++) {
        struct br_segment_group *t = &s->group[i];
        t->segments.load = even ? NULL : next;
        if (!even) {
            spread(s, t, vector);
            next += segment_length(t) * d * BR_LANES;
        }
        s->loops->charge(&t->segments, s->drive.uniform);
    }
    return BR_OK;
}

/* ---- a step ---- */

/* Round-off of the tip's increment is small beside the velocity that it leads to. */
static const double most_bias = 1e-8;

/* Computes the increments and costates at the ends of all segments, for the tip's costate h, and
 * the tip's increment y (out). */
static void join(struct br_panels *s, double *h, double *y)
{
    for (int i = s->groups; i-- > 0;) {
        struct br_segment_group *t = &s->group[i];
        s->loops->join_left(&t->segments, t->q, t->z, h, t->ends.right);
    }
    y[0] = y[1] = 0;
    for (int i = 0; i < s->groups; i++) {
        struct br_segment_group *t = &s->group[i];
        s->loops->join_right(&t->segments, t->z, y, t->ends.left, t->ends.right);
    }
}

/* Computes the tables for the field's step, and the response to a unit force at the tip. */
static enum br_status prepare(struct br_panels *s, struct br_error *err)
{
    const enum br_status status = br_panels_tables(s, err);
    if (status)
        return status;
    double unit[2] = {1 / s->r, 0};
    const size_t bytes = (size_t)s->d * BR_LANES * sizeof(double);
    for (int i = 0; i < s->groups; i++) {
        memset(s->group[i].q, 0, bytes);
        memset(s->group[i].z, 0, bytes);
    }
    join(s, unit, s->force_increment);
    s->compliance = -s->force_increment[0];
    for (int i = 0; i < s->groups; i++) {
        memcpy(s->group[i].force_right, s->group[i].ends.right, bytes);
        memcpy(s->group[i].force_left, s->group[i].ends.left, bytes);
    }
    return BR_OK;
}

static enum br_status panels_create(const struct br_field *field, const struct br_kernel *kernel,
                                    void **self, struct br_error *err)
{
    struct br_panels *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "a solver");
    s->field = *field;
    kernel = kernel ? kernel : br_kernel_best();
    if (!kernel->available())
        return br_fail(err, BR_BAD_INPUT, "kernel %s is not available on this machine",
                       kernel->name);
    s->loops = kernel->loops[field->kind];
    s->d = field->kind == BR_AXIAL ? 1 : 2;
    const enum br_status status = lay_out_all(s, err);
    return status ? status : prepare(s, err);
}

static double panels_compliance(const void *self)
{
    return ((const struct br_panels *)self)->compliance;
}

static enum br_status panels_predict(void *self, const struct br_drive *drive, double *velocity,
                                     struct br_error *err)
{
    struct br_panels *s = self;
    const enum br_status status =
        drive->changed || s->stale_load ? set_load(s, drive->vector, err) : BR_OK;
    if (status)
        return status;
    s->stale_load = false;
    for (int i = 0; i < s->groups && s->stale_ends; i++)
        s->loops->blend(&s->group[i].segments, 0, NULL, NULL);
    s->stale_ends = false;
    s->drive.factor = drive->factor;
    for (int i = 0; i < s->groups; i++)
        s->loops->gather(&s->group[i].segments, drive->factor, s->group[i].q, s->group[i].z);
    double costate[2] = {0};
    for (int c = 0; c < s->d; c++)
        costate[c] = -(drive->factor * s->tip_load[c] + drive->tip[c] / s->r);
    join(s, costate, s->tip_increment);
    *velocity = s->tip[TIP_VELOCITY] + s->tip_increment[0];
    if (!(fabs(s->tip[TIP_BIAS]) <= most_bias * fabs(*velocity)))
        s->tip[TIP_BIAS] = 0; /* it belongs to a motion that has died away */
    s->tip_increment[0] += s->tip[TIP_BIAS];
    *velocity += s->tip[TIP_BIAS];
    return BR_OK;
}

/* Computes the tip's values from the field: values that are only incremented would drift. The
 * round-off of the joins' increment hardly changes from step to step, and a tip that sticks would
 * creep by it; so the next increment is corrected by the difference to `expected`. */
static void compute_tip(struct br_panels *s, double expected)
{
    double velocity[2] = {0}, displacement[2] = {0}, left[2 * BR_LANES];
    for (int i = 0; i < s->groups; i++) {
        find_left_ends(s, &s->group[i], s->group[i].ends.velocity, velocity, left);
        if (s->d == 1)
            find_left_ends(s, &s->group[i], s->group[i].ends.displacement, displacement, left);
    }
    s->tip[TIP_VELOCITY] = velocity[0];
    s->tip[TIP_BIAS] += s->tip[TIP_VELOCITY] - expected;
    if (s->d == 1)
        s->tip[TIP_DISPLACEMENT] = displacement[0];
}

static double panels_finish(void *self, double force)
{
    struct br_panels *s = self;
    for (int i = 0; i < s->groups; i++) {
        struct br_segment_group *t = &s->group[i];
        for (size_t j = 0; j < (size_t)s->d * BR_LANES; j++) {
            t->ends.right[j] += force * t->force_right[j];
            t->ends.left[j] += force * t->force_left[j];
        }
        s->loops->advance(&t->segments, &s->drive, &t->ends);
    }
    s->advanced = true;
    compute_tip(s, s->tip[TIP_VELOCITY] + s->tip_increment[0] + force * s->force_increment[0]);
    return s->tip[TIP_VELOCITY];
}

static double panels_tip_displacement(const void *self)
{
    const struct br_panels *s = self;
    return s->d == 1 ? s->tip[TIP_DISPLACEMENT] : find_tip_displacement(s); /* laws need only u */
}

/* ---- other steps and sums of states, for schemes of several stages ---- */

static enum br_status panels_set_step(void *self, double k, struct br_error *err)
{
    struct br_panels *s = self;
    s->field.k = k;
    s->stale_load = s->stale_ends = true;
    return prepare(s, err);
}

static void panels_exchange(void *self, size_t a, size_t b)
{
    struct br_panels *s = self;
    br_exchange_states(self, a, b);
    point_at_first(s);
    s->advanced = false;
    s->stale_ends = true;
}

/* Picks the states whose weights are not 0; returns how many. */
static size_t pick(const struct br_panels *s, size_t count, const double *weight,
                   double *of[BR_MOST_STATES], double by[BR_MOST_STATES])
{
    size_t picked = 0;
    for (size_t j = 0; j < count; j++)
        if (weight[j] != 0) {
            of[picked] = s->states.of[j];
            by[picked++] = weight[j];
        }
    return picked;
}

/* br_add_states for the odd rest, whose other lanes stay 0. */
static void add_one_lane(double *to, size_t size, size_t count, double *const *from,
                         const double *weight)
{
    for (size_t i = 0; i < size; i += BR_LANES) {
        double sum = 0;
        for (size_t j = 0; j < count; j++)
            sum += weight[j] * from[j][i];
        to[i] = sum;
    }
}

static void panels_combine(void *self, size_t into, size_t count, const double *weight)
{
    struct br_panels *s = self;
    double *of[BR_MOST_STATES], by[BR_MOST_STATES], *to = s->states.of[into];
    const size_t picked = pick(s, count, weight, of, by);
    const bool blends = into == 0 && picked > 0;
    for (int i = 0; i < s->groups; i++) {
        const struct br_segments *segments = &s->group[i].segments;
        const size_t size = group_size(s, &s->group[i]);
        if (blends)
            s->loops->blend(segments, picked, (const double *const *)of, by);
        else
            (segments->lanes == 1 ? add_one_lane : br_add_states)(to, size, picked, of, by);
        to += size;
        for (size_t j = 0; j < picked; j++)
            of[j] += size;
    }
    br_add_states(to, TIP_NUMBERS, picked, of, by);
    if (into == 0) {
        s->stale_ends = !blends;
        s->advanced = false;
    }
}

/* Sums squares in long double: in double they would overflow or underflow. */
static void add_squares(const struct br_panels *s, const struct br_segments *segments,
                        size_t numbers, const double *state, long double sum[2])
{
    for (size_t i = 0; i < numbers; i++)
        if (i % BR_LANES < segments->lanes) {
            const size_t rate = i / ((size_t)s->d * BR_LANES) % 2;
            sum[rate] += (long double)state[i] * state[i];
        }
}

/* Sums squares in double, without traps: after an overflow panels_size sums again. */
static void sum_squares(const struct br_panels *s, size_t state, double sum[2])
{
    const double *at = s->states.of[state];
    fenv_t environment;
    feholdexcept(&environment);
    sum[0] = sum[1] = 0;
    for (int i = 0; i < s->groups; i++) {
        s->loops->square(&s->group[i].segments, at, sum);
        at += group_size(s, &s->group[i]);
    }
    fesetenv(&environment);
}

/* The square of u_x over an element is kappa^2 / h, of w_xx in the units of tables.c (kappa_0^2 +
 * kappa_1^2) / h^3. */
static void panels_size(void *self, size_t state, double size[2])
{
    const struct br_panels *s = self;
    const double least = 1e-280, most = 1e280; /* of sums without overflow or underflow */
    double sum[2];
    long double wide[2] = {0};
    sum_squares(s, state, sum);
    const double *at = s->states.of[state];
    const bool in_range =
        isgreater(fmin(sum[0], sum[1]), least) && isless(fmax(sum[0], sum[1]), most);
    for (int i = 0; i < s->groups && !in_range; i++) {
        const size_t numbers = group_size(s, &s->group[i]);
        add_squares(s, &s->group[i].segments, numbers, at, wide);
        at += numbers;
    }
    const long double h = s->field.h, unit = s->d == 1 ? h : h * h * h;
    for (int rate = 0; rate < 2; rate++)
        size[rate] = (double)sqrtl((in_range ? sum[rate] : wide[rate]) / unit);
}

const struct br_field_solver br_panels = {
    .create = panels_create,
    .free = br_free_states,
    .tip_compliance = panels_compliance,
    .set = panels_set,
    .get = panels_get,
    .strain_rate = panels_strain_rate,
    .predict = panels_predict,
    .finish = panels_finish,
    .tip_displacement = panels_tip_displacement,
    .set_step = panels_set_step,
    .keep = br_keep_states,
    .exchange = panels_exchange,
    .combine = panels_combine,
    .size = panels_size,
};
