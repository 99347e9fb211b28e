/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot in a folder of its own, which is removed again. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "plots/gnuplot.h"
#include "plots/page.h"

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

enum { LINES = 17, MOST_POINTS = 2000 };

typedef double of_row(const struct br_history_row *row);

static double axial_of(const struct br_history_row *row)
{
    return row->displacement[BR_AXIAL];
}

static double bending_of(const struct br_history_row *row)
{
    return row->displacement[BR_BENDING];
}

static double contact_of(const struct br_history_row *row)
{
    return row->contact_force;
}

static double friction_of(const struct br_history_row *row)
{
    return row->friction_force;
}

static double bound_of(const struct br_history_row *row)
{
    return row->friction_bound;
}

struct curve {
    const char *title;
    of_row *value;
    bool wanted;
};

/* A page of one or two curves, in data blocks of the script itself. */
static void write_page(FILE *out, const char *title, const struct br_history_record *r,
                       const struct curve *curve, size_t count)
{
    const size_t every = r->rows > MOST_POINTS ? (r->rows - 1) / MOST_POINTS + 1 : 1;
    size_t shown = 0;
    for (size_t c = 0; c < count; c++) {
        if (!curve[c].wanted)
            continue;
        fprintf(out, "$d%zu << EOD\n", shown++);
        for (size_t i = 0; i < r->rows; i += every) {
            const double value = curve[c].value(&r->row[i]);
            if (isfinite(value))
                fprintf(out, "%.9g %.9g\n", r->row[i].time, value);
        }
        fputs("EOD\n", out);
    }
    if (!shown)
        return;
    fprintf(out, "%s\nset title '%s'\nplot ", shown > 1 ? "set key below" : "unset key", title);
    for (size_t c = 0, d = 0; c < count; c++)
        if (curve[c].wanted)
            fprintf(out, "%s$d%zu using 1:2 with lines title '%s'", d ? ", " : "", d,
                    curve[c].title),
                d++;
    fputc('\n', out);
}

static void write_pages(FILE *out, const struct br_scene *s, const struct br_history_record *r,
                        int columns)
{
    const bool rubs = s->friction.law != BR_FRICTIONLESS;
    fprintf(out,
            "set terminal dumb noenhanced size %d,%d\nset output '%s'\n"
            "set xlabel 'time (s)'\nset xrange [0:%.9g]\n",
            columns, LINES, output_name, s->duration);
    write_page(out, "horizontal displacement of the tip, u(L) (m)", r,
               (const struct curve[]){{"u", axial_of, s->axial.modelled}}, 1);
    write_page(out, "vertical displacement of the tip, w(L) (m)", r,
               (const struct curve[]){{"w", bending_of, s->bending.modelled}}, 1);
    write_page(out, "contact force (N)", r,
               (const struct curve[]){{"contact", contact_of, s->contact.modelled}}, 1);
    write_page(out, "friction force and its bound (N)", r,
               (const struct curve[]){{"friction", friction_of, rubs}, {"bound", bound_of, rubs}},
               2);
    fputs("unset output\n", out);
}

enum br_status br_gnuplot_letters(FILE *out, const struct br_scene *scene,
                                  const struct br_history_record *record, int columns,
                                  bool *missing, struct br_error *err)
{
    struct workshop w = {0};
    FILE *script = NULL, *output = NULL;
    *missing = false;
    enum br_status status = open_workshop(&w, &script, err);
    if (!status) {
        write_pages(script, scene, record, columns);
        status = run_workshop(&w, script, &output, missing, err);
    }
    for (int c; !status && (c = getc(output)) != EOF;)
        if (c != '\f')
            putc(c, out);
    close_workshop(&w, output);
    return status;
}
