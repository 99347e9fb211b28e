/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/outline.h"

#include <float.h>
#include <math.h>

/* Degrees of what stands for the data: on an element, and over a Radau step. */
enum { SPACE_DEGREE = 15, TIME_DEGREE = 8, MOST_ELEMENTS = 400, MOST_CELLS = 20000 };

/* Functions of x and of t that the field depends on. */
enum { MOST = 2 * BR_LOAD_TERMS + 2 };

struct subject {
    const struct br_function *f;
    double until; /* s: it counts from 0 on */
};

struct work {
    struct br_outline *o;
    const struct br_exact_data *data;
    size_t degree;
    double length, duration, density;
    struct subject space[MOST], time[MOST];
    size_t spaces, times;
    struct br_breaks bend; /* places where functions of x jump or bend, m */
    struct br_error *err;
};

struct br_exact_data br_exact_data_of(const struct br_scene *s, size_t degree)
{
    const struct br_axial *a = &s->axial;
    const struct br_bending *b = &s->bending;
    if (degree == 1)
        return (struct br_exact_data){
            .stiffness = a->stiffness,
            .viscosity = a->viscosity,
            .load = &a->load,
            .tip_force = &a->tip_force,
            .displacement = &a->displacement,
            .velocity = &a->velocity,
            .slope = &a->displacement,
        };
    return (struct br_exact_data){
        .stiffness = b->stiffness,
        .viscosity = b->viscosity,
        .load = &b->load,
        .tip_force = &b->tip_force,
        .tip_moment = &b->tip_moment,
        .displacement = &b->displacement,
        .velocity = &b->velocity,
        .slope = &b->displacement_slope,
    };
}

/* ---- who counts ---- */

static void list_space(struct work *w, const struct br_function *f, double until)
{
    if (f->uses_x)
        w->space[w->spaces++] = (struct subject){f, f->uses_t ? until : 0};
}

static void list_time(struct work *w, const struct br_function *f)
{
    if (f && f->uses_t && !f->uses_x)
        w->time[w->times++] = (struct subject){f, w->duration};
}

static void list_subjects(struct work *w, const struct br_exact_data *d)
{
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &d->load->term[i];
        if (br_product_is_zero(p))
            continue;
        list_space(w, &p->space, w->duration);
        list_time(w, &p->space);
        list_time(w, &p->time);
    }
    list_space(w, d->slope, 0);
    list_space(w, d->velocity, 0);
    list_time(w, d->tip_force);
    list_time(w, d->tip_moment);
}

static struct br_box box_of(const struct work *w, const struct subject *s)
{
    return (struct br_box){{0, w->length}, {0, s->until}};
}

static bool is_known(const struct br_function *f)
{
    return f->ops && f->ops->bound;
}

static bool inseparable(const struct subject *s)
{
    return s->f->uses_x && s->f->uses_t && s->until > 0;
}

/* ---- parts between places where functions jump ---- */

/* So much apart, of a place, guards that vanish there have a sign for sure. */
static const double apart = 8 * DBL_EPSILON;

/* Part i of `breaks`->count + 1 of [0, all], as far as functions are smooth there for sure. */
static struct br_interval part(const struct br_breaks *breaks, size_t i, double all)
{
    return (struct br_interval){i ? breaks->at[i - 1].high * (1 + apart) : 0,
                                i < breaks->count ? breaks->at[i].low * (1 - apart) : all};
}

/* What is this narrow, of all, lies within one place, or in an end. */
static const double narrow = 1e-13;

/* Places with nothing but round-off between them are one; what happens in it is counted by
 * count_hidden. */
static void join_breaks(struct br_breaks *breaks, double all)
{
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

/* The ends of [0, all] and of the parts. */
static enum br_status add_parts(struct br_list *list, const struct br_breaks *breaks, double all,
                                struct br_error *err)
{
    enum br_status status = br_list_add(list, 0, err);
    for (size_t i = 0; i < breaks->count && !status; i++) {
        const struct br_interval at = breaks->at[i];
        const bool wide = at.high - at.low > narrow * all; /* no more could be told */
        if (at.high < all && (wide || at.low > 0))
            status = br_list_add(list, at.high, err);
        if (!status && at.low > 0 && (wide || at.high == all))
            status = br_list_add(list, at.low, err);
    }
    return status ? status : br_list_add(list, all, err);
}

static enum br_status find_bends(struct work *w)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < w->spaces && !status; i++)
        if (is_known(w->space[i].f))
            status = br_breaks_add(w->space[i].f, BR_X, box_of(w, &w->space[i]), &w->bend, w->err);
    w->o->fronts = w->bend.moving;
    join_breaks(&w->bend, w->length);
    return status;
}

/* ---- meshes ---- */

static struct br_list *new_cells(struct work *w)
{
    return &w->o->cell[w->o->cells++];
}

static struct br_sight sight_of(const struct work *w, const struct subject *s)
{
    const struct br_box box = box_of(w, s);
    const double x = s->f->uses_x ? w->length : 1, t = s->f->uses_t && s->until > 0 ? s->until : 1;
    const double mean = br_sight_mean(s->f, box);
    return (struct br_sight){
        .f = s->f,
        .degree = {SPACE_DEGREE, TIME_DEGREE},
        .mean = mean,
        .most_missed = 1e-13 * mean * x * t,
        .least = 1e-15 * (s->f->uses_x ? w->length : w->duration),
        .most = MOST_CELLS,
    };
}

/* What a function may hide, of its integral. */
static void count_missed(struct work *w, const struct br_sight *sight)
{
    if (sight->missed > 0) /* in units of most_missed */
        w->o->missed = fmax(w->o->missed, 1e-13 * sight->missed / sight->most_missed);
}

static enum br_status mesh_both(struct work *w, const struct subject *s)
{
    const struct br_breaks *bend = &w->bend, *jump = &w->o->jump;
    struct br_sight sight = sight_of(w, s);
    struct br_list ends[2] = {{0}, {0}};
    enum br_status status = add_parts(&ends[BR_T], jump, w->duration, w->err);
    for (size_t i = 0; i <= bend->count && !status; i++)
        for (size_t j = 0; j <= jump->count && !status; j++) {
            const struct br_box box = {part(bend, i, w->length), part(jump, j, w->duration)};
            if (box.x.high > box.x.low && box.t.high > box.t.low)
                status = br_sight_both(&sight, box, ends, w->err);
        }
    for (size_t i = 0; i < ends[BR_X].count && !status; i++)
        status = br_list_add(&w->o->end, ends[BR_X].at[i], w->err);
    br_list_free(&ends[BR_X]);
    *new_cells(w) = ends[BR_T];
    count_missed(w, &sight);
    return status;
}

static enum br_status mesh_parts(struct work *w, const struct subject *s, enum br_variable along,
                                 struct br_list *ends)
{
    const struct br_breaks *breaks = along == BR_X ? &w->bend : &w->o->jump;
    const double all = along == BR_X ? w->length : w->duration;
    struct br_sight sight = sight_of(w, s);
    enum br_status status = BR_OK;
    for (size_t i = 0; i <= breaks->count && !status; i++) {
        struct br_box box = {{0, 0}, {0, 0}};
        const struct br_interval here = part(breaks, i, all);
        *(along == BR_X ? &box.x : &box.t) = here;
        if (here.high > here.low)
            status = br_sight_along(&sight, along, box, ends, w->err);
    }
    count_missed(w, &sight);
    return status;
}

static enum br_status mesh_time(struct work *w, const struct subject *s)
{
    struct br_list *cells = new_cells(w);
    const enum br_status status = add_parts(cells, &w->o->jump, w->duration, w->err);
    return status || !is_known(s->f) ? status : mesh_parts(w, s, BR_T, cells);
}

static enum br_status find_elements(struct work *w)
{
    enum br_status status = add_parts(&w->o->end, &w->bend, w->length, w->err);
    for (size_t i = 0; i < w->spaces && !status; i++)
        if (is_known(w->space[i].f))
            status = inseparable(&w->space[i]) ? mesh_both(w, &w->space[i])
                                               : mesh_parts(w, &w->space[i], BR_X, &w->o->end);
    br_list_sort(&w->o->end, 0);
    return status;
}

/* Whether all that depends on x is smooth enough for one element [a, b]. */
static bool fits(const struct work *w, double a, double b)
{
    for (size_t i = 0; i < w->bend.count; i++)
        if (w->bend.at[i].high > a && w->bend.at[i].high < b)
            return false;
    for (size_t i = 0; i < w->spaces; i++) {
        const struct subject *s = &w->space[i];
        const struct br_box box = {{a * (1 + apart), b * (1 - apart)}, {0, s->until}};
        struct br_interval value;
        if (!is_known(s->f))
            continue;
        if (inseparable(s) || !br_function_bound(s->f, box, &value))
            return false;
        const double size = fmax(fabs(value.low), fabs(value.high));
        if (!(br_sight_error(s->f, BR_X, box, SPACE_DEGREE) <= BR_SIGHT_TOLERANCE * size))
            return false;
    }
    return true;
}

/* Meshes by halving leave many elements beside a narrow one that say nothing. */
static void join_elements(struct work *w)
{
    struct br_list *end = &w->o->end;
    size_t kept = 0;
    for (size_t i = 1; i < end->count; i++) {
        if (i + 1 < end->count && fits(w, end->at[kept], end->at[i + 1]))
            continue;
        end->at[++kept] = end->at[i];
    }
    end->count = kept + 1;
}

/* ---- time ---- */

static enum br_status find_jumps(struct work *w)
{
    struct br_breaks *jump = &w->o->jump;
    enum br_status status = BR_OK;
    for (size_t i = 0; i < w->times && !status; i++)
        if (is_known(w->time[i].f))
            status = br_breaks_add(w->time[i].f, BR_T, box_of(w, &w->time[i]), jump, w->err);
    for (size_t i = 0; i < w->spaces && !status; i++) {
        const struct subject *s = &w->space[i];
        bool complete = true;
        if (!inseparable(s) || !is_known(s->f))
            continue;
        status = br_breaks_add(s->f, BR_T, box_of(w, s), jump, w->err);
        if (!status)
            status = br_front_times(s->f, box_of(w, s), jump, &complete, w->err);
    }
    join_breaks(jump, w->duration);
    return status;
}

/* What a function may do within places that are more than neighbouring numbers wide. */
static enum br_status count_hidden(struct work *w, const struct subject *s, enum br_variable along)
{
    const struct br_breaks *breaks = along == BR_X ? &w->bend : &w->o->jump;
    const double all = along == BR_X ? w->length : w->duration;
    for (size_t i = 0; i < breaks->count; i++) {
        const struct br_interval at = breaks->at[i];
        struct br_box box = box_of(w, s), where;
        struct br_interval value;
        if (!is_known(s->f) || !(at.high - at.low > 4 * DBL_EPSILON * at.high))
            continue;
        *(along == BR_X ? &box.x : &box.t) = at;
        if (br_prove_bounded(s->f, box, 0, &value, &where))
            return br_must_be_finite(s->f, box, w->err);
        const double share = (at.high - at.low) / all * (value.high - value.low);
        if (share > 0)
            w->o->missed = fmax(w->o->missed, share / br_sight_mean(s->f, box_of(w, s)));
    }
    return BR_OK;
}

static enum br_status count_all_hidden(struct work *w)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < w->spaces && !status; i++) {
        status = count_hidden(w, &w->space[i], BR_X);
        if (!status && inseparable(&w->space[i]))
            status = count_hidden(w, &w->space[i], BR_T);
    }
    for (size_t i = 0; i < w->times && !status; i++)
        status = count_hidden(w, &w->time[i], BR_T);
    return status;
}

/* Fronts that pass from one element to the next. */
static enum br_status find_crossings(struct work *w)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < w->spaces && w->o->fronts && !status; i++)
        for (size_t e = 1; e + 1 < w->o->end.count && !status; e++) {
            const double x = w->o->end.at[e];
            const struct br_box box = {{x, x}, {0, w->duration}};
            if (inseparable(&w->space[i]) && is_known(w->space[i].f))
                status = br_breaks_add(w->space[i].f, BR_T, box, &w->o->jump, w->err);
        }
    return status;
}

/* ---- layers ---- */

/* How short the data's changes are that leave layers behind: jumps after t = 0 and short cells; no
 * less than what estimates leave out (compare.c). Infinite for none. */
static double shortest_change(const struct work *w)
{
    const double least = 1e-6 * w->duration, most = 1e-3 * w->duration;
    double width = w->o->jump.count ? least : INFINITY;
    for (size_t i = 0; i < w->o->cells; i++)
        for (size_t j = 1; j < w->o->cell[i].count; j++)
            width = fmin(width, w->o->cell[i].at[j] - w->o->cell[i].at[j - 1]);
    return width < most ? fmax(width, least) : INFINITY;
}

/* Elements that grow from one end of the beam as a layer there does: velocities diffuse. */
static enum br_status grade(struct work *w, bool tip, double layer)
{
    const double growth = 3;
    const struct br_list *end = &w->o->end;
    const double first = tip ? w->length - end->at[end->count - 2] : end->at[1];
    enum br_status status = BR_OK;
    for (double d = layer; growth * d < first && !status; d *= growth)
        status = br_list_add(&w->o->end, tip ? w->length - d : d, w->err);
    br_list_sort(&w->o->end, 0);
    return status;
}

static bool has_spread_load(const struct br_load *load)
{
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        if (!br_product_is_zero(&load->term[i]))
            return true;
    return false;
}

static enum br_status find_layers(struct work *w)
{
    const struct br_exact_data *d = w->data;
    const double layer =
        pow(d->viscosity / w->density * shortest_change(w), 0.5 / (double)w->degree);
    const bool tip = !br_function_is_zero(d->tip_force) ||
                     (d->tip_moment && !br_function_is_zero(d->tip_moment));
    enum br_status status = BR_OK;
    if (!(layer > narrow * w->length))
        return BR_OK;
    if (tip)
        status = grade(w, true, layer);
    return !status && has_spread_load(d->load) ? grade(w, false, layer) : status;
}

/* ---- what is proved ---- */

/* Adds to what may be missed how far polynomials of the highest degree may be from a function in
 * the cells: Radau's and Gauss's rules integrate these. */
static void count_proved(struct work *w, const struct subject *s, enum br_variable along,
                         const struct br_list *ends)
{
    double sum = 0;
    const double all = along == BR_X ? w->length : w->duration;
    for (size_t i = 0; i + 1 < ends->count; i++) {
        const struct br_interval cell = {ends->at[i] * (1 + apart), ends->at[i + 1] * (1 - apart)};
        struct br_box box = {{0, 0}, {0, 0}};
        *(along == BR_X ? &box.x : &box.t) = cell;
        struct br_interval value;
        if (!(cell.low < cell.high && br_function_bound(s->f, box, &value)))
            continue;
        const double error = br_sight_error(s->f, along, box, 15);
        sum += (cell.high - cell.low) / all * fmin(error, value.high - value.low);
    }
    if (sum > 0)
        w->o->proved += sum / br_sight_mean(s->f, box_of(w, s));
}

static void count_all_proved(struct work *w)
{
    for (size_t i = 0; i < w->spaces; i++)
        if (is_known(w->space[i].f) && inseparable(&w->space[i]))
            w->o->proved += BR_SIGHT_TOLERANCE;
        else if (is_known(w->space[i].f))
            count_proved(w, &w->space[i], BR_X, &w->o->end);
    for (size_t i = 0; i < w->times; i++)
        if (is_known(w->time[i].f))
            count_proved(w, &w->time[i], BR_T, &w->o->cell[w->o->cells - w->times + i]);
}

static enum br_status look(struct work *w)
{
    w->o->cell = br_allocate(MOST, sizeof *w->o->cell);
    if (!w->o->cell)
        return br_no_memory(w->err, "the exact solution");
    enum br_status status = find_bends(w);
    if (!status)
        status = find_jumps(w);
    if (!status)
        status = count_all_hidden(w);
    if (!status)
        status = find_elements(w);
    if (!status)
        join_elements(w);
    for (size_t i = 0; i < w->times && !status; i++)
        status = mesh_time(w, &w->time[i]);
    if (!status)
        status = find_layers(w);
    if (!status)
        status = find_crossings(w);
    for (size_t i = 0; i < w->o->cells; i++)
        br_list_sort(&w->o->cell[i], 0);
    if (!status)
        count_all_proved(w);
    return status;
}

enum br_status br_outline_init(struct br_outline *o, const struct br_scene *scene, size_t degree,
                               struct br_error *err)
{
    const struct br_exact_data data = br_exact_data_of(scene, degree);
    struct work w = {
        .o = o,
        .data = &data,
        .degree = degree,
        .length = scene->length,
        .duration = scene->duration,
        .density = scene->density,
        .err = err,
    };
    *o = (struct br_outline){0};
    list_subjects(&w, &data);
    const enum br_status status = look(&w);
    br_breaks_free(&w.bend);
    return status;
}

void br_outline_clear(struct br_outline *o)
{
    for (size_t i = 0; i < o->cells; i++)
        br_list_free(&o->cell[i]);
    free(o->cell);
    br_list_free(&o->end);
    br_breaks_free(&o->jump);
    *o = (struct br_outline){0};
}

/* Waves need polynomials in proportion to an element's width, more at its ends; and each element
 * some of its own, growing with the others, lest its share of the error stay the same. */
size_t br_outline_terms(const struct br_outline *o, size_t e, size_t modes)
{
    const struct br_list *end = &o->end;
    const double h = (end->at[e + 1] - end->at[e]) / end->at[end->count - 1];
    const size_t own = modes / 4 + 3 < 16 ? modes / 4 + 3 : 16;
    const size_t terms = own + (size_t)ceil((double)modes * sqrt(h));
    return end->count == 2 || terms > modes ? modes : terms;
}

/* The cell that holds t; where two meet the later one. */
static size_t cell_of(const struct br_list *cells, double t)
{
    size_t low = 0, high = cells->count - 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (cells->at[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static double reach_in(const struct br_list *cells, double t)
{
    size_t i = cell_of(cells, t);
    double reach = fmin(cells->at[i + 1] - t, cells->at[i + 1] - cells->at[i]);
    while (++i + 1 < cells->count) {
        const double wide = cells->at[i + 1] - cells->at[i];
        if (wide <= reach)
            break;
        reach = fmin(cells->at[i + 1] - t, wide);
        if (reach < cells->at[i + 1] - t)
            break;
    }
    return reach;
}

bool br_outline_is_sharp(const struct br_outline *o, double t, double width)
{
    for (size_t i = 0; i < o->cells; i++) {
        const struct br_list *c = &o->cell[i];
        for (size_t j = cell_of(c, t - width); j + 1 < c->count && c->at[j] < t + width; j++)
            if (c->at[j + 1] - c->at[j] < width)
                return true;
    }
    return false;
}

double br_outline_cell(const struct br_outline *o, double t)
{
    double width = INFINITY;
    for (size_t i = 0; i < o->cells; i++)
        if (o->cell[i].count > 1) {
            const size_t j = cell_of(&o->cell[i], t);
            width = fmin(width, o->cell[i].at[j + 1] - o->cell[i].at[j]);
        }
    return width;
}

double br_outline_reach(const struct br_outline *o, double t)
{
    double reach = INFINITY;
    for (size_t i = 0; i < o->cells; i++)
        if (o->cell[i].count > 1)
            reach = fmin(reach, reach_in(&o->cell[i], t));
    return reach;
}
