/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BR_CLI_NUMBER_OPTION_H
#define BR_CLI_NUMBER_OPTION_H

#include "solver/status.h"

/* Reads a whole number from 0 to `most`; text NULL: not given, *value stays. Fails with
 * BR_BAD_INPUT, naming the option. */
enum br_status br_read_count_option(const char *option, const char *text, int most, int *value,
                                    struct br_error *err);

/* Reads a number above `low` and below `high`, which may be infinite, likewise. */
enum br_status br_read_number_option(const char *option, const char *text, double low, double high,
                                     double *value, struct br_error *err);

#endif
