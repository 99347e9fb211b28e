/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tree as a function: node by node over arrays of places. What does not use x is computed once a
 * call. */
#include <fenv.h>
#include <string.h>

#include "study/scene/derive.h"
#include "study/scene/elementary.h"
#include "study/scene/enclosure.h"

enum { CHUNK = 256 }; /* places at a time: the arrays stay in the first caches */

struct expression {
    struct br_tree tree;
    const struct br_elementary *set;
    double **array; /* of each node: CHUNK values, in a slot of `room` */
    double *room;
    struct br_proofs proofs;
};

static void expression_free(void *self)
{
    struct expression *e = self;
    if (!e)
        return;
    br_proofs_clear(&e->proofs);
    br_tree_clear(&e->tree);
    free(e->array);
    free(e->room);
    free(e);
}

/* last[i]: the last node that needs node i; those that do not use x are kept for the whole call. */
static void find_last_uses(const struct br_tree *tree, size_t *last)
{
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        last[i] = n->uses_x ? i : tree->count;
        for (unsigned k = 0; k < br_operation_arguments(n->operation); k++)
            if (last[n->argument[k]] < i)
                last[n->argument[k]] = i;
    }
}

/* Gives each node a slot; one whose node is needed no more is given again. slot, spare, last: out
 * and workspace, tree->count each. Returns how many slots there are. */
static size_t give_slots(const struct br_tree *tree, size_t *slot, size_t *spare, size_t *last)
{
    size_t slots = 0, spares = 0;
    find_last_uses(tree, last);
    for (size_t i = 0; i < tree->count; i++) {
        const struct br_node *n = &tree->node[i];
        slot[i] = n->uses_x && spares ? spare[--spares] : slots++;
        for (unsigned k = 0; k < br_operation_arguments(n->operation); k++)
            if (last[n->argument[k]] == i) {
                spare[spares++] = slot[n->argument[k]];
                last[n->argument[k]] = tree->count; /* once, where it is both arguments */
            }
    }
    return slots;
}

static void fill(double *array, size_t count, double value)
{
    for (size_t i = 0; i < count; i++)
        array[i] = value;
}

static bool make_arrays(struct expression *e)
{
    const size_t count = e->tree.count;
    size_t *slot = br_allocate(3 * count, sizeof *slot);
    e->array = br_allocate(count, sizeof *e->array);
    const size_t slots = slot ? give_slots(&e->tree, slot, slot + count, slot + 2 * count) : 0;
    e->room = slots ? br_allocate_aligned(slots * CHUNK, sizeof *e->room) : NULL;
    const bool done = e->array && e->room;
    for (size_t i = 0; i < count && done; i++) {
        e->array[i] = e->room + slot[i] * CHUNK;
        if (e->tree.node[i].operation == BR_OP_NUMBER)
            fill(e->array[i], CHUNK, e->tree.node[i].number);
    }
    free(slot);
    return done;
}

/* Takes the tree over, even where it fails. */
static struct expression *create(struct br_tree *tree)
{
    struct expression *e = br_allocate(1, sizeof *e);
    if (!e) {
        br_tree_clear(tree);
        return NULL;
    }
    e->tree = *tree;
    *tree = (struct br_tree){0};
    e->set = br_elementary_best();
    struct br_error unsaid;
    if (make_arrays(e) && !br_proofs_init(&e->proofs, &e->tree, &unsaid))
        return e;
    expression_free(e);
    return NULL;
}

static void *expression_clone(const void *self)
{
    const struct br_tree *from = &((const struct expression *)self)->tree;
    struct br_tree copy = {br_allocate(from->count, sizeof *copy.node), from->count};
    if (!copy.node)
        return NULL;
    memcpy(copy.node, from->node, from->count * sizeof *copy.node);
    return create(&copy);
}

static size_t round_up(size_t count, size_t width)
{
    return (count + width - 1) / width * width;
}

static void apply(const struct expression *e, size_t i, size_t count)
{
    const struct br_node *n = &e->tree.node[i];
    const double *const argument[] = {e->array[n->argument[0]], e->array[n->argument[1]],
                                      e->array[n->argument[2]]};
    br_operation_apply(e->set, n->operation, count, argument, e->array[i]);
}

/* What does not use x, in as many values as will be wanted at a time. */
static void evaluate_once(const struct expression *e, double t, size_t count)
{
    for (size_t i = 0; i < e->tree.count; i++) {
        const struct br_node *n = &e->tree.node[i];
        if (n->uses_x || n->operation == BR_OP_NUMBER)
            continue;
        if (n->operation == BR_OP_T)
            e->array[i][0] = t;
        else
            apply(e, i, e->set->width);
        fill(e->array[i], count, e->array[i][0]);
    }
}

/* At most CHUNK places; the vectors' last places are filled with the last one. */
static void evaluate_places(const struct expression *e, size_t count, const double *x)
{
    const size_t full = round_up(count, e->set->width);
    for (size_t i = 0; i < e->tree.count; i++) {
        const struct br_node *n = &e->tree.node[i];
        if (n->operation == BR_OP_X) {
            memcpy(e->array[i], x, count * sizeof *x);
            fill(e->array[i] + count, full - count, x[count - 1]);
        } else if (n->uses_x) {
            apply(e, i, full);
        }
    }
}

static void expression_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct expression *e = self;
    const double *root = e->array[e->tree.count - 1];
    const int rounding = fegetround();
    if (rounding != FE_TONEAREST)
        fesetround(FE_TONEAREST);
    evaluate_once(e, t, count < CHUNK ? round_up(count, e->set->width) : CHUNK);
    for (size_t done = 0; done < count; done += CHUNK) {
        const size_t some = count - done < CHUNK ? count - done : CHUNK;
        evaluate_places(e, some, x + done);
        memcpy(value + done, root, some * sizeof *value);
    }
    if (rounding != FE_TONEAREST)
        fesetround(rounding);
}

static enum br_status expression_derive(const void *self, const struct br_derivation *what,
                                        struct br_function *out, struct br_error *err)
{
    struct br_tree tree;
    const enum br_status status =
        br_tree_derivation(&((const struct expression *)self)->tree, what, &tree, err);
    return status ? status : br_tree_function(&tree, out, err);
}

static bool expression_bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct expression *e = self;
    return br_tree_bound(&e->tree, e->proofs.work, box, value);
}

static bool expression_taylor(const void *self, enum br_variable along, struct br_box box,
                              size_t order, struct br_interval *coefficient)
{
    const struct expression *e = self;
    return br_tree_taylor(&e->tree, e->proofs.work, along, box, order, coefficient);
}

static const struct br_function *expression_guard(const void *self, size_t i)
{
    const struct expression *e = self;
    return i < e->proofs.guards ? &e->proofs.guard[i] : NULL;
}

static const struct br_function_ops expression_ops = {
    .evaluate = expression_evaluate,
    .clone = expression_clone,
    .free = expression_free,
    .bound = expression_bound,
    .taylor = expression_taylor,
    .guard = expression_guard,
    .derive = expression_derive,
};

enum br_status br_tree_function(struct br_tree *tree, struct br_function *f, struct br_error *err)
{
    const struct br_node *root = &tree->node[tree->count - 1];
    *f = (struct br_function){.uses_x = root->uses_x, .uses_t = root->uses_t};
    if (root->operation == BR_OP_NUMBER) {
        f->constant = root->number;
        br_tree_clear(tree);
        return BR_OK;
    }
    f->self = create(tree);
    if (!f->self) {
        *f = (struct br_function){0};
        return br_no_memory(err, "an expression");
    }
    f->ops = &expression_ops;
    return BR_OK;
}

const struct br_tree *br_tree_of(const struct br_function *f)
{
    return f->ops == &expression_ops ? &((const struct expression *)f->self)->tree : NULL;
}
