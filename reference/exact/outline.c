/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/exact/outline.h"

#include <float.h>
#include <gsl/gsl_interp.h>
#include <math.h>

/* Degrees of the polynomials that replace the data: on an element, and over a Radau step. */
enum { SPACE_DEGREE = 15, TIME_DEGREE = 8, MOST_CELLS = 20000 };

/* Functions of x and of t that the field depends on. */
enum { MOST = 2 * BR_LOAD_TERMS + 2 };

struct subject {
    const struct br_function *f;
    struct br_box box; /* where it is needed: at t = 0 alone where it has no t, or later ones do not
                          matter */
    bool both;         /* of x and t, and no product */
};

/* Arrays of two: by br_variable. */
struct work {
    struct br_outline *o;
    const struct br_exact_data *data;
    double all[2], density; /* L, m; T, s; kg/m */
    struct subject subject[2][MOST];
    size_t subjects[2];
    struct br_breaks breaks[2]; /* where functions of x or t jump or bend, m and s */
    enum br_status status;      /* where it is not BR_OK, nothing more is done */
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

/* ---- the functions that matter ---- */

static bool is_known(const struct br_function *f)
{
    return f->ops && f->ops->bound;
}

static void list(struct work *w, enum br_variable along, const struct br_function *f, double until)
{
    const struct br_box box = {{0, w->all[BR_X]}, {0, f->uses_t ? until : 0}};
    w->subject[along][w->subjects[along]++] =
        (struct subject){f, box, f->uses_x && f->uses_t && until > 0};
}

/* A function without bounds has no proofs: of such a function only the ends of steps are known. */
static void list_space(struct work *w, const struct br_function *f, double until)
{
    if (f->uses_x && is_known(f))
        list(w, BR_X, f, until);
}

static void list_time(struct work *w, const struct br_function *f)
{
    if (f && f->uses_t && !f->uses_x)
        list(w, BR_T, f, w->all[BR_T]);
}

static void list_subjects(struct work *w)
{
    const struct br_exact_data *d = w->data;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &d->load->term[i];
        if (br_product_is_zero(p))
            continue;
        list_space(w, &p->space, w->all[BR_T]);
        list_time(w, &p->space);
        list_time(w, &p->time);
    }
    list_space(w, d->slope, 0);
    list_space(w, d->velocity, 0);
    list_time(w, d->tip_force);
    list_time(w, d->tip_moment);
}

/* The box that is `here` along one axis, and the beginning of the other axis. */
static struct br_box line(enum br_variable along, struct br_interval here)
{
    struct br_box box = {{0, 0}, {0, 0}};
    *br_side(&box, along) = here;
    return box;
}

/* ---- parts between places where functions jump ---- */

/* At this distance from a place, relative to it, guards that vanish there surely have a sign. */
static const double apart = 8 * DBL_EPSILON;

/* Part i of an axis (breaks' count + 1 of them), as far as functions are surely smooth there. */
static struct br_interval part(const struct work *w, enum br_variable along, size_t i)
{
    const struct br_breaks *breaks = &w->breaks[along];
    return (struct br_interval){i ? breaks->at[i - 1].high * (1 + apart) : 0,
                                i < breaks->count ? breaks->at[i].low * (1 - apart)
                                                  : w->all[along]};
}

/* A gap this narrow, relative to the axis, belongs to the places on both sides, or to the end. */
static const double narrow = 1e-13;

/* Joins places that only round-off separates. count_hidden counts what a function may do within
 * the joined place. */
static void join_breaks(struct work *w, enum br_variable along)
{
    struct br_breaks *breaks = &w->breaks[along];
    const double all = w->all[along];
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

static void add(struct work *w, struct br_list *to, double value)
{
    if (!w->status)
        w->status = br_list_add(to, value, &w->o->store, w->err);
}

/* The ends of an axis and of its parts. */
static void add_parts(struct work *w, enum br_variable along, struct br_list *to)
{
    const double all = w->all[along];
    add(w, to, 0);
    for (size_t i = 0; i < w->breaks[along].count; i++) {
        const struct br_interval at = w->breaks[along].at[i];
        const bool wide = at.high - at.low > narrow * all; /* the place is not known better */
        if (at.high < all && (wide || at.low > 0))
            add(w, to, at.high);
        if (at.low > 0 && (wide || at.high == all))
            add(w, to, at.low);
    }
    add(w, to, all);
}

static void add_breaks(struct work *w, enum br_variable along, const struct br_function *f,
                       struct br_box box)
{
    if (!w->status)
        w->status = br_breaks_add(f, along, box, &w->breaks[along], w->err);
}

static void find_bends(struct work *w)
{
    for (size_t i = 0; i < w->subjects[BR_X]; i++)
        add_breaks(w, BR_X, w->subject[BR_X][i].f, w->subject[BR_X][i].box);
    w->o->fronts = w->breaks[BR_X].moving;
    join_breaks(w, BR_X);
}

/* Finds the times at which functions of t alone jump, and at which fronts come or go. */
static void find_jumps(struct work *w)
{
    for (size_t i = 0; i < w->subjects[BR_T]; i++)
        if (is_known(w->subject[BR_T][i].f))
            add_breaks(w, BR_T, w->subject[BR_T][i].f, w->subject[BR_T][i].box);
    for (size_t i = 0; i < w->subjects[BR_X]; i++) {
        const struct subject *s = &w->subject[BR_X][i];
        bool complete = true;
        if (!s->both)
            continue;
        add_breaks(w, BR_T, s->f, s->box);
        if (!w->status)
            w->status = br_front_times(s->f, s->box, &w->breaks[BR_T], &complete, w->err);
    }
    join_breaks(w, BR_T);
}

/* Finds the times at which fronts pass from one element to the next. */
static void find_crossings(struct work *w)
{
    for (size_t i = 0; i < w->subjects[BR_X] && w->o->fronts; i++)
        for (size_t e = 1; e + 1 < w->o->end.count; e++) {
            const double x = w->o->end.at[e];
            const struct br_box box = {{x, x}, {0, w->all[BR_T]}};
            if (w->subject[BR_X][i].both)
                add_breaks(w, BR_T, w->subject[BR_X][i].f, box);
        }
}

/* ---- meshes ---- */

static struct br_list *new_cells(struct work *w)
{
    return &w->o->cell[w->o->cells++];
}

static struct br_sight sight_of(const struct work *w, const struct subject *s)
{
    const double x = s->f->uses_x ? w->all[BR_X] : 1, t = s->box.t.high > 0 ? s->box.t.high : 1;
    const double mean = br_sight_mean(s->f, s->box);
    return (struct br_sight){
        .f = s->f,
        .degree = {SPACE_DEGREE, TIME_DEGREE},
        .mean = mean,
        .most_missed = 1e-13 * mean * x * t,
        .least = 1e-15 * w->all[s->f->uses_x ? BR_X : BR_T],
        .most = MOST_CELLS,
        .store = &w->o->store,
    };
}

/* Counts the share of its integral that a function may hide. */
static void count_missed(struct work *w, const struct br_sight *sight)
{
    if (sight->missed > 0) /* in units of most_missed */
        w->o->missed = fmax(w->o->missed, 1e-13 * sight->missed / sight->most_missed);
}

static void mesh_both(struct work *w, const struct subject *s)
{
    struct br_sight sight = sight_of(w, s);
    struct br_list *ends[2] = {&w->o->end, new_cells(w)};
    add_parts(w, BR_T, ends[BR_T]);
    for (size_t i = 0; i <= w->breaks[BR_X].count; i++)
        for (size_t j = 0; j <= w->breaks[BR_T].count && !w->status; j++) {
            const struct br_box box = {part(w, BR_X, i), part(w, BR_T, j)};
            if (box.x.high > box.x.low && box.t.high > box.t.low)
                w->status = br_sight_both(&sight, box, ends, w->err);
        }
    count_missed(w, &sight);
}

static void mesh_parts(struct work *w, const struct subject *s, enum br_variable along,
                       struct br_list *ends)
{
    struct br_sight sight = sight_of(w, s);
    for (size_t i = 0; i <= w->breaks[along].count && !w->status; i++) {
        const struct br_interval here = part(w, along, i);
        if (here.high > here.low)
            w->status = br_sight_along(&sight, along, line(along, here), ends, w->err);
    }
    count_missed(w, &sight);
}

static void find_elements(struct work *w)
{
    add_parts(w, BR_X, &w->o->end);
    for (size_t i = 0; i < w->subjects[BR_X] && !w->status; i++) {
        const struct subject *s = &w->subject[BR_X][i];
        if (s->both)
            mesh_both(w, s);
        else
            mesh_parts(w, s, BR_X, &w->o->end);
    }
    br_list_sort(&w->o->end);
}

/* Adds the cells of functions of t alone, behind those of functions of both. */
static void find_cells(struct work *w)
{
    for (size_t i = 0; i < w->subjects[BR_T] && !w->status; i++) {
        struct br_list *cells = new_cells(w);
        add_parts(w, BR_T, cells);
        if (!w->status && is_known(w->subject[BR_T][i].f))
            mesh_parts(w, &w->subject[BR_T][i], BR_T, cells);
    }
}

/* Whether all that depends on x is smooth enough for one element [a, b]. */
static bool fits(const struct work *w, double a, double b)
{
    const struct br_breaks *bend = &w->breaks[BR_X];
    for (size_t i = 0; i < bend->count; i++)
        if (bend->at[i].high > a && bend->at[i].high < b)
            return false;
    for (size_t i = 0; i < w->subjects[BR_X]; i++) {
        const struct subject *s = &w->subject[BR_X][i];
        const struct br_box box = {{a * (1 + apart), b * (1 - apart)}, s->box.t};
        struct br_interval value;
        if (s->both || !br_function_bound(s->f, box, &value))
            return false;
        const double size = fmax(fabs(value.low), fabs(value.high));
        if (!(br_sight_error(s->f, BR_X, box, SPACE_DEGREE) <= BR_SIGHT_TOLERANCE * size))
            return false;
    }
    return true;
}

/* Joins elements that the data do not need: meshes by halving have many beside a narrow one. */
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

/* ---- what hides in places that are wide ---- */

/* Counts what a function may do within places that are wider than two neighbouring numbers. */
static void count_hidden(struct work *w, const struct subject *s, enum br_variable along)
{
    const struct br_breaks *breaks = &w->breaks[along];
    for (size_t i = 0; i < breaks->count && !w->status; i++) {
        const struct br_interval at = breaks->at[i];
        struct br_box box = s->box, where;
        struct br_interval value;
        if (!is_known(s->f) || !(at.high - at.low > 4 * DBL_EPSILON * at.high))
            continue;
        *br_side(&box, along) = at;
        if (br_prove_bounded(s->f, box, 0, &value, &where)) {
            w->status = br_must_be_finite(s->f, box, w->err);
            return;
        }
        const double share = (at.high - at.low) / w->all[along] * (value.high - value.low);
        if (share > 0)
            w->o->missed = fmax(w->o->missed, share / br_sight_mean(s->f, s->box));
    }
}

static void count_all_hidden(struct work *w)
{
    for (size_t i = 0; i < w->subjects[BR_X]; i++) {
        count_hidden(w, &w->subject[BR_X][i], BR_X);
        if (w->subject[BR_X][i].both)
            count_hidden(w, &w->subject[BR_X][i], BR_T);
    }
    for (size_t i = 0; i < w->subjects[BR_T]; i++)
        count_hidden(w, &w->subject[BR_T][i], BR_T);
}

/* ---- layers ---- */

/* The shortest time, s, in which the data change so that a layer remains: at jumps after t = 0 and
 * in short cells. At least what estimates leave out (exact.c). Infinite: no layer. */
static double shortest_change(const struct work *w)
{
    const double least = 1e-6 * w->all[BR_T], most = 1e-3 * w->all[BR_T];
    double width = w->breaks[BR_T].count ? least : INFINITY;
    for (size_t i = 0; i < w->o->cells; i++)
        for (size_t j = 1; j < w->o->cell[i].count; j++)
            width = fmin(width, w->o->cell[i].at[j] - w->o->cell[i].at[j - 1]);
    return width < most ? fmax(width, least) : INFINITY;
}

/* Adds elements that grow from one end of the beam as a layer there grows, since velocities
 * diffuse. */
static void grade(struct work *w, bool tip, double layer)
{
    const double growth = 3, length = w->all[BR_X];
    struct br_list *end = &w->o->end;
    const double first = tip ? length - end->at[end->count - 2] : end->at[1];
    for (double d = layer; growth * d < first; d *= growth)
        add(w, end, tip ? length - d : d);
    br_list_sort(end);
}

static void find_layers(struct work *w)
{
    const struct br_exact_data *d = w->data;
    const double layer =
        pow(d->viscosity / w->density * shortest_change(w), 0.5 / (double)w->o->degree);
    const bool tip = !br_function_is_zero(d->tip_force) ||
                     (d->tip_moment && !br_function_is_zero(d->tip_moment));
    if (w->status || !(layer > narrow * w->all[BR_X]))
        return;
    if (tip)
        grade(w, true, layer);
    if (!br_load_is_zero(d->load))
        grade(w, false, layer);
}

/* ---- what is proved ---- */

/* A cell as far as functions are surely smooth there. The end that it shares with a place where
 * they jump is one end of the place, which may be the other one. */
static struct br_interval smooth_part(const struct work *w, enum br_variable along, double low,
                                      double high)
{
    const struct br_breaks *breaks = &w->breaks[along];
    struct br_interval cell = {low, high};
    for (size_t i = 0; i < breaks->count; i++) {
        const struct br_interval at = breaks->at[i];
        if (at.low <= low && low <= at.high)
            cell.low = at.high;
        if (at.low <= high && high <= at.high)
            cell.high = at.low;
    }
    return (struct br_interval){cell.low * (1 + apart), cell.high * (1 - apart)};
}

/* Adds to what may be missed how far polynomials of the highest degree may be from a function in
 * the cells: Radau's and Gauss's rules integrate these. */
static void count_proved(struct work *w, const struct subject *s, enum br_variable along,
                         const struct br_list *ends)
{
    double sum = 0;
    for (size_t i = 0; i + 1 < ends->count; i++) {
        const struct br_interval cell = smooth_part(w, along, ends->at[i], ends->at[i + 1]);
        struct br_interval value;
        if (!(cell.low < cell.high && br_function_bound(s->f, line(along, cell), &value)))
            continue;
        const double error = br_sight_error(s->f, along, line(along, cell), 15);
        sum += (cell.high - cell.low) / w->all[along] * fmin(error, value.high - value.low);
    }
    if (sum > 0)
        w->o->proved += sum / br_sight_mean(s->f, s->box);
}

static void count_all_proved(struct work *w)
{
    for (size_t i = 0; i < w->subjects[BR_X]; i++)
        if (w->subject[BR_X][i].both)
            w->o->proved += BR_SIGHT_TOLERANCE;
        else
            count_proved(w, &w->subject[BR_X][i], BR_X, &w->o->end);
    const struct br_list *cells = w->o->cell + w->o->cells - w->subjects[BR_T];
    for (size_t i = 0; i < w->subjects[BR_T]; i++)
        if (is_known(w->subject[BR_T][i].f))
            count_proved(w, &w->subject[BR_T][i], BR_T, &cells[i]);
}

enum br_status br_outline_init(struct br_outline *o, const struct br_scene *scene, size_t degree,
                               struct br_error *err)
{
    const struct br_exact_data data = br_exact_data_of(scene, degree);
    struct work w = {
        .o = o,
        .data = &data,
        .all = {[BR_X] = scene->length, [BR_T] = scene->duration},
        .density = scene->density,
        .err = err,
    };
    *o = (struct br_outline){.degree = degree};
    o->cell = br_store_take(&o->store, MOST, sizeof *o->cell);
    if (!o->cell)
        return br_no_memory(err, "the exact solution");
    list_subjects(&w);
    find_bends(&w);
    find_jumps(&w);
    count_all_hidden(&w);
    find_elements(&w);
    if (!w.status)
        join_elements(&w);
    find_cells(&w);
    find_layers(&w);
    find_crossings(&w);
    for (size_t i = 0; i < o->cells; i++)
        br_list_sort(&o->cell[i]);
    if (!w.status)
        count_all_proved(&w);
    br_breaks_free(&w.breaks[BR_X]);
    o->jump = w.breaks[BR_T];
    return w.status;
}

void br_outline_clear(struct br_outline *o)
{
    br_store_clear(&o->store);
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
    return gsl_interp_bsearch(cells->at, t, 0, cells->count - 1);
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
    for (size_t i = 0; i < o->cells; i++) {
        const size_t j = cell_of(&o->cell[i], t);
        width = fmin(width, o->cell[i].at[j + 1] - o->cell[i].at[j]);
    }
    return width;
}

double br_outline_reach(const struct br_outline *o, double t)
{
    double reach = INFINITY;
    for (size_t i = 0; i < o->cells; i++)
        reach = fmin(reach, reach_in(&o->cell[i], t));
    return reach;
}
