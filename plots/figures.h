/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures 2 to 10 of the paper: a registry. Each draws what study/paper/paper.h has marched, and
 * computes nothing.
 *
 * To add a figure: a draw function in figures_axial.c, figures_bending.c or figures_sweep.c, and
 * one row in figures.c. */
#ifndef BR_PLOTS_FIGURES_H
#define BR_PLOTS_FIGURES_H

#include "plots/chart.h"
#include "study/paper/claims.h"

struct br_figure {
    int number;         /* of the paper */
    size_t example;     /* 1 to 4 */
    const char *title;  /* the paper's caption */
    const char *says;   /* what the paper's text says of it */
    const char *beside; /* what we show besides; may be NULL */
    /* Panels and curves of a laid out chart; false: no memory. */
    bool (*draw)(const struct br_paper *paper, struct br_chart *chart);
};

/* In the order of the paper; NULL-terminated. */
extern const struct br_figure *const br_figures[];

/* chart (out): to be cleared, even after a failure. Fails with BR_NO_MEMORY. */
enum br_status br_figure_draw(const struct br_figure *figure, const struct br_paper *paper,
                              struct br_chart *chart, struct br_error *err);

/* A figure's caption: what the paper says, and whether we see it, as plain text or, for the
 * folder's README.md with all figures, as Markdown. findings: in the order of br_claims. */
void br_figure_caption(FILE *out, const struct br_figure *figure, const struct br_paper *paper,
                       const struct br_finding *findings);
void br_figures_readme(FILE *out, const struct br_paper *paper, const struct br_finding *findings);

/* Inside: curves that several figures share. Each returns whether there was memory. */
bool br_draw_field(const struct br_example *example, enum br_field_kind kind,
                   struct br_panel *panel); /* at the figure's times */
bool br_draw_tip(const struct br_example *example, enum br_field_kind kind, const char *title,
                 struct br_panel *panel);
bool br_draw_stress(const struct br_example *example, const char *title, struct br_panel *panel);
bool br_draw_bound(const struct br_example *example, double sign, const char *title,
                   struct br_panel *panel);

bool br_draw_figure2(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure3(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure4(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure5(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure6(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure7(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure8(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure9(const struct br_paper *paper, struct br_chart *chart);
bool br_draw_figure10(const struct br_paper *paper, struct br_chart *chart);

#endif
