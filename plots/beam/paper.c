/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures 2 to 10 of the paper. To add a figure: a filler, and a row. */
#include <stddef.h>

#include "plots/beam/pictures.h"
#include "study/paper/paper.h"

static const char horizontal[] = "horizontal displacement u (m)",
                  vertical[] = "vertical displacement w (m)", over_time[] = "time t (s)",
                  early_time[] = "time t (µs)", stress[] = "tangential stress σ_V(1,t)";

/* A panel of a field at the figure's times. */
static void add_field(const struct br_example *e, enum br_field_kind kind, const char *title,
                      struct br_figure *f)
{
    const struct br_history_record *r = &e->record;
    const size_t unknowns = r->unknowns[kind], every = r->n > 200 ? r->n / 200 : 1;
    BR_SAY(br_panel_add(f, false, "x (m)", "%s", kind == BR_AXIAL ? horizontal : vertical)->title,
           "%s", title);
    for (size_t sample = 0; sample < r->samples; sample++) {
        const double *nodal = br_history_field(r, sample, kind, false);
        struct br_series *s = br_series_add(f, BR_PEN_LINE, "t = %.4g s", r->at[sample].time);
        for (size_t i = 0; i <= r->n; i += every)
            br_point_add(s, (double)i / (double)r->n * e->scene.length, nodal[i * unknowns], NULL);
    }
}

static void add_stress(const struct br_example *e, struct br_figure *f)
{
    br_rows_add(f, BR_PEN_LINE, stress, &e->record, BR_ROW(friction_force), -1);
}

/* The beam, and its contact node over time. */
static void add_beam(const struct br_example *e, enum br_field_kind kind, struct br_figure *f)
{
    add_field(e, kind, "the beam", f);
    struct br_panel *p =
        br_panel_add(f, false, over_time, "%s", kind == BR_AXIAL ? horizontal : vertical);
    BR_SAY(p->title, "the contact node");
    br_rows_add(
        f, BR_PEN_LINE, "", &e->record,
        kind == BR_AXIAL ? BR_ROW(displacement[BR_AXIAL]) : BR_ROW(displacement[BR_BENDING]), 1);
}

/* Beside the exact line every 40th of the scheme's rows as circles. */
static void fill2(const struct br_paper *paper, struct br_figure *f)
{
    const struct br_early *early = &paper->early;
    add_field(&paper->example[0], BR_AXIAL, "horizontal", f);
    add_field(&paper->example[0], BR_BENDING, "vertical", f);
    BR_SAY(br_panel_add(f, false, early_time, "w(L,t) (nm)")->title, "the tip at first");
    struct br_series *exact = br_series_add(f, BR_PEN_GUIDE, "exact");
    for (size_t i = 0; i <= BR_EXACT_EARLY; i++)
        br_point_add(exact, 1e6 * early->exact[i].time,
                     1e9 * early->exact[i].displacement[BR_BENDING], NULL);
    struct br_series *scheme = br_series_add(f, BR_PEN_RINGS, "scheme, k = 0.1 µs");
    for (size_t i = 0; i < early->record.rows; i += 40)
        br_point_add(scheme, 1e6 * early->record.row[i].time,
                     1e9 * early->record.row[i].displacement[BR_BENDING], NULL);
}

static void fill3(const struct br_paper *paper, struct br_figure *f)
{
    static const char bound[] = "friction bound h(t) = c_V u(1,t)";
    const struct br_history_row *exact = paper->early.exact;
    struct br_panel *p = br_panel_add(f, false, over_time, "force (N)");
    p->log_y = true;
    BR_SAY(p->title, "the scheme");
    add_stress(&paper->example[0], f);
    br_rows_add(f, BR_PEN_LINE, bound, &paper->example[0].record, BR_ROW(friction_bound), 1);
    BR_SAY(br_panel_add(f, false, early_time, "force (N)")->title, "the first instants, exact");
    struct br_series *s[] = {br_series_add(f, BR_PEN_LINE, "%s", stress),
                             br_series_add(f, BR_PEN_LINE, "%s", bound)};
    for (size_t i = 0; i <= BR_EXACT_EARLY; i++) {
        br_point_add(s[0], 1e6 * exact[i].time, -exact[i].friction_force, NULL);
        br_point_add(s[1], 1e6 * exact[i].time, exact[i].friction_bound, NULL);
    }
}

/* When the tip lets go by the text, and by the exact solution. */
static void mark_release(const struct br_example *e, struct br_figure *f)
{
    br_mark_add(f, 0.68, "0.68 s, the text");
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].phase == BR_SLIP_DOWN) {
            char title[40];
            BR_SAY(title, "%.2f s, exact", e->event[i].time);
            br_mark_add(f, e->event[i].time, title);
        }
}

static void fill6(const struct br_paper *paper, struct br_figure *f)
{
    const struct br_example *e = &paper->example[2];
    br_panel_add(f, false, over_time, "force (N)");
    add_stress(e, f);
    br_rows_add(f, BR_PEN_LINE, "friction bound c_V", &e->record, BR_ROW(friction_bound), 1);
}

/* When the exact tip begins to stick or to slip. */
static void mark_phases(const struct br_example *e, struct br_figure *f)
{
    for (size_t i = 0; i < e->events; i++)
        if (e->event[i].field == BR_BENDING && e->event[i].time > 0)
            br_mark_add(f, e->event[i].time, br_phase_text(e->event[i].phase));
}

static void fill9(const struct br_paper *paper, struct br_figure *f)
{
    static const char bound[] = "bound h(t) = c_V u(1,t), and -h(t)";
    const struct br_example *e = &paper->example[3];
    BR_SAY(br_panel_add(f, false, over_time, "force (N)")->title, "friction bound");
    br_rows_add(f, BR_PEN_LINE, bound, &e->record, BR_ROW(friction_bound), 1);
    BR_SAY(br_panel_add(f, false, over_time, "force (N)")->title, "tangential stress");
    br_rows_add(f, BR_PEN_LINE, bound, &e->record, BR_ROW(friction_bound), 1);
    br_rows_add(f, BR_PEN_LINE, bound, &e->record, BR_ROW(friction_bound), -1);
    add_stress(e, f);
}

static void fill10(const struct br_paper *paper, struct br_figure *f)
{
    static const char *const labels[] = {[BR_SWEEP_CONTACT] = "contact coefficient c_H (N/m)",
                                         [BR_SWEEP_FRICTION] = "friction coefficient c_V (N/m)"};
    for (size_t sweep = 0; sweep < sizeof labels / sizeof *labels; sweep++) {
        const struct br_sweep *s = &paper->sweep[sweep];
        br_panel_add(f, true, labels[sweep], "|u| + |w| (m^{3/2})");
        struct br_series *most =
            br_series_add(f, BR_PEN_LINE, "largest of all times, contact at u_n");
        struct br_series *last = br_series_add(f, BR_PEN_LINE, "at t = T, contact at u_n");
        struct br_series *printed =
            br_series_add(f, BR_PEN_RINGS, "largest, as printed: at u_{n-1}");
        size_t unstable = s->points; /* the first */
        for (size_t i = 0; i < s->points; i++) {
            const struct br_sweep_point *at = &s->point[i];
            br_point_add(most, at->coefficient, at->most[1], NULL);
            br_point_add(last, at->coefficient, at->last[1], NULL);
            br_point_add(printed, at->coefficient, at->most[0], NULL);
            if (at->unstable && unstable == s->points)
                unstable = i;
        }
        br_mark_add(f, s->paper, "the paper's coefficient");
        if (unstable < s->points)
            br_mark_add(f, s->point[unstable].coefficient, "unstable on the right, as printed");
    }
}

const struct br_paper_figure br_paper_figures[] = {
    {
        .number = 2,
        .example = 1,
        .title = "Example 1: horizontal and vertical displacements at different instants",
        .says =
            "The right end of the beam keeps clamped, because the tangential stress does not achieve "
            "the friction bound, and the beam remains stuck to the obstacle.",
        .beside =
            "The third panel is w(L,t) in the first 100 microseconds, exact and by the scheme with steps of "
            "0.1 microseconds: the friction bound first grows slower than the reaction.",
        .fill = fill2,
    },
    {
        .number = 3,
        .example = 1,
        .title = "Example 1: evolution in time of the tangential stress and the friction bound",
        .says = "The tangential stress does not achieve the friction bound.",
        .beside =
            "The second panel has the first 100 microseconds of the exact solution, where it does.",
        .fill = fill3,
    },
    {
        .number = 4,
        .example = 2,
        .title = "Example 2: vertical displacements, and that of the contact node over time",
        .says =
            "There is always movement of the contact node, since the tangential stress equals the "
            "friction bound.",
        .bending = true,
    },
    {
        .number = 5,
        .example = 3,
        .title = "Example 3: vertical displacements, and that of the contact node over time",
        .says =
            "The contact node is clamped until time t = 0.68 s, when the tangential stress reaches the "
            "friction bound.",
        .bending = true,
        .mark = mark_release,
    },
    {
        .number = 6,
        .example = 3,
        .title = "Example 3: evolution in time of the tangential stress",
        .says = "At t = 0.68 s the tangential stress reaches the friction bound.",
        .fill = fill6,
        .mark = mark_release,
    },
    {
        .number = 7,
        .example = 4,
        .title = "Example 4: horizontal displacements, and that of the contact node over time",
        .says = "There is always penetration of the beam into the obstacle.",
    },
    {
        .number = 8,
        .example = 4,
        .title = "Example 4: vertical displacements, and that of the contact node over time",
        .says = "The text only names this figure.",
        .bending = true,
        .mark = mark_phases,
    },
    {
        .number = 9,
        .example = 4,
        .title = "Example 4: evolution in time of the friction bound and the tangential stress",
        .says = "The friction bound is h(t) = c_V u(1,t).",
        .beside = "The bound is drawn beside the stress, too, with both signs.",
        .fill = fill9,
        .mark = mark_phases,
    },
    {
        .number = 10,
        .example = 4,
        .title = "Example 4: sum of the L2 norms over the coefficients of contact and friction",
        .says = "The stability of the solution is clearly observed.",
        .beside =
            "The paper says neither the ranges nor the time of its norms: shown are the largest sum "
            "of all times and that at t = T. Beyond the dash-dotted line in c_H the scheme as printed, "
            "with the contact force of the step before, amplifies.",
        .fill = fill10,
    },
    {.number = 0},
};

struct br_figure br_paper_figure_draw(const struct br_paper_figure *row,
                                      const struct br_paper *paper)
{
    const struct br_example *e = &paper->example[row->example - 1];
    struct br_figure f = {0};
    BR_SAY(f.stem, "figure%d", row->number);
    BR_SAY(f.title, "Figure %d. %s", row->number, row->title);
    if (row->fill)
        row->fill(paper, &f);
    else
        add_beam(e, row->bending ? BR_BENDING : BR_AXIAL, &f);
    if (row->mark)
        row->mark(e, &f);
    return f;
}
