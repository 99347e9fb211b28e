/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of a command that makes results: its folder is opened, it computes, its reports are
 * built and drawn, and then shown, written and put in place together, or not at all. Of several
 * ranks only the first one speaks and writes. */
#ifndef BR_CLI_SESSION_H
#define BR_CLI_SESSION_H

#include "base/kept.h"
#include "cli/option.h"
#include "cli/output.h"
#include "plots/pictures.h"
#include "solver/scene.h"
#include "study/foresee/foreseen.h"
#include "study/foresee/warnings.h"
#include "study/trade/split.h"
#include "study/trade/trial.h"
#include "study/verify/check.h"
#include "tables/document.h"

/* A scene as a command opens it. Begins as zeros; not to be moved. */
struct br_opened_scene {
    char path[1024]; /* of its file */
    char *text;      /* of the file, or what stands in it by --set; owned */
    struct br_scene scene;
};

struct br_session;

/* Finds a scene, loads its file once and reads it, with the keys of --set. Fails as br_scene_find,
 * br_scene_load and br_scene_read do; clear it even then. */
enum br_status br_opened_scene_read(struct br_opened_scene *scene, const struct br_session *session,
                                    const char *name, struct br_error *err);
void br_opened_scene_clear(struct br_opened_scene *scene);

/* Its strings are static, or the scene's. scene NULL: not of one scene. */
struct br_provenance br_provenance_of(const struct br_opened_scene *scene, int threads);

/* Begins with br_session_begin. */
struct br_session {
    const char *out;      /* the folder of --out; NULL: nothing is written */
    const char *set;      /* of --set: KEY=VALUE, a line each; NULL: not given */
    bool resume, plots;   /* --resume; without --no-plots */
    const double *format; /* formats of them: rows of br_document_formats, of --format; 0: all are
                             written. Borrowed from the options */
    size_t formats;
    bool writes;                  /* the first rank */
    bool quiet;                   /* --quiet, or another rank */
    int threads;                  /* of --threads; 0: all cores */
    struct br_document *document; /* `documents` of them; owned */
    size_t documents;
    struct br_output output;  /* of --out; not open without that option */
    struct br_figure *figure; /* `figures` of them, to be drawn; owned */
    size_t figures;
    bool lost;                    /* a figure, for lack of memory */
    struct br_gnuplot at_work[8]; /* gnuplots that draw side by side, while files are written */
    size_t drawn;
    bool missing; /* gnuplot is not installed */
    bool said;    /* this was printed */
};

struct br_session br_session_begin(const struct br_options *options);

/* Refuses several ranks (BR_BAD_INPUT), for work that measures time. */
enum br_status br_session_alone(struct br_error *err);

/* Makes the folder of --out, so call it before a long computation. Fails as br_output_open. */
enum br_status br_session_open(struct br_session *session, struct br_error *err);

/* Opens the store of finished work (out) in the folder of --out, which is open. With --resume,
 * stored work is used. Without a folder, or on several ranks, nothing is stored, and --resume is
 * refused (BR_BAD_INPUT). Fails with BR_IO, too. */
enum br_status br_session_keep(const struct br_session *session, struct br_kept *kept,
                               struct br_error *err);

/* Prints how much stored work was used, and warns of stored files that are damaged. */
void br_session_report_kept(const struct br_session *session, const struct br_kept *kept);

/* Says what --set has set, in a report without the title of a scene, which says it, too. */
void br_session_put_set(const struct br_session *session, struct br_document *report);

/* A scene and what --set has set in it, as words of a command line. Owned by the caller; NULL: out
 * of memory. */
char *br_session_scene(const struct br_session *session, const char *name);

/* Makes room for reports. Fails with BR_NO_MEMORY. */
enum br_status br_session_report(struct br_session *session, size_t documents,
                                 struct br_error *err);

/* Names a picture in a report and keeps it for br_session_finish, unless it has no panels or the
 * options ask for no pictures. Takes ownership of the figure. title NULL: the figure's own. */
void br_session_draw(struct br_session *session, struct br_document *report,
                     struct br_figure figure, const char *title);

/* Prints a sentence on standard error before work of some seconds: "24 marches, about 40 s, 0.3
 * GB". With --quiet nothing is printed. */
void br_session_announce(const struct br_session *session, const struct br_foreseen *work);

/* Writes the reports and pictures and puts all in place. For each of the formats (NULL-terminated)
 * that --format wants and each report there is a file NAME.EXTENSION; formats that have a table a
 * file have NAME.EXTENSION (the main table) and NAME-TABLE.EXTENSION; report.html has all reports.
 * A picture that fails costs no table and no exit code: a warning says which, and why. Fails as
 * br_figure_check, br_document_print and br_output_commit. */
enum br_status br_session_write(struct br_session *session,
                                const struct br_document_format *const *formats,
                                struct br_error *err);

/* Shows the reports on the terminal, with an empty line after each; then writes all if --out is
 * given. Fails as br_session_write; the reports are shown even then. */
enum br_status br_session_finish(struct br_session *session, struct br_error *err);

/* Removes what has not been put in place, and releases the rest. */
void br_session_close(struct br_session *session);

/* Puts a name before the message of a failure: "example2: ..."; returns its status. */
enum br_status br_failed_in(struct br_error *err, const char *name);

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
void br_warn_of_checks(const struct br_check *checks, size_t count);
void br_warn_of_trials(const struct br_scene *scene, const struct br_trial *trials, size_t count);

#endif
