/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/picture_files.h"

#include "cli/signals.h"
#include "study/scene/quote.h"

enum { NAME = 160 };

static void write_chart(FILE *out, const void *picture, bool script)
{
    script ? br_chart_write_script(out, picture) : br_chart_write_data(out, picture);
}

static void write_heat(FILE *out, const void *picture, bool script)
{
    script ? br_heat_write_script(out, picture) : br_heat_write_data(out, picture);
}

static enum br_status draw(struct br_picture_files *f, const char *stem, const void *picture,
                           void (*write)(FILE *, const void *, bool), struct br_error *err)
{
    char name[NAME];
    enum br_status status = BR_OK;
    for (int script = 0; script < 2 && !status; script++) {
        FILE *file = NULL;
        snprintf(name, sizeof name, "%s%s", stem, script ? ".gp" : ".dat");
        status = br_output_file(f->output, name, &file, err);
        if (status)
            return status;
        write(file, picture, script);
        status = br_output_close(file, name, err);
    }
    return status ? status : br_picture_files_render(f, name, err);
}

enum br_status br_picture_files_chart(struct br_picture_files *f, const struct br_chart *chart,
                                      struct br_error *err)
{
    return draw(f, chart->stem, chart, write_chart, err);
}

enum br_status br_picture_files_heat(struct br_picture_files *f, const struct br_heat *heat,
                                     struct br_error *err)
{
    return draw(f, heat->stem, heat, write_heat, err);
}

enum br_status br_picture_failed(const struct br_error *why, const char *what, struct br_error *err)
{
    if (br_signals_caught()) /* Ctrl-C ends gnuplot, too: that is no failure of its own */
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    fprintf(stderr, "beamrate: warning: ");
    br_quote(stderr, &br_for_text, what);
    fprintf(stderr, " is not drawn: ");
    br_quote(stderr, &br_for_text, why->message);
    fprintf(stderr, "; its script (*.gp), its data and all tables are kept\n");
    return BR_OK;
}

static enum br_status end_oldest(struct br_picture_files *f, struct br_error *err)
{
    char script[BR_SCRIPT_NAME];
    struct br_error why = {0};
    snprintf(script, sizeof script, "%s", f->renderer.at_work[0].script);
    return br_renderer_end_oldest(&f->renderer, &why) ? br_picture_failed(&why, script, err)
                                                      : BR_OK;
}

enum br_status br_picture_files_render(struct br_picture_files *f, const char *script,
                                       struct br_error *err)
{
    struct br_error why = {0};
    enum br_status status = BR_OK;
    if (!f->missing && f->renderer.count == BR_MOST_RENDERINGS)
        status = end_oldest(f, err);
    if (status || f->missing ||
        !br_renderer_add(&f->renderer, f->output->staging, script, &f->missing, &why))
        return status;
    return f->missing ? BR_OK : br_picture_failed(&why, script, err);
}

enum br_status br_picture_files_finish(struct br_picture_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    while (f->renderer.count)
        if (end_oldest(f, err))
            status = BR_INTERRUPTED;
    if (br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    if (!status && f->missing)
        fprintf(stderr, "beamrate: gnuplot is not installed: the pictures are written as scripts "
                        "(*.gp) and data, but not rendered\n");
    return status;
}
