/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A recorded march: the tip over time, and a moving picture. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "plots/pictures.h"
#include "study/run/history.h"
#include "study/scene/quote.h"

void br_rows_add(struct br_figure *f, const char *title, const struct br_history_record *r,
                 size_t place, double factor)
{
    struct br_series *s = br_series_add(f, BR_PEN_LINE, "%s", title);
    for (size_t i = 0; i < r->rows; i++) {
        const double *value = (const double *)((const char *)&r->row[i] + place);
        br_point_add(s, r->row[i].time, factor * *value, NULL);
    }
}

struct br_figure br_history_draw(const struct br_scene *scene, const struct br_history_record *r)
{
    struct br_figure figure = {.stem = "history"}, *f = &figure;
    BR_SAY(f->title, "The tip over time: %s", scene->title);
    if (scene->axial.modelled) {
        br_panel_add(f, "time (s)", "horizontal displacement, u(L) (m)");
        br_rows_add(f, "u", r, BR_ROW(displacement[BR_AXIAL]), 1);
    }
    if (scene->bending.modelled) {
        br_panel_add(f, "time (s)", "vertical displacement, w(L) (m)");
        br_rows_add(f, "w", r, BR_ROW(displacement[BR_BENDING]), 1);
    }
    if (scene->contact.modelled) {
        br_panel_add(f, "time (s)", "contact force (N)");
        br_rows_add(f, "contact", r, BR_ROW(contact_force), 1);
    }
    if (scene->friction.law != BR_FRICTIONLESS) {
        br_panel_add(f, "time (s)", "friction force and its bound (N)");
        br_rows_add(f, "friction", r, BR_ROW(friction_force), 1);
        br_rows_add(f, "bound", r, BR_ROW(friction_bound), 1);
        br_rows_add(f, "bound", r, BR_ROW(friction_bound), -1);
    }
    return figure;
}

/* ---- a movie: its script computes nothing but scales ---- */

void br_movie_write_data(FILE *out, const struct br_movie *m)
{
    enum { POINTS = 200 };
    const struct br_history_record *r = m->record;
    const size_t every = r->n > POINTS ? r->n / POINTS : 1;
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, m->scene->title);

    /* The tip in all frames. The scheme has no friction force at t = 0. */
    fputs("# index 0, the tip: t (s) | u (m) | w (m) | dw/dt (m/s) | contact force (N) | friction "
          "force (N) | its bound (N)\n",
          out);
    for (size_t frame = 0; frame < r->samples; frame++) {
        const struct br_history_row *at = &r->at[frame];
        fprintf(out, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", at->time, at->displacement[BR_AXIAL],
                at->displacement[BR_BENDING], at->velocity[BR_BENDING], at->contact_force,
                isnan(at->friction_force) ? 0 : at->friction_force, at->friction_bound);
    }

    for (size_t frame = 0; frame < r->samples; frame++) {
        const double *u = br_history_field(r, frame, BR_AXIAL, false);
        const double *w = br_history_field(r, frame, BR_BENDING, false);
        fprintf(out, "\n\n# index %zu: x (m) | u (m) | w (m) at t = %.9g s\n", frame + 1,
                r->at[frame].time);
        for (size_t i = 0;; i = i + every < r->n ? i + every : r->n) {
            fprintf(out, "%.9g %.9g %.9g\n", (double)i / (double)r->n * m->scene->length,
                    u[i * r->unknowns[BR_AXIAL]], w[2 * i]);
            if (i == r->n)
                break;
        }
    }
}

/* Factors by which displacements and forces are magnified: 1, 2 or 5 times a power of ten. */
static const char scales[] =
    "array time[frames]; array u[frames]; array w[frames]; array speed[frames]\n"
    "array contact[frames]; array friction[frames]; array bound[frames]\n"
    "stats data index 0 using (i = int($0) + 1, time[i] = $1, u[i] = $2, w[i] = $3, "
    "speed[i] = $4, contact[i] = $5, friction[i] = $6, bound[i] = $7, 0) nooutput\n"
    "larger(a, b) = a > b ? a : b\n"
    "size_of(low, high) = larger(abs(low), abs(high))\n"
    "stats data index 1:frames using 2 nooutput; most_u = size_of(STATS_min, STATS_max)\n"
    "stats data index 1:frames using 3 nooutput; most_w = size_of(STATS_min, STATS_max)\n"
    "stats data index 0 using 5 nooutput; most_contact = size_of(STATS_min, STATS_max)\n"
    "stats data index 0 using 6 nooutput; most_friction = size_of(STATS_min, STATS_max)\n"
    "down(x) = (p = 10.0**floor(log10(x)), d = x/p, p*(d >= 5 ? 5 : d >= 2 ? 2 : 1))\n"
    "scale(most, wanted) = most > 0 ? down(wanted/most) : 1\n"
    "axial_scale = scale(larger(most_u, gap), 0.2*length)\n"
    "bending_scale = scale(most_w, 0.3*length)\n"
    "contact_scale = most_contact > 0 ? 0.25*length/most_contact : 0 # m per N\n"
    "friction_scale = most_friction > 0 ? 0.2*length/most_friction : 0\n"
    "x_bar = down(0.25*length); u_bar = down(0.2*length/axial_scale); "
    "w_bar = down(0.2*length/bending_scale)\n";

static const char stage[] =
    "drawn(name, most, scale) = most > 0 ? sprintf('%s drawn %g times as large. ', name, scale) : ''\n"
    "set label 2 drawn('u', most_u, axial_scale).drawn('w', most_w, bending_scale) "
    "at screen 0.03,0.885 left\n"
    "set xrange [-0.05*length:1.5*length]; set yrange [-0.62*length:0.62*length]\n"
    "set lmargin at screen 0.03; set rmargin at screen 0.82\n"
    "set bmargin at screen 0.09; set tmargin at screen 0.9\n"
    "unset key; unset border; unset tics\n"
    "set palette defined (0 '#0072b2', 0.5 '#aaaaaa', 1 '#d55e00')\n"
    "set cbrange [(most_u > 0 ? -most_u : -1):(most_u > 0 ? most_u : 1)]\n"
    "unset colorbox\n"
    "if (most_u > 0) {\n"
    "    set label 7 'horizontal displacement u (m)' at screen 0.97,0.475 center rotate\n"
    "    set colorbox user origin 0.84,0.15 size 0.02,0.65; set cbtics\n"
    "}\n"
    "set object 1 rectangle from -0.04*length,-0.2*length to 0,0.2*length "
    "fc rgb '#888888' fs solid 1 noborder\n"
    "if (touches) {\n"
    "    edge = length + axial_scale*gap\n"
    "    set object 2 rectangle from edge,-0.5*length to 1.5*length,0.5*length "
    "fc rgb '#dddddd' fs solid 1 noborder behind\n"
    "    set label 3 'obstacle' at edge + 0.02*length,-0.46*length left\n"
    "}\n";

/* Scale bars for lengths and for displacements. */
static const char bars[] =
    "set arrow 11 from 0,-0.55*length to x_bar,-0.55*length heads back size 0.01*length,90\n"
    "set label 11 sprintf('x: %g m', x_bar) at 0,-0.5*length left font ',11'\n"
    "if (most_u > 0) {\n"
    "    set arrow 12 from 0.4*length,-0.55*length to 0.4*length + axial_scale*u_bar,-0.55*length "
    "heads back size 0.01*length,90\n"
    "    set label 12 sprintf('u: %g m', u_bar) at 0.4*length,-0.5*length left font ',11'\n"
    "}\n"
    "if (most_w > 0) {\n"
    "    set arrow 13 from 0.75*length,-0.57*length to 0.75*length,-0.57*length + "
    "bending_scale*w_bar heads back size 0.01*length,90\n"
    "    set label 13 sprintf('w: %g m', w_bar) at 0.77*length,-0.5*length left font ',11'\n"
    "}\n";

/* Arrows from the tip: the contact pushes left, friction acts against the slip (lambda < 0 is drawn
 * up). The friction bound is drawn on both sides, as far as the picture reaches. */
static const char forces[] =
    "    tx = length + axial_scale*u[i]; ty = bending_scale*w[i]\n"
    "    set label 4 sprintf('t = %.4f s', time[i]) at screen 0.97,0.95 right font ',17'\n"
    "    if (touches) {\n"
    "        set label 5 sprintf('contact force %.4g N', contact[i]) at screen 0.03,0.045 left\n"
    "        unset arrow 1; unset label 8\n"
    "    }\n"
    "    if (touches && contact[i] > 0) {\n"
    "        set arrow 1 from tx + contact_scale*contact[i],ty to tx,ty lw 4 "
    "lc rgb '#009e73' front\n"
    "        set label 8 'contact' at tx + contact_scale*contact[i] + 0.015*length,ty left "
    "font ',11' front\n"
    "    }\n"
    "    if (rubs) {\n"
    "        state = touches && contact[i] <= 0 ? 'open' : speed[i] == 0 || "
    "abs(friction[i]) < bound[i] ? 'sticks' : 'slips'\n"
    "        set label 6 sprintf('friction %.4g N of %.4g N: %s', abs(friction[i]), bound[i], "
    "state) at screen 0.32,0.045 left\n"
    "        set arrow 2 from tx,ty to tx,ty - friction_scale*friction[i] lw 4 "
    "lc rgb '#000000' front\n"
    "        unset label 9; f = friction_scale*friction[i]\n"
    "        if (abs(f) > 0.05*length) {\n"
    "            set label 9 'friction' at tx - 0.04*length,ty - f right font ',11' front\n"
    "        }\n"
    "        b = friction_scale*bound[i]; d = 0.03*length\n"
    "        unset arrow 3; unset arrow 4; unset label 10\n"
    "        if (b > 0 && b < 0.5*length) {\n"
    "            set arrow 3 from tx - d,ty + b to tx + d,ty + b nohead lw 3 lc rgb '#444444' front\n"
    "            set arrow 4 from tx - d,ty - b to tx + d,ty - b nohead lw 3 lc rgb '#444444' front\n"
    "            set label 10 'bound' at tx + d + 0.01*length,ty + b left font ',11' front\n"
    "        }\n"
    "    }\n"
    "    plot data index i using ($1 + axial_scale*$2):(bending_scale*$3):2 with lines lw 8 "
    "lc palette\n";

void br_movie_write_script(FILE *out, const struct br_movie *m)
{
    const struct br_scene *s = m->scene;
    char name[512], file[512];
    snprintf(name, sizeof name, "%s.gif", m->stem);
    br_quoted(file, sizeof file, &br_for_text, name);
    br_script_head(out, s->title, m->stem, file);
    fprintf(
        out,
        "frames = %zu\nlength = %.9g; gap = %.9g # m\n"
        "touches = %d; rubs = %d # whether there is an obstacle, friction\n%s"
        "set terminal gif animate delay 8 loop 0 size 900,520 rounded font 'DejaVu Sans,13'\nset label 1 ",
        m->record->samples, s->length, s->contact.modelled ? s->contact.gap : 0,
        s->contact.modelled, s->friction.law != BR_FRICTIONLESS, scales);
    br_quote(out, &br_for_gnuplot, s->title);
    fprintf(out, " noenhanced at screen 0.03,0.95 left font ',17'\n%s%s", stage, bars);
    fprintf(out,
            "set output stem.'.gif'\ndo for [i=1:frames] {\n%s    print '.'\n}\nunset output\n",
            forces);
}
