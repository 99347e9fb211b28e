/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Products of nodal values, and what a meter is made of; for energy*.c alone. */
#ifndef BR_REFERENCE_ENERGY_FORMS_H
#define BR_REFERENCE_ENERGY_FORMS_H

#include "reference/energy.h"
#include "reference/watched.h"
#include "solver/load.h"

typedef long double real;

/* a'Mb, and a'Kb of the stiffness without its coefficient; in: br_field_size values each. */
real br_mass_product(const struct br_field *field, const double *a, const double *b);
real br_bend_product(const struct br_field *field, const double *a, const double *b);

/* Of one field's state, J, with the contact's potential of an axial one. */
struct br_field_energy {
    real kinetic, stored, contact;
};
struct br_field_energy br_energy_of_field(const struct br_field *field,
                                          const struct br_contact *contact,
                                          const double *displacement, const double *velocity);

/* Rates of work at one time, W. */
struct br_power {
    real load, viscous, tip; /* tip: of the contact or the friction force, which resists */
    real load_size;          /* the sum of the sizes of the nodes' shares */
    real residual;           /* of what a sound stage's residual may do, over its relative size */
};

/* Since t = 0, J. */
struct br_field_work {
    real load, viscous, tip, scheme, contact, noise, gained;
    size_t steps, gaining;
};

struct br_meter_field {
    struct br_field field; /* as the scene has it */
    bool modelled;
    struct br_field_energy start, now;
    struct br_power before, row[BR_TEXTBOOK_ROWS]; /* at the step's beginning, and its stages */
    struct br_field_work work;
    struct br_step_load own; /* where there are no stages */
    real k;                  /* of the step, s */
    real largest;            /* sum of the sizes of a step's terms so far, J */
    double *scratch[2];      /* displacement and velocity, br_field_size values each */
};

struct br_energy_meter {
    struct br_march *march;
    const struct br_scene *scene;
    const struct br_method *method;
    struct br_watched seen;
    struct br_meter_field field[2]; /* by br_field_kind */
    double time;                    /* of the last look, s, where it is not */
    double limit, worst;            /* of the imbalance; worst: since the last call */
    double update;                  /* what a certificate allows the displacement's update */
    bool any;
    double *memory;
};

/* By the scheme's own sums: watching. Fails as br_energy_meter_create. */
enum br_status br_meter_watch(struct br_energy_meter *meter, struct br_error *err);

/* c'v, and the sum of the sizes of its terms (out). */
real br_nodal_product(const double *c, const double *v, size_t size, real *sizes);

#endif
