/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/trade.h"

#include <string.h>

#include "base/load.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/verdicts.h"
#include "plots/pictures.h"

struct programs_run {
    const struct br_options *options; /* borrowed, as the session */
    struct br_session *session;
    const char *cost;              /* of --cost; "": not given */
    struct br_study_file *file;    /* owned */
    struct br_work_source *source; /* files, then others; owned */
    size_t files, sources;
    struct br_work_precision *works; /* owned */
    size_t count;
};

bool br_is_trade_source(const char *word)
{
    struct br_error err;
    char *text = NULL;
    const char *dot = strrchr(word, '.'), *slash = strrchr(word, '/');
    if (!br_is_yaml(word))
        return (strcmp(word, "-") == 0 && !br_program.beam) ||
               (dot && dot[1] && (!slash || dot > slash));
    const bool is =
        !br_text_load(word, BR_LONGEST_STUDY, "study file", &text, &err) && br_is_study_file(text);
    free(text);
    return is;
}

static enum br_status read_source(struct programs_run *r, const char *word, struct br_error *err)
{
    struct br_study_file *f = &r->file[r->files];
    struct br_work_source *s = &r->source[r->files++];
    const enum br_status status = br_study_file_open(word, r->options, f, err);
    f->request.cost = r->cost;
    s->path = f->request.path;
    return status;
}

static enum br_status read_all(struct programs_run *r, const struct br_work_source *other,
                               size_t others, struct br_error *err)
{
    const struct br_options *o = r->options;
    r->file = br_allocate(o->words + 1, sizeof *r->file);
    r->source = br_allocate(o->words + others + 1, sizeof *r->source);
    if (!r->file || !r->source)
        return br_no_memory(err, "the programs");
    err->status = BR_OK;
    for (size_t i = 0; i < o->words; i++)
        if ((!others || br_is_trade_source(o->word[i])) && read_source(r, o->word[i], err))
            return err->status;
    br_work_name_sources(r->source, r->files);
    for (r->sources = r->files; r->sources < r->files + others; r->sources++)
        r->source[r->sources] = other[r->sources - r->files];
    return BR_OK;
}

static enum br_status compute(struct programs_run *r, struct br_error *err)
{
    const struct br_observer *observer = br_progress_start("timing", r->session->quiet);
    enum br_status status = BR_OK;
    for (size_t i = 0; i < r->files && !status; i++) {
        br_progress_part(i, r->files);
        r->file[i].request.observer = observer;
        status = br_orders_read(&r->file[i].request, &r->source[i].numbers, err);
    }
    br_progress_end();
    status = br_progress_result(status, err);
    return status ? status
                  : br_work_find(r->source, r->sources, r->cost, &r->works, &r->count, err);
}

static enum br_status write_all(struct programs_run *r, struct br_error *err)
{
    struct br_provenance provenance;
    if (br_session_report(r->session, 1, err))
        return err->status;
    struct br_document *d = r->session->document;
    br_provenance_fill(&provenance, r->session->threads);
    bool runs = false;
    for (size_t i = 0; i < r->files; i++)
        runs |= r->file[i].request.command != NULL;
    br_report_work(r->works, r->count, runs ? provenance.machine : NULL, d);
    for (size_t i = 0; i < r->files; i++)
        if (r->source[i].numbers.taken)
            br_put_note(d, "%s: %s.", r->source[i].name, r->source[i].numbers.taken);
    br_session_draw(r->session, d, br_work_draw(r->works, r->count, d->caption),
                    "Errors over costs, with each program's own best and the front of all");
    br_put_provenance(d, &provenance);
    return br_session_finish(r->session, err);
}

enum br_status br_trade_sources(const struct br_options *options, struct br_session *session,
                                const struct br_work_source *other, size_t others,
                                struct br_error *err)
{
    const char *cost = br_option_text(options, BR_OPT_COST);
    struct programs_run r = {.options = options, .session = session, .cost = cost ? cost : ""};
    bool failed = br_session_alone(err) || read_all(&r, other, others, err) ||
                  br_session_open(session, err) || compute(&r, err) || write_all(&r, err);
    for (size_t i = 0; i < r.files && !failed; i++)
        if (br_numbers_check_runs(&r.source[i].numbers, err))
            failed = br_failed_in(err, r.source[i].name);
    br_work_clear(r.works, r.count);
    for (size_t i = 0; i < r.files; i++)
        br_study_file_clear(&r.file[i]);
    free(r.file);
    br_work_sources_clear(r.source, r.files); /* the others are borrowed */
    return failed ? err->status : BR_OK;
}
