/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/inside.h"

#include <float.h>
#include <gsl/gsl_interp.h>
#include <math.h>

#include "solver/box.h"

/* Functions that the field depends on. */
enum { MOST = 2 * BR_LOAD_TERMS + 4 };

/* Arrays of two: by br_variable. */
struct data_mesh_work {
    struct br_data_mesh *o;
    const struct br_scene_field *data;
    double all[2], density; /* L, m; T, s; kg/m */
    struct br_function_mesh subject[MOST];
    size_t subjects;
    struct br_breaks breaks[2]; /* where functions jump or bend, m and s */
    enum br_status status;      /* where it is not BR_OK, nothing more is done */
    struct br_error *err;
};

/* ---- the functions that matter ---- */

/* Whether a function changes along a variable. */
static bool has(const struct br_function_mesh *s, enum br_variable v)
{
    return (v == BR_X ? s->box.x : s->box.t).high > 0;
}

/* Whether it does along both, and is no product. */
static bool is_mixed(const struct br_function_mesh *s)
{
    return has(s, BR_X) && has(s, BR_T);
}

/* f is needed up to a time. Without bounds it has no proofs. */
static void list(struct data_mesh_work *w, const struct br_function *f, double until)
{
    if (!f->ops || !f->ops->bound)
        return;
    const struct br_box box = {{0, f->uses_x ? w->all[BR_X] : 0}, {0, f->uses_t ? until : 0}};
    if (box.x.high > 0 || box.t.high > 0)
        w->subject[w->subjects++] =
            (struct br_function_mesh){f, box, br_function_mesh_mean(f, box), 0};
}

static void list_subjects(struct data_mesh_work *w)
{
    const struct br_scene_field *d = w->data;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &d->load.term[i];
        if (br_product_is_zero(p))
            continue;
        list(w, &p->space, w->all[BR_T]);
        list(w, &p->time, w->all[BR_T]);
    }
    list(w, br_initial_slope(d, w->o->degree), 0);
    list(w, &d->velocity, 0);
    list(w, &d->tip_force, w->all[BR_T]);
    list(w, &d->tip_moment, w->all[BR_T]);
}

/* ---- intervals between points where functions jump ---- */

/* At this distance from a point, relative to it, switching functions that vanish there surely have
 * a sign. */
static const double apart = 8 * DBL_EPSILON;

/* Part i of an axis (breaks' count + 1 of them), as far as functions are surely smooth there. */
static struct br_interval part(const struct data_mesh_work *w, enum br_variable v, size_t i)
{
    const struct br_breaks *breaks = &w->breaks[v];
    return (struct br_interval){i ? breaks->at[i - 1].high * (1 + apart) : 0,
                                i < breaks->count ? breaks->at[i].low * (1 - apart) : w->all[v]};
}

/* A gap this narrow, relative to the axis, belongs to the points on both sides, or to the end. */
static const double narrow = 1e-13;

/* Joins points that only round-off separates. count_hidden counts the integrals of functions within
 * the joined interval. */
static void join_breaks(struct data_mesh_work *w, enum br_variable v)
{
    struct br_breaks *breaks = &w->breaks[v];
    const double all = w->all[v];
    size_t kept = 0;
    for (size_t i = 0; i < breaks->count; i++) {
        struct br_interval at = breaks->at[i];
        if (at.low <= narrow * all)
            at.low = 0;
        if (at.high >= (1 - narrow) * all)
            at.high = all;
        if (kept && at.low - breaks->at[kept - 1].high <= narrow * all)
            breaks->at[kept - 1].high = at.high;
        else
            breaks->at[kept++] = at;
    }
    breaks->count = kept;
}

static void add(struct data_mesh_work *w, enum br_variable v, double value)
{
    br_list_add(&w->o->end[v], value, &w->o->store);
}

/* The ends of an axis and of its parts. */
static void add_parts(struct data_mesh_work *w, enum br_variable v)
{
    const double all = w->all[v];
    add(w, v, 0);
    for (size_t i = 0; i < w->breaks[v].count; i++) {
        const struct br_interval at = w->breaks[v].at[i];
        const bool wide = at.high - at.low > narrow * all; /* the point is not known more exactly */
        if (at.high < all && (wide || at.low > 0))
            add(w, v, at.high);
        if (at.low > 0 && (wide || at.high == all))
            add(w, v, at.low);
    }
    add(w, v, all);
}

static void add_breaks(struct data_mesh_work *w, enum br_variable v, const struct br_function *f,
                       struct br_box box)
{
    if (!w->status)
        w->status = br_breaks_add(f, v, box, &w->breaks[v], w->err);
}

/* Finds the points or times at which functions jump or bend, and at which fronts come or go. */
static void find_breaks(struct data_mesh_work *w, enum br_variable v)
{
    for (const struct br_function_mesh *s = w->subject; s < w->subject + w->subjects; s++) {
        if (has(s, v))
            add_breaks(w, v, s->f, s->box);
        if (v == BR_T && is_mixed(s) && !w->status)
            w->status = br_front_times(s->f, s->box, &w->breaks[BR_T], w->err);
    }
    join_breaks(w, v);
}

/* Finds the times at which fronts pass from one element to the next. */
static void find_crossings(struct data_mesh_work *w)
{
    for (const struct br_function_mesh *s = w->subject; s < w->subject + w->subjects; s++)
        for (size_t e = 1; is_mixed(s) && w->o->fronts && e + 1 < w->o->end[BR_X].count; e++) {
            const double x = w->o->end[BR_X].at[e];
            add_breaks(w, BR_T, s->f, (struct br_box){{x, x}, s->box.t});
        }
}

/* ---- meshes ---- */

/* Adds the ends of cells in all parts, and counts the share of its integral that a function may
 * hide in them. */
static void mesh(struct data_mesh_work *w, struct br_function_mesh *s)
{
    const struct br_interval none = {0, 0};
    const size_t parts[] = {has(s, BR_X) ? w->breaks[BR_X].count + 1 : 1,
                            has(s, BR_T) ? w->breaks[BR_T].count + 1 : 1};
    for (size_t i = 0; i < parts[BR_X]; i++)
        for (size_t j = 0; j < parts[BR_T] && !w->status; j++) {
            const struct br_interval x = has(s, BR_X) ? part(w, BR_X, i) : none;
            const struct br_interval t = has(s, BR_T) ? part(w, BR_T, j) : none;
            if ((x.high > x.low) == has(s, BR_X) && (t.high > t.low) == has(s, BR_T))
                w->status =
                    br_function_mesh_add(s, (struct br_box){x, t}, w->o->end, &w->o->store, w->err);
        }
    w->o->missed = fmax(w->o->missed, s->missed);
}

static void find_cells(struct data_mesh_work *w)
{
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        add_parts(w, v);
    for (size_t i = 0; i < w->subjects; i++)
        mesh(w, &w->subject[i]);
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        br_list_sort(&w->o->end[v]);
    if (w->o->store.failed && !w->status)
        w->status = br_no_memory(w->err, "the exact solution");
}

/* Whether all that depends on x is smooth enough for one element [a, b]. */
static bool fits(const struct data_mesh_work *w, double a, double b)
{
    const struct br_breaks *bend = &w->breaks[BR_X];
    for (size_t i = 0; i < bend->count; i++)
        if (bend->at[i].high > a && bend->at[i].high < b)
            return false;
    for (const struct br_function_mesh *s = w->subject; s < w->subject + w->subjects; s++) {
        const struct br_box box = {{a * (1 + apart), b * (1 - apart)}, s->box.t};
        struct br_interval value;
        if (!has(s, BR_X))
            continue;
        if (is_mixed(s) || !br_function_bound(s->f, box, &value))
            return false;
        const double size = fmax(fabs(value.low), fabs(value.high));
        if (!(br_function_mesh_error(s->f, BR_X, box, BR_MESH_DEGREE) <= BR_MESH_TOLERANCE * size))
            return false;
    }
    return true;
}

/* Joins elements that the data do not need: meshes by halving have many beside a narrow one. */
static void join_elements(struct data_mesh_work *w)
{
    struct br_list *end = &w->o->end[BR_X];
    size_t kept = 0;
    for (size_t i = 1; i < end->count; i++) {
        if (i + 1 < end->count && fits(w, end->at[kept], end->at[i + 1]))
            continue;
        end->at[++kept] = end->at[i];
    }
    end->count = kept + 1;
}

/* ---- integrals within wide breaks ---- */

/* Counts the integrals of functions within breaks that are wider than two neighbouring numbers. */
static void count_hidden(struct data_mesh_work *w, enum br_variable v)
{
    for (const struct br_function_mesh *s = w->subject; s < w->subject + w->subjects; s++)
        for (size_t i = 0; has(s, v) && i < w->breaks[v].count && !w->status; i++) {
            const struct br_interval at = w->breaks[v].at[i];
            struct br_box box = s->box, where;
            struct br_interval value;
            if (!(at.high - at.low > 4 * DBL_EPSILON * at.high))
                continue;
            *side(&box, v) = at;
            if (br_prove_bounded(s->f, box, &value, &where)) {
                w->status = br_must_be_finite(s->f, box, w->err);
                return;
            }
            const double share = (at.high - at.low) / w->all[v] * (value.high - value.low);
            if (share > 0)
                w->o->missed = fmax(w->o->missed, share / s->mean);
        }
}

/* ---- layers ---- */

/* Share of T: the estimates leave out changes as short as this (exact.c). */
static const double shortest = 1e-6;

/* Adds elements that grow from one end of the beam as a layer there grows, since velocities
 * diffuse. */
static void grade(struct data_mesh_work *w, bool tip, double layer)
{
    const double growth = 3, length = w->all[BR_X];
    struct br_list *end = &w->o->end[BR_X];
    const double first = tip ? length - end->at[end->count - 2] : end->at[1];
    for (double d = layer; growth * d < first; d *= growth)
        add(w, BR_X, tip ? length - d : d);
    br_list_sort(end);
}

/* Where the data jump in time, or change so that they ask for several cells, a layer remains at the
 * tip or the clamp. */
static void find_layers(struct data_mesh_work *w)
{
    const struct br_scene_field *d = w->data;
    const double layer =
        pow(d->viscosity / w->density * (shortest * w->all[BR_T]), 0.5 / (double)w->o->degree);
    const bool tip = !br_function_is_zero(&d->tip_force) || !br_function_is_zero(&d->tip_moment);
    if (w->o->end[BR_T].count == 2 || !(layer > narrow * w->all[BR_X]))
        return;
    if (tip)
        grade(w, true, layer);
    if (!br_load_is_zero(&d->load))
        grade(w, false, layer);
}

/* ---- what is proved ---- */

/* Adds to what may be missed how far polynomials of the highest degree may be from functions in
 * the cells, as far as they are surely smooth there: Radau's and Gauss's rules integrate these. */
static void count_proved(struct data_mesh_work *w, enum br_variable v,
                         const struct br_function_mesh *s)
{
    const struct br_list *end = &w->o->end[v];
    double sum = 0;
    for (size_t i = 0, k = 0; i <= w->breaks[v].count; i++) {
        const struct br_interval here = part(w, v, i);
        while (k > 0 && end->at[k] > here.low)
            k--;
        for (; k + 1 < end->count && end->at[k] < here.high; k++) {
            struct br_box box = {{0, 0}, {0, 0}};
            struct br_interval value, *cell = side(&box, v);
            *cell =
                (struct br_interval){fmax(end->at[k], here.low), fmin(end->at[k + 1], here.high)};
            if (!(cell->low < cell->high && br_function_bound(s->f, box, &value)))
                continue;
            const double error = br_function_mesh_error(s->f, v, box, BR_MESH_DEGREE);
            sum += (cell->high - cell->low) / w->all[v] * fmin(error, value.high - value.low);
        }
    }
    if (sum > 0)
        w->o->proved += sum / s->mean;
}

static void count_all_proved(struct data_mesh_work *w)
{
    for (const struct br_function_mesh *s = w->subject; s < w->subject + w->subjects; s++)
        for (enum br_variable v = BR_X; v <= BR_T; v++)
            if (has(s, v) && !is_mixed(s))
                count_proved(w, v, s);
            else if (v == BR_X && is_mixed(s))
                w->o->proved += BR_MESH_TOLERANCE;
}

enum br_status br_data_mesh_init(struct br_data_mesh *o, const struct br_scene *scene,
                                 enum br_field_kind kind, struct br_error *err)
{
    struct data_mesh_work w = {
        .o = o,
        .data = &scene->field[kind],
        .all = {[BR_X] = scene->length, [BR_T] = scene->duration},
        .density = scene->density,
        .err = err,
    };
    *o = (struct br_data_mesh){.data = &scene->field[kind], .degree = kind == BR_AXIAL ? 1 : 2};
    list_subjects(&w);
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        find_breaks(&w, v);
    o->fronts = w.breaks[BR_X].moving;
    for (enum br_variable v = BR_X; v <= BR_T; v++)
        count_hidden(&w, v);
    find_cells(&w);
    if (!w.status) {
        join_elements(&w);
        find_layers(&w);
        find_crossings(&w);
        count_all_proved(&w);
    }
    br_breaks_free(&w.breaks[BR_X]);
    o->jump = w.breaks[BR_T];
    return o->store.failed && !w.status ? br_no_memory(err, "the exact solution") : w.status;
}

void br_data_mesh_clear(struct br_data_mesh *o)
{
    br_store_clear(&o->store);
    br_breaks_free(&o->jump);
    *o = (struct br_data_mesh){0};
}

/* Waves need polynomials in proportion to an element's width, and more at its ends. Each element
 * has some more of its own, whose number grows with the others, so that its share of the error
 * falls. */
size_t br_data_mesh_terms(const struct br_data_mesh *o, size_t e, size_t modes)
{
    const struct br_list *end = &o->end[BR_X];
    const double h = (end->at[e + 1] - end->at[e]) / end->at[end->count - 1];
    const size_t own = modes / 4 + 3 < 16 ? modes / 4 + 3 : 16;
    const size_t terms = own + (size_t)ceil((double)modes * sqrt(h));
    return end->count == 2 || terms > modes ? modes : terms;
}

/* The cell that contains t; where two meet the later one. */
static size_t cell_of(const struct br_data_mesh *o, double t)
{
    return gsl_interp_bsearch(o->end[BR_T].at, t, 0, o->end[BR_T].count - 1);
}

bool br_data_mesh_is_sharp(const struct br_data_mesh *o, double t, double width)
{
    const struct br_list *c = &o->end[BR_T];
    for (size_t j = cell_of(o, t - width); j + 1 < c->count && c->at[j] < t + width; j++)
        if (c->at[j + 1] - c->at[j] < width)
            return true;
    return false;
}

double br_data_mesh_cell(const struct br_data_mesh *o, double t)
{
    const double *end = &o->end[BR_T].at[cell_of(o, t)];
    return o->end[BR_T].count > 2 ? end[1] - end[0] : INFINITY;
}

double br_data_mesh_reach(const struct br_data_mesh *o, double t)
{
    const double *end = o->end[BR_T].at, *last = end + o->end[BR_T].count - 1;
    end += cell_of(o, t);
    double reach = fmin(end[1] - t, end[1] - end[0]);
    while (++end < last && end[1] - end[0] > reach) {
        reach = fmin(end[1] - t, end[1] - end[0]);
        if (reach < end[1] - t)
            break;
    }
    return reach;
}
