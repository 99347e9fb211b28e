/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/grid/costs.h"

#include <math.h>

#include "base/clock.h"
#include "solver/linear/linear_solver.h"
#include "solver/march.h"
#include "solver/scene.h"
#include "study/grid/study_march.h"

static const double nanosecond = 1e-9;

/* ---- one march ---- */

/* Nodal arrays of a march beside its solvers, bytes an element. */
static const double nodal_arrays = 80;

double br_march_bytes(const struct br_planned_march *o)
{
    const double states = br_time_scheme_kept(o->method->scheme);
    double element = nodal_arrays;
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_field field =
            br_field_of_scene(o->scene, kind, o->n, 1, o->method->axial_degree);
        const struct br_linear_solver *l = br_method_solver(o->method, &field);
        if (o->scene->field[kind].modelled)
            element += br_by_element_of(&l->bytes, &field) +
                       states * br_by_element_of(&l->state_bytes, &field);
    }
    return element * (double)o->n;
}

/* Steps of an adaptive scheme at a tolerance of 1e-4; they grow as the inverse of the tolerance to
 * 1/4 (order 4). */
static const double usual_steps = 30;

double br_march_seconds(const struct br_planned_march *o)
{
    const double steps = o->method->scheme->adaptive
                             ? usual_steps * pow(1e4 * o->method->tolerance, -0.25)
                             : (double)o->steps;
    return nanosecond * steps * br_method_cost(o->method, o->scene, o->n);
}

/* A march that ends when it has taken long enough. */
struct probe {
    double begun; /* s of this thread */
    size_t asked;
};

static bool is_over(void *self)
{
    static const double longest = 0.02;
    struct probe *p = self;
    return ++p->asked % 16 == 0 && br_thread_seconds() - p->begun > longest;
}

enum br_status br_march_pace(const struct br_planned_march *o, double *pace, struct br_error *err)
{
    enum { MESH = 400, MESH_OF_ADAPTIVE = 100, STEPS = 400 };
    const bool adaptive = o->method->scheme->adaptive;
    const size_t most = adaptive ? MESH_OF_ADAPTIVE : MESH;
    struct br_planned_march little = *o;
    struct br_march *march;
    little.n = o->n < most ? o->n : most;
    little.steps = adaptive ? o->steps : STEPS;
    *pace = 1;
    enum br_status status =
        br_march_create(&march, o->scene, little.n, little.steps, o->method, err);
    if (status)
        return status == BR_NO_MEMORY ? status : BR_OK;
    struct probe probe = {.begun = br_thread_seconds()};
    br_march_stop_when(march, is_over, &probe);
    while (!status && br_march_steps_done(march) < little.steps && !is_over(&probe))
        status = br_march_step(march, err);
    const double spent = br_thread_seconds() - probe.begun;
    /* an unfinished first level counts as half of one */
    const double done = fmax(0.5, (double)br_march_steps_done(march)) / (double)little.steps;
    br_march_free(march);
    if (!status || status == BR_INTERRUPTED)
        *pace = spent / done / br_march_seconds(&little);
    return status == BR_NO_MEMORY ? status : BR_OK;
}

/* ---- studies ---- */

/* ns, measured on one core, n = 100 to 3200, 1e3 to 1e4 time levels, scaled to the 3 GHz of
 * the solvers' costs. */
static const double measure_ns = 12;       /* to sample an element's field, and to project there */
static const double sample_fine_ns = 15;   /* to sample an element's field of a fine run */
static const double sample_exact_ns = 30;  /* to evaluate an element's field of a solution, */
static const double sample_given_ns = 100; /* of one that is given */
static const double create_ns = 3.3e7;     /* a solution of the continuous problem */

/* To evaluate both fields on n elements at so many levels. */
static double sampling(const struct br_scene *scene, double ns, size_t n, size_t levels)
{
    const double fields = (double)scene->axial.modelled + (double)scene->bending.modelled;
    return nanosecond * ns * fields * (double)n * (double)levels;
}

double br_measure_seconds(const struct br_scene *scene, size_t n, size_t levels)
{
    return sampling(scene, measure_ns, n, levels);
}

static struct br_planned_march cell_of(const struct br_study *s, size_t cell)
{
    return br_planned(s->scene, br_study_method(s, cell), br_study_resolution(s, cell));
}

static struct br_planned_march reference_of(const struct br_study *s)
{
    return br_planned(s->scene, &s->reference_method, s->reference);
}

double br_cell_seconds(const struct br_study *s, size_t cell)
{
    const struct br_planned_march march = cell_of(s, cell);
    return br_march_seconds(&march) + br_measure_seconds(s->scene, march.n, march.steps);
}

/* The reference is sampled at every time level of a cell: about as often as the cell of most
 * steps. */
double br_reference_seconds(const struct br_study *s)
{
    size_t levels = 0, n = 0;
    for (size_t j = 0; j < s->k_count; j++)
        levels = s->steps[j] > levels ? s->steps[j] : levels;
    for (size_t i = 0; i < s->n_count; i++)
        n = s->n[i] > n ? s->n[i] : n;
    if (!s->reference_kind->nests)
        return nanosecond * create_ns +
               sampling(s->scene,
                        s->reference_kind == &br_reference_mms ? sample_given_ns : sample_exact_ns,
                        n, levels);
    const struct br_planned_march fine = reference_of(s);
    return br_march_seconds(&fine) + sampling(s->scene, sample_fine_ns, fine.n, levels);
}

/* ---- the work of a command ---- */

static void add_time(struct br_costs *w, double seconds)
{
    w->seconds += seconds;
    w->longest = fmax(w->longest, seconds);
}

/* seconds: with its errors or samples. */
static void add(struct br_costs *w, const struct br_planned_march *march, double seconds)
{
    const double bytes = br_march_bytes(march);
    w->marches++;
    w->bytes = w->together ? w->bytes + bytes : fmax(w->bytes, bytes);
    if (march->method->scheme->adaptive) {
        w->untimed++;
        return;
    }
    if (seconds > w->longest)
        w->dearest = *march;
    add_time(w, seconds);
    w->steps += br_march_seconds(march);
}

void br_costs_add_march(struct br_costs *w, const struct br_planned_march *planned)
{
    add(w, planned, br_march_seconds(planned));
}

/* What a study keeps of time levels (study_march.h): a list of those of its cells, and the steps by
 * which the axial field of a fine run may be ahead. */
static double level_bytes(const struct br_study *s)
{
    const double step_ahead = 120; /* br_tip_path */
    double levels = 0;
    for (size_t j = 0; j < s->k_count; j++)
        levels += (double)s->steps[j];
    return levels * sizeof(size_t) +
           step_ahead * BR_STUDY_MARCH_BUFFERS * (double)(br_study_longest_gap(s) - 1);
}

void br_costs_add_study(struct br_costs *w, const struct br_study *s)
{
    w->bytes += level_bytes(s);
    for (size_t c = 0; c < br_study_cells(s); c++) {
        const struct br_planned_march cell = cell_of(s, c);
        add(w, &cell, br_cell_seconds(s, c));
    }
    const struct br_planned_march fine = reference_of(s);
    if (s->reference_kind->nests)
        add(w, &fine, br_reference_seconds(s));
    else
        add_time(w, br_reference_seconds(s));
}

void br_costs_measure(struct br_costs *w)
{
    const double before = w->seconds;
    double pace;
    struct br_error err;
    if (!w->dearest.scene || br_march_pace(&w->dearest, &pace, &err))
        return;
    w->seconds += (pace - 1) * w->steps;
    w->longest *= w->seconds / before;
}

double br_costs_seconds(const struct br_costs *w, int threads)
{
    return w->alone ? w->seconds : fmax(w->seconds / threads, w->longest);
}
