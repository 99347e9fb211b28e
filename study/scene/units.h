/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of the numbers and expressions of a scene: "kN/m", "N mm^2", "lbf/in".
 *
 * Why no library: with udunits2 a number would depend on data files and variables of the machine,
 * 9 mm would differ from the 0.009 m that strtod reads, and N/m s would be ambiguous. */
#ifndef BR_STUDY_SCENE_UNITS_H
#define BR_STUDY_SCENE_UNITS_H

#include <stdbool.h>
#include <stddef.h>

/* The powers of metre, second and kilogram. */
struct br_dimension {
    int metre, second, kilogram;
};

/* Factor 10^ten times these powers; the factor of a decimal multiple is exactly 1. */
struct br_unit {
    struct br_dimension of;
    long double factor;
    int ten;
};

/* Reads a unit: words with powers, separated by blanks or *, then at most one / with one word or a
 * bracket after it; "" and "1" are 1. Returns false if the text is not a unit. */
bool br_unit_read(const char *text, struct br_unit *unit);

bool br_dimension_is(struct br_dimension a, struct br_dimension b);

/* Returns "a force per length"; for a dimension without a name, its powers in `text` (out). */
enum { BR_DIMENSION_TEXT = 64 };
const char *br_dimension_words(struct br_dimension d, char text[BR_DIMENSION_TEXT]);

/* Lists the words of all units, for a message; returns text (out). */
enum { BR_UNIT_WORDS = 160 };
const char *br_unit_words(char text[BR_UNIT_WORDS]);

/* The end of a message about a text that is no unit: "; did you mean 'kN/m'?" if a change of one of
 * its words makes a unit of the dimension, else nothing; returns text (out, BR_SUGGESTION bytes).
 */
char *br_unit_suggestion(const char *unknown, struct br_dimension of, char *text);

/* A number in m, s and kg. For a decimal multiple, the double is what strtod reads after the
 * decimal point is moved. For another unit it is the rounded long double. */
struct br_si_number {
    double value;
    long double wide;
};

/* Converts the decimal number in the first `length` characters of text. Returns false if it is too
 * long. */
bool br_unit_convert(const struct br_unit *unit, const char *text, size_t length,
                     struct br_si_number *quantity);

/* Writes the expression in m, s and kg to out, for kilo- "(expression)*1000". Returns false if it
 * does not fit. */
bool br_unit_apply(const struct br_unit *unit, const char *expression, char *out, size_t size);

#endif
