/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a certificate is made of, for certificate.c and witness.c alone. */
#ifndef BR_REFERENCE_CERTIFICATE_PARTS_H
#define BR_REFERENCE_CERTIFICATE_PARTS_H

#include "reference/certificate.h"

/* Branches of a law: contact has two, open and closed; friction three, stick, slip up and down. */
enum { BR_CONTACT_BRANCHES = 2, BR_FRICTION_BRANCHES = 3, BR_MOST_BRANCHES = 3 };

/* A scheme's weights are up to 8, and its steps grow by 5. */
enum { BR_MOST_WEIGHT = 64 };

/* Nodal unknowns of a field's elements. */
static inline size_t br_step_unknowns(const struct br_method *method, enum br_field_kind kind)
{
    return kind == BR_AXIAL && method->axial_degree != 2 ? 1 : 2;
}

/* a over a size, or over the last bit of the largest such size so far (in/out: in the step) where
 * that is more; 0 for 0. */
double br_over_scale(const struct br_step *step, enum br_field_kind kind, enum br_scale scale,
                     double a, double size);

/* The larger of two numbers; NaN where one is. */
double br_worse_of(double a, double b);

/* The residual of (27) or (28), relative; 0 where the field is not modelled. */
double br_step_residual(const struct br_step *step, enum br_field_kind kind);

/* What a certificate says of one field alone: the other's entries are 0. */
struct br_certificate br_certify_field(const struct br_step *step, enum br_field_kind kind);

/* Distances (out) from each branch of a field's law prolonged beyond its end: contact that may
 * pull or be pressed and open, |lambda| beyond the bound. Returns how many there are; 0: the law
 * has no branches that could be held. */
int br_branch_distances(const struct br_step *step, enum br_field_kind kind,
                        double distance[BR_MOST_BRANCHES]);

#endif
