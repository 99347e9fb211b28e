/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of a registry's rows as "a, b", for help and messages. Static strings. */
#ifndef BR_CLI_NAMES_H
#define BR_CLI_NAMES_H

#include <stdio.h>

const char *br_scheme_names(void);
const char *br_solver_names(void);
const char *br_kernel_names(void); /* those that are available here */
const char *br_contact_names(void);
const char *br_friction_names(void);
const char *br_judge_names(void);
const char *br_norm_names(void);
const char *br_format_names(void);

/* Below the help of commands that compare methods: the words of their names, and the norms. */
void br_print_contender_words(FILE *out);

#endif
