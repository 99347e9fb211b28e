/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods that are held against each other: a contender is a method with a name. The name is made
 * of rows of the registries, "euler+lagged", "bdf2+uzawa", "bdf3+p2": a time scheme, and what is
 * not the default for it. */
#ifndef BR_STUDY_TRADE_CONTENDER_H
#define BR_STUDY_TRADE_CONTENDER_H

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

/* Whether the steps are chosen by a tolerance. */
bool br_contender_adaptive(const struct br_contender *contender);

/* Reads one name: words joined by '+', in any order, at most one of a kind: rows of the registries
 * of time schemes, contact rules, friction rules and linear solvers; "p1" and "p2", the degree of
 * the axial elements; "scaled" and "refined", for solvers that heed that. Without a contact rule
 * the contact is the registry's first where the scheme may lag, else implicit, as on the command
 * line. *contender (out). Fails with BR_BAD_INPUT, naming the word. */
enum br_status br_contender_read(const char *name, struct br_contender *contender,
                                 struct br_error *err);

/* Reads names separated by commas, each once; *contenders (out). Fails with BR_BAD_INPUT, naming
 * the option. */
enum br_status br_contenders_read(const char *option, const char *text,
                                  struct br_contenders *contenders, struct br_error *err);

/* Who a scene is marched by where nobody is named (out): every time scheme with every contact rule
 * that it takes; elements of degree 2 where the scheme's order is worth them; and the first scheme
 * of order two with every other friction rule and every other linear solver. Left out is what is
 * the same as another one in this scene, and what br_march_create refuses. */
void br_contenders_default(const struct br_scene *scene, struct br_contenders *contenders);

/* The words of names as lines of help: a kind, then its words. */
size_t br_contender_kinds(void);
const char *br_contender_kind(size_t kind, char *words, size_t size);

#endif
