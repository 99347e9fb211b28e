/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of loads whose jumps and peaks in x the elements' quadrature misses: the load vector of hat
 * functions on the mesh, by the rule that is marched with, is compared with that of the same hats
 * by the same rule on a much finer mesh, where they are sums of the finer hats. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/load.h"
#include "study/warnings.h"

/* Elements of the finer mesh, about, and how much finer it is at least. */
enum { FINE = 8192, LEAST_FINER = 2, MOST_FINER = 1024 };
static const size_t most_times = 5; /* at which a load with t is looked at */

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

/* Adds what the coarse vector lacks of the fine one. */
static void compare(const struct br_scene *scene, size_t n, size_t finer, const double *coarse,
                    const double *fine, struct missed *m)
{
    for (size_t i = 0; i <= n; i++) {
        double sum = 0;
        const size_t from = i ? (i - 1) * finer : 0, to = i < n ? (i + 1) * finer : n * finer;
        for (size_t j = from; j <= to; j++) {
            const double away = fabs((double)j - (double)(i * finer)) / (double)finer;
            sum += (1 - away) * fine[j];
        }
        const double miss = fabs(sum - coarse[i]);
        m->force += miss;
        if (miss > m->worst) {
            m->worst = miss;
            m->place = scene->length * (double)i / (double)n;
        }
    }
    for (size_t j = 0; j <= n * finer; j++)
        m->size += fabs(fine[j]);
}

/* The load at some times inside of [0, T] or, where its shape does not change, at one. */
static enum br_status measure(const struct br_load *load, const struct br_outlook *o, bool changes,
                              struct missed *m, struct br_error *err)
{
    const size_t times = changes ? most_times : 1;
    size_t finer = FINE / o->n / times; /* how many elements the finer mesh has in one */
    finer = finer < LEAST_FINER ? LEAST_FINER : finer > MOST_FINER ? MOST_FINER : finer;
    const struct br_field mesh[] = {hats(o->scene, o->n), hats(o->scene, o->n * finer)};
    const struct br_function none = {0};
    const struct br_forces forces = {load, &none, NULL};
    struct br_step_load on[2] = {0};
    enum br_status status = BR_OK;
    for (int i = 0; i < 2 && !status; i++)
        status = br_step_load_init(&on[i], &forces, &mesh[i], err);
    for (size_t i = 0; i < times && !status; i++) {
        const double t = o->scene->duration * ((double)i + 0.5) / (double)most_times;
        for (int j = 0; j < 2 && !status; j++)
            status = br_step_load_update(&on[j], &mesh[j], t, err);
        if (!status)
            compare(o->scene, o->n, finer, on[0].drive.vector, on[1].drive.vector, m);
    }
    for (int i = 0; i < 2; i++)
        br_step_load_clear(&on[i]);
    return status;
}

static enum br_status look_at(const struct br_load *load, const char *name,
                              const struct br_outlook *o, struct br_warnings *w,
                              struct br_error *err)
{
    struct missed m = {0};
    struct br_error failure = {0};
    size_t terms = 0;
    bool uses_x = false, uses_t = false;
    for (size_t i = 0; i < BR_LOAD_TERMS; i++) {
        const struct br_product *p = &load->term[i];
        if (br_product_is_zero(p))
            continue;
        terms++;
        uses_x |= p->space.uses_x;
        uses_t |= p->space.uses_t;
    }
    if (!uses_x)
        return BR_OK;
    const enum br_status status = measure(load, o, uses_t || terms > 1, &m, &failure);
    if (status == BR_NO_MEMORY)
        return br_fail(err, status, "%s", failure.message);
    if (status || !(m.force > large * m.size)) /* what is not finite, the march tells */
        return BR_OK;
    br_warn(w, BR_WARN_LOAD_SPACE, "more elements, as short as what happens there",
            "%s does inside of elements what their quadrature does not see: with n = %zu %.2g %% "
            "of it, most of it near x = %.4g m",
            name, o->n, 100 * m.force / m.size, m.place);
    return BR_OK;
}

static enum br_status look(const struct br_outlook *o, struct br_warnings *w, struct br_error *err)
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
