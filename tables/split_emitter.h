/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where errors come from (study/trade/split.h), as text: one const record a format. */
#ifndef BR_TABLES_SPLIT_EMITTER_H
#define BR_TABLES_SPLIT_EMITTER_H

#include "study/trade/split.h"
#include "tables/document.h"
#include "tables/sentences.h"

struct br_split_page {
    const struct br_split *split; /* count runs of one scene; borrowed */
    size_t count;
    const struct br_provenance *provenance;
};

struct br_split_emitter {
    const char *name;      /* as on the command line */
    const char *extension; /* of its file, with the dot */
    const char *title;     /* one line for a person */
    /* Fails with BR_NO_MEMORY only: write errors stay in `out`. */
    enum br_status (*emit)(FILE *out, const struct br_split_page *page, struct br_error *err);
};

/* NULL-terminated; the first is the terminal's. */
extern const struct br_split_emitter *const br_split_emitters[];

/* One line of a run's table in one norm: a part, the sum of the parts, or the whole. */
struct br_split_line {
    const char *name;
    const char *none;                        /* why there is no such part; NULL: there is */
    double error[BR_PARTS], floor[BR_PARTS]; /* NaN: not modelled; no floor */
    double share;                            /* of the sum, total; NaN: cannot be told */
    double tip[2];                           /* by br_field_kind, m; NaN: not modelled */
};
size_t br_split_lines(const struct br_split *split);
struct br_split_line br_split_line(const struct br_split *split, size_t norm, size_t line);

/* "7.448e-04", "< 3.4e-16" below the floor, "-"; and a share, "99.8 %". Buffers: at least 32
 * bytes; each is returned. */
const char *br_split_error_text(const struct br_split_line *line, enum br_part part, char *buffer);
const char *br_split_share_text(const struct br_split_line *line, char *buffer);
const char *br_split_tip_text(const struct br_split_line *line, enum br_field_kind kind,
                              char *buffer);

/* "n = 100, k = 0.01 s: euler, contact lagged, friction exact, solver riccati" */
const char *br_split_run_text(const struct br_split *split, char *buffer, size_t size);

/* How parts are measured, once for all runs; what those of a run add up to. */
void br_split_say_chain(const struct br_split *split, const struct br_writer *w);
void br_split_say_run(const struct br_split *split, const struct br_writer *w);

#endif
