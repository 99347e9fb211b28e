/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods that are held against each other: a contender is a method with a name. The name is made
 * of rows of the registries, "euler+lagged", "bdf2+uzawa", "trbdf2+p2": a time scheme, and what is
 * not the default for it. */
#ifndef BR_CONTENDER_H
#define BR_CONTENDER_H

#include "solver/march.h"

enum { BR_CONTENDER_NAME = 80, BR_MOST_CONTENDERS = 64 };

struct br_contender {
    char name[BR_CONTENDER_NAME]; /* as on the command line */
    struct br_method method;
};

struct br_contenders {
    struct br_contender list[BR_MOST_CONTENDERS];
    size_t count;
};

/* What a scene's method means without its name: whether the steps are chosen by a tolerance. */
bool br_contender_adaptive(const struct br_contender *contender);

/* Reads one name: rows joined by '+', in any order, one of a registry at most; "p1" and "p2" are
 * the degrees of the axial elements. Without a contact rule the contact is implicit, but with a
 * scheme that may lag it is the registry's first, as on the command line. *contender (out). Fails
 * with BR_BAD_INPUT, naming the word. */
enum br_status br_contender_read(const char *name, struct br_contender *contender,
                                 struct br_error *err);

/* Reads names separated by commas; each once. Fails with BR_BAD_INPUT, naming the option. */
enum br_status br_contenders_read(const char *option, const char *text,
                                  struct br_contenders *contenders, struct br_error *err);

/* Who a scene is marched by where nobody is named: every time scheme with every contact rule that
 * it takes; and the first scheme of order two or more with every other friction rule, every other
 * linear solver and every other degree. Left out is what is the same as another one in this scene,
 * and what br_march_create refuses. */
void br_contenders_default(const struct br_scene *scene, struct br_contenders *contenders);

#endif
