/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene: all the data of problem (1)-(12), and nothing of how it is solved. A field or law that
 * is not modelled costs nothing. */
#ifndef BR_SOLVER_SCENE_H
#define BR_SOLVER_SCENE_H

#include "solver/function.h"
#include "solver/kind.h"

/* space(x, t) * time(t), N/m. Where space does not use t it is assembled once; where it does not
 * use x either, without quadrature. */
struct br_product {
    struct br_function space, time;
};

enum { BR_LOAD_TERMS = 8 };

/* A load per length, N/m: the sum of its terms. Terms that are zero cost nothing. */
struct br_load {
    struct br_product term[BR_LOAD_TERMS];
};

/* Whether space or time is the constant zero. */
bool br_product_is_zero(const struct br_product *product);
bool br_load_is_zero(const struct br_load *load);

/* The load at x, m, and t, s. */
double br_load_value(const struct br_load *load, double x, double t);

/* out becomes an independent copy, without terms that are zero; clear it even where this fails
 * (BR_NO_MEMORY). */
enum br_status br_load_clone(const struct br_load *load, struct br_load *out, struct br_error *err);
void br_load_clear(struct br_load *load);

/* A field: the rod of (3) and (8), or the beam of (4), (9) and (11). What a rod does not have is
 * zero. */
struct br_scene_field {
    bool modelled;
    double stiffness; /* a1, N; a2, N m^2 */
    double viscosity; /* c1, N s; c2, N m^2 s */
    struct br_load load;
    struct br_function tip_force;  /* of t, at x = L beside the contact or the friction, N */
    struct br_function tip_moment; /* beam: of t, at x = L, N m: works on the slope w_x */
    struct br_function displacement, velocity;             /* u0(x) or w0(x), m; v0(x), m/s */
    struct br_function displacement_slope, velocity_slope; /* beam: their derivatives, 1 and 1/s,
                                                              for Hermite interpolation */
    char *solution;                 /* owned; NULL, or u(x, t) or w(x, t), m, from which load, tip
                                       force and initial data were derived (reference/mms) */
    struct br_function given;       /* that solution */
    struct br_function stick_force; /* beam: of t, N: lambda of it while its tip sticks */
};

/* Normal compliance (10). */
struct br_contact {
    bool modelled;
    double gap;       /* g, m */
    double stiffness; /* c_H, N/m */
};

/* The stiffness, N/m, of a contact whose force is c_H (u - g)_+; NaN where a law is not linear in
 * u - g. All that holds for a linear force alone asks for it: closed forms, exact and given
 * solutions, certificates, energies. They refuse NaN, or pass it on to a check that fails. */
double br_contact_stiffness(const struct br_contact *contact);

/* What each of them is: br_friction_models in solver/laws.c. */
enum br_friction_law { BR_FRICTIONLESS, BR_TRESCA, BR_COULOMB, BR_FRICTION_LAWS };

/* Friction (12); the bound h(t) is c_V (Tresca) or c_V (u(L,t) - g)_+ (Coulomb). */
struct br_friction {
    enum br_friction_law law;
    double coefficient;    /* c_V, N for Tresca, N/m for Coulomb */
    double regularisation; /* mu of (29), m/s; 0: none given */
};

/* A number that is computed from other data of the scene: for reports. The texts are static. */
struct br_derived {
    const char *what, *from; /* as "axial.stiffness" and "young area" */
    const char *unit;
    double value;
};
enum { BR_MOST_DERIVED = 12 };

struct br_scene {
    char *name;      /* owned; one word */
    char *title;     /* owned; one line for a person */
    char *remark;    /* owned; NULL, or a note for the reader of the results */
    double length;   /* L, m */
    double duration; /* T, s */
    double density;  /* rho, kg/m */
    union {
        struct br_scene_field field[BR_FIELDS]; /* by br_field_kind */
        struct {
            struct br_scene_field axial, bending; /* the same ones by name */
        };
    };
    struct br_contact contact;
    struct br_friction friction;
    struct br_derived derived[BR_MOST_DERIVED]; /* up to the first without `what` */
};

/* Refuses (BR_BAD_INPUT) numbers that are not finite or have a sign that makes
 * no sense, and combinations that mean nothing (a bound that follows a contact, without contact).
 */
enum br_status br_scene_check(const struct br_scene *scene, struct br_error *err);

/* Function i of all that a scene has, borrowed; NULL from the last one on. */
struct br_function *br_scene_function(struct br_scene *scene, size_t i);

/* Releases what the scene owns; accepts a zeroed scene. */
void br_scene_clear(struct br_scene *scene);

#endif
