/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads whose jumps and peaks in x the elements' quadrature misses: the load vector of hat
 * functions by the rule that is marched with is compared with their integrals on a mesh on which
 * the load is proved to be resolved (load_mesh.h). */
#include <math.h>
#include <stdio.h>

#include "study/foresee/load_mesh.h"
#include "study/foresee/warnings.h"

enum { TIMES = 5 }; /* at which a load with t is looked at, beside that of its peak */

static const double large = 0.02; /* of the load's size */

struct missed {
    double force, size; /* that the rule does not see, and of the load; summed over times, N */
    double worst, place;
};

static struct br_field hats(const struct br_scene *scene, size_t n)
{
    struct br_scene axial = *scene;
    axial.axial.stiffness = axial.axial.viscosity = 1;
    return br_field_of_scene(&axial, BR_AXIAL, n, scene->duration);
}

/* Subtracts weight times the hats' integrals over one piece of element e from their vector. */
static void subtract_piece(const struct br_function *f, struct br_box box, struct br_interval piece,
                           double h, size_t e, double *vector)
{
    double value[BR_LOAD_PLACES];
    br_load_values(f, BR_X, box, piece, value);
    for (int i = 0; i < BR_LOAD_PLACES; i++) {
        const double x = piece.low + (piece.high - piece.low) * br_load_place[i],
                     part = (piece.high - piece.low) * br_load_weight[i] * value[i],
                     right = x / h - (double)e;
        vector[e] -= (1 - right) * part;
        vector[e + 1] -= right * part;
    }
}

static void subtract_exact(const struct br_function *f, struct br_box box,
                           const struct br_mesh *mesh, size_t n, double *vector)
{
    const double h = box.x.high / (double)n;
    size_t e = 0;
    for (size_t i = 0; i < mesh->count; i++)
        for (double from = mesh->at[i]; from < mesh->at[i + 1];) {
            const double end = e + 1 < n ? (double)(e + 1) * h : box.x.high,
                         to = fmin(end, mesh->at[i + 1]);
            if (to > from)
                subtract_piece(f, box, (struct br_interval){from, to}, h, e, vector);
            e += to >= end && e + 1 < n;
            from = to;
        }
}

/* A load that is looked at on its elements. */
struct sight {
    const struct br_scene *scene;
    struct br_field field;
    double *vector; /* n + 1 */
    struct missed missed;
    bool known; /* all could be resolved */
};

/* weight * f at one time */
static enum br_status compare(struct sight *s, const struct br_function *f, double weight, double t,
                              struct br_error *err)
{
    const struct br_box box = {{0, s->scene->length}, {t, t}};
    const size_t n = s->field.n;
    struct br_mesh mesh = {0};
    double size = 0;
    enum br_status status = br_assemble_load(&s->field, f, t, s->vector, err);
    if (!status)
        status = br_load_mesh(f, BR_X, box, &mesh, &size, err);
    s->known &= status != BR_BAD_INPUT;
    if (!status)
        subtract_exact(f, box, &mesh, n, s->vector);
    for (size_t i = 0; i <= n && !status; i++) {
        const double missed = weight * fabs(s->vector[i]);
        s->missed.force += missed;
        if (missed > s->missed.worst) {
            s->missed.worst = missed;
            s->missed.place = s->scene->length * (double)i / (double)n;
        }
    }
    s->missed.size += weight * size;
    br_mesh_free(&mesh);
    return status == BR_NO_MEMORY ? status : BR_OK; /* what is not finite, the march tells */
}

/* One term, at times inside of [0, T] and that of its peak or, where its shape does not change, at
 * one time. */
static enum br_status measure(struct sight *s, const struct br_product *p, struct br_error *err)
{
    const double duration = s->scene->duration;
    const struct br_box box = {{0, s->scene->length}, {0, duration}};
    struct br_interval values;
    struct br_box peak;
    double weight = 0;
    if (p->space.ops && !p->space.ops->bound)
        return BR_OK; /* of a solution that was given: nothing is proved of it */
    if (br_enclose_values(&p->time, box, 0, &values, &peak))
        weight = fmax(fabs(values.low), fabs(values.high));
    if (!p->space.uses_t)
        return compare(s, &p->space, (TIMES + 1) * weight, 0, err);
    s->known &= br_enclose_values(&p->space, box, 0, &values, &peak);
    enum br_status status = compare(s, &p->space, weight, peak.t.low, err);
    for (int i = 0; i < TIMES && !status; i++)
        status = compare(s, &p->space, weight, duration * (i + 0.5) / TIMES, err);
    return status;
}

static void tell(const char *name, const struct sight *s, struct br_warnings *w)
{
    const struct missed *m = &s->missed;
    const double missed = s->known ? m->force : INFINITY;
    const char *share = br_unseen(w, BR_WARN_LOAD_SPACE, missed, m->size, large);
    if (!s->known)
        br_warn(w, BR_WARN_LOAD_SPACE, "more elements, as short as what happens there",
                "%s changes so often in x that it is not known how much of it the elements' "
                "quadrature sees, with n = %zu",
                name, s->field.n);
    else if (share)
        br_warn(w, BR_WARN_LOAD_SPACE, "more elements, as short as what happens there",
                "%s does inside of elements what their quadrature does not see: with n = %zu %s "
                "of it, most of it near x = %.4g m",
                name, s->field.n, share, m->place);
}

static enum br_status look_at(const struct br_load *load, const char *name,
                              const struct br_planned_march *o, struct br_warnings *w,
                              struct br_error *err)
{
    struct sight s = {.scene = o->scene, .field = hats(o->scene, o->n), .known = true};
    bool uses_x = false;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++)
        uses_x |= !br_product_is_zero(&load->term[i]) && load->term[i].space.uses_x;
    if (!uses_x)
        return BR_OK;
    s.vector = br_allocate(o->n + 1, sizeof *s.vector);
    enum br_status status = s.vector ? BR_OK : br_no_memory(err, "a load vector");
    for (size_t i = 0; i < BR_LOAD_TERMS && !status; i++)
        if (!br_product_is_zero(&load->term[i]))
            status = measure(&s, &load->term[i], err);
    free(s.vector);
    if (!status)
        tell(name, &s, w);
    return status;
}

static enum br_status look(const struct br_planned_march *o, struct br_warnings *w,
                           struct br_error *err)
{
    const struct br_scene *s = o->scene;
    enum br_status status = BR_OK;
    if (s->axial.modelled)
        status = look_at(&s->axial.load, "the axial load", o, w, err);
    if (s->bending.modelled && !status)
        status = look_at(&s->bending.load, "the bending load", o, w, err);
    return status;
}

const struct br_warning_source br_warn_load_space = {
    .title = "loads inside of the elements",
    .look = look,
};
