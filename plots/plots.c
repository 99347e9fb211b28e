/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/plots.h"

#include <errno.h>
#include <string.h>

#include "study/scene/quote.h"

const struct br_plot *const br_plots[] = {&br_plot_h, &br_plot_k, &br_plot_parts, &br_plot_printed,
                                          NULL};

const struct br_plot *br_plot_find(const char *name)
{
    for (size_t i = 0; br_plots[i]; i++)
        if (strcmp(br_plots[i]->name, name) == 0)
            return br_plots[i];
    return NULL;
}

enum br_status br_plot_file(const struct br_plot *plot, const struct br_report *report,
                            const char *extension, char *file, size_t size, struct br_error *err)
{
    if (!br_is_name(report->name))
        return br_fail(err, BR_BAD_INPUT,
                       "the report's name is \"%s\", expected the beginning of a file name",
                       report->name);
    const int length = snprintf(file, size, "%s-%s%s%s", report->name, plot->name,
                                *extension ? "." : "", extension);
    if (length < 0 || (size_t)length >= size)
        return br_fail(err, BR_BAD_INPUT, "the report's name is too long for a file name");
    return BR_OK;
}

enum { LONGEST_NAME = 256, LONGEST_PATH = 4096 };

static enum br_status open_file(const struct br_plot *plot, const struct br_report *report,
                                const char *folder, const char *extension, FILE **out,
                                struct br_error *err)
{
    char file[LONGEST_NAME], path[LONGEST_PATH];
    const enum br_status status = br_plot_file(plot, report, extension, file, sizeof file, err);
    if (status)
        return status;
    const int length = snprintf(path, sizeof path, "%s/%s", folder, file);
    if (length < 0 || (size_t)length >= sizeof path)
        return br_fail(err, BR_BAD_INPUT, "the folder's name is too long");
    *out = fopen(path, "w");
    if (!*out)
        return br_fail(err, BR_IO, "cannot write %s: %s", path, strerror(errno));
    return BR_OK;
}

static enum br_status close_file(FILE *out, const char *folder, const struct br_plot *plot,
                                 struct br_error *err)
{
    const bool failed = ferror(out);
    errno = 0;
    if (fclose(out) != 0 || failed)
        return br_fail(err, BR_IO, "the plot %s could not be written in %s: %s", plot->name, folder,
                       errno ? strerror(errno) : "the disk may be full");
    return BR_OK;
}

enum br_status br_plot_write(const struct br_plot *plot, const struct br_report *report,
                             const char *folder, struct br_error *err)
{
    char stem[LONGEST_NAME];
    FILE *out = NULL;
    enum br_status status = br_plot_file(plot, report, "", stem, sizeof stem, err);
    if (!status)
        status = open_file(plot, report, folder, "dat", &out, err);
    if (status)
        return status;
    plot->write_data(out, report);
    status = close_file(out, folder, plot, err);
    if (!status)
        status = open_file(plot, report, folder, "gp", &out, err);
    if (status)
        return status;
    plot->write_script(out, report, stem);
    return close_file(out, folder, plot, err);
}
