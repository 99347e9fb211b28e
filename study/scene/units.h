/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of the numbers and expressions of a scene: "kN/m", "N mm^2", "lbf/in".
 *
 * Not a library's: with udunits2 a number would depend on data files and variables of the machine
 * that reads it, 9 mm would not be the 0.009 m that strtod reads, and N/m s would be a guess. */
#ifndef BR_STUDY_SCENE_UNITS_H
#define BR_STUDY_SCENE_UNITS_H

#include <stdbool.h>
#include <stddef.h>

/* The powers of metre, second and kilogram. */
struct br_dimension {
    int metre, second, kilogram;
};

/* One of it is factor 10^ten of these powers; the factor of a decimal multiple is 1 exactly. */
struct br_unit {
    struct br_dimension of;
    long double factor;
    int ten;
};

/* Reads a text that is a unit: words with powers and blanks or * between them, then at most one /,
 * behind which stands one word or a bracket; "" and "1" are 1. Returns whether it is one. */
bool br_unit_read(const char *text, struct br_unit *unit);

bool br_dimension_is(struct br_dimension a, struct br_dimension b);

/* "a force per length": in `text` (out) where it has no name; returns it. */
enum { BR_DIMENSION_TEXT = 64 };
const char *br_dimension_words(struct br_dimension d, char text[BR_DIMENSION_TEXT]);

/* The words that units are made of, for a message; returns text (out). */
enum { BR_UNIT_WORDS = 160 };
const char *br_unit_words(char text[BR_UNIT_WORDS]);

/* What a number is in m, s and kg. The double is what strtod makes of the decimal number with its
 * point moved, or else the nearest one to within the rounding of the long double. */
struct br_quantity {
    double value;
    long double wide;
};

/* The number that the first `length` letters of text are. Returns false where it is too long. */
bool br_unit_convert(const struct br_unit *unit, const char *text, size_t length,
                     struct br_quantity *quantity);

/* Puts "(expression)*1e3" for kilo- into out: the expression in m, s and kg. Returns false where it
 * has no room. */
bool br_unit_apply(const struct br_unit *unit, const char *expression, char *out, size_t size);

#endif
