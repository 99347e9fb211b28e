/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate extremes [PART...]: where does it break, and does it say so? */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/documents.h"
#include "cli/extremes_part.h"
#include "cli/picture_files.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/signals.h"
#include "study/ranks/ranks.h"

enum { MOST_PARTS = 16 };

struct work {
    const struct br_options *options;
    const struct br_extremes_part *part[MOST_PARTS]; /* parts, in the registry's order */
    size_t parts;
    size_t *n; /* n_count; owned */
    size_t n_count;
    uint64_t seed;
    struct br_output output;
    struct br_provenance provenance;
    void *result[MOST_PARTS];
    struct br_document document[MOST_PARTS];
};

/* ---- what the options say ---- */

/* Which parts heed an option, as in the help: "map". */
static const char *heeders(unsigned option)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_extremes_part *const *p = br_extremes_parts; *p; p++) {
        const size_t used = strlen(text);
        if ((*p)->heeds & option)
            snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", (*p)->name);
    }
    return *text ? text : "no part";
}

static const struct {
    const char *option;
    enum br_option_id id;
    unsigned bit;
} heeded[] = {{"--n", BR_OPT_N, BR_HEEDS_N},
              {"--k", BR_OPT_K, BR_HEEDS_K},
              {"--cases", BR_OPT_CASES, BR_HEEDS_CASES},
              {"--seed", BR_OPT_SEED, BR_HEEDS_SEED},
              {"--rounding", BR_OPT_ROUNDING, BR_HEEDS_ROUNDING},
              {"--resume", BR_OPT_RESUME, BR_HEEDS_RESUME}};
enum { HEEDED = sizeof heeded / sizeof *heeded };

/* With the options that it heeds. */
static const char *part_title(size_t row)
{
    static char text[256];
    const struct br_extremes_part *part = br_extremes_parts[row];
    size_t used = (size_t)snprintf(text, sizeof text, "%.150s.", part->title);
    for (size_t i = 0; i < HEEDED && used < sizeof text; i++)
        if (part->heeds & heeded[i].bit)
            used += (size_t)snprintf(text + used, sizeof text - used, " %s", heeded[i].option);
    return text;
}

static const char *part_name(size_t row)
{
    return br_extremes_parts[row] ? br_extremes_parts[row]->name : NULL;
}

static const struct br_words parts = {part_name, part_title, NULL};

/* An option that no chosen part heeds would be dropped silently. */
static enum br_status check_heeded(const struct work *w, struct br_error *err)
{
    unsigned all = 0;
    for (size_t i = 0; i < w->parts; i++)
        all |= w->part[i]->heeds;
    for (size_t i = 0; i < HEEDED; i++)
        if (br_option_given(w->options, heeded[i].id) && !(all & heeded[i].bit))
            return br_fail(err, BR_BAD_INPUT, "%s: no chosen part heeds it; it is for %s",
                           heeded[i].option, heeders(heeded[i].bit));
    return BR_OK;
}

/* All that are wanted, in the registry's order whatever that of the words; none: all. */
static enum br_status choose_parts(struct work *w, struct br_error *err)
{
    for (size_t row = 0; br_extremes_parts[row] && w->parts < MOST_PARTS; row++) {
        size_t times = 0;
        for (size_t i = 0; i < w->options->words; i++)
            times += strcmp(w->options->word[i], br_extremes_parts[row]->name) == 0;
        if (times > 1)
            return br_fail(err, BR_BAD_INPUT, "part %s is given twice",
                           br_extremes_parts[row]->name);
        if (times || !w->options->words)
            w->part[w->parts++] = br_extremes_parts[row];
    }
    return BR_OK;
}

static enum br_status read_seed(const char *text, uint64_t *seed, struct br_error *err)
{
    char *end = NULL;
    const bool hexadecimal = text && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    const char *digits = text + (hexadecimal ? 2 : 0);
    if (!text)
        return BR_OK;
    errno = 0;
    const bool signless = *digits && strspn(digits, "0123456789abcdefABCDEF") == strlen(digits);
    const unsigned long long value = strtoull(text, &end, hexadecimal ? 16 : 10);
    if (!signless || *end || errno || value == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "--seed: found '%s', expected a whole number from 1 to 2^64 - 1, decimal or "
                       "0x and hexadecimal",
                       text);
    *seed = value;
    return BR_OK;
}

static enum br_status read_request(struct work *w, struct br_error *err)
{
    enum br_status status = choose_parts(w, err);
    if (!status)
        status = read_seed(br_option_text(w->options, BR_OPT_SEED), &w->seed, err);
    if (!status)
        status = br_option_counts(w->options, BR_OPT_N, &w->n, &w->n_count, err);
    return status ? status : check_heeded(w, err);
}

/* ---- what an interrupted part has left ---- */

enum { PATH = 1200 };

static void kept_path(const struct work *w, size_t i, char path[PATH])
{
    snprintf(path, PATH, "%s/%s.cases", w->output.folder, w->part[i]->name);
}

/* Hours of work are not thrown away without a word. */
static enum br_status check_kept(const struct work *w, struct br_error *err)
{
    char path[PATH];
    struct stat there;
    for (size_t i = 0; i < w->parts && !br_option_given(w->options, BR_OPT_RESUME); i++) {
        kept_path(w, i, path);
        if (w->part[i]->heeds & BR_HEEDS_RESUME && stat(path, &there) == 0)
            return br_fail(err, BR_BAD_INPUT,
                           "%s is what an interrupted run has left: --resume goes on with it; "
                           "remove it to begin anew",
                           path);
    }
    return BR_OK;
}

static enum br_status remove_kept(const struct work *w, struct br_error *err)
{
    char path[PATH];
    for (size_t i = 0; i < w->parts; i++) {
        kept_path(w, i, path);
        if (w->part[i]->heeds & BR_HEEDS_RESUME && unlink(path) < 0 && errno != ENOENT)
            return br_fail(err, BR_IO, "%s: %s", path, strerror(errno));
    }
    return BR_OK;
}

/* ---- computing ---- */

static enum br_status run_part(struct work *w, size_t i, struct br_error *err)
{
    const struct br_extremes_part *part = w->part[i];
    const struct br_options *o = w->options;
    char kept[PATH], what[64];
    struct br_error inner = {0};
    kept_path(w, i, kept);
    snprintf(what, sizeof what, "%s (%zu of %zu)", part->name, i + 1, w->parts);
    const struct br_extremes_job job = {
        .cases = (size_t)br_option_number(o, BR_OPT_CASES, 0),
        .seed = w->seed,
        .threads = (int)br_option_number(o, BR_OPT_THREADS, 0),
        .n = w->n,
        .k = o->number[BR_OPT_K],
        .n_count = w->n_count,
        .k_count = o->count[BR_OPT_K],
        .rounding = br_rounding_mode((size_t)br_option_number(o, BR_OPT_ROUNDING, 0)),
        .kept = part->heeds & BR_HEEDS_RESUME ? kept : NULL,
        .folder = w->output.staging,
        .observer = br_progress_start(what, br_option_given(w->options, BR_OPT_QUIET)),
    };
    const enum br_status status = part->run(&job, &w->result[i], &inner);
    br_progress_end();
    if (status)
        return br_fail(err, status, "%s: %.1000s", part->name, inner.message);
    return br_signals_caught() ? br_fail(err, BR_INTERRUPTED, "interrupted") : BR_OK;
}

/* ---- files ---- */

static void build_report(struct work *w, size_t i)
{
    struct br_document *d = &w->document[i];
    w->part[i]->report(w->result[i], d);
    br_put_provenance(d, &w->provenance);
}

/* The pictures of one part: into files, and their names into its report. */
static enum br_status draw(struct work *w, size_t part, struct br_picture_files *files,
                           struct br_error *err)
{
    enum br_status status = BR_OK;
    bool last = false;
    for (size_t i = 0; !status && !last; i++) {
        struct br_figure figure = {0};
        status = w->part[part]->draw(w->result[part], i, &figure, err);
        last = !figure.panels;
        if (!status && !last) {
            br_put_picture(&w->document[part], figure.stem, figure.title);
            status = br_picture_files_draw(files, &figure, err);
        }
        br_figure_clear(&figure);
    }
    return status;
}

/* The pictures first: they are rendered while the tables are written. */
static enum br_status write_all(struct work *w, struct br_error *err)
{
    struct br_picture_files files = {.output = &w->output};
    enum br_status status = BR_OK;
    for (size_t i = 0; i < w->parts && !status && !br_option_given(w->options, BR_OPT_NO_PLOTS);
         i++)
        if (w->part[i]->draw)
            status = draw(w, i, &files, err);
    if (!status)
        status = br_documents_write(&files, w->options, w->document, w->parts, err);
    const enum br_status drawn = br_picture_files_finish(&files, status ? NULL : err);
    return status ? status : drawn;
}

/* The first verdict that fails. */
static enum br_status judge(const struct work *w, struct br_error *err)
{
    for (size_t i = 0; i < w->parts; i++) {
        struct br_error inner = {0};
        const enum br_status status = w->part[i]->verdict(w->result[i], &inner);
        if (status)
            return br_fail(err, status, "%s: %.1000s", w->part[i]->name, inner.message);
    }
    return BR_OK;
}

static enum br_status work(struct work *w, struct br_error *err)
{
    enum br_status status = read_request(w, err);
    if (!status)
        status = br_output_open(&w->output, br_option_text(w->options, BR_OPT_OUT), err);
    if (!status)
        status = check_kept(w, err);
    for (size_t i = 0; i < w->parts && !status; i++)
        status = run_part(w, i, err);
    if (status)
        return status;
    br_provenance_fill(&w->provenance, (int)br_option_number(w->options, BR_OPT_THREADS, 0));
    for (size_t i = 0; i < w->parts; i++)
        build_report(w, i);
    status = write_all(w, err);
    if (!status && !br_option_given(w->options, BR_OPT_QUIET))
        status = br_documents_show(w->document, w->parts, err);
    if (!status)
        status = br_output_commit(&w->output, err);
    if (!status)
        status = remove_kept(w, err);
    if (!status && !br_option_given(w->options, BR_OPT_QUIET))
        br_output_announce(&w->output);
    return status ? status : judge(w, err);
}

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    struct work w = {.options = options};
    if (br_ranks_size() > 1)
        return br_fail(err, BR_BAD_INPUT,
                       "found %d ranks, expected one: its threads share the work", br_ranks_size());
    const enum br_status status = work(&w, err);
    br_output_discard(&w.output);
    for (size_t i = 0; i < w.parts; i++) {
        br_document_clear(&w.document[i]);
        w.part[i]->free(w.result[i]);
    }
    free(w.n);
    return status;
}

const struct br_command br_command_extremes = {
    .bit = BR_FOR_EXTREMES,
    .name = "extremes",
    .arguments = "[PART...]",
    .title = "where does it break, and does it say so?",
    .about =
        "Where does it break, and does it say so? Each part goes to one kind of extremes, compares "
        "what the theory predicts with what is measured, and writes tables and pictures. The "
        "verdict fails where a result is wrong and nothing said so. Without a PART all are "
        "tried.",
    .more =
        "Parts floors and steps hold every linear solver, and what steps gather, to the exact "
        "discrete solution in long double. Part stability has the limit of the lagged contact "
        "over its stiffness and k, predicted and measured by marches of one step. An option that "
        "no chosen part heeds is refused.",
    .example = {"beamrate extremes", "beamrate extremes map --cases 10 --seed 7",
                "beamrate extremes floors -n 100,1000 -k 0.01"},
    .most_words = BR_MOST_WORDS,
    .words = &parts,
    .run = run,
};
