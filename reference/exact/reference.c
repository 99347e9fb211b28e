/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference as a reference. */
#include <math.h>

#include "base/clock.h"
#include "reference/exact/exact.h"
#include "reference/reference.h"
#include "solver/modes.h"
#include "solver/scene.h"

struct exact_reference {
    const struct br_exact *exact; /* shared */
    struct br_exact_state *state;
    struct br_exact_projection **projection; /* by br_field_kind, measure and mesh */
    const struct br_scene *scene;
    size_t meshes, levels;
    int axial_degree;
    double seconds[2]; /* by br_field_kind */
};

static struct br_exact_projection **projection_at(const struct exact_reference *e,
                                                  enum br_field_kind kind, enum br_measure measure,
                                                  size_t mesh)
{
    return &e->projection[((size_t)kind * BR_MEASURES + (size_t)measure) * e->meshes + mesh];
}

static void exact_free(void *self)
{
    struct exact_reference *e = self;
    if (!e)
        return;
    for (size_t i = 0; e->projection && i < 2 * BR_MEASURES * e->meshes; i++)
        br_exact_projection_free(e->projection[i]);
    free(e->projection);
    br_exact_state_free(e->state);
    br_exact_give_back(e->exact);
    free(e);
}

static struct br_exact_quantity quantity_of(enum br_field_kind kind, enum br_measure measure)
{
    return (struct br_exact_quantity){
        .field = kind,
        .velocity = measure != BR_DISPLACEMENT,
        .order = measure != BR_STRAIN_RATE ? 0
                 : kind == BR_AXIAL        ? 1
                                           : 2,
    };
}

static enum br_status create_projections(struct exact_reference *e,
                                         const struct br_reference_request *r, struct br_error *err)
{
    e->projection = br_allocate(2 * BR_MEASURES * r->mesh_count, sizeof(void *));
    enum br_status status = e->projection ? BR_OK : br_no_memory(err, "the exact reference");
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++)
        for (enum br_measure measure = 0; measure < BR_TIP; measure++) {
            const struct br_exact_quantity quantity = quantity_of(kind, measure);
            const struct br_elements elements = {kind, r->axial_degree};
            const size_t meshes = r->measured[kind][measure] ? r->mesh_count : 0;
            for (size_t i = 0; i < meshes && !status; i++) {
                const struct br_exact_mesh mesh = {r->mesh[i],
                                                   br_mode_count(elements, measure) - 1};
                status = br_exact_projection_create(projection_at(e, kind, measure, i), e->exact,
                                                    &quantity, &mesh, err);
            }
        }
    return status;
}

static enum br_status exact_create(void **self, const struct br_reference_request *r,
                                   struct br_error *err)
{
    struct exact_reference *e = br_allocate(1, sizeof *e);
    *self = e;
    if (!e)
        return br_no_memory(err, "the exact reference");
    const double start = br_seconds();
    e->scene = r->scene;
    e->meshes = r->mesh_count;
    e->levels = r->levels;
    e->axial_degree = r->axial_degree;
    struct br_exact_options options = {.acceptable = 1e-5};
    if (r->modest)
        options.max_modes = 64;
    if (r->observer) {
        options.stop = r->observer->stop;
        options.stop_self = r->observer->self;
        options.progress = r->observer->preparing;
    }
    if (options.progress)
        options.progress(options.stop_self, 0); /* the loads are examined first */
    enum br_status status = br_exact_borrow(&e->exact, r->scene, &options, err);
    if (!status)
        status = br_exact_state_create(&e->state, e->exact, err);
    if (!status)
        status = create_projections(e, r, err);
    e->seconds[BR_AXIAL] = br_seconds() - start;
    return status;
}

static enum br_status exact_advance(void *self, enum br_field_kind kind, size_t i,
                                    struct br_error *err)
{
    struct exact_reference *e = self;
    (void)err;
    const double start = br_seconds();
    br_exact_field_at(e->exact, kind, e->scene->duration * (double)i / (double)e->levels, e->state);
    e->seconds[kind] += br_seconds() - start;
    return BR_OK;
}

static void exact_sample(void *self, const struct br_sample_at *at, struct br_view *view)
{
    struct exact_reference *e = self;
    if (at->measure == BR_TIP) {
        br_view_modes(view, 0);
        *view->values = e->state->tip[at->kind].displacement;
        return;
    }
    br_view_modes(view,
                  br_mode_count((struct br_elements){at->kind, e->axial_degree}, at->measure));
    br_exact_projection_apply(*projection_at(e, at->kind, at->measure, at->mesh), e->state,
                              view->values, &view->rest);
}

/* Finds the shortest phase: it ends with the next event of its field. The last ones go on. */
static void find_shortest(const struct br_exact *exact, struct br_reference_report *report)
{
    size_t count;
    const struct br_exact_event *event = br_exact_events(exact, &count);
    for (size_t i = 0; i < count; i++) {
        size_t next = i + 1;
        while (next < count && event[next].field != event[i].field)
            next++;
        const double length = next < count ? event[next].time - event[i].time : INFINITY;
        if (isfinite(length) &&
            (report->shortest.length == 0 || length < report->shortest.length)) {
            report->shortest.from = event[i].time;
            report->shortest.length = length;
            report->shortest.phase = (int)event[i].phase;
        }
    }
}

/* A root mean square over the beam, times sqrt(L), is an L2 norm. */
static struct br_reference_report exact_report(const void *self)
{
    const struct exact_reference *e = self;
    const double length = e->scene->length;
    struct br_reference_report report = {.seconds = e->seconds[BR_AXIAL] + e->seconds[BR_BENDING]};
    for (enum br_field_kind kind = BR_AXIAL; kind <= BR_BENDING; kind++) {
        const struct br_exact_size error = /* zeros where nothing is modelled */
            br_exact_report(e->exact, kind).error;
        double *own = report.own_error[kind];
        own[BR_DISPLACEMENT] = error.displacement * sqrt(length);
        own[BR_VELOCITY] = error.velocity * sqrt(length);
        own[BR_STRAIN_RATE] = error.strain_rate * sqrt(length);
        own[BR_TIP] = error.displacement;
    }
    find_shortest(e->exact, &report);
    return report;
}

/* Digits of an event's time that are not below its error. */
static int sure_digits(const struct br_exact_event *event)
{
    const double digits = floor(log10(event->time / event->error)) + 1;
    return (int)fmin(fmax(digits, 1), 12);
}

/* One line per event; the first ones of very many. */
static void exact_print_notes(const void *self, FILE *out)
{
    enum { MOST = 20 };
    const struct exact_reference *e = self;
    static const char *const subjects[] = {"", "tip "};
    size_t count;
    const struct br_exact_event *event = br_exact_events(e->exact, &count);
    for (size_t i = 0; i < count && i < MOST; i++) {
        if (event[i].time == 0)
            fprintf(out, "At t = 0: %s%s.\n", subjects[event[i].field],
                    event[i].phase == BR_OPEN ? "contact is open" : br_phase_text(event[i].phase));
        else
            fprintf(out, "At t = %.*g s (+- %.0e s): %s%s.\n", sure_digits(&event[i]),
                    event[i].time, event[i].error, subjects[event[i].field],
                    br_phase_text(event[i].phase));
    }
    if (count > MOST)
        fprintf(out, "%zu more events follow.\n", count - MOST);
}

const struct br_reference br_reference_exact = {
    .name = "exact",
    .syntax = "exact",
    .title = "the solution of the continuous problem, with an estimate of its own error",
    .citation = "reference/exact/exact.h: Legendre-Galerkin in space, Radau IIA in time, events "
                "located",
    .create = exact_create,
    .free = exact_free,
    .advance = exact_advance,
    .sample = exact_sample,
    .report = exact_report,
    .print_notes = exact_print_notes,
};
