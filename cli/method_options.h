/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options that choose a method, the same in every command that marches. */
#ifndef BR_CLI_METHOD_OPTIONS_H
#define BR_CLI_METHOD_OPTIONS_H

#include <popt.h>
#include <stdio.h>

#include "solver/march.h"

/* As given, before they are checked; NULL: not given. */
struct br_method_options {
    char *scheme, *tolerance;
    char *solver, *kernel, *scaling, *refinement;
    char *contact, *friction;
    char *friction_parameter, *friction_tolerance, *friction_iterations;
    char *axial_degree;
};

enum { BR_METHOD_OPTIONS = 13 };

/* Fills the table that a command's own one includes by BR_INCLUDE_METHOD(table); both must
 * outlive popt's context. */
void br_method_options_table(struct br_method_options *options,
                             struct poptOption table[BR_METHOD_OPTIONS]);
#define BR_INCLUDE_METHOD(table)                                        \
    {                                                                   \
        NULL, '\0', POPT_ARG_INCLUDE_TABLE, (table), 0, "Method:", NULL \
    }

void br_method_options_clear(struct br_method_options *options);

/* Puts what the options say into *method (in/out); what they do not say stays, but for the contact
 * rule, which follows a scheme that cannot do with it. Fails with BR_BAD_INPUT, naming the option,
 * what was found and what was expected. */
enum br_status br_method_options_read(const struct br_method_options *options,
                                      struct br_method *method, struct br_error *err);

/* Refuses (BR_BAD_INPUT) an option that none of `count` methods heeds: it is not ignored. */
enum br_status br_method_options_check(const struct br_method_options *options,
                                       const struct br_method *const *method, size_t count,
                                       struct br_error *err);

/* One line a scheme, solver, kernel, contact rule and friction rule, below a command's options. */
void br_print_method_registries(FILE *out);

#endif
