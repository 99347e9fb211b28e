/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The assembled form that the peers share. The right side is one pass over the nodes, with -K w
 * from nodal differences, as in solver/umfpack.c, which loses less than an assembled K would. */
#include <stdlib.h>
#include <string.h>

#include "tests/bench/peers.h"

struct form {
    struct br_field field;
    size_t unknowns;
    struct peer_matrix matrix;
    const struct peer_library *library;
    void *factor;
    double *displacement, *velocity; /* nodal, clamped node included */
    double *response;                /* z, the solution for a unit force on the tip */
    double *rhs;                     /* workspace, nodal */
    const double *free_velocity;     /* v*, without the clamped node */
};

/* Stiffness of an element for unit material: B'B/h, or B' diag(1, 1/3) B/h^3. */
static double stiffness(const struct br_field *f, size_t a, size_t b)
{
    if (f->kind == BR_AXIAL)
        return (a == b ? 1 : -1) / f->h;
    static const double first[4] = {0, -1, 0, 1}, second[4] = {6, 3, -6, 3};
    return (first[a] * first[b] + second[a] * second[b] / 3) / (f->h * f->h * f->h);
}

static double entry(const struct br_field *f, size_t a, size_t b)
{
    const double mass = f->kind == BR_AXIAL ? br_axial_mass[a][b] : br_bending_mass[a][b];
    return f->density * f->h * mass / f->k +
           (f->viscosity + f->k * f->stiffness) * stiffness(f, a, b);
}

static void assemble(struct form *s)
{
    const size_t u = s->unknowns, rows = s->matrix.band + 1;
    for (size_t e = 0; e < s->field.n; e++)
        for (size_t a = 0; a < 2 * u; a++)
            for (size_t b = 0; b <= a; b++) {
                const size_t i = e * u + a, j = e * u + b;
                if (j >= u)
                    s->matrix.value[(j - u) * rows + i - j] += entry(&s->field, a, b);
            }
}

static size_t tip(const struct form *s)
{
    return s->field.n * s->unknowns;
}

static enum br_status solve(struct form *s, const double **solution, struct br_error *err)
{
    *solution = s->library->solve(s->factor, s->rhs + s->unknowns);
    return *solution ? BR_OK : br_fail(err, BR_SINGULAR, "a peer's solve failed");
}

enum br_status peer_create(const struct br_field *field, const struct peer_library *library,
                           void **self, struct br_error *err)
{
    struct form *s = br_allocate(1, sizeof *s);
    *self = s;
    if (!s)
        return br_no_memory(err, "a peer");
    s->field = *field;
    s->unknowns = br_field_unknowns(field);
    s->library = library;
    s->matrix.order = field->n * s->unknowns;
    s->matrix.band = 2 * s->unknowns - 1;
    const size_t nodal = br_field_size(field);
    s->displacement = br_allocate(4 * nodal, sizeof(double));
    s->matrix.value = br_allocate(s->matrix.order * (s->matrix.band + 1), sizeof(double));
    if (!s->displacement || !s->matrix.value)
        return br_no_memory(err, "a peer");
    s->velocity = s->displacement + nodal;
    s->response = s->velocity + nodal;
    s->rhs = s->response + nodal;
    assemble(s);
    enum br_status status = library->create(&s->matrix, &s->factor, err);
    s->rhs[tip(s)] = 1;
    if (!status)
        status = solve(s, &s->free_velocity, err);
    if (!status)
        memcpy(s->response + s->unknowns, s->free_velocity, s->matrix.order * sizeof(double));
    return status;
}

void peer_free(void *self)
{
    struct form *s = self;
    if (!s)
        return;
    if (s->factor)
        s->library->free(s->factor);
    free(s->displacement);
    free(s->matrix.value);
    free(s);
}

double peer_compliance(const void *self)
{
    const struct form *s = self;
    return s->response[tip(s)];
}

void peer_set(void *self, const double *displacement, const double *velocity)
{
    struct form *s = self;
    memcpy(s->displacement, displacement, br_field_size(&s->field) * sizeof(double));
    memcpy(s->velocity, velocity, br_field_size(&s->field) * sizeof(double));
}

void peer_get(const void *self, double *displacement, double *velocity)
{
    const struct form *s = self;
    if (displacement)
        memcpy(displacement, s->displacement, br_field_size(&s->field) * sizeof(double));
    if (velocity)
        memcpy(velocity, s->velocity, br_field_size(&s->field) * sizeof(double));
}

void peer_strain_rate(const void *self, double *rate)
{
    const struct form *s = self;
    for (size_t i = 0; i < s->field.n; i++)
        if (s->field.kind == BR_AXIAL)
            rate[i] = s->velocity[i + 1] - s->velocity[i];
        else
            br_curvature(s->velocity + 2 * i, rate + 2 * i);
}

/* rhs += M v/k - K w, each element's right half carried to the next node. */
static void add_axial(const struct form *s)
{
    const struct br_field *f = &s->field;
    const double mass = f->density * f->h / f->k, stiff = f->stiffness / f->h;
    const double *v = s->velocity, *w = s->displacement;
    double carried = 0;
    for (size_t i = 0; i < f->n; i++) {
        const double force = stiff * (w[i + 1] - w[i]);
        s->rhs[i] += carried + mass * (v[i] / 3 + v[i + 1] / 6) + force;
        carried = mass * (v[i] / 6 + v[i + 1] / 3) - force;
    }
    s->rhs[f->n] += carried;
}

static void add_bending(const struct form *s)
{
    const struct br_field *f = &s->field;
    const double mass = f->density * f->h / f->k, rigidity = f->stiffness / (f->h * f->h * f->h);
    double carried[2] = {0, 0};
    for (size_t i = 0; i < f->n; i++) {
        const double *v = s->velocity + 2 * i;
        double kappa[2], momentum[4];
        br_curvature(s->displacement + 2 * i, kappa);
        const double m0 = rigidity * kappa[0], m1 = rigidity / 3 * kappa[1];
        for (int a = 0; a < 4; a++)
            momentum[a] = mass * (br_bending_mass[a][0] * v[0] + br_bending_mass[a][1] * v[1] +
                                  br_bending_mass[a][2] * v[2] + br_bending_mass[a][3] * v[3]);
        s->rhs[2 * i] += carried[0] + momentum[0] - 6 * m1;
        s->rhs[2 * i + 1] += carried[1] + momentum[1] - (3 * m1 - m0);
        carried[0] = momentum[2] + 6 * m1;
        carried[1] = momentum[3] - (3 * m1 + m0);
    }
    s->rhs[2 * f->n] += carried[0];
    s->rhs[2 * f->n + 1] += carried[1];
}

enum br_status peer_predict(void *self, const struct br_drive *drive, double *velocity,
                            struct br_error *err)
{
    struct form *s = self;
    const size_t nodal = br_field_size(&s->field);
    for (size_t i = 0; i < nodal && drive->vector; i++)
        s->rhs[i] = drive->factor * drive->vector[i];
    if (!drive->vector)
        memset(s->rhs, 0, nodal * sizeof(double));
    for (size_t c = 0; c < s->unknowns; c++)
        s->rhs[tip(s) + c] += drive->tip[c];
    if (s->field.kind == BR_AXIAL)
        add_axial(s);
    else
        add_bending(s);
    const enum br_status status = solve(s, &s->free_velocity, err);
    *velocity = status ? 0 : s->free_velocity[tip(s) - s->unknowns];
    return status;
}

/* v = v* - r z,  w += k v */
double peer_finish(void *self, double force)
{
    struct form *s = self;
    const size_t u = s->unknowns;
    for (size_t i = 0; i < s->matrix.order; i++) {
        s->velocity[i + u] = s->free_velocity[i] - force * s->response[i + u];
        s->displacement[i + u] += s->field.k * s->velocity[i + u];
    }
    return s->velocity[tip(s)];
}

double peer_tip_displacement(const void *self)
{
    const struct form *s = self;
    return s->displacement[tip(s)];
}
