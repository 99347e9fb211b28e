/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A certificate for a step: is it a step of (27), (28), (10) and (12)? Computed from
 * the nodal values before and after it, with element matrices of its own (the
 * textbook's 12, 6, 4, 2) in long double, and nothing of a solver's numerics.
 *
 * Schemes other than Euler's are certified stage by stage. A stage is an Euler step of length
 * tau that starts at a sum Z of what was before. The step checker builds Z from the velocities and
 * the rates of change of earlier stages with the coefficients that the literature prints
 * (textbook.h), and decides by itself where a step starts anew. So a stage that passes obeys
 * the equations of motion and the laws at its own time, and belongs to that scheme.
 *
 * The norm of a residual. The residual of (28) is a set of nodal forces r. Its size as
 * a vector means nothing on a fine mesh: nodal values are rounded to one part in 1e16,
 * and K w magnifies that by h^-4. Its effect on the beam is measured by the bending
 * moment m that balances it, r'z = int m z_xx dx for every z of the space, and
 *     |m|_L2 = sup { r'z : |z_xx|_L2 = 1 },
 * found from the free end by summing forces and levers: no system is solved. For (27)
 * it is the normal force. A residual is given relative to the sum of the same norms of
 * the terms of the equation. Rounded nodal values then cost about 2^-53 n^2 in bending
 * and 2^-53 n in axial, and no solver can do better in these numbers. */
#ifndef BR_REFERENCE_CERTIFICATE_CERTIFICATE_H
#define BR_REFERENCE_CERTIFICATE_CERTIFICATE_H

#include "solver/march.h"
#include "solver/method.h"

/* How far a step, or the worst stage of one, is from each law; pure numbers, 0 for a perfect step,
 * NaN where the step has a value that is not finite or a law that is not known here. */
struct br_certificate {
    double axial_residual;   /* of (27) */
    double bending_residual; /* of (28) */
    double update; /* u_n - u_{n-1} - k v_n of both fields, or Y - Z - tau Y'; the stated values of
                      the tip; the stage's time and tau */
    double friction; /* distance of (v, lambda) from the graph of (12) or (29); lambda relative to
                        the bound, k v to the largest nodal value and to the distance that lambda
                        alone would move the tip */
    /* force - c_H (u - g)_+ at u_{n-1} or u_n, relative to the force, and to c_H times
     * displacements and the distance that the force alone would move the tip */
    double contact;
};
enum { BR_CERTIFICATE_ENTRIES = sizeof(struct br_certificate) / sizeof(double) };

/* Its numbers, one after the other. */
static inline double *br_certificate_entries(struct br_certificate *certificate)
{
    return &certificate->axial_residual;
}

/* Nodal values of one field around a step, or of Z and a stage, laid out as in solver/field.h. */
struct br_step_field {
    const double *displacement_before, *displacement; /* m */
    const double *velocity_before, *velocity;         /* m/s */
    const double *load;                               /* F_n, N */
};

/* What a certificate's numbers are relative to. */
enum br_scale {
    BR_SCALE_RESIDUAL, /* norms of an equation's terms */
    BR_SCALE_FIELD,    /* displacements, and k times velocities */
    BR_SCALE_LAW,      /* forces of the contact or friction law */
    BR_SCALES
};

/* All that is known of one step or stage. */
struct br_checked_step {
    const struct br_scene *scene;
    const struct br_method *method; /* which laws were to be used */
    size_t n;                       /* elements */
    double k;                       /* s; of a stage tau */
    double compliance[2]; /* z_tip by br_field_kind, m/s per N; 0: not known. The tip's velocity is
                             v* less the force times that, and rounded as these two are */
    struct br_step_field field[2]; /* by br_field_kind; of modelled fields */
    const double *axial_tip;       /* u(L), m, at the time of a stage of the bending field where
                                      field[BR_AXIAL] is not of that time; else NULL */
    struct br_tip tip;
    /* In/out: the largest scales of the march so far, BR_SCALES by br_field_kind. Values below
     * their last bit count as nothing, since they may underflow. NULL: only this step counts. */
    double (*largest)[BR_SCALES];
    double speed[2];  /* the largest by br_field_kind in the steps that this one's states were found
                         from, m/s; 0: the step counts alone */
    double size[2];   /* the same of the norms of the equation's terms, from `size_now` */
    double *size_now; /* out, by br_field_kind: the sum of these norms; NULL: not wanted */
    double inertia_round_off; /* what inertia adds to the predicted relative round-off of the field
                                 that is certified; 0: nothing */
};

/* BR_OK where no number of the certificate is above the one in `limits`; a NaN is.
 * Fails with BR_VERDICT, naming the first that is. */
enum br_status br_certificate_check(const struct br_certificate *certificate,
                                    const struct br_certificate *limits, struct br_error *err);

/* Limits of a sound step on n elements, given the predicted relative round-off of the solver's
 * displacements (br_march_round_off). Adaptive steps that end at a switch obey the laws as
 * accurately as the switch was found. */
struct br_certificate br_certificate_limits(const struct br_time_scheme *scheme, size_t n,
                                            double round_off);

/* Becomes the worse of the two, entry by entry; NaN is the worst. */
void br_certificate_merge(struct br_certificate *worst, const struct br_certificate *other);

/* Watches a march, stage by stage. */
struct br_step_checker;

/* Watches a march (br_march_watch) that has taken no step yet. The march, its scene and the method
 * must outlive the checker. Fails with BR_BAD_INPUT where the scheme is not in the tables of
 * textbook.h, with BR_NO_MEMORY; *checker is then NULL. */
enum br_status br_step_checker_create(struct br_step_checker **checker, struct br_march *march,
                                      const struct br_scene *scene, const struct br_method *method,
                                      struct br_error *err);
void br_step_checker_free(struct br_step_checker *checker); /* accepts NULL */

/* The certificate of the steps since the last call, the worst of all their stages; all NaN where
 * there was none. */
struct br_certificate br_step_checker_step(struct br_step_checker *checker);

/* ---- what a certificate is made of, for this folder alone ---- */

/* Branches of a law: contact has two, open and closed; friction three, stick, slip up and down. */
enum { BR_MOST_BRANCHES = 3 };

/* Nodal unknowns of a field's elements. */
static inline size_t br_step_unknowns(const struct br_method *method, enum br_field_kind kind)
{
    return kind == BR_AXIAL && method->axial_degree != 2 ? 1 : 2;
}

/* The larger of two numbers; NaN where one is. */
double br_worse_of(double a, double b);

/* The certificate of one field: the entries of the other are 0. */
struct br_certificate br_certify_field(const struct br_checked_step *step, enum br_field_kind kind);

/* Distances (out) from each branch of a field's law prolonged beyond its end: a closed contact that
 * pulls, an open one that is penetrated, |lambda| beyond the bound. Returns the number of branches;
 * 0: the law has none that can be kept active. */
int br_branch_distances(const struct br_checked_step *step, enum br_field_kind kind,
                        double distance[BR_MOST_BRANCHES]);

#endif
