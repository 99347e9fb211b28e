/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures 2 to 10 of the paper, and their captions. To add a figure: a filler, and a row. */
#include <math.h>

#include "plots/pictures.h"
#include "study/paper/claims.h"

/* ---- curves ---- */

/* A field at the figure's times. */
static void add_field(const struct br_example *e, enum br_field_kind kind, struct br_panel *p)
{
    const struct br_history_record *r = &e->record;
    const size_t unknowns = r->unknowns[kind], every = r->n > 200 ? r->n / 200 : 1;
    for (size_t look = 0; look < r->looks; look++) {
        const double *nodal = br_history_field(r, look, kind, false);
        struct br_series *s = br_series_add(p, BR_PEN_LINE, "t = %.4g s", r->at[look].time);
        for (size_t i = 0; i <= r->n; i += every)
            br_point_add(s, (double)i / (double)r->n * e->scene.length, nodal[i * unknowns], NULL);
    }
    BR_SAY(p->x_label, "x (m)");
    BR_SAY(p->y_label,
           kind == BR_AXIAL ? "horizontal displacement u (m)" : "vertical displacement w (m)");
}

/* Over time. */
static struct br_series *add_rows(const struct br_example *e, enum br_row_value value,
                                  const char *title, struct br_panel *p)
{
    struct br_series *s = br_series_add(p, BR_PEN_LINE, "%s", title);
    for (size_t i = 0; i < e->record.rows; i++)
        br_point_add(s, e->record.row[i].time, br_value_of_row(&e->record.row[i], value), NULL);
    BR_SAY(p->x_label, "time t (s)");
    BR_SAY(p->y_label, "%s",
           value == BR_ROW_AXIAL     ? "horizontal displacement u (m)"
           : value == BR_ROW_BENDING ? "vertical displacement w (m)"
                                     : "force (N)");
    return s;
}

static struct br_panel *add_panel(struct br_figure *f, const char *title)
{
    struct br_panel *p = br_panel_add(f);
    BR_SAY(p->title, "%s", title);
    return p;
}

/* ---- Example 1 ---- */

static struct br_panel *add_inset(struct br_figure *f, struct br_range x, struct br_range y,
                                  const char *title)
{
    struct br_panel *p = add_panel(f, title);
    p->inset_x = x;
    p->inset_y = y;
    p->x.high = 100;
    BR_SAY(p->x_label, "time t (µs)");
    return p;
}

/* Exact line, and every 40th of the scheme's rows as circles. */
static void add_early_slip(const struct br_early *early, struct br_panel *p)
{
    struct br_series *exact = br_series_add(p, BR_PEN_LINE, "exact");
    for (size_t i = 0; i <= BR_EXACT_EARLY; i++)
        br_point_add(exact, 1e6 * early->exact[i].time,
                     1e9 * early->exact[i].displacement[BR_BENDING], NULL);
    struct br_series *scheme = br_series_add(p, BR_PEN_RINGS, "scheme");
    for (size_t i = 0; i < early->record.rows; i += 40)
        br_point_add(scheme, 1e6 * early->record.row[i].time,
                     1e9 * early->record.row[i].displacement[BR_BENDING], NULL);
    BR_SAY(p->y_label, "w(L,t) (nm)");
}

static void fill2(const struct br_paper *paper, struct br_figure *f)
{
    const struct br_example *e = &paper->example[0];
    f->one_key = true;
    add_field(e, BR_AXIAL, add_panel(f, "horizontal"));
    struct br_panel *p = add_panel(f, "vertical");
    p->y.high = 0.17;
    add_field(e, BR_BENDING, p);
    add_early_slip(&paper->early,
                   add_inset(f, (struct br_range){0.24, 0.95}, (struct br_range){0.6, 0.91},
                             "the tip at first: line exact, o k = 0.1 µs"));
}

static void fill3(const struct br_paper *paper, struct br_figure *f)
{
    const struct br_early *early = &paper->early;
    struct br_panel *p = br_panel_add(f);
    p->log_y = true;
    p->y.low = 1e-2; /* room for the inset */
    add_rows(&paper->example[0], BR_ROW_STRESS, "tangential stress {/Symbol s}_V(1,t)", p);
    add_rows(&paper->example[0], BR_ROW_BOUND, "friction bound h(t) = c_V u(1,t)", p);
    p = add_inset(f, (struct br_range){0.55, 0.95}, (struct br_range){0.18, 0.44},
                  "the first instants, exact");
    p->y.high = 0.6;
    BR_SAY(p->y_label, "force (N)");
    struct br_series *stress = br_series_add(p, BR_PEN_LINE, "stress");
    struct br_series *bound = br_series_add(p, BR_PEN_LINE, "bound");
    for (size_t i = 0; i <= BR_EXACT_EARLY; i++) {
        const double time = 1e6 * early->exact[i].time;
        br_point_add(stress, time, -early->exact[i].friction_force, NULL);
        br_point_add(bound, time, early->exact[i].friction_bound, NULL);
    }
}

/* ---- Examples 2 to 4 ---- */

/* The beam, and its contact node over time, which is returned. */
static struct br_panel *fill_beam(const struct br_example *e, enum br_field_kind kind,
                                  struct br_figure *f)
{
    f->one_key = true;
    add_field(e, kind, add_panel(f, "the beam"));
    struct br_panel *p = add_panel(f, "the contact node");
    add_rows(e, kind == BR_AXIAL ? BR_ROW_AXIAL : BR_ROW_BENDING, "", p);
    return p;
}

static void fill4(const struct br_paper *paper, struct br_figure *f)
{
    fill_beam(&paper->example[1], BR_BENDING, f);
}

/* When the tip lets go by the text, and by the exact solution. */
static void mark_release(const struct br_example *e, struct br_panel *p)
{
    struct br_mark *mark = br_mark_add(p, 0.68, "0.68 s, the text");
    mark->height = 0.3;
    mark->left = true;
    for (size_t i = 0; i < e->events && p->marks < BR_PANEL_MARKS; i++)
        if (e->event[i].phase == BR_SLIP_DOWN) {
            mark = br_mark_add(p, e->event[i].time, "%.2f s, exact", e->event[i].time);
            mark->height = 0.2;
            mark->left = true;
        }
}

static void fill5(const struct br_paper *paper, struct br_figure *f)
{
    mark_release(&paper->example[2], fill_beam(&paper->example[2], BR_BENDING, f));
}

static void fill6(const struct br_paper *paper, struct br_figure *f)
{
    struct br_panel *p = br_panel_add(f);
    mark_release(&paper->example[2], p);
    add_rows(&paper->example[2], BR_ROW_STRESS, "tangential stress {/Symbol s}_V(1,t)", p);
    add_rows(&paper->example[2], BR_ROW_BOUND, "friction bound c_V", p);
}

static void fill7(const struct br_paper *paper, struct br_figure *f)
{
    fill_beam(&paper->example[3], BR_AXIAL, f);
}

/* When the exact tip begins to stick or to slip; height: of the later labels. */
static void mark_phases(const struct br_example *e, double height, struct br_panel *p)
{
    for (size_t i = 0; i < e->events && p->marks < BR_PANEL_MARKS; i++)
        if (e->event[i].field == BR_EXACT_BENDING && e->event[i].time > 0) {
            struct br_mark *mark =
                br_mark_add(p, e->event[i].time, "%s", br_phase_text(e->event[i].phase));
            mark->left = e->event[i].time > 0.5 * e->scene.duration;
            mark->height = mark->left ? height : 0.05;
        }
}

static void fill8(const struct br_paper *paper, struct br_figure *f)
{
    mark_phases(&paper->example[3], 0.05, fill_beam(&paper->example[3], BR_BENDING, f));
}

static void fill9(const struct br_paper *paper, struct br_figure *f)
{
    const struct br_example *e = &paper->example[3];
    add_rows(e, BR_ROW_BOUND, "h(t) = c_V u(1,t)", add_panel(f, "friction bound"));
    struct br_panel *p = add_panel(f, "tangential stress");
    add_rows(e, BR_ROW_BOUND, "bounds h(t) and -h(t)", p);
    struct br_series *below = add_rows(e, BR_ROW_BOUND, "", p);
    for (size_t i = 0; below && i < below->count; i++)
        below->point[i].y *= -1;
    if (below)
        below->hue = 1;
    add_rows(e, BR_ROW_STRESS, "stress {/Symbol s}_V(1,t)", p);
    mark_phases(e, 0.4, p);
}

static struct br_panel *fill_sweep(const struct br_sweep *s, struct br_figure *f)
{
    struct br_panel *p = br_panel_add(f);
    struct br_series *most = br_series_add(p, BR_PEN_LINE, "largest of all times, contact at u_n");
    struct br_series *last = br_series_add(p, BR_PEN_LINE, "at t = T, contact at u_n");
    struct br_series *printed = br_series_add(p, BR_PEN_RINGS, "largest, as printed: at u_{n-1}");
    for (size_t i = 0; i < s->points; i++) {
        const struct br_sweep_point *at = &s->point[i];
        br_point_add(most, at->coefficient, at->most[1], NULL);
        br_point_add(last, at->coefficient, at->last[1], NULL);
        br_point_add(printed, at->coefficient, at->most[0], NULL);
    }
    p->log_x = p->log_y = true;
    BR_SAY(p->y_label, "|u| + |w| (m^{3/2})");
    struct br_mark *mark = br_mark_add(p, s->paper, "the paper's");
    mark->height = s->point[0].most[1] < 0.5 ? 0.5 : 0.06; /* clear of the curves */
    mark->left = true;
    return p;
}

static void fill10(const struct br_paper *paper, struct br_figure *f)
{
    const struct br_sweep *contact = &paper->sweep[BR_SWEEP_CONTACT];
    f->one_key = true;
    struct br_panel *p = fill_sweep(contact, f);
    BR_SAY(p->x_label, "contact coefficient c_H (N/m)");
    for (size_t i = 0; i < contact->points; i++)
        if (contact->point[i].unstable) {
            br_mark_add(p, contact->point[i].coefficient, "as printed: amplifies")->height = 0.4;
            break;
        }
    p = fill_sweep(&paper->sweep[BR_SWEEP_FRICTION], f);
    BR_SAY(p->x_label, "friction coefficient c_V (N/m)");
}

/* ---- the registry ---- */

const struct br_paper_figure br_paper_figures[] = {
    {
        .number = 2,
        .example = 1,
        .title = "Example 1: horizontal and vertical displacements at different instants",
        .says =
            "The right end of the beam keeps clamped, because the tangential stress does not achieve "
            "the friction bound, and the beam remains stuck to the obstacle.",
        .beside =
            "The inset is w(L,t) in the first 100 microseconds, exact and by the scheme with steps of "
            "0.1 microseconds: the friction bound first grows slower than the reaction.",
        .fill = fill2,
    },
    {
        .number = 3,
        .example = 1,
        .title = "Example 1: evolution in time of the tangential stress and the friction bound",
        .says = "The tangential stress does not achieve the friction bound.",
        .beside = "The inset has the first 100 microseconds of the exact solution, where it does.",
        .fill = fill3,
    },
    {
        .number = 4,
        .example = 2,
        .title = "Example 2: vertical displacements, and that of the contact node over time",
        .says =
            "There is always movement of the contact node, since the tangential stress equals the "
            "friction bound.",
        .fill = fill4,
    },
    {
        .number = 5,
        .example = 3,
        .title = "Example 3: vertical displacements, and that of the contact node over time",
        .says =
            "The contact node is clamped until time t = 0.68 s, when the tangential stress reaches the "
            "friction bound.",
        .fill = fill5,
    },
    {
        .number = 6,
        .example = 3,
        .title = "Example 3: evolution in time of the tangential stress",
        .says = "At t = 0.68 s the tangential stress reaches the friction bound.",
        .fill = fill6,
    },
    {
        .number = 7,
        .example = 4,
        .title = "Example 4: horizontal displacements, and that of the contact node over time",
        .says = "There is always penetration of the beam into the obstacle.",
        .fill = fill7,
    },
    {
        .number = 8,
        .example = 4,
        .title = "Example 4: vertical displacements, and that of the contact node over time",
        .says = "The text only names this figure.",
        .fill = fill8,
    },
    {
        .number = 9,
        .example = 4,
        .title = "Example 4: evolution in time of the friction bound and the tangential stress",
        .says = "The friction bound is h(t) = c_V u(1,t).",
        .beside = "The bound is drawn beside the stress, too, with both signs.",
        .fill = fill9,
    },
    {
        .number = 10,
        .example = 4,
        .title = "Example 4: sum of the L2 norms depending on c_H and c_V",
        .says = "The stability of the solution is clearly observed.",
        .beside =
            "The paper says neither the ranges nor the time of its norms: shown are the largest sum "
            "of all times and that at t = T. Beyond the dashed line in c_H the scheme as printed, "
            "with the contact force of the step before, amplifies.",
        .fill = fill10,
    },
    {.number = 0},
};

enum br_status br_paper_figure_draw(const struct br_paper_figure *row, const struct br_paper *paper,
                                    struct br_figure *f, struct br_error *err)
{
    *f = (struct br_figure){0};
    BR_SAY(f->stem, "figure%d", row->number);
    BR_SAY(f->title, "Figure %d. %s", row->number, row->title);
    row->fill(paper, f);
    return br_figure_check(f, err);
}

/* ---- captions ---- */

/* "last time at rest 0.8 +- 0.001 s, exact 0.8 s, the paper 0.68 s" */
static void write_value(FILE *out, const struct br_claim *claim, const struct br_finding *f)
{
    const char *unit = claim->unit[0] == '1' ? "" : claim->unit, *blank = *unit ? " " : "";
    fprintf(out, "%s %.6g", claim->measured, f->value);
    if (isfinite(f->error))
        fprintf(out, " +- %.2g", f->error);
    fprintf(out, "%s%s", blank, unit);
    if (isfinite(f->exact))
        fprintf(out, ", exact %.6g%s%s", f->exact, blank, unit);
    if (isfinite(f->printed))
        fprintf(out, ", the paper %.6g%s%s", f->printed, blank, unit);
}

/* As the claims' table says it, in a sentence. */
static const char *verdict(enum br_agreement agreement)
{
    return agreement == BR_AGREES    ? "We agree"
           : agreement == BR_DIFFERS ? "We differ"
                                     : "This is undecided";
}

static void write_findings(FILE *out, int figure, const struct br_finding *findings,
                           const char *bullet)
{
    for (size_t i = 0; br_claims[i]; i++) {
        if (br_claims[i]->figure != figure)
            continue;
        fprintf(out, "%s\"%s\" %s: ", bullet, br_claims[i]->statement,
                verdict(findings[i].agreement));
        write_value(out, br_claims[i], &findings[i]);
        fprintf(out, "%s%s.\n", *findings[i].note ? "; " : "", findings[i].note);
    }
}

/* What happens at the tip of the exact solution. */
static void write_events(FILE *out, const struct br_example *e, const char *bullet)
{
    fprintf(out, "%sThe exact solution:", bullet);
    for (size_t i = 0; i < e->events; i++)
        fprintf(out, "%s at t = %.6g s %s%s", i ? "," : "", e->event[i].time,
                e->event[i].field == BR_EXACT_BENDING ? "the tip " : "",
                br_phase_text(e->event[i].phase));
    fputs(".\n", out);
}

static void write_caption(FILE *out, const struct br_paper_figure *figure,
                          const struct br_paper *paper, const struct br_finding *findings,
                          const char *bullet)
{
    fprintf(out, "%sThe paper: %s\n", bullet, figure->says);
    write_findings(out, figure->number, findings, bullet);
    write_events(out, &paper->example[figure->example - 1], bullet);
    if (figure->beside)
        fprintf(out, "%s%s\n", bullet, figure->beside);
}

void br_paper_caption(FILE *out, const struct br_paper_figure *figure, const struct br_paper *paper,
                      const struct br_finding *findings)
{
    fprintf(out, "Figure %d. %s (h = 1/%zu m, k = 1/%zu s)\n\n", figure->number, figure->title,
            paper->request.n, paper->request.per_second);
    write_caption(out, figure, paper, findings, "");
}

void br_paper_readme(FILE *out, const struct br_paper *paper, const struct br_finding *findings)
{
    fprintf(
        out,
        "# Figures 2 to 10 of the paper, marched again\n\n"
        "Examples 1 to 4 with h = 1/%zu m and k = 1/%zu s; every figure as a gnuplot script beside "
        "its data,\nand, where gnuplot is installed, as SVG and PNG. What all of section 3.2 says "
        "is in [claims.md](claims.md).\n",
        paper->request.n, paper->request.per_second);
    for (const struct br_paper_figure *f = br_paper_figures; f->number; f++) {
        fprintf(out, "\n## Figure %d. %s\n\n![Figure %d](figure%d.svg)\n\n", f->number, f->title,
                f->number, f->number);
        write_caption(out, f, paper, findings, "- ");
    }
}
