/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables as text: one const record a format. Emitters compute nothing. */
#ifndef BR_TABLES_EMITTER_H
#define BR_TABLES_EMITTER_H

#include <stdio.h>

#include "study/fit/report.h"
#include "tables/document.h"

struct br_emitter {
    const char *name;      /* as on the command line */
    const char *extension; /* of its file, with the dot */
    const char *title;     /* one line for a person */
    /* Writes one report; fails with BR_NO_MEMORY only: write errors stay in `out`. */
    enum br_status (*emit)(FILE *out, const struct br_report *report,
                           const struct br_provenance *provenance, struct br_error *err);
};

/* NULL-terminated; the first is the terminal's. */
extern const struct br_emitter *const br_emitters[];
const struct br_emitter *br_emitter_find(const char *name);

#endif
