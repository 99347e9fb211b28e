/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/picture_files.h"

#include <string.h>

#include "cli/signals.h"
#include "study/scene/quote.h"

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
    struct br_error why = {0};
    struct br_gnuplot oldest = f->at_work[0];
    memmove(f->at_work, f->at_work + 1, --f->count * sizeof *f->at_work);
    return br_gnuplot_end_figure(&oldest, &why) ? br_picture_failed(&why, oldest.script, err)
                                                : BR_OK;
}

static enum br_status render(struct br_picture_files *f, const char *script, struct br_error *err)
{
    struct br_error why = {0};
    enum br_status status = BR_OK;
    if (f->missing)
        return BR_OK;
    if (f->count == sizeof f->at_work / sizeof *f->at_work)
        status = end_oldest(f, err);
    if (status)
        return status;
    if (!br_gnuplot_start(&f->at_work[f->count], f->output->staging, script, NULL, &f->missing,
                          &why)) {
        f->count++;
        return BR_OK;
    }
    return f->missing ? BR_OK : br_picture_failed(&why, script, err);
}

enum br_status br_picture_files_draw(struct br_picture_files *f, const struct br_figure *figure,
                                     struct br_error *err)
{
    char name[BR_SCRIPT_NAME + 8];
    if (br_figure_check(figure, err))
        return err->status;
    for (int script = 0; script < 2; script++) {
        FILE *file;
        BR_SAY(name, "%s%s", figure->stem, script ? ".gp" : ".dat");
        enum br_status status = br_output_file(f->output, name, &file, err);
        if (status)
            return status;
        script ? br_figure_write_script(file, figure) : br_figure_write_data(file, figure);
        status = br_output_close(file, name, err);
        if (status)
            return status;
    }
    return render(f, name, err);
}

enum br_status br_picture_files_finish(struct br_picture_files *f, struct br_error *err)
{
    enum br_status status = BR_OK;
    while (f->count)
        if (end_oldest(f, err))
            status = BR_INTERRUPTED;
    if (br_signals_caught())
        status = br_fail(err, BR_INTERRUPTED, "interrupted");
    if (!status && f->missing && !f->said) {
        f->said = true;
        fprintf(stderr, "beamrate: gnuplot is not installed: the pictures are written as scripts "
                        "(*.gp) and data, but not rendered\n");
    }
    return status;
}
