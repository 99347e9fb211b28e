/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the session of a command has of scenes. */
#ifndef BR_CLI_BEAM_SESSION_H
#define BR_CLI_BEAM_SESSION_H

#include "cli/session.h"
#include "solver/scene.h"
#include "study/estimate/warnings.h"
#include "study/grid/costs.h"
#include "study/trade/split.h"
#include "study/trade/trial.h"
#include "study/verify/check.h"

/* A scene as a command opens it. Begins as zeros; not to be moved. */
struct br_opened_scene {
    char path[1024]; /* of its file */
    char *text;      /* of the file, or what stands in it by --set; owned */
    struct br_scene scene;
};

/* Finds a scene, loads its file once and reads it, with the keys of --set. Fails as br_scene_find,
 * br_scene_load and br_scene_read do; clear it even then. */
enum br_status br_opened_scene_read(struct br_opened_scene *scene, const struct br_session *session,
                                    const char *name, struct br_error *err);
void br_opened_scene_clear(struct br_opened_scene *scene);

/* Its strings are static, or the scene's. scene NULL: not of one scene. */
struct br_provenance br_provenance_of(const struct br_opened_scene *scene, int threads);

/* Prints a sentence on standard error before work of some seconds: "24 marches, about 40 s, 0.3
 * GB". With --quiet nothing is printed. */
void br_session_announce(const struct br_session *session, const struct br_costs *work);

/* ---- warnings on standard error, before marches begin (warn.c) ---- */

/* Prints them, a line each: "beamrate: warning: ...; ...", with the scene's name where it is not
 * "". */
void br_print_warnings(const char *scene, const struct br_warnings *warnings);

/* The next two functions print the warnings that are cheap to find for a command's many marches,
 * scene by scene. This one serves cells of studies, runs of `trade --split`, and the paper's
 * examples in `figures`. Fails with BR_BAD_INPUT or BR_NO_MEMORY if a march is refused. */
enum br_status br_warn_of_studies(const struct br_study *studies, size_t count,
                                  struct br_error *err);
enum br_status br_warn_of_splits(const struct br_split *splits, size_t count, struct br_error *err);
enum br_status br_warn_of_paper(struct br_error *err);

/* The same for the marches of checks, and of trials of a scene: a refused march is one of their
 * results, not a failure. */
void br_warn_of_checks(const struct br_scene_check *checks, size_t count);
void br_warn_of_trials(const struct br_scene *scene, const struct br_trial *trials, size_t count);

#endif
