/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot in a folder of its own, which is removed again. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "plots/pictures.h"
#include "plots/render.h"
#include "study/run/history.h"

static const char script_name[] = "script.gp", output_name[] = "output";

enum { FOLDER = 1024, PATH = FOLDER + 16 };

struct workshop {
    char folder[FOLDER]; /* in $TMPDIR, or /tmp */
};

static enum br_status fail(const char *what, struct br_error *err)
{
    return br_fail(err, BR_IO, "%s: %s", what, strerror(errno));
}

static enum br_status open_workshop(struct workshop *w, FILE **script, struct br_error *err)
{
    char path[PATH];
    const char *parent = getenv("TMPDIR");
    const int length = snprintf(w->folder, sizeof w->folder, "%s/beamrate-XXXXXX",
                                parent && *parent ? parent : "/tmp");
    errno = ENAMETOOLONG;
    if ((size_t)length >= sizeof w->folder || !mkdtemp(w->folder)) {
        w->folder[0] = '\0';
        return fail("a folder for gnuplot", err);
    }
    snprintf(path, sizeof path, "%s/%s", w->folder, script_name);
    *script = fopen(path, "w");
    return *script ? BR_OK : fail(path, err);
}

/* Closes and runs the script; *output: what it wrote. */
static enum br_status run_workshop(const struct workshop *w, FILE *script, FILE **output,
                                   bool *missing, struct br_error *err)
{
    char path[PATH];
    *output = NULL;
    const bool failed = ferror(script);
    if (fclose(script) != 0 || failed)
        return br_fail(err, BR_IO, "gnuplot's script could not be written; the disk may be full");
    const enum br_status status = br_gnuplot_run(w->folder, script_name, missing, err);
    if (status)
        return status;
    snprintf(path, sizeof path, "%s/%s", w->folder, output_name);
    *output = fopen(path, "r");
    return *output ? BR_OK : fail(path, err);
}

static void close_workshop(const struct workshop *w, FILE *output)
{
    char path[PATH];
    if (output)
        fclose(output);
    if (!w->folder[0])
        return;
    snprintf(path, sizeof path, "%s/%s", w->folder, script_name);
    unlink(path);
    snprintf(path, sizeof path, "%s/%s", w->folder, output_name);
    unlink(path);
    rmdir(w->folder);
}

enum br_status br_gnuplot_has(const char *terminal, bool *has, bool *missing, struct br_error *err)
{
    struct workshop w = {0};
    FILE *script = NULL, *output = NULL;
    *has = *missing = false;
    enum br_status status = open_workshop(&w, &script, err);
    if (!status) {
        fprintf(script, "set print '%s'\nprint GPVAL_TERMINALS\nunset print\n", output_name);
        status = run_workshop(&w, script, &output, missing, err);
    }
    char name[64];
    while (!status && fscanf(output, "%63s", name) == 1)
        *has = *has || strcmp(name, terminal) == 0;
    close_workshop(&w, output);
    return *missing ? BR_OK : status;
}

/* ---- letters ---- */

double br_value_of_row(const struct br_history_row *row, enum br_row_value what)
{
    switch (what) {
    case BR_ROW_TIME:
        return row->time;
    case BR_ROW_AXIAL:
        return row->displacement[BR_AXIAL];
    case BR_ROW_BENDING:
        return row->displacement[BR_BENDING];
    case BR_ROW_SPEED:
        return row->velocity[BR_BENDING];
    case BR_ROW_CONTACT:
        return row->contact_force;
    case BR_ROW_FRICTION:
        return row->friction_force;
    case BR_ROW_STRESS:
        return -row->friction_force;
    case BR_ROW_BOUND:
        return row->friction_bound;
    }
    return NAN;
}

static void add_rows(const struct br_history_record *r, const char *title, enum br_row_value value,
                     struct br_panel *p)
{
    enum { MOST_POINTS = 2000 };
    const size_t every = r->rows > MOST_POINTS ? (r->rows - 1) / MOST_POINTS + 1 : 1;
    struct br_series *s = br_series_add(p, BR_PEN_LINE, "%s", title);
    for (size_t i = 0; i < r->rows; i += every)
        br_point_add(s, r->row[i].time, br_value_of_row(&r->row[i], value), NULL);
}

static struct br_panel *add_panel(struct br_figure *f, const char *label)
{
    struct br_panel *p = br_panel_add(f);
    BR_SAY(p->x_label, "time (s)");
    BR_SAY(p->y_label, "%s", label);
    return p;
}

enum br_status br_history_draw(const struct br_scene *scene, const struct br_history_record *r,
                               struct br_figure *f, struct br_error *err)
{
    *f = (struct br_figure){0};
    if (scene->axial.modelled)
        add_rows(r, "u", BR_ROW_AXIAL,
                 add_panel(f, "horizontal displacement of the tip, u(L) (m)"));
    if (scene->bending.modelled)
        add_rows(r, "w", BR_ROW_BENDING,
                 add_panel(f, "vertical displacement of the tip, w(L) (m)"));
    if (scene->contact.modelled)
        add_rows(r, "contact", BR_ROW_CONTACT, add_panel(f, "contact force (N)"));
    if (scene->friction.law != BR_FRICTIONLESS) {
        struct br_panel *p = add_panel(f, "friction force and its bound (N)");
        add_rows(r, "friction", BR_ROW_FRICTION, p);
        add_rows(r, "bound", BR_ROW_BOUND, p);
    }
    return br_figure_check(f, err);
}

enum br_status br_gnuplot_letters(FILE *out, const struct br_figure *figure, int columns,
                                  bool *missing, struct br_error *err)
{
    struct workshop w = {0};
    FILE *script = NULL, *output = NULL;
    *missing = false;
    enum br_status status = open_workshop(&w, &script, err);
    if (!status) {
        br_figure_write_letters(script, figure, columns, output_name);
        status = run_workshop(&w, script, &output, missing, err);
    }
    for (int c; !status && (c = getc(output)) != EOF;)
        if (c != '\f')
            putc(c, out);
    close_workshop(&w, output);
    return status;
}
