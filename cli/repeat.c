/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate repeat REPORT.json: the command that made a report, once more, and what differs. */
#include <errno.h>
#include <fcntl.h>
#include <popt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "study/orders/process.h"
#include "study/orders/request.h"
#include "study/scene/file.h"
#include "study/scene/quote.h"
#include "tables/json_value.h"
#include "tables/reports.h"

enum { PATH = 1300 };

struct run {
    const char *path;                 /* of the report */
    json_t *was, *is;                 /* owned */
    const struct br_command *command; /* that made it */
    struct br_options options;        /* as it had them, then those of the new run */
    char folder[64];                  /* a temporary one; "": not made */
    char out[PATH];                   /* the new report */
    char scene[PATH];                 /* a copy of the scene as it was; "": not needed */
};

/* ---- the report ---- */

static enum br_status read_json(const char *path, json_t **json, struct br_error *err)
{
    json_error_t why;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno));
    *json = br_json_read(file, &why);
    close(file);
    return *json ? BR_OK
                 : br_fail(err, BR_BAD_INPUT, "%s:%d: not JSON: %s", path, why.line, why.text);
}

static const char *provenance_of(const json_t *report, const char *key)
{
    return json_string_value(json_object_get(json_object_get(report, "provenance"), key));
}

/* The command line that the report names, parsed as it was. */
static enum br_status parse_command(struct run *r, struct br_error *err)
{
    enum {
        REPEATED = BR_FOR_TABLES | BR_FOR_STUDY | BR_FOR_CHECK | BR_FOR_RUN | BR_FOR_TRADE |
                   BR_FOR_PLAN | BR_FOR_EXTREMES | BR_FOR_FIGURES
    };
    const char *line = provenance_of(r->was, "command_line"), **word = NULL;
    int words = 0;
    struct br_error inner = {0};
    if (!line || !*line || !provenance_of(r->was, "version"))
        return br_fail(err, BR_BAD_INPUT,
                       "%s: no provenance: found no provenance.command_line and .version, expected "
                       "a report that this program has written as JSON",
                       r->path);
    if (poptParseArgvString(line, &words, &word) == 0 && words > 1)
        r->command = br_find_command(word[1]);
    if (!r->command || !(r->command->bit & REPEATED))
        br_fail(
            &inner, BR_BAD_INPUT,
            "found '%.300s', expected one of beamrate's tables, study, check, run, trade, plan, "
            "extremes or figures",
            line);
    else
        br_options_parse(words - 1, word + 1, r->command, &r->options, &inner);
    free(word);
    return inner.status ? br_fail(err, inner.status, "%s: provenance.command_line: %.1000s",
                                  r->path, inner.message)
                        : BR_OK;
}

/* ---- the scene as it was ---- */

/* Where the scene's file is not what it was, its text is in the report. */
static enum br_status restore_scene(struct run *r, struct br_error *err)
{
    const char *path = provenance_of(r->was, "scene_path");
    const char *text = provenance_of(r->was, "scene_text");
    char *now = NULL;
    if (!path || !text || r->options.words != 1)
        return BR_OK;
    const bool there = strncmp(path, "/dev/", 5) != 0 && !br_scene_load(path, &now, NULL) &&
                       strcmp(now, text) == 0;
    free(now);
    if (there)
        return BR_OK;
    const char *slash = strrchr(path, '/');
    snprintf(r->scene, sizeof r->scene, "%s/%.1000s", r->folder, slash ? slash + 1 : path);
    FILE *file = fopen(r->scene, "wxe");
    const bool written = file && fputs(text, file) >= 0;
    if ((file && fclose(file) != 0) || !written)
        return br_fail(err, BR_IO, "%s: %s", r->scene, strerror(errno));
    free(r->options.word[0]);
    r->options.word[0] = strdup(r->scene);
    return r->options.word[0] ? BR_OK : br_no_memory(err, "the command");
}

/* ---- at work ---- */

/* Sends output to a temporary folder, or to one file if it was one. Options that write elsewhere,
 * or ask questions, are left out. */
static enum br_status redirect(struct run *r, struct br_error *err)
{
    static const enum br_option_id left_out[] = {
        BR_OPT_OUT,  BR_OPT_JSON,  BR_OPT_JUNIT,           BR_OPT_TAP,      BR_OPT_MARKDOWN,
        BR_OPT_PLOT, BR_OPT_QUIET, BR_OPT_UPDATE_BASELINE, BR_OPT_RESUME,   BR_OPT_ANIMATE,
        BR_OPT_KEEP, BR_OPT_TRUST, BR_OPT_FORMAT,          BR_OPT_NO_PLOTS, BR_OPT_GITHUB};
    struct br_options *o = &r->options;
    const char *name = json_string_value(json_object_get(r->was, "name"));
    const bool folder = br_option_of(r->command, BR_OPT_OUT) &&
                        (!br_option_given(o, BR_OPT_JSON) || br_option_given(o, BR_OPT_OUT));
    char file[200], out[100];
    snprintf(file, sizeof file, "%.190s", name ? name : "report");
    br_make_name(file);
    snprintf(out, sizeof out, "%s/out", r->folder);
    snprintf(r->out, sizeof r->out, folder ? "%s/out/%s.json" : "%s/report.json", r->folder, file);
    for (size_t i = 0; i < sizeof left_out / sizeof *left_out; i++)
        if (br_option_set(o, left_out[i], NULL, err))
            return err->status;
    const bool failed =
        br_option_set(o, folder ? BR_OPT_OUT : BR_OPT_JSON, folder ? out : r->out, err) ||
        (folder && br_option_set(o, BR_OPT_FORMAT, "json", err)) ||
        br_option_set(o, BR_OPT_NO_PLOTS, "", err) || br_option_set(o, BR_OPT_QUIET, "", err);
    return failed ? err->status : BR_OK;
}

/* A command that fails may have written its report, too. */
static enum br_status run_command(struct run *r, struct br_error *err)
{
    struct br_error inner = {0};
    const enum br_status status = r->command->run(&r->options, &inner);
    if (br_signals_caught())
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (status) {
        fputs("beamrate: ", stderr);
        br_quote(stderr, &br_for_text, inner.message);
        fputc('\n', stderr);
    }
    if (access(r->out, R_OK) == 0)
        return read_json(r->out, &r->is, err);
    return br_fail(err, BR_IO,
                   "%s: the repeated command wrote no such report: it ended with exit code %d; is "
                   "this the folder that it was run in?",
                   r->path, br_status_exit_code(status));
}

static enum br_status report(struct run *r, bool quiet, struct br_error *err)
{
    struct br_document d = {0};
    struct br_repeated found;
    char caption[400];
    snprintf(caption, sizeof caption, "Repeated: %.380s", provenance_of(r->was, "command_line"));
    br_document_begin(&d, "repeat", "beamrate repeat", 1, caption);
    br_report_repeated(r->was, r->is, &found, &d);
    br_put_answer(&d, "It was made by version %s (%s), and now by %s (%s).",
                  provenance_of(r->was, "version"), provenance_of(r->was, "commit"),
                  provenance_of(r->is, "version"), provenance_of(r->is, "commit"));
    if (*r->scene)
        br_put_answer(&d, "The scene's file is not what it was: its text in the report was taken.");
    if (found.different > BR_LONG_TABLE)
        br_put_answer(&d, "The first %d of them are shown.", BR_LONG_TABLE);
    const enum br_status status = quiet ? BR_OK : br_document_show(stdout, &d, err);
    br_document_clear(&d);
    if (!status && !found.compared)
        return br_fail(err, BR_BAD_INPUT, "%s: found nothing to compare, expected numbers",
                       r->path);
    if (status || !found.different)
        return status;
    return br_fail(err, BR_VERDICT, "%s: %zu of %zu values differ", r->path, found.different,
                   found.compared);
}

static enum br_status make_folder(struct run *r, struct br_error *err)
{
    const char *where = getenv("TMPDIR");
    snprintf(r->folder, sizeof r->folder, "%.30s/beamrate-repeat-XXXXXX",
             where && strlen(where) < 30 ? where : "/tmp");
    if (mkdtemp(r->folder))
        return BR_OK;
    br_fail(err, BR_IO, "%s: %s", r->folder, strerror(errno));
    r->folder[0] = '\0';
    return BR_IO;
}

static void clear(struct run *r)
{
    br_remove_folder(r->folder);
    br_options_clear(&r->options);
    json_decref(r->was);
    json_decref(r->is);
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    struct run r = {.path = options->words ? options->word[0] : NULL};
    if (br_session_alone(err))
        return err->status;
    if (!options->words)
        return br_fail(err, BR_BAD_INPUT,
                       "no report is given, expected a file that beamrate has written as JSON");
    const bool failed = read_json(r.path, &r.was, err) || parse_command(&r, err) ||
                        make_folder(&r, err) || restore_scene(&r, err) || redirect(&r, err) ||
                        run_command(&r, err) ||
                        report(&r, br_option_given(options, BR_OPT_QUIET), err);
    clear(&r);
    return failed ? err->status : BR_OK;
}

const struct br_command br_command_repeat = {
    .bit = BR_FOR_REPEAT,
    .name = "repeat",
    .arguments = "REPORT.json",
    .title = "repeats the command that made a report, and says what differs",
    .about = "Reads a report that beamrate has written as JSON, runs the command that made it once "
             "more, with the scene as it was, and says what differs: numbers beyond their stated "
             "error or round-off, verdicts, what only one of the two has. Exit code 1 where "
             "something does.",
    .more =
        "Times are not compared, and of trade and plan, whose choices depend on times, only the "
        "errors of trials. Nothing is written but into a temporary folder. Other files that "
        "the command line names are sought where they were, from the present folder.",
    .example = {"beamrate repeat results/example2.json"},
    .most_words = 1,
    .run = run,
};
