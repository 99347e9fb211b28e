/* SPDX-License-Identifier: GPL-3.0-or-later */
/* G of ida_system.h and its derivatives. */
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>

#include "solver/ida_laws.h"

/* The unknowns of one element: of its nodal values i = first ... last - 1, since the clamped node
 * has none, `place` is where the displacement stands, and the velocity is `unknowns` behind it. */
struct element {
    enum br_field_kind kind;
    size_t unknowns, first, last;
    size_t place[4];
};

static struct element element_of(const struct br_ida_system *s, enum br_field_kind kind, size_t e)
{
    const size_t unknowns = br_field_unknowns(&s->field[kind]);
    struct element element = {kind, unknowns, e == 0 ? unknowns : 0, 2 * unknowns, {0}};
    for (size_t i = element.first; i < element.last; i++)
        element.place[i] = br_ida_at(s, kind, e + i / unknowns) + i % unknowns;
    return element;
}

/* ---- the residual ---- */

/* residual -= F(t) */
static void take_loads(const struct br_ida_system *s, enum br_field_kind kind, double *residual)
{
    const struct br_drive *drive = &s->load[kind].drive;
    const size_t n = s->field[kind].n, unknowns = br_field_unknowns(&s->field[kind]);
    for (size_t node = 1; node <= n && drive->vector; node++)
        for (size_t c = 0; c < unknowns; c++)
            residual[br_ida_at(s, kind, node) + unknowns + c] -=
                drive->factor * drive->vector[node * unknowns + c];
    for (size_t c = 0; c < unknowns; c++)
        residual[br_ida_tip_row(s, kind) + c] -= drive->tip[c];
}

/* residual += rho M v' + C v + K w, and w' - v at the right node. */
static void add_element(const struct br_field *f, const struct element *e, const double *y,
                        const double *rate, double *residual)
{
    double stress[4] = {0}, force[4];
    for (size_t i = e->first; i < e->last; i++) {
        const double w = y[e->place[i]], v = y[e->place[i] + e->unknowns];
        stress[i] = f->stiffness * w + f->viscosity * v;
        if (i >= e->unknowns)
            residual[e->place[i]] = rate[e->place[i]] - v;
    }
    br_ida_elastic_force(f, stress, force);
    for (size_t i = e->first; i < e->last; i++) {
        double sum = force[i];
        for (size_t j = e->first; j < e->last; j++)
            sum += br_ida_mass(f, i, j) * rate[e->place[j] + e->unknowns];
        residual[e->place[i] + e->unknowns] += sum;
    }
}

static void add_tip_forces(const struct br_ida_system *s, const double *y, double *residual)
{
    if (s->modelled[BR_AXIAL])
        residual[br_ida_tip_row(s, BR_AXIAL)] +=
            s->scene->contact.stiffness * br_ida_penetration(s, y);
    if (!s->modelled[BR_BENDING])
        return;
    double *const tip = residual + br_ida_tip_row(s, BR_BENDING);
    *tip += br_ida_given_friction(s, y);
    if (br_ida_sticks(s))
        *tip = br_ida_tip_velocity(s, BR_BENDING, y);
}

int br_ida_residual(double t, N_Vector y, N_Vector rate, N_Vector residual, void *system)
{
    struct br_ida_system *s = system;
    if (br_ida_load(s, t, &s->err))
        return -1;
    double *const r = N_VGetArrayPointer(residual);
    memset(r, 0, s->count * sizeof *r);
    for (int i = BR_AXIAL; i <= BR_BENDING; i++) {
        const enum br_field_kind kind = (enum br_field_kind)i;
        if (!s->modelled[kind])
            continue;
        take_loads(s, kind, r);
        for (size_t e = 0; e < s->field[kind].n; e++) {
            const struct element element = element_of(s, kind, e);
            add_element(&s->field[kind], &element, N_VGetArrayPointer(y), N_VGetArrayPointer(rate),
                        r);
        }
    }
    add_tip_forces(s, N_VGetArrayPointer(y), r);
    return 0;
}

/* ---- its derivatives ---- */

static void add(SUNMatrix matrix, size_t row, size_t column, double value)
{
    SM_ELEMENT_B(matrix, (sunindextype)row, (sunindextype)column) += value;
}

/* of dG/dy + cj dG/dy', or with cj = 0 and `rates` of dG/dy' alone */
struct part {
    double displacement, velocity, rate; /* factors of dG/dw, dG/dv, dG/dy' */
};

static void add_blocks(const struct br_ida_system *s, const struct element *e, struct part part,
                       SUNMatrix matrix)
{
    const struct br_field *f = &s->field[e->kind];
    const size_t tip =
        e->kind == BR_BENDING && br_ida_sticks(s) ? br_ida_tip_row(s, BR_BENDING) : SIZE_MAX;
    for (size_t i = e->first; i < e->last; i++) {
        const size_t row = e->place[i] + e->unknowns;
        if (i >= e->unknowns) {
            add(matrix, e->place[i], e->place[i], part.rate);
            add(matrix, e->place[i], row, -part.velocity);
        }
        for (size_t j = e->first; j < e->last && row != tip; j++) {
            const double k = s->element_stiffness[e->kind][i][j];
            add(matrix, row, e->place[j], part.displacement * f->stiffness * k);
            add(matrix, row, e->place[j] + e->unknowns,
                part.velocity * f->viscosity * k + part.rate * br_ida_mass(f, i, j));
        }
    }
}

static void add_fields(const struct br_ida_system *s, struct part part, SUNMatrix matrix)
{
    for (int i = BR_AXIAL; i <= BR_BENDING; i++) {
        const enum br_field_kind kind = (enum br_field_kind)i;
        for (size_t e = 0; e < s->field[kind].n && s->modelled[kind]; e++) {
            const struct element element = element_of(s, kind, e);
            add_blocks(s, &element, part, matrix);
        }
    }
}

/* lambda = h(u) phi(v), h(u) being c_V (u - g) with Coulomb. */
static void add_friction(const struct br_ida_system *s, const double *y, SUNMatrix matrix)
{
    const size_t row = br_ida_tip_row(s, BR_BENDING);
    const double v = br_ida_tip_velocity(s, BR_BENDING, y);
    const bool creeps = s->regime.friction == BR_IDA_STICK;
    const double slope = s->regime.friction == BR_IDA_SLIP_UP ? 1 : -1;
    if (creeps)
        add(matrix, row, row, br_ida_bound(s, y) / s->mu);
    if (s->scene->friction.law == BR_COULOMB && s->regime.closed)
        add(matrix, row, br_ida_tip_row(s, BR_AXIAL) - 1,
            s->scene->friction.coefficient * (creeps ? v / s->mu : slope));
}

int br_ida_jacobian(double t, double cj, N_Vector y, N_Vector rate, N_Vector residual,
                    SUNMatrix jacobian, void *system, N_Vector a, N_Vector b, N_Vector c)
{
    (void)t, (void)rate, (void)residual, (void)a, (void)b, (void)c;
    const struct br_ida_system *s = system;
    add_fields(s, (struct part){1, 1, cj}, jacobian);
    if (s->modelled[BR_AXIAL] && s->regime.closed)
        add(jacobian, br_ida_tip_row(s, BR_AXIAL), br_ida_tip_row(s, BR_AXIAL) - 1,
            s->scene->contact.stiffness);
    if (br_ida_sticks(s))
        add(jacobian, br_ida_tip_row(s, BR_BENDING), br_ida_tip_row(s, BR_BENDING), 1);
    else if (s->modelled[BR_BENDING] && s->regime.friction != BR_IDA_FREE)
        add_friction(s, N_VGetArrayPointer(y), jacobian);
    return 0;
}

void br_ida_rate_matrix(const struct br_ida_system *s, SUNMatrix matrix)
{
    add_fields(s, (struct part){0, 0, 1}, matrix);
    if (br_ida_sticks(s)) /* v = 0 goes on */
        add(matrix, br_ida_tip_row(s, BR_BENDING), br_ida_tip_row(s, BR_BENDING), 1);
}
