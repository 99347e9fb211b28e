/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The experiments of `beamrate extremes`: a registry. An experiment computes by a module of study/,
 * reports its results by one of tables/, and draws them by plots/. */
#ifndef BR_CLI_BEAM_EXTREMES_EXPERIMENT_H
#define BR_CLI_BEAM_EXTREMES_EXPERIMENT_H

#include "cli/beam/session.h"
#include "study/extremes/extremes.h"

/* Where the results go. All borrowed. */
struct br_extremes_output {
    struct br_session *session; /* for br_session_draw: the stems of pictures are the experiment's
                                   name, or begin with it and a dash */
    struct br_document *report; /* zeros; owned by the session */
    struct br_error *verdict;   /* zeros; BR_VERDICT: what is wrong */
};

/* An option that an experiment accepts, as a bit: others are refused. --threads is for all. */
#define BR_ACCEPTS(option) (1ull << BR_OPT_##option)
_Static_assert(BR_OPT_METHOD < 64, "a bit for each option");

enum { BR_EXTREMES_SCENES = BR_FLOOR_SCENES };

struct br_extremes_experiment {
    const char *name;                      /* one word, as on the command line, and of its files */
    const char *title;                     /* one line for a person */
    unsigned long long accepts;            /* BR_ACCEPTS */
    const char *scene[BR_EXTREMES_SCENES]; /* bundled ones, where the user names none */
    /* Computes, begins the report (its name is the experiment's) and puts everything into it but
     * the provenance, draws, and gives verdicts: a wrong result is a verdict, not a failure. Fails
     * with BR_BAD_INPUT, BR_NO_MEMORY, BR_INTERRUPTED, BR_IO. */
    enum br_status (*run)(const struct br_extremes_job *job, const struct br_extremes_output *to,
                          struct br_error *err);
};

/* In the order in which they run; ends with zeros (cli/beam/extremes_experiments.c). */
extern const struct br_extremes_experiment br_extremes_experiments[];

#endif
