/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods that are compared, each by its name. The name is made of rows of the registries,
 * "euler+lagged", "bdf2+uzawa", "bdf3+p2": a time scheme, and what is not the default for it. */
#ifndef BR_STUDY_TRADE_NAMED_METHOD_H
#define BR_STUDY_TRADE_NAMED_METHOD_H

#include "solver/march.h"

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
 * the axial elements; "scaled" and "refined", for solvers that accept that option. Without a
 * contact rule the contact is the registry's first where the scheme may lag, else implicit, as on
 * the command line. *named (out). Fails with BR_BAD_INPUT, naming the word. */
enum br_status br_named_method_read(const char *name, struct br_named_method *named,
                                    struct br_error *err);

/* Reads names separated by commas, each once; *methods (out). Fails with BR_BAD_INPUT, naming
 * the option. */
enum br_status br_named_methods_read(const char *option, const char *text,
                                     struct br_named_methods *methods, struct br_error *err);

/* Who a scene is marched by where nobody is named (out): every time scheme with every contact rule
 * that it takes; elements of degree 2 where the scheme's order is worth them; and the first scheme
 * of order two with every other friction rule and every other linear solver. Left out is what is
 * the same as another one in this scene, and what br_march_create refuses. */
void br_named_methods_default(const struct br_scene *scene, struct br_named_methods *methods);

/* The scheme of the highest order among those that do not choose their steps: a fine run's. */
const struct br_time_scheme *br_highest_scheme(void);

/* The words of names as lines of help: a kind, then its words (out); NULL: behind the last. */
const char *br_named_method_kind(size_t kind, char *words, size_t size);

#endif
