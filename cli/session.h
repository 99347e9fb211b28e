/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of a command that makes results: its folder is opened, it computes, its reports are
 * built and drawn, and then shown, written and put in place together, or not at all. Of several
 * ranks only the first one speaks and writes. */
#ifndef BR_CLI_SESSION_H
#define BR_CLI_SESSION_H

#include "cli/option.h"
#include "cli/output.h"
#include "plots/pictures.h"
#include "tables/document.h"

/* Begins with br_session_begin. */
struct br_session {
    const char *out;      /* the folder of --out; NULL: nothing is written */
    const char *set;      /* of --set: KEY=VALUE, a line each; NULL: not given */
    bool plots;           /* without --no-plots */
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

/* Says what --set has set, in a report without the title of a scene, which says it, too. */
void br_session_put_set(const struct br_session *session, struct br_document *report);

/* Makes room for reports. Fails with BR_NO_MEMORY. */
enum br_status br_session_report(struct br_session *session, size_t documents,
                                 struct br_error *err);

/* Names a picture in a report and keeps it for br_session_finish, unless it has no panels or the
 * options ask for no pictures. Takes ownership of the figure. title NULL: the figure's own. */
void br_session_draw(struct br_session *session, struct br_document *report,
                     struct br_figure figure, const char *title);

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

#endif
