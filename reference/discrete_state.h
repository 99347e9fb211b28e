/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What discrete.c looks after and discrete_step.c steps with; for these alone. */
#ifndef BR_REFERENCE_DISCRETE_STATE_H
#define BR_REFERENCE_DISCRETE_STATE_H

#include "reference/discrete.h"
#include "reference/discrete_load.h"
#include "reference/textbook.h"

/* Which branch of its law a field's tip is on. */
enum br_discrete_regime {
    BR_DISCRETE_NO_LAW,
    BR_DISCRETE_OPEN,
    BR_DISCRETE_CLOSED,
    BR_DISCRETE_STICK,
    BR_DISCRETE_FORWARD,
    BR_DISCRETE_BACKWARD
};

/* One field, and where its scheme is. */
struct br_discrete_part {
    bool modelled;
    size_t n, d;
    struct br_discrete_field field;
    struct br_discrete_load load;
    size_t since; /* steps since t = 0 or the last switch */
    enum br_discrete_regime regime;
};

/* The rod's tip over one step, for the friction bound. */
struct br_discrete_path {
    int count;
    long double time[BR_TEXTBOOK_ROWS],
        depth[BR_TEXTBOOK_ROWS]; /* of the stages: over k, and (u - g)_+, m */
    long double u[2], slope[2];  /* u and k u_t at both ends, m */
};

struct br_discrete {
    const struct br_scene *scene;
    const char *scheme;
    bool implicit, regularised;
    size_t steps, done;
    struct br_discrete_part part[2]; /* by br_field_kind */
    struct br_discrete_path path;
    struct br_discrete_tip tip;
};

/* One step of one field. Fails as br_discrete_step. */
enum br_status br_discrete_step_field(struct br_discrete *discrete, enum br_field_kind kind,
                                      struct br_error *err);

#endif
