/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/picture_files.h"

enum { NAME = 80 };

/* Opens stem + extension; NULL after a failure. */
static FILE *open_file(struct br_picture_files *f, const char *stem, const char *extension,
                       char name[NAME], struct br_error *err)
{
    FILE *file = NULL;
    snprintf(name, NAME, "%s%s", stem, extension);
    return br_output_file(f->output, name, &file, err) ? NULL : file;
}

static enum br_status render(struct br_picture_files *f, const char *script, struct br_error *err)
{
    if (f->missing)
        return BR_OK;
    const enum br_status status =
        br_renderer_add(&f->renderer, f->output->staging, script, &f->missing, err);
    return f->missing ? BR_OK : status;
}

enum br_status br_picture_files_chart(struct br_picture_files *f, const struct br_chart *chart,
                                      struct br_error *err)
{
    char name[NAME];
    FILE *file = open_file(f, chart->stem, ".dat", name, err);
    if (!file)
        return err->status;
    br_chart_write_data(file, chart);
    enum br_status status = br_output_close(file, name, err);
    if (status)
        return status;
    file = open_file(f, chart->stem, ".gp", name, err);
    if (!file)
        return err->status;
    br_chart_write_script(file, chart);
    status = br_output_close(file, name, err);
    return status ? status : render(f, name, err);
}

enum br_status br_picture_files_heat(struct br_picture_files *f, const struct br_heat *heat,
                                     struct br_error *err)
{
    char name[NAME];
    FILE *file = open_file(f, heat->stem, ".dat", name, err);
    if (!file)
        return err->status;
    br_heat_write_data(file, heat);
    enum br_status status = br_output_close(file, name, err);
    if (status)
        return status;
    file = open_file(f, heat->stem, ".gp", name, err);
    if (!file)
        return err->status;
    br_heat_write_script(file, heat);
    status = br_output_close(file, name, err);
    return status ? status : render(f, name, err);
}

enum br_status br_picture_files_finish(struct br_picture_files *f, struct br_error *err)
{
    const enum br_status status = br_renderer_finish(&f->renderer, err);
    if (!status && f->missing)
        fprintf(stderr, "beamrate: gnuplot is not installed: the plots are written as scripts "
                        "(*.gp) and data, but not rendered\n");
    return status;
}
