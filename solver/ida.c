/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The peer: a general-purpose solver of differential-algebraic equations. */
#include <ida/ida.h>
#include <math.h>

#include "solver/ida_march.h"
#include "solver/integrator.h"

struct foreign {
    struct br_ida_march march;
    size_t steps; /* time levels */
};

static const double close_enough = 1e-13; /* of the duration */

static enum br_status refuse(const struct br_scene *scene, const struct br_method *method,
                             struct br_error *err)
{
    if (method->solver != br_linear_solvers[0])
        return br_fail(err, BR_BAD_INPUT,
                       "linear solver %s with scheme ida, expected none to be given: IDA solves "
                       "its systems itself",
                       method->solver->name);
    if (method->linear.kernel)
        return br_fail(err, BR_BAD_INPUT, "kernel %s with scheme ida, expected none to be given",
                       method->linear.kernel->name);
    if (method->friction->iterates)
        return br_fail(err, BR_BAD_INPUT,
                       "friction rule %s with scheme ida, expected exact or regularised",
                       method->friction->name);
    if (!(scene->density > 0))
        return br_fail(err, BR_BAD_INPUT, "density %g with scheme ida, expected more than 0",
                       scene->density);
    return BR_OK;
}

static void free_foreign(void *self)
{
    struct foreign *f = self;
    if (!f)
        return;
    br_ida_clear(&f->march);
    free(f);
}

static enum br_status create(void **self, const struct br_scene *scene, size_t n, size_t steps,
                             const struct br_method *method, struct br_error *err)
{
    const enum br_status status = refuse(scene, method, err);
    if (status)
        return status;
    struct foreign *f = br_allocate(1, sizeof *f);
    *self = f;
    if (!f)
        return br_no_memory(err, "a march of scheme ida");
    f->steps = steps;
    return br_ida_init(&f->march, scene, n, method, err);
}

static enum br_status advance(void *self, size_t level, struct br_error *err)
{
    struct foreign *f = self;
    struct br_ida_march *m = &f->march;
    const double end = m->system.scene->duration;
    const double t = end * (double)level / (double)f->steps;
    enum br_status status = BR_OK;
    while (!status && !(m->reached >= t - close_enough * end))
        status = br_ida_step(m, err);
    return status ? status : br_ida_see(m, fmin(t, m->reached), err);
}

static void get(const void *self, enum br_field_kind kind, double *displacement, double *velocity)
{
    const struct foreign *f = self;
    br_ida_nodal(&f->march.system, kind, N_VGetArrayPointer(f->march.seen), displacement, velocity);
}

static void strain_rate(const void *self, enum br_field_kind kind, double *rate)
{
    const struct foreign *f = self;
    br_ida_strain_rate(&f->march.system, kind, N_VGetArrayPointer(f->march.seen), rate);
}

static double tip_displacement(const void *self, enum br_field_kind kind)
{
    const struct foreign *f = self;
    return br_ida_tip_displacement(&f->march.system, kind, N_VGetArrayPointer(f->march.seen));
}

static void tip(const void *self, struct br_tip *out)
{
    *out = ((const struct foreign *)self)->march.tip;
}

static void counts(const void *self, struct br_counts *out)
{
    const struct foreign *f = self;
    *out = f->march.counts;
    br_ida_add_counts(&f->march, out);
}

static size_t switches(const void *self, const struct br_switch **first)
{
    const struct foreign *f = self;
    *first = f->march.found;
    return f->march.found_count;
}

static const struct br_integrator integrator = {
    .create = create,
    .free = free_foreign,
    .advance = advance,
    .get = get,
    .strain_rate = strain_rate,
    .tip_displacement = tip_displacement,
    .tip = tip,
    .counts = counts,
    .switches = switches,
};

const struct br_time_scheme br_ida = {
    .name = "ida",
    .title = "SUNDIALS IDA: orders 1 to 5 and steps by --tolerance, assembled stiffness form",
    .citation = "Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363-396; solver/ida_system.h",
    .order = 5,
    .adaptive = true,
    .integrator = &integrator,
    .bytes = 4100,
};
