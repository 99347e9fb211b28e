/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of each report, filled from its result: nothing is computed here but where a point
 * stands. Clear what they return; where there was no memory for all of it, br_figure_check tells.
 *
 * To add a picture: a filler, and a row of its registry or a declaration below. */
#ifndef BR_PLOTS_PICTURES_H
#define BR_PLOTS_PICTURES_H

#include "plots/figure.h"
struct br_named_method;
struct br_orders;
struct br_energy_behaviour;
struct br_example;
struct br_extreme_map;
struct br_floors;
struct br_history_record;
struct br_paper;
struct br_report;
struct br_scene;
struct br_split;
struct br_stability;
struct br_variation;
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

/* Ask picture->applies first. */
struct br_figure br_convergence_draw(const struct br_convergence_picture *picture,
                                     const struct br_report *report);

/* ---- trade.c: what a digit costs ---- */

/* A method's curve joins the trials that none of its own beats; dots are the others. */
struct br_trade_picture {
    const char *name;  /* of the files: <scene>-<name>.gp and so on */
    const char *title; /* one line for a person */
    /* Which methods have a curve. */
    bool (*shows)(const struct br_trade *trade, const struct br_named_method *named);
    const char *label;                            /* of the axis of work, with its unit */
    double (*work)(const struct br_trial *trial); /* along that axis; NaN: not drawn */
};
extern const struct br_trade_picture *const br_trade_pictures[]; /* NULL-terminated */

/* Whether it has anything to show. */
bool br_trade_picture_applies(const struct br_trade_picture *picture, const struct br_trade *trade);

struct br_figure br_trade_draw(const struct br_trade_picture *picture, const struct br_trade *trade,
                               const char *name, const char *caption);

/* ---- split.c: where the error comes from ---- */

/* A panel for each of the first two methods among the runs, over what they differ by: k on the
 * finest mesh, or else h at the smallest k; no panels where no two runs differ by either. */
struct br_figure br_split_draw(const struct br_split *split, size_t count);

/* ---- orders.c: any program's errors ---- */

/* A panel over the size of elements, and of steps; the line of each quantity at the finest size of
 * the other. */
struct br_figure br_orders_draw(const struct br_orders *orders, const char *caption);

/* ---- variation.c: over a scene's number that is varied ---- */

/* A panel for each axis of its columns. */
struct br_figure br_variation_draw(const struct br_variation *variation);

/* ---- extremes.c ---- */

/* Deviation from the exact discrete solution: over n at time step number k, or, of what steps
 * gather, over their number. */
struct br_figure br_floors_draw(const struct br_floors *floors, size_t k);
/* Loss of energy a period over steps a period. */
struct br_figure br_energy_draw(const struct br_energy_behaviour *behaviour);
/* The lagged contact's growth over c_H and k, and what most cases of the map's cells are. */
struct br_figure br_stability_draw(const struct br_stability *stability);
struct br_figure br_extreme_map_draw(const struct br_extreme_map *map);

/* ---- paper.c: Figures 2 to 10 ---- */

/* A row of the registry, in the order of the paper. */
struct br_paper_figure {
    int number;
    size_t example;     /* 1 to 4 */
    const char *title;  /* the paper's caption */
    const char *says;   /* what the paper's text says of it */
    const char *beside; /* what we show besides; may be NULL */
    bool bending;       /* the displacements of the beam: which they are; and NULL for fill */
    void (*fill)(const struct br_paper *paper, struct br_figure *figure);
    void (*mark)(const struct br_example *example, struct br_figure *figure); /* may be NULL */
};
extern const struct br_paper_figure br_paper_figures[]; /* ends with number 0 */

struct br_figure br_paper_figure_draw(const struct br_paper_figure *row,
                                      const struct br_paper *paper);

/* ---- run.c: the tip of a run over time ---- */

/* The place of a number in struct br_history_row. */
#define BR_ROW(member) offsetof(struct br_history_row, member)

/* A line over time of a number of all rows, times `factor`. */
void br_rows_add(struct br_figure *figure, const char *title,
                 const struct br_history_record *record, size_t place, double factor);

/* For a terminal, with letters. */
struct br_figure br_history_draw(const struct br_scene *scene,
                                 const struct br_history_record *record);

/* ---- run.c, too: beam, obstacle, and the forces at the tip, moving ---- */

/* A row of the registry. */
struct br_movie_format {
    const char *extension; /* of the file; "/": a folder of frames */
    const char *terminal;  /* gnuplot's, with its options */
    const char *title;     /* one line for a person */
    bool frames;           /* one file each, ... */
    bool film;             /* ... of which ffmpeg makes one */
};
extern const struct br_movie_format br_movie_formats[]; /* ends with zeros */

/* The format of a file by its ending; NULL: none. */
const struct br_movie_format *br_movie_format_of(const char *file);

/* What is shown: all looks of the record. Borrowed. */
struct br_movie {
    const struct br_scene *scene;
    const struct br_history_record *record;
    const struct br_movie_format *format;
    const char *stem; /* of the files, without a quote; frames are stem-0001.png and so on */
};

/* The tip in all frames, then each frame's fields, and the script that draws the file from
 * stem.dat. */
void br_movie_write_data(FILE *out, const struct br_movie *movie);
void br_movie_write_script(FILE *out, const struct br_movie *movie);

/* The name of a movie's picture: of frame i for a set of frames. */
void br_movie_file(const struct br_movie *movie, size_t frame, char *file, size_t size);

#endif
