/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of `beamrate extremes`: a registry. A part computes by a module of study/, says what it
 * has found by one of tables/, and draws it by plots/. */
#ifndef BR_CLI_EXTREMES_PART_H
#define BR_CLI_EXTREMES_PART_H

#include "cli/session.h"
#include "study/extremes/extremes.h"

/* Where what is found goes. All borrowed. */
struct br_extremes_output {
    struct br_session *session; /* for br_session_draw: the stems of pictures are the part's name,
                                   or begin with it and a dash */
    struct br_document *report; /* zeros; owned by the session */
    struct br_error *verdict;   /* zeros; BR_VERDICT: what has been found wrong */
};

/* An option that a part heeds, as a bit: others are refused. --threads is for all. */
#define BR_HEEDS(option) (1ull << BR_OPT_##option)
_Static_assert(BR_OPT_METHOD < 64, "a bit for each option");

struct br_extremes_part {
    const char *name;         /* one word, as on the command line, and of its files */
    const char *title;        /* one line for a person */
    unsigned long long heeds; /* BR_HEEDS; with RESUME it has job->kept, which others find NULL */
    /* Computes, begins the report (its name is the part's) and puts all into it but provenance,
     * draws, and judges: what is found wrong is a verdict, no failure. Fails with BR_BAD_INPUT,
     * BR_NO_MEMORY, BR_INTERRUPTED, BR_IO. */
    enum br_status (*run)(const struct br_extremes_job *job, const struct br_extremes_output *to,
                          struct br_error *err);
};

/* In the order in which they run; ends with zeros (cli/extremes_parts.c). */
extern const struct br_extremes_part br_extremes_parts[];

#endif
