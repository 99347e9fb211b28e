/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/session.h"

#include <string.h>

#include "base/quote.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/provenance.h"

struct br_session br_session_begin(const struct br_options *options)
{
    const bool writes = br_is_first();
    return (struct br_session){
        .out = br_option_text(options, BR_OPT_OUT),
        .set = br_option_text(options, BR_OPT_SET),
        .plots = !br_option_given(options, BR_OPT_NO_PLOTS),
        .format = options->number[BR_OPT_FORMAT],
        .formats = options->count[BR_OPT_FORMAT],
        .writes = writes,
        .quiet = br_option_given(options, BR_OPT_QUIET) || !writes,
        .threads = (int)br_option_number(options, BR_OPT_THREADS, 0),
    };
}

enum br_status br_session_alone(struct br_error *err)
{
    const int ranks = br_program.beam ? br_program.beam->size() : 1;
    return ranks == 1
               ? BR_OK
               : br_fail(err, BR_BAD_INPUT,
                         "found %d ranks, which disturb each other's times, expected one", ranks);
}

enum br_status br_session_open(struct br_session *s, struct br_error *err)
{
    return s->writes && s->out ? br_output_open(&s->output, s->out, err) : BR_OK;
}

void br_session_put_set(const struct br_session *s, struct br_document *report)
{
    for (const char *set = s->set, *end; set; set = *end ? end + 1 : NULL) {
        end = strchrnul(set, '\n');
        br_put_answer(report, "With --set %.*s", (int)(end - set), set);
    }
}

enum br_status br_session_report(struct br_session *s, size_t documents, struct br_error *err)
{
    s->document = br_allocate(documents, sizeof *s->document);
    s->documents = s->document ? documents : 0;
    return s->document ? BR_OK : br_no_memory(err, "the reports");
}

void br_session_draw(struct br_session *s, struct br_document *report, struct br_figure figure,
                     const char *title)
{
    struct br_figure *more = NULL;
    if (figure.panels && s->plots) {
        br_put_picture(report, figure.stem, title ? title : figure.title);
        more = realloc(s->figure, (s->figures + 1) * sizeof *more);
        s->lost |= !more;
    }
    if (more) {
        s->figure = more;
        s->figure[s->figures++] = figure;
    } else
        br_figure_clear(&figure);
}

/* ---- pictures ---- */

/* Warns of a picture that gnuplot has not drawn (what: its name). BR_INTERRUPTED: by a signal. */
static enum br_status picture_failed(const struct br_error *why, const char *what,
                                     struct br_error *err)
{
    if (br_signals_caught()) /* Ctrl-C ends gnuplot, too: the picture did not fail by itself */
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    br_print(
        stderr, &br_for_text,
        "beamrate: warning: %s is not drawn: %s; its script (*.gp), its data and all tables are "
        "kept\n",
        what, why->message);
    return BR_OK;
}

static enum br_status end_oldest(struct br_session *s, struct br_error *err)
{
    struct br_error why = {0};
    struct br_gnuplot oldest = s->at_work[0];
    memmove(s->at_work, s->at_work + 1, --s->drawn * sizeof *s->at_work);
    return br_gnuplot_end(&oldest, &why) ? picture_failed(&why, oldest.script, err) : BR_OK;
}

static enum br_status render(struct br_session *s, const char *script, struct br_error *err)
{
    struct br_error why = {0};
    if (s->missing)
        return BR_OK;
    if (s->drawn == sizeof s->at_work / sizeof *s->at_work && end_oldest(s, err))
        return err->status;
    if (br_gnuplot_start(&s->at_work[s->drawn], s->output.staging, script, &s->missing, &why))
        return s->missing ? BR_OK : picture_failed(&why, script, err);
    s->drawn++;
    return BR_OK;
}

/* Writes a figure's data and script, and starts gnuplot on it, if gnuplot is installed. */
static enum br_status draw(struct br_session *s, const struct br_figure *figure,
                           struct br_error *err)
{
    char name[BR_SCRIPT_NAME + 8];
    if (br_figure_check(figure, err))
        return err->status;
    for (int script = 0; script < 2; script++) {
        FILE *file;
        BR_SAY(name, "%s%s", figure->stem, script ? ".gp" : ".dat");
        if (br_output_file(&s->output, name, &file, err))
            return err->status;
        script ? br_figure_write_script(file, figure) : br_figure_write_data(file, figure);
        if (br_output_close(file, name, err))
            return err->status;
    }
    return render(s, name, err);
}

/* Waits for all pictures; prints once that gnuplot is missing. */
static enum br_status end_pictures(struct br_session *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    while (s->drawn)
        if (end_oldest(s, err))
            status = BR_INTERRUPTED;
    if (br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    if (!status && s->missing && !s->said) {
        s->said = true;
        fprintf(stderr, "beamrate: gnuplot is not installed: the pictures are written as scripts "
                        "(*.gp) and data, but not rendered\n");
    }
    return status;
}

/* ---- files ---- */

/* Writes one file: of one table, of a report, or, as a page, of all reports. */
static enum br_status write_file(const struct br_session *s, const struct br_document_format *f,
                                 const struct br_document *d, const struct br_document_table *table,
                                 struct br_error *err)
{
    char name[600] = "report.html";
    FILE *file;
    const bool page = f == &br_document_html, main = !table || table->flags & BR_MAIN;
    if (!page)
        snprintf(name, sizeof name, "%.400s%s%.100s%s", d->name, main ? "" : "-",
                 main ? "" : table->key, f->extension);
    if (br_output_file(&s->output, name, &file, err))
        return err->status;
    const enum br_status status =
        page ? br_document_print_page(file, d, s->documents, s->output.staging, err)
             : br_document_print(file, f, d, table, err);
    const enum br_status closed = br_output_close(file, name, status ? NULL : err);
    return status ? status : closed;
}

static enum br_status write_report(const struct br_session *s, const struct br_document_format *f,
                                   const struct br_document *d, struct br_error *err)
{
    size_t block = 0;
    if (br_document_status(d, err))
        return err->status;
    if (!f->by_table)
        return write_file(s, f, d, NULL, err);
    for (const struct br_document_table *t; (t = br_document_next_table(d, &block));)
        if (write_file(s, f, d, t, err))
            return err->status;
    return BR_OK;
}

static bool is_wanted(const struct br_session *s, const struct br_document_format *f)
{
    bool wanted = !s->formats;
    for (size_t i = 0; i < s->formats; i++)
        wanted |= br_document_formats[(size_t)s->format[i]] == f;
    return wanted;
}

/* The page contains the pictures, so it is written after them. */
enum br_status br_session_write(struct br_session *s, const struct br_document_format *const *f,
                                struct br_error *err)
{
    if (s->lost)
        return br_no_memory(err, "a figure");
    for (size_t i = 0; i < s->figures; i++)
        if (draw(s, &s->figure[i], err))
            return err->status;
    for (; *f; f++) {
        const bool page = *f == &br_document_html;
        if (!is_wanted(s, *f))
            continue;
        if (page && end_pictures(s, err))
            return err->status;
        for (size_t i = 0; i < (page ? 1 : s->documents); i++)
            if (write_report(s, *f, &s->document[i], err))
                return err->status;
    }
    return end_pictures(s, err) ? err->status : br_output_commit(&s->output, err);
}

enum br_status br_session_finish(struct br_session *s, struct br_error *err)
{
    enum br_status status = BR_OK;
    if (!s->quiet && s->documents) {
        status = br_document_show(stdout, s->document, s->documents, err);
        putchar('\n');
    }
    fflush(stdout); /* before anything can fail; main checks standard output at the end */
    if (status || !br_output_is_open(&s->output))
        return status;
    status = br_session_write(s, br_document_formats, err);
    if (!status && !s->quiet) {
        br_print(stdout, &br_for_text, "Written to %s/", s->output.folder);
        if (s->output.replaced || s->output.removed)
            printf("; of the files of an earlier run there %zu are replaced, %zu removed",
                   s->output.replaced, s->output.removed);
        fputc('\n', stdout);
    }
    return status;
}

void br_session_close(struct br_session *s)
{
    end_pictures(s, NULL);
    br_output_discard(&s->output);
    for (size_t i = 0; i < s->figures; i++)
        br_figure_clear(&s->figure[i]);
    free(s->figure);
    for (size_t i = 0; i < s->documents; i++)
        br_document_clear(&s->document[i]);
    free(s->document);
}

enum br_status br_failed_in(struct br_error *err, const char *name)
{
    const struct br_error inner = *err;
    return br_fail(err, inner.status, "%s: %.1000s", name, inner.message);
}
