/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fillers that make figures of the beam's reports, as plots/pictures.h says.
 *
 * To add a picture, write a filler, and a row of its registry or a declaration below. */
#ifndef BR_PLOTS_BEAM_PICTURES_H
#define BR_PLOTS_BEAM_PICTURES_H

#include "plots/pictures.h"

struct br_named_method;
struct br_example;
struct br_floors;
struct br_history_record;
struct br_paper;
struct br_report;
struct br_scene;
struct br_split;
struct br_stability;
struct br_trade;
struct br_trial;

/* ---- convergence.c: a study's errors ---- */

/* A row of the registry. Its files are <report->name>-<name>.dat, .gp and so on. */
struct br_convergence_picture {
    const char *name;
    const char *title; /* one line for a person */
    const char *short_title;
    void (*fill)(const struct br_report *report, struct br_figure *figure);
};
extern const struct br_convergence_picture br_convergence_pictures[]; /* ends with zeros */

/* No panels if there is nothing to show. */
struct br_figure br_convergence_draw(const struct br_convergence_picture *picture,
                                     const struct br_report *report);

/* ---- trade.c: what a digit costs ---- */

/* A method's stairs join the trials that none of its own beats; dots are the others. */
struct br_trade_picture {
    const char *name;  /* of the files: <scene>-<name>.gp and so on */
    const char *title; /* one line for a person */
    const char *short_title;
    bool
        of_rules; /* of the methods that differ in rules and solvers; else in scheme and elements */
    const char *label;                            /* of the axis of work, with its unit */
    double (*work)(const struct br_trial *trial); /* along that axis; NaN: not drawn */
};
extern const struct br_trade_picture br_trade_pictures[]; /* ends with zeros */

/* No panels if no method is shown. */
struct br_figure br_trade_draw(const struct br_trade_picture *picture, const struct br_trade *trade,
                               const char *name, const char *caption);

/* ---- split.c: where the error comes from ---- */

/* A panel for each of the first two methods among the runs. The axis is k on the finest mesh, if
 * the runs differ in k, or else h at the smallest k; no panels if no two runs differ in either. */
struct br_figure br_split_draw(const struct br_split *split, size_t count);

/* ---- extremes.c ---- */

/* Deviation from the exact discrete solution over n, at time step number k; or, for round-off that
 * adds up, over the number of steps. */
struct br_figure br_floors_draw(const struct br_floors *floors, size_t k);
/* Stable and unstable marches over n and k, and over c_H and k. */
struct br_figure br_stability_draw(const struct br_stability *stability);

/* ---- paper.c: Figures 2 to 10 ---- */

/* A row of the registry, in the order of the paper. */
struct br_paper_figure {
    int number;
    size_t example;     /* 1 to 4 */
    const char *title;  /* the paper's caption */
    const char *says;   /* the statement in the paper's text */
    const char *beside; /* what we add to the paper's picture; may be NULL */
    bool bending;       /* it shows the beam's w, not the rod's u; fill is NULL then */
    void (*fill)(const struct br_paper *paper, struct br_figure *figure);
    void (*mark)(const struct br_example *example, struct br_figure *figure); /* may be NULL */
};
extern const struct br_paper_figure br_paper_figures[]; /* ends with number 0 */

struct br_figure br_paper_figure_draw(const struct br_paper_figure *row,
                                      const struct br_paper *paper);

/* ---- run.c: the tip of a run over time ---- */

/* The offset of a number in struct br_history_row. */
#define BR_ROW(member) offsetof(struct br_history_row, member)

/* Adds a line: a number of all rows, times `factor`, over time. */
void br_rows_add(struct br_figure *figure, enum br_pen pen, const char *title,
                 const struct br_history_record *record, size_t place, double factor);

/* Its files are called history. */
struct br_figure br_history_draw(const struct br_scene *scene,
                                 const struct br_history_record *record);

#endif
