/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods that are compared, each with a name: "euler+lagged", "bdf2+uzawa", "bdf3+p2". A name is
 * the time scheme and the choices that are not the default for that scheme. */
#ifndef BR_STUDY_SCENE_NAMED_METHOD_H
#define BR_STUDY_SCENE_NAMED_METHOD_H

#include "solver/march.h"
#include "solver/method.h"

enum { BR_METHOD_NAME_SIZE = 80, BR_MOST_NAMED_METHODS = 64 };

struct br_named_method {
    char name[BR_METHOD_NAME_SIZE]; /* as on the command line */
    struct br_method method;
};

struct br_named_methods {
    struct br_named_method list[BR_MOST_NAMED_METHODS];
    size_t count;
};

/* Reads one name: words joined by '+', in any order, at most one of a kind: rows of the registries
 * of time schemes, contact rules, friction rules and linear solvers; "p1" and "p2", the degree of
 * the axial elements. Without a contact rule the contact is the registry's first where the scheme
 * may lag, else implicit, as on the command line. *named (out). Fails with BR_BAD_INPUT, naming the
 * word. */
enum br_status br_named_method_read(const char *name, struct br_named_method *named,
                                    struct br_error *err);

/* Reads names separated by commas, each once; *methods (out). Fails with BR_BAD_INPUT, naming
 * --methods. */
enum br_status br_named_methods_read(const char *text, struct br_named_methods *methods,
                                     struct br_error *err);

/* Adds the method of a formatted name, unless it is none, the list has it already or is full, or
 * the scene refuses it; NULL: any scene. */
__attribute__((format(printf, 3, 4))) void br_named_methods_add(struct br_named_methods *methods,
                                                                const struct br_scene *scene,
                                                                const char *format, ...);

/* The methods (out) for a scene when the user names none: every time scheme with every contact rule
 * that it accepts; elements of degree 2 for the first scheme of order two and for higher orders;
 * and the first scheme of order two with every other friction rule and every other linear solver.
 * Methods that are listed already, and those that br_march_create refuses, are left out. */
void br_named_methods_default(const struct br_scene *scene, struct br_named_methods *methods);

/* The scheme of the highest order among those with equal steps; for fine runs. */
const struct br_time_scheme *br_highest_scheme(void);

/* For the help text: the title of a kind of words, and its words (out); NULL: behind the last kind.
 */
const char *br_named_method_kind(size_t kind, char *words, size_t size);

#endif
