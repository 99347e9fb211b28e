/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march as it is seen by a watcher that samples each stage (br_march_watch) and knows the scheme
 * from textbook.h: the states of the step so far, and the textbook's row of each. */
#ifndef BR_REFERENCE_CERTIFICATE_WATCHED_H
#define BR_REFERENCE_CERTIFICATE_WATCHED_H

#include "reference/textbook.h"
#include "solver/march.h"

enum { BR_MOST_BACK = 3 };

/* Y = (displacement, velocity), and the rate of change of the velocity; br_past_states' size values
 * each, m, m/s, m/s^2. */
struct br_nodal {
    double *displacement, *velocity, *acceleration;
};

/* Of one field. The arrays are borrowed. */
struct br_past_states {
    size_t size;
    struct br_nodal past[BR_MOST_BACK];    /* Y_{n-1}, Y_{n-2}, Y_{n-3} */
    struct br_nodal row[BR_TEXTBOOK_ROWS]; /* of the textbook, in this step */
    struct br_nodal start;                 /* Z; without acceleration */
};

struct br_watched_field {
    struct br_past_states y; /* what the step starts from, and its rows so far */
    size_t steps, since;     /* steps so far, and since the last start */
    double began, now;       /* this step, and its last stage so far, s */
    enum br_regime regime;   /* then; it decides where a step starts anew */
    int last;                /* of the rows, the step's end; -1: not in the textbook */
    double *load;            /* of the last stage, N */
};

struct br_watched {
    struct br_march *march;
    void *watcher; /* samples it stage by stage */
    const struct br_scene *scene;
    const struct br_method *method;
    size_t n;
    int back, rows;                   /* earlier steps used, and rows of the textbook, at most */
    struct br_watched_field field[2]; /* by br_field_kind */
    double *memory;
};

/* Samples a march at t = 0. From then on the watcher samples its stages (br_march_watch), until the
 * watched is cleared. The march, its scene and the method must outlive the watched. Fails with
 * BR_BAD_INPUT where the scheme is not in textbook.h, with BR_NO_MEMORY; clear it even then. */
enum br_status br_watched_init(struct br_watched *watched, struct br_march *march,
                               const struct br_scene *scene, const struct br_method *method,
                               const struct br_march_watcher *watcher, struct br_error *err);
void br_watched_clear(struct br_watched *watched);

/* The textbook's step that a field is in. */
const struct br_textbook *br_watched_textbook(const struct br_watched *watched,
                                              enum br_field_kind kind);

/* Samples a stage: its state, rates of change and load. Returns tau, s; NAN where the textbook's
 * step has no such row. */
long double br_watched_stage(struct br_watched *watched, const struct br_march_stage *stage);

/* Goes on to the next step of a field; switched: as br_march_watcher's step gets it. */
void br_watched_step(struct br_watched *watched, enum br_field_kind kind, bool switched);

#endif
