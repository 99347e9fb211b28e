/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of each report, filled from its result: nothing is computed here but where a point
 * stands. All fail with BR_NO_MEMORY; the figure (out) is to be cleared, even then.
 *
 * To add a picture: a filler, and a row of its registry or a declaration below. */
#ifndef BR_PLOTS_PICTURES_H
#define BR_PLOTS_PICTURES_H

#include "plots/figure.h"
struct br_contender;
struct br_drifts;
struct br_energy_behaviour;
struct br_extreme_map;
struct br_finding;
struct br_floors;
struct br_history_record;
struct br_history_row;
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
    bool (*applies)(const struct br_report *report);
    void (*fill)(const struct br_report *report, struct br_figure *figure);
};
extern const struct br_convergence_picture *const br_convergence_pictures[]; /* NULL-terminated */

/* Ask picture->applies first. Fails with BR_BAD_INPUT where report->name makes no file name. */
enum br_status br_convergence_draw(const struct br_convergence_picture *picture,
                                   const struct br_report *report, struct br_figure *figure,
                                   struct br_error *err);

/* ---- trade.c: what a digit costs ---- */

/* A method's curve joins the trials that none of its own beats; dots are the others. */
struct br_trade_picture {
    const char *name;  /* of the files: <scene>-<name>.gp and so on */
    const char *title; /* one line for a person */
    /* Which methods have a curve. */
    bool (*shows)(const struct br_trade *trade, const struct br_contender *contender);
    const char *label;                            /* of the axis of work, with its unit */
    double (*work)(const struct br_trial *trial); /* along that axis; NaN: not drawn */
};
extern const struct br_trade_picture *const br_trade_pictures[]; /* NULL-terminated */

/* Whether it has anything to show. */
bool br_trade_picture_applies(const struct br_trade_picture *picture, const struct br_trade *trade);

enum br_status br_trade_draw(const struct br_trade_picture *picture, const struct br_trade *trade,
                             const char *name, const char *caption, struct br_figure *figure,
                             struct br_error *err);

/* ---- split.c: where the error comes from ---- */

/* A panel for each of the first two methods among the runs, over what they differ by: k on the
 * finest mesh, or else h at the smallest k; no panels where no two runs differ by either. */
enum br_status br_split_draw(const struct br_split *split, size_t count, struct br_figure *figure,
                             struct br_error *err);

/* ---- extremes.c ---- */

/* Deviation from the exact discrete solution: over n at time step number k, and over N. */
enum br_status br_floors_draw(const struct br_floors *floors, size_t k, struct br_figure *figure,
                              struct br_error *err);
enum br_status br_drifts_draw(const struct br_drifts *drifts, struct br_figure *figure,
                              struct br_error *err);
/* Loss of energy a period over steps a period. */
enum br_status br_energy_draw(const struct br_energy_behaviour *behaviour, struct br_figure *figure,
                              struct br_error *err);
/* The lagged contact's growth over c_H and k, and what most cases of the map's cells are. */
enum br_status br_stability_draw(const struct br_stability *stability, struct br_figure *figure,
                                 struct br_error *err);
enum br_status br_extreme_map_draw(const struct br_extreme_map *map, struct br_figure *figure,
                                   struct br_error *err);

/* ---- paper.c: Figures 2 to 10 ---- */

/* A row of the registry, in the order of the paper. */
struct br_paper_figure {
    int number;
    size_t example;     /* 1 to 4 */
    const char *title;  /* the paper's caption */
    const char *says;   /* what the paper's text says of it */
    const char *beside; /* what we show besides; may be NULL */
    void (*fill)(const struct br_paper *paper, struct br_figure *figure);
};
extern const struct br_paper_figure br_paper_figures[]; /* ends with number 0 */

enum br_status br_paper_figure_draw(const struct br_paper_figure *row, const struct br_paper *paper,
                                    struct br_figure *figure, struct br_error *err);

/* What the paper says of a figure, and whether we see it, as plain text; and of all figures, as
 * Markdown, for the folder's README.md. findings: in the order of br_claims. */
void br_paper_caption(FILE *out, const struct br_paper_figure *row, const struct br_paper *paper,
                      const struct br_finding *findings);
void br_paper_readme(FILE *out, const struct br_paper *paper, const struct br_finding *findings);

/* ---- letters.c: the tip of a run over time, for a terminal ---- */

/* What a row of a history tells of the tip. */
enum br_row_value {
    BR_ROW_TIME,
    BR_ROW_AXIAL,
    BR_ROW_BENDING,
    BR_ROW_SPEED, /* of bending */
    BR_ROW_CONTACT,
    BR_ROW_FRICTION,
    BR_ROW_STRESS, /* minus friction */
    BR_ROW_BOUND
};
double br_value_of_row(const struct br_history_row *row, enum br_row_value what);

enum br_status br_history_draw(const struct br_scene *scene, const struct br_history_record *record,
                               struct br_figure *figure, struct br_error *err);

#endif
