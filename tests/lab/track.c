/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/lab/track.h"

#include <math.h>

#include "study/extremes/extremes.h"
#include "tests/exact_points.h"

/* Chooses even points of `count`, where an element has `parts`, and then points nearer and nearer
 * to the tip, which is the last. The even points lie in all parts of elements: nodes alone may be
 * far better, or worse, than the points between them. */
static size_t choose_points(size_t count, size_t parts, size_t point[BR_TRACK_POINTS])
{
    const size_t even = count < BR_TRACK_EVEN ? count : BR_TRACK_EVEN;
    const size_t within = count / even < parts ? 0 : parts; /* an element, where it is shorter */
    size_t points = 0;
    for (size_t i = 0; i + 1 < even; i++)
        point[points++] = (i + 1) * count / even - i * within / even;
    for (size_t from_tip = count / (2 * BR_TRACK_EVEN);
         from_tip > 0 && points + 1 < BR_TRACK_POINTS; from_tip /= 2)
        point[points++] = count - from_tip;
    point[points++] = count;
    return points;
}

struct br_track_samples br_track_samples(size_t n, size_t steps)
{
    struct br_track_samples p = {.n = n, .steps = steps, .parts = 1};
    const size_t parts = steps < BR_TRACK_LEVELS ? steps : BR_TRACK_LEVELS;
    while (n * p.parts < 256 * BR_TRACK_EVEN) /* room for those near the tip */
        p.parts *= 2;
    p.levels = parts + 1;
    p.points = choose_points(n * p.parts, p.parts, p.point);
    for (size_t i = 0; i < p.levels; i++)
        p.level[i] = i * steps / parts;
    return p;
}

/* ---- marches ---- */

struct recorder {
    const struct br_track_request *request;
    struct br_track *track;
    double *nodal; /* displacements, then velocities */
};

/* The displacement at xi, 0 to 1, in the element whose nodal unknowns (solver/field.h) begin at
 * `at`; slope (out): of a beam h w_x. */
static double nodal_value(enum br_field_kind kind, size_t unknowns, const double *at, double xi,
                          double *slope)
{
    const double *end = at + unknowns, r = 1 - xi;
    *slope = 0;
    if (kind == BR_AXIAL)
        return at[0] * r + end[0] * xi - (unknowns == 2 ? end[1] * xi * r : 0);
    *slope = 6 * xi * r * (end[0] - at[0]) + r * (1 - 3 * xi) * at[1] - xi * (2 - 3 * xi) * end[1];
    return (1 + 2 * xi) * r * r * at[0] + xi * r * r * at[1] + xi * xi * (3 - 2 * xi) * end[0] -
           xi * xi * r * end[1];
}

/* slope: L w_x/4, m. */
static void keep_slope(struct br_track *t, size_t point, double slope)
{
    t->value[BR_TRACK_SLOPE][t->sampled][point] = slope;
    t->largest[BR_BENDING] = fmax(t->largest[BR_BENDING], fabs(slope));
}

static void record_field(struct recorder *l, const struct br_march *march, enum br_field_kind kind)
{
    struct br_track *t = l->track;
    const struct br_field *f = br_march_field(march, kind);
    const size_t unknowns = br_field_unknowns(f), size = br_field_size(f);
    br_march_get(march, kind, l->nodal, l->nodal + size);
    for (size_t i = 0; i < 2 * size; i++)
        t->finite = t->finite && isfinite(l->nodal[i]);
    for (size_t i = 0; i < size; i += unknowns)
        t->largest[kind] = fmax(t->largest[kind], fabs(l->nodal[i]));
    for (size_t p = 0; p < t->samples.points; p++) {
        const size_t part = l->request->finer * t->samples.point[p], parts = t->samples.parts;
        const size_t element = (part - 1) / parts; /* that contains the point or ends at it */
        const double xi = (double)(part - element * parts) / (double)parts;
        double slope;
        t->value[kind][t->sampled][p] =
            nodal_value(kind, unknowns, l->nodal + element * unknowns, xi, &slope);
        if (kind == BR_BENDING)
            keep_slope(t, p, slope * (double)f->n / 4);
    }
}

static enum br_status record(void *self, const struct br_march *march,
                             const struct br_history_row *row, struct br_error *why)
{
    struct recorder *l = self;
    (void)row;
    if (!l->nodal)
        l->nodal =
            br_allocate(4 * (l->request->samples->n * l->request->finer + 1), sizeof *l->nodal);
    if (!l->nodal)
        return br_no_memory(why, "a march's values");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        if (br_march_models(march, kind))
            record_field(l, march, kind);
    l->track->sampled++;
    return BR_OK;
}

static enum br_status record_step(void *self, const struct br_march *march,
                                  const struct br_history_row *row, struct br_error *why)
{
    struct br_track *t = ((struct recorder *)self)->track;
    (void)why;
    (void)row;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        t->largest[kind] = fmax(t->largest[kind], fabs(br_march_tip_displacement(march, kind)));
    return BR_OK;
}

enum br_status br_track_march(const struct br_track_request *q, struct br_track *t,
                              struct br_error *why)
{
    *t = (struct br_track){.samples = *q->samples, .finite = true};
    struct recorder recorder = {.request = q, .track = t};
    const struct br_history_observer observer = {
        .self = &recorder, .step = record_step, .sample = record};
    size_t level[BR_TRACK_LEVELS + 1];
    for (size_t i = 0; i < t->samples.levels; i++)
        level[i] = t->samples.level[i] * q->shorter;
    const struct br_run_request request = {
        .scene = q->scene,
        .wanted = q->wanted,
        .method = *q->method,
        .n = t->samples.n * q->finer,
        .steps = t->samples.steps * q->shorter,
        .level = level,
        .levels = t->samples.levels,
        .check = q->check,
        .output = &observer,
        .outputs = 1,
    };
    const enum br_status status = br_run(&request, &t->report, &t->failure);
    free(recorder.nodal);
    if (status == BR_NO_MEMORY)
        return br_fail(why, status, "%s", t->failure.message);
    t->begun = !status;
    if (!status)
        t->failure = t->report.failure;
    return BR_OK;
}

/* ---- the exact solution ---- */

struct step_limit {
    size_t left;
};

static bool stop(void *self)
{
    struct step_limit *p = self;
    return p->left-- == 0;
}

/* Values of one field, or its slope, at the points (out). */
static enum br_status evaluate(const struct br_exact *exact, struct br_track *t,
                               const struct br_exact_quantity *part, double length,
                               const struct br_exact_state *state, double value[BR_TRACK_POINTS])
{
    double x[BR_TRACK_POINTS];
    for (size_t p = 0; p < t->samples.points; p++)
        x[p] = length * (double)t->samples.point[p] / (double)(t->samples.n * t->samples.parts);
    return exact_points(exact, state, part, t->samples.points, x, value, &t->failure);
}

static enum br_status read_exact(const struct br_exact *exact, struct br_track *t,
                                 enum br_field_kind kind, double length,
                                 const struct br_exact_state *state)
{
    struct br_exact_quantity part = {kind, false, 0};
    double *value = t->value[kind][t->sampled], slope[BR_TRACK_POINTS];
    enum br_status status = evaluate(exact, t, &part, length, state, value);
    for (size_t p = 0; p < t->samples.points && !status; p++)
        t->largest[kind] = fmax(t->largest[kind], fabs(value[p]));
    const struct br_exact_report report = br_exact_report(exact, part.field);
    t->largest[kind] = fmax(t->largest[kind], report.largest.displacement);
    t->own_error[kind] = report.error.displacement;
    part.order = 1;
    if (!status && kind == BR_BENDING)
        status = evaluate(exact, t, &part, length, state, slope);
    for (size_t p = 0; p < t->samples.points && !status && kind == BR_BENDING; p++)
        keep_slope(t, p, slope[p] * length / 4);
    return status;
}

static void record_exact(const struct br_exact *exact, const struct br_scene *scene,
                         struct br_track *t)
{
    struct br_exact_state *state = NULL;
    enum br_status status = br_exact_state_create(&state, exact, &t->failure);
    for (; t->sampled < t->samples.levels && !status; t->sampled++) {
        br_exact_at(exact,
                    scene->duration * (double)t->samples.level[t->sampled] /
                        (double)t->samples.steps,
                    state);
        for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING && !status; kind++)
            if (scene->field[kind].modelled)
                status = read_exact(exact, t, kind, scene->length, state);
    }
    br_exact_state_free(state);
}

enum br_status br_track_exact(const struct br_scene *scene, const struct br_track_samples *samples,
                              size_t steps, struct br_track *t, struct br_error *why)
{
    *t = (struct br_track){.samples = *samples, .finite = true};
    struct step_limit limit = {steps};
    const struct br_exact_options options = {.tolerance = 1e-6,
                                             .acceptable = 1e-3,
                                             .max_modes = 96,
                                             .max_steps = steps,
                                             .stop = stop,
                                             .stop_self = &limit};
    struct br_exact *exact = NULL;
    const enum br_status status = br_exact_create(&exact, scene, &options, &t->failure);
    t->begun = !status;
    if (!status)
        record_exact(exact, scene, t);
    br_exact_free(exact);
    return t->failure.status == BR_NO_MEMORY ? br_no_memory(why, "the exact solution") : BR_OK;
}

/* ---- distances ---- */

/* The largest difference in a value, or largest value (b: NULL); NAN where one is not finite. */
static double difference(const struct br_track *a, const struct br_track *b, int value)
{
    double most = 0;
    for (size_t i = 0; i < a->samples.levels; i++)
        for (size_t p = 0; p < a->samples.points; p++) {
            const double d = a->value[value][i][p] - (b ? b->value[value][i][p] : 0);
            most = br_worst(most, isfinite(d) ? fabs(d) : NAN);
        }
    return most;
}

/* The same of a field: of a beam also of the bulge. */
static double largest(const struct br_track *a, const struct br_track *b, enum br_field_kind kind)
{
    const double most = difference(a, b, (int)kind);
    return kind == BR_AXIAL ? most : br_worst(most, difference(a, b, BR_TRACK_SLOPE));
}

double br_track_distance(const struct br_track *track, const struct br_track *reference,
                         enum br_field_kind kind)
{
    const double *size = reference->largest;
    if (track->sampled < track->samples.levels || reference->sampled < track->samples.levels)
        return NAN;
    const double most = largest(track, reference, kind);
    return most == 0 ? 0 : most / (size[kind] > 0 ? size[kind] : size[1 - kind]);
}

/* ---- errors ---- */

/* The mean square of a field, or of its difference from another one, at a level: by the trapezoidal
 * rule from the clamped end, where it is 0. The last interval, at the tip, counts with its first
 * value where that is lower: a layer there may be far narrower than the interval. */
static double square(const struct br_track *a, const struct br_track *b, int value, size_t level)
{
    const struct br_track_samples *at = &a->samples;
    double sum = 0, left = 0;
    size_t from = 0;
    for (size_t p = 0; p < at->points; p++) {
        const double d = a->value[value][level][p] - (b ? b->value[value][level][p] : 0);
        const bool tip = p > 0 && p + 1 == at->points && d * d > left;
        sum += (left + (tip ? left : d * d)) * (double)(at->point[p] - from) / 2;
        left = d * d;
        from = at->point[p];
    }
    return sum / (double)(at->n * at->parts);
}

static double largest_mean(const struct br_track *a, const struct br_track *b,
                           enum br_field_kind kind)
{
    double most = 0;
    for (size_t i = 0; i < a->samples.levels; i++)
        most = br_worst(most, square(a, b, (int)kind, i));
    return sqrt(most);
}

/* The mean at all times: scaled by the largest value of all times over the largest sampled one. */
static double mean_size(const struct br_track *t, enum br_field_kind kind)
{
    const double mean = largest_mean(t, NULL, kind), sampled = largest(t, NULL, kind);
    return sampled > 0 ? mean * fmax(1, t->largest[kind] / sampled) : 0;
}

double br_track_error(const struct br_track *track, const struct br_track *reference,
                      enum br_field_kind kind, double *sure_to)
{
    *sure_to = 0;
    if (track->sampled < track->samples.levels || reference->sampled < track->samples.levels)
        return NAN;
    const double own = mean_size(reference, kind);
    const double size = own > 0 ? own : mean_size(reference, (enum br_field_kind)(1 - kind));
    const double error = largest_mean(track, reference, kind);
    if (!(size > 0)) /* the squares are lost to underflow */
        return br_track_distance(track, reference, kind);
    *sure_to = reference->own_error[kind] == 0 ? 0 : reference->own_error[kind] / size;
    return error == 0 ? 0 : error / size;
}
