/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the program has of the beam beside its commands. */
#ifndef BR_CLI_BEAM_BEAM_H
#define BR_CLI_BEAM_BEAM_H

#include "cli/command.h"
#include "study/scene/method_fields.h"

extern const struct br_beam br_beam; /* topics.c */

/* ---- options (option_rows.c) ---- */

extern const struct br_words br_reference_words;

/* Adds the options of the beam that a command takes behind `count` others. */
size_t br_beam_add_options(const struct br_command *command, struct br_option row[BR_OPTIONS],
                           size_t count);

/* The default of an option of the method. */
const char *br_beam_standard(const struct br_option *row, char text[BR_OPTION_TEXT]);

/* Names and numbers of a method must be valid, whatever a scene says; --steps becomes --k, and the
 * two exclude each other. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_beam_check_options(struct br_options *options, struct br_error *err);

/* ---- the documentation, made from commands, options and registries ---- */

/* The registries whose rows are chosen by name, with their headings; returns their number. */
enum { BR_REGISTRIES = BR_METHOD_FIELDS + 3 };
size_t br_registries(struct br_registry list[BR_REGISTRIES]);

/* The manual page, and docs/options.md. */
void br_print_manual(FILE *out);
void br_print_options_page(FILE *out);

#endif
