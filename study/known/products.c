/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/scene.h"
#include "study/known/expression.h"

#include <math.h>

/* A sum of products, as nodes of a builder. */
struct sum {
    size_t count;
    struct {
        unsigned space, time;
    } term[BR_LOAD_TERMS];
};

/* The builder begins with a copy of the expression, whose indices do not change. */
struct products_work {
    struct br_tree_builder builder;
    unsigned one;
};

static unsigned multiply(struct products_work *w, unsigned a, unsigned b)
{
    return a == w->one ? b : b == w->one ? a : br_tree_node(&w->builder, BR_OP_MULTIPLY, a, b, 0);
}

static unsigned divide(struct products_work *w, unsigned a, unsigned b)
{
    return b == w->one ? a : br_tree_node(&w->builder, BR_OP_DIVIDE, a, b, 0);
}

static unsigned add(struct products_work *w, unsigned a, unsigned b)
{
    return br_tree_node(&w->builder, BR_OP_ADD, a, b, 0);
}

static bool uses_t(const struct products_work *w, unsigned node)
{
    return node != BR_NO_NODE && w->builder.tree.node[node].uses_t;
}

/* Adds a product, or merges it with one of equal space or time factor. False: too many. */
static bool append(struct products_work *w, struct sum *s, unsigned space, unsigned time)
{
    for (size_t i = 0; i < s->count; i++) {
        if (s->term[i].space == space) {
            s->term[i].time = add(w, s->term[i].time, time);
            return true;
        }
        if (s->term[i].time == time && uses_t(w, s->term[i].space) == uses_t(w, space)) {
            s->term[i].space = add(w, s->term[i].space, space);
            return true;
        }
    }
    if (s->count == BR_LOAD_TERMS)
        return false;
    s->term[s->count].space = space;
    s->term[s->count++].time = time;
    return true;
}

static struct sum single(unsigned space, unsigned time)
{
    return (struct sum){1, {{space, time}}};
}

static struct sum split(struct products_work *w, unsigned i);

static void negate(struct products_work *w, struct sum *s)
{
    for (size_t i = 0; i < s->count; i++) {
        unsigned *factor = s->term[i].space == w->one ? &s->term[i].time : &s->term[i].space;
        *factor = br_tree_node(&w->builder, BR_OP_NEGATE, *factor, 0, 0);
    }
}

static bool add_all(struct products_work *w, struct sum *to, const struct sum *from)
{
    bool fits = true;
    for (size_t i = 0; i < from->count && fits; i++)
        fits = append(w, to, from->term[i].space, from->term[i].time);
    return fits;
}

/* a * b, where one of them is a single product, or a / b, where b is one. */
static bool combine(struct products_work *w, const struct sum *a, const struct sum *b,
                    bool quotient, struct sum *out)
{
    bool fits = b->count == 1 || (a->count == 1 && !quotient);
    *out = (struct sum){0};
    for (size_t i = 0; i < a->count; i++)
        for (size_t j = 0; j < b->count && fits; j++) {
            const unsigned space[] = {a->term[i].space, b->term[j].space};
            const unsigned time[] = {a->term[i].time, b->term[j].time};
            fits = quotient
                       ? append(w, out, divide(w, space[0], space[1]), divide(w, time[0], time[1]))
                       : append(w, out, multiply(w, space[0], space[1]),
                                multiply(w, time[0], time[1]));
        }
    return fits;
}

static bool is_integer(const struct products_work *w, unsigned i)
{
    const struct br_node *n = &w->builder.tree.node[i];
    return n->operation == BR_OP_NUMBER && n->number == rint(n->number);
}

/* F(x)^n G(t)^n, and likewise abs. */
static bool of_product(struct products_work *w, const struct br_node *n, struct sum *out)
{
    if ((n->operation == BR_OP_POW && !is_integer(w, n->argument[1])))
        return false;
    *out = split(w, n->argument[0]);
    if (out->count != 1)
        return false;
    unsigned *factor[] = {&out->term[0].space, &out->term[0].time};
    for (int i = 0; i < 2; i++)
        if (*factor[i] != w->one)
            *factor[i] = br_tree_node(&w->builder, n->operation, *factor[i], n->argument[1], 0);
    return true;
}

/* Writes a node as a sum of products; false: it is not one. */
static bool multiply_out(struct products_work *w, const struct br_node *n, struct sum *out)
{
    struct sum other;
    switch (n->operation) {
    case BR_OP_NEGATE:
        *out = split(w, n->argument[0]);
        negate(w, out);
        return true;
    case BR_OP_ADD:
    case BR_OP_SUBTRACT:
        *out = split(w, n->argument[0]);
        other = split(w, n->argument[1]);
        if (n->operation == BR_OP_SUBTRACT)
            negate(w, &other);
        return add_all(w, out, &other);
    case BR_OP_MULTIPLY:
    case BR_OP_DIVIDE: {
        const struct sum first = split(w, n->argument[0]);
        other = split(w, n->argument[1]);
        return combine(w, &first, &other, n->operation == BR_OP_DIVIDE, out);
    }
    case BR_OP_POW:
    case BR_OP_ABS:
        return of_product(w, n, out);
    default:
        return false;
    }
}

static struct sum split(struct products_work *w, unsigned i)
{
    struct sum out;
    if (i == BR_NO_NODE)
        return single(i, i);
    const struct br_node n = w->builder.tree.node[i]; /* the list moves as it grows */
    if (n.uses_x && n.uses_t && multiply_out(w, &n, &out))
        return out;
    return n.uses_x || !n.uses_t ? single(i, w->one) : single(w->one, i);
}

static enum br_status function_of(struct products_work *w, unsigned root, struct br_function *f,
                                  struct br_error *err)
{
    struct br_tree tree;
    const enum br_status status = br_tree_part(&w->builder.tree, root, &tree, err);
    return status ? status : br_tree_function(&tree, f, err);
}

enum br_status br_products(struct br_function *f, struct br_load *load, struct br_error *err)
{
    const struct br_function one = {.constant = 1};
    *load = (struct br_load){0};
    if (!f->uses_x || !f->uses_t || !br_tree_of(f)) {
        load->term[0] = f->uses_x ? (struct br_product){*f, one} : (struct br_product){one, *f};
        return BR_OK;
    }
    struct products_work w = {0};
    w.one = br_tree_number(&w.builder, 1);
    const struct br_tree *tree = br_tree_of(f);
    const struct sum sum = split(&w, br_tree_graft(&w.builder, tree, (unsigned)tree->count - 1));
    if (w.builder.status == BR_BAD_INPUT) { /* too many nodes when multiplied out */
        br_tree_clear(&w.builder.tree);
        load->term[0] = (struct br_product){*f, one};
        return BR_OK;
    }
    enum br_status status = w.builder.status ? br_no_memory(err, "a load's products") : BR_OK;
    for (size_t i = 0; i < sum.count && !status; i++) {
        status = function_of(&w, sum.term[i].space, &load->term[i].space, err);
        if (!status)
            status = function_of(&w, sum.term[i].time, &load->term[i].time, err);
    }
    br_tree_clear(&w.builder.tree);
    br_function_free(f);
    if (status)
        br_load_clear(load);
    return status;
}
