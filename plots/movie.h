/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A moving picture of a recorded march: beam, obstacle, and the forces at the tip. Nothing is
 * computed here but scales. */
#ifndef BR_PLOTS_MOVIE_H
#define BR_PLOTS_MOVIE_H

#include <stdio.h>

#include "study/run/history.h"

/* A row of the registry. */
struct br_movie_format {
    const char *extension; /* of the file; "/": a folder of frames */
    const char *terminal;  /* gnuplot's */
    const char *title;     /* one line for a person */
    bool frames;           /* one file each */
};
/* NULL-terminated. */
extern const struct br_movie_format *const br_movie_formats[];

/* The format of a file by its ending; NULL: none. */
const struct br_movie_format *br_movie_format_of(const char *file);

/* What is shown: all looks of the record. Borrowed. */
struct br_movie {
    const struct br_scene *scene;
    const struct br_history_record *record;
    const struct br_movie_format *format;
    const char *stem; /* of the files, without a quote; frames are stem-0001.png and so on */
};

/* The frames' fields, one block each, and the script that draws the file from stem.dat. */
void br_movie_write_data(FILE *out, const struct br_movie *movie);
void br_movie_write_script(FILE *out, const struct br_movie *movie);

/* The name of a movie's picture: of frame i for a set of frames. */
void br_movie_file(const struct br_movie *movie, size_t frame, char *file, size_t size);

#endif
