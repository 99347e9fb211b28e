/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A moving picture of a recorded march. Nothing is computed here but scales. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "plots/pictures.h"
#include "study/run/history.h"
#include "study/scene/quote.h"

const struct br_movie_format br_movie_formats[] = {
    {".gif", "gif", "animated GIF", false},
    {".webp", "webp", "animated WebP", false},
    {"/", "pngcairo", "a folder of PNG frames", true},
    {0},
};

const struct br_movie_format *br_movie_format_of(const char *file)
{
    const size_t length = strlen(file);
    for (const struct br_movie_format *f = br_movie_formats; f->extension; f++) {
        const size_t ending = strlen(f->extension);
        if (length >= ending && strcmp(file + length - ending, f->extension) == 0)
            return f;
    }
    return NULL;
}

void br_movie_file(const struct br_movie *m, size_t frame, char *file, size_t size)
{
    if (m->format->frames)
        snprintf(file, size, "%s-%04zu.png", m->stem, frame + 1);
    else
        snprintf(file, size, "%s%s", m->stem, m->format->extension);
}

/* ---- scales ---- */

/* How much larger things are drawn than they are. */
struct scales {
    double axial, bending;    /* 1 */
    double contact, friction; /* m of the picture per N */
    double most_axial;        /* |u|, m */
};

/* The largest number 1, 2 or 5 times a power of ten that is no larger. */
static double round_down(double value)
{
    const double power = pow(10, floor(log10(value)));
    const double digit = value / power;
    return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/* What brings `most` to at most `wanted`; 1 where nothing moves. */
static double scale_to(double most, double wanted)
{
    return most > 0 && isfinite(most) ? round_down(wanted / most) : 1;
}

static double most_of_field(const struct br_history_record *r, enum br_field_kind kind)
{
    const size_t unknowns = r->unknowns[kind];
    double most = 0;
    for (size_t look = 0; look < r->looks; look++) {
        const double *nodal = br_history_field(r, look, kind, false);
        for (size_t i = 0; i <= r->n; i++)
            most = fmax(most, fabs(nodal[i * unknowns]));
    }
    return most;
}

static struct scales find_scales(const struct br_movie *m)
{
    const double length = m->scene->length;
    double contact = 0, friction = 0;
    for (size_t i = 0; i < m->record->looks; i++) {
        contact = fmax(contact, fabs(m->record->at[i].contact_force));
        friction = fmax(friction, fabs(m->record->at[i].friction_force));
    }
    const double axial = most_of_field(m->record, BR_AXIAL);
    const double gap = m->scene->contact.modelled ? m->scene->contact.gap : 0;
    return (struct scales){
        .axial = scale_to(fmax(axial, gap), 0.2 * length),
        .bending = scale_to(most_of_field(m->record, BR_BENDING), 0.3 * length),
        .contact = contact > 0 ? 0.25 * length / contact : 0,
        .friction = friction > 0 ? 0.2 * length / friction : 0,
        .most_axial = axial > 0 ? axial : 1,
    };
}

/* ---- data ---- */

enum { POINTS = 200 };

void br_movie_write_data(FILE *out, const struct br_movie *m)
{
    const struct br_history_record *r = m->record;
    const size_t every = r->n > POINTS ? r->n / POINTS : 1;
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, m->scene->title);
    fputs("# one block a frame: x (m) | u (m) | w (m)\n", out);
    for (size_t look = 0; look < r->looks; look++) {
        const double *u = br_history_field(r, look, BR_AXIAL, false);
        const double *w = br_history_field(r, look, BR_BENDING, false);
        fprintf(out, "# frame %zu: t = %.9g s\n", look + 1, r->at[look].time);
        for (size_t i = 0;; i = i + every < r->n ? i + every : r->n) {
            fprintf(out, "%.9g %.9g %.9g\n", (double)i / (double)r->n * m->scene->length,
                    u[i * r->unknowns[BR_AXIAL]], w[2 * i]);
            if (i == r->n)
                break;
        }
        fputs("\n\n", out);
    }
}

/* ---- the script ---- */

static void write_array(FILE *out, const char *name, const struct br_history_record *r,
                        size_t place)
{
    fprintf(out, "array %s[%zu] = [", name, r->looks);
    for (size_t i = 0; i < r->looks; i++) {
        const double value = *(const double *)((const char *)&r->at[i] + place);
        const bool none = isnan(value); /* the scheme has no friction force at t = 0 */
        fprintf(out, "%s%.9g", i == 0 ? "" : i % 8 ? ", " : ", \\\n    ", none ? 0 : value);
    }
    fputs("]\n", out);
}

static void write_head(FILE *out, const struct br_movie *m)
{
    const struct scales s = find_scales(m);
    char name[512], file[512], pictures[600];
    br_movie_file(m, 0, name, sizeof name);
    br_quoted(file, sizeof file, &br_for_text, name);
    BR_SAY(pictures, "%s%s", file, m->format->frames ? " and so on" : "");
    br_script_head(out, m->scene->title, m->stem, pictures);
    fprintf(
        out,
        "length = %.9g # m\ngap = %.9g # m\naxial_scale = %.9g\nbending_scale = %.9g\n"
        "contact_scale = %.9g # m per N\nfriction_scale = %.9g # m per N\nmost = %.9g # |u|, m\n",
        m->scene->length, m->scene->contact.modelled ? m->scene->contact.gap : 0, s.axial,
        s.bending, s.contact, s.friction, s.most_axial);
    write_array(out, "time", m->record, BR_ROW(time));
    write_array(out, "u", m->record, BR_ROW(displacement[BR_AXIAL]));
    write_array(out, "w", m->record, BR_ROW(displacement[BR_BENDING]));
    write_array(out, "speed", m->record, BR_ROW(velocity[BR_BENDING]));
    write_array(out, "contact", m->record, BR_ROW(contact_force));
    write_array(out, "friction", m->record, BR_ROW(friction_force));
    write_array(out, "bound", m->record, BR_ROW(friction_bound));
}

static void write_terminal(FILE *out, const struct br_movie *m)
{
    const size_t frames = m->record->looks;
    if (m->format->frames)
        fputs("set terminal pngcairo size 900,520 rounded font 'DejaVu Sans,13'\n", out);
    else
        fprintf(
            out,
            "set terminal %s animate delay %s loop 0 size 900,520 rounded font 'DejaVu Sans,13'\n",
            m->format->terminal, strcmp(m->format->terminal, "gif") == 0 ? "8" : "80");
    if (!m->format->frames) {
        fputs("set output ", out);
        char file[512];
        br_movie_file(m, 0, file, sizeof file);
        br_quote(out, &br_for_gnuplot, file);
        fputc('\n', out);
    }
    fprintf(out, "frames = %zu\n", frames);
}

static void write_stage(FILE *out, const struct br_movie *m)
{
    fprintf(out, "set label 1 ");
    br_quote(out, &br_for_gnuplot, m->scene->title);
    fprintf(
        out,
        " noenhanced at screen 0.03,0.95 left font ',17'\n"
        "set label 2 sprintf('u drawn %%g times as large, w %%g times', axial_scale, bending_scale) "
        "at screen 0.03,0.885 left\n"
        "set xrange [-0.05*length:1.5*length]; set yrange [-0.62*length:0.62*length]\n"
        "set lmargin at screen 0.03; set rmargin at screen 0.82\n"
        "set bmargin at screen 0.09; set tmargin at screen 0.9\n"
        "unset key; unset border; unset tics\n"
        "set palette defined (0 '#0072b2', 0.5 '#aaaaaa', 1 '#d55e00')\n"
        "set cbrange [-most:most]\n"
        "set label 7 'horizontal displacement u (m)' at screen 0.97,0.475 center rotate\n"
        "set colorbox user origin 0.84,0.15 size 0.02,0.65; set cbtics\n"
        "set object 1 rectangle from -0.04*length,-0.2*length to 0,0.2*length "
        "fc rgb '#888888' fs solid 1 noborder\n");
    if (m->scene->contact.modelled)
        fputs("edge = length + axial_scale*gap\n"
              "set object 2 rectangle from edge,-0.5*length to 1.5*length,0.5*length "
              "fc rgb '#dddddd' fs solid 1 noborder behind\n"
              "set label 3 'obstacle' at edge + 0.02*length,-0.46*length left\n",
              out);
}

/* Arrows from the tip: the contact pushes left, friction against the slip, lambda up being -. */
static void write_forces(FILE *out, const struct br_movie *m)
{
    fputs("    tx = length + axial_scale*u[i]; ty = bending_scale*w[i]\n"
          "    set label 4 sprintf('t = %.4f s', time[i]) at screen 0.97,0.95 right font ',17'\n",
          out);
    if (m->scene->contact.modelled)
        fputs(
            "    set label 5 sprintf('contact force %.4g N', contact[i]) at screen 0.03,0.045 left\n"
            "    if (contact[i] > 0) {\n"
            "        set arrow 1 from tx + contact_scale*contact[i],ty to tx,ty lw 4 "
            "lc rgb '#009e73' front\n"
            "    } else { unset arrow 1 }\n",
            out);
    if (m->scene->friction.law == BR_FRICTIONLESS)
        return;
    fputs(
        "    state = open(i) ? 'open' : speed[i] == 0 || abs(friction[i]) < bound[i] ? 'sticks' : "
        "'slips'\n"
        "    set label 6 sprintf('friction %.4g N of %.4g N: %s', abs(friction[i]), bound[i], state) "
        "at screen 0.32,0.045 left\n"
        "    set arrow 2 from tx,ty to tx,ty - friction_scale*friction[i] lw 4 "
        "lc rgb '#000000' front\n"
        "    # The bound, to both sides, as far as the picture reaches.\n"
        "    b = friction_scale*bound[i]; d = 0.03*length\n"
        "    if (b < 0.5*length) {\n"
        "        set arrow 3 from tx - d,ty + b to tx + d,ty + b nohead lw 3 lc rgb '#444444' front\n"
        "        set arrow 4 from tx - d,ty - b to tx + d,ty - b nohead lw 3 lc rgb '#444444' front\n"
        "    } else { unset arrow 3; unset arrow 4 }\n",
        out);
}

void br_movie_write_script(FILE *out, const struct br_movie *m)
{
    write_head(out, m);
    write_terminal(out, m);
    write_stage(out, m);
    fputs(m->scene->contact.modelled ? "open(i) = contact[i] <= 0\n" : "open(i) = 0\n", out);
    fputs("do for [i=1:frames] {\n", out);
    if (m->format->frames)
        fputs("    set output stem.sprintf('-%04d.png', i)\n", out);
    write_forces(out, m);
    fputs("    plot stem.'.dat' index i - 1 using ($1 + axial_scale*$2):(bending_scale*$3):2 "
          "with lines lw 8 lc palette\n}\nunset output\n",
          out);
}
