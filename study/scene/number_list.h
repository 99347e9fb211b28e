/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists of numbers, on the command line and in scenes: "100,200,400", with blanks
 * behind the commas or without. */
#ifndef BR_STUDY_SCENE_NUMBER_LIST_H
#define BR_STUDY_SCENE_NUMBER_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include "solver/status.h"

/* Reads a finite number at the start of text; returns what follows, or NULL. */
const char *br_read_number(const char *text, double *value);

/* What a number may be: in (low, high), or a whole one in [low, high]. */
struct br_number_range {
    double low, high;
    bool whole;
};

/* Reads a text that is one number of the range. Fails with BR_BAD_INPUT: "found 'x', expected a
 * number above 0 and below 1". */
enum br_status br_read_in_range(const char *text, const struct br_number_range *range,
                                double *value, struct br_error *err);

/* Writes the fewest digits, of 15 or 17, that are the number again; returns text (out). */
const char *br_shortest(double number, char *text, size_t size);

/* Reads a list of distinct positive numbers (or whole numbers) in any order; *values
 * is owned by the caller, even after a failure (BR_BAD_INPUT, naming the option). */
enum br_status br_read_numbers(const char *option, const char *text, double **values, size_t *count,
                               struct br_error *err);
enum br_status br_read_counts(const char *option, const char *text, size_t **values, size_t *count,
                              struct br_error *err);

#endif
