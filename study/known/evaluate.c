/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes trees and evaluates them node by node over arrays of points. Nodes that do not use x are
 * computed once per call. */
#include <string.h>

#include "study/known/expression.h"
#include "study/known/operations.h"

/* ---- trees ---- */

const struct br_operation_row br_operations[] = {
#define X(name, arguments, word) {arguments, word},
    BR_OPERATION_LIST(X)
#undef X
};

void br_tree_clear(struct br_tree *tree)
{
    free(tree->node);
    *tree = (struct br_tree){0};
}

/* Compares bits: 0 differs from -0. */
static bool are_equal(const struct br_node *a, const struct br_node *b)
{
    return a->operation == b->operation &&
           memcmp(a->argument, b->argument, sizeof a->argument) == 0 &&
           memcmp(&a->number, &b->number, sizeof a->number) == 0;
}

static unsigned give_up(struct br_tree_builder *b, enum br_status status)
{
    b->status = status;
    return BR_NO_NODE;
}

static bool make_room(struct br_tree_builder *b)
{
    if (b->tree.count < b->room)
        return true;
    const size_t room = b->room ? 2 * b->room : 32;
    struct br_node *node = br_allocate(room, sizeof *node);
    if (!node)
        return false;
    if (b->tree.count)
        memcpy(node, b->tree.node, b->tree.count * sizeof *node);
    free(b->tree.node);
    b->tree.node = node;
    b->room = room;
    return true;
}

static unsigned find_or_append(struct br_tree_builder *b, const struct br_node *node)
{
    for (size_t i = 0; i < b->tree.count; i++)
        if (are_equal(&b->tree.node[i], node))
            return (unsigned)i;
    if (b->tree.count == BR_TREE_MOST_NODES)
        return give_up(b, BR_BAD_INPUT);
    if (!make_room(b))
        return give_up(b, BR_NO_MEMORY);
    b->tree.node[b->tree.count] = *node;
    return (unsigned)b->tree.count++;
}

unsigned br_tree_number(struct br_tree_builder *b, double number)
{
    const struct br_node node = {.operation = BR_OP_NUMBER, .number = number};
    return b->status ? BR_NO_NODE : find_or_append(b, &node);
}

static bool is(const struct br_tree_builder *b, unsigned i, double number)
{
    return b->tree.node[i].operation == BR_OP_NUMBER && b->tree.node[i].number == number;
}

/* The simpler node of an operation on 0, 1 or the like; BR_NO_NODE: there is none. */
static unsigned simplify(struct br_tree_builder *b, enum br_operation operation, unsigned a,
                         unsigned c)
{
    switch (operation) {
    case BR_OP_NEGATE:
        return is(b, a, 0)                                 ? a
               : b->tree.node[a].operation == BR_OP_NEGATE ? b->tree.node[a].argument[0]
                                                           : BR_NO_NODE;
    case BR_OP_ADD:
        return is(b, a, 0) ? c : is(b, c, 0) ? a : BR_NO_NODE;
    case BR_OP_SUBTRACT:
        return is(b, c, 0) ? a : is(b, a, 0) ? br_tree_node(b, BR_OP_NEGATE, c, 0, 0) : BR_NO_NODE;
    case BR_OP_MULTIPLY:
        if (is(b, a, 0) || is(b, c, 1))
            return a;
        if (is(b, c, 0) || is(b, a, 1))
            return c;
        return is(b, a, -1)   ? br_tree_node(b, BR_OP_NEGATE, c, 0, 0)
               : is(b, c, -1) ? br_tree_node(b, BR_OP_NEGATE, a, 0, 0)
                              : BR_NO_NODE;
    case BR_OP_DIVIDE:
        return is(b, a, 0) || is(b, c, 1) ? a : BR_NO_NODE;
    case BR_OP_POW:
        return is(b, c, 0) ? br_tree_number(b, 1) : is(b, c, 1) ? a : BR_NO_NODE;
    default:
        return BR_NO_NODE;
    }
}

unsigned br_tree_node(struct br_tree_builder *b, enum br_operation operation, unsigned first,
                      unsigned second, unsigned third)
{
    const unsigned argument[] = {first, second, third};
    struct br_node node = {
        .operation = operation, .uses_x = operation == BR_OP_X, .uses_t = operation == BR_OP_T};
    double number[3] = {0};
    size_t numbers = 0;
    for (unsigned i = 0; i < br_operations[operation].arguments; i++) {
        if (b->status || argument[i] == BR_NO_NODE)
            return BR_NO_NODE;
        const struct br_node *a = &b->tree.node[argument[i]];
        node.argument[i] = argument[i];
        node.uses_x |= a->uses_x;
        node.uses_t |= a->uses_t;
        numbers += a->operation == BR_OP_NUMBER;
        number[i] = a->number;
    }
    const unsigned shorter = b->simplifies ? simplify(b, operation, first, second) : BR_NO_NODE;
    if (shorter != BR_NO_NODE || b->status)
        return shorter;
    if (numbers && numbers == br_operations[operation].arguments)
        return br_tree_number(b, br_operation_value(operation, number[0], number[1], number[2]));
    return find_or_append(b, &node);
}

unsigned br_tree_graft(struct br_tree_builder *b, const struct br_tree *from, unsigned root)
{
    return br_tree_substitute(b, from, root, BR_NO_NODE, BR_NO_NODE);
}

unsigned br_tree_substitute(struct br_tree_builder *b, const struct br_tree *from, unsigned root,
                            unsigned x, unsigned t)
{
    unsigned *moved = br_allocate(root + 1, sizeof *moved);
    if (!moved)
        return give_up(b, BR_NO_MEMORY);
    moved[root] = 1; /* first pass: whether each node is used */
    for (unsigned i = root + 1; i-- > 0;)
        for (unsigned k = 0; moved[i] && k < br_operations[from->node[i].operation].arguments; k++)
            moved[from->node[i].argument[k]] = 1;
    for (unsigned i = 0; i <= root; i++) { /* second pass: its new index */
        const struct br_node *n = &from->node[i];
        const unsigned instead = n->operation == BR_OP_X   ? x
                                 : n->operation == BR_OP_T ? t
                                                           : BR_NO_NODE;
        if (moved[i] && instead != BR_NO_NODE)
            moved[i] = instead;
        else if (moved[i] && n->operation == BR_OP_NUMBER)
            moved[i] = br_tree_number(b, n->number);
        else if (moved[i])
            moved[i] = br_tree_node(b, n->operation, moved[n->argument[0]], moved[n->argument[1]],
                                    moved[n->argument[2]]);
    }
    const unsigned out = moved[root];
    free(moved);
    return out;
}

static enum br_status refuse(enum br_status status, struct br_error *err)
{
    return status == BR_NO_MEMORY ? br_no_memory(err, "an expression")
           : status ? br_fail(err, status, "it has more than %d operations", BR_TREE_MOST_NODES)
                    : BR_OK;
}

enum br_status br_tree_part(const struct br_tree *from, unsigned root, struct br_tree *part,
                            struct br_error *err)
{
    struct br_tree_builder b = {0};
    br_tree_graft(&b, from, root);
    if (b.status)
        br_tree_clear(&b.tree);
    *part = b.tree;
    return refuse(b.status, err);
}

enum br_status br_tree_finish(struct br_tree_builder *b, unsigned root, struct br_tree *tree,
                              struct br_error *err)
{
    *tree = (struct br_tree){0};
    const enum br_status status =
        b->status ? refuse(b->status, err) : br_tree_part(&b->tree, root, tree, err);
    br_tree_clear(&b->tree);
    *b = (struct br_tree_builder){0};
    return status;
}

/* ---- operations on arrays ---- */

#define ROW(set) &br_elementary_##set,
const struct br_elementary *const br_elementary_all[] = {BR_INSTRUCTION_SETS(ROW) NULL};

double br_operation_value(enum br_operation operation, double a, double b, double c)
{
    enum { MOST_WIDTH = 8 };
    _Alignas(64) double value[4][MOST_WIDTH];
    for (size_t i = 0; i < MOST_WIDTH; i++) {
        value[0][i] = a;
        value[1][i] = b;
        value[2][i] = c;
    }
    const struct br_elementary *set = br_elementary_all[br_instruction_set_best()];
    const double *const argument[3] = {value[0], value[1], value[2]};
    const int rounding = br_round_to_nearest();
    set->apply(operation, set->width, argument, value[3]);
    br_round_as_before(rounding);
    return value[3][0];
}

/* ---- trees as functions ---- */

enum { CHUNK = 256 }; /* points at a time: the arrays stay in the fast caches */

/* A tree and the workspace of its bounds. */
struct enclosed {
    struct br_tree tree;
    struct br_interval *work; /* a switching function uses that of its expression */
};

struct switching {
    struct enclosed of;
    struct br_function f;
};

struct expression {
    struct enclosed of; /* first member: bounds take a pointer to it */
    const struct br_elementary *set;
    double *room; /* CHUNK values of each node */
    struct switching *switching;
    size_t switchings;
};

static void expression_free(void *self)
{
    struct expression *e = self;
    if (!e)
        return;
    for (size_t i = 0; i < e->switchings; i++)
        br_tree_clear(&e->switching[i].of.tree);
    br_tree_clear(&e->of.tree);
    free(e->of.work);
    free(e->switching);
    free(e->room);
    free(e);
}

static void fill(double *array, size_t count, double value)
{
    for (size_t i = 0; i < count; i++)
        array[i] = value;
}

static double *values_of(const struct expression *e, size_t node)
{
    return e->room + node * CHUNK;
}

static const struct br_function_ops switching_ops;

static bool is_truth(enum br_operation o)
{
    return o == BR_OP_NOT || (o >= BR_OP_LESS && o <= BR_OP_OR);
}

static bool compares(enum br_operation o)
{
    return o >= BR_OP_MIN && o <= BR_OP_EQUAL;
}

/* Whether a node jumps or bends where argument k changes its sign; of a comparison, min or max:
 * where the difference of both arguments does. A truth value needs no switching function: it jumps
 * where the switching functions of its own arguments change their signs. */
static bool needs_switching(const struct br_tree *tree, const struct br_node *n, unsigned k)
{
    const enum br_operation o = n->operation;
    if (!n->uses_x && !n->uses_t)
        return false;
    if (compares(o))
        return k == 0;
    return o == BR_OP_ABS || o == BR_OP_SIGN || o == BR_OP_STEP ||
           (!is_truth(tree->node[n->argument[k]].operation) &&
            (o == BR_OP_NOT || o == BR_OP_AND || o == BR_OP_OR || (o == BR_OP_CHOOSE && k == 0)));
}

/* Appends the switching function, which has at most one node more than the tree. */
static bool add_switching(struct expression *e, const struct br_node *n, unsigned k)
{
    struct br_tree_builder b = {0};
    struct switching *g = &e->switching[e->switchings];
    unsigned root = br_tree_graft(&b, &e->of.tree, n->argument[k]);
    if (compares(n->operation))
        root = br_tree_node(&b, BR_OP_SUBTRACT, root,
                            br_tree_graft(&b, &e->of.tree, n->argument[1]), 0);
    if (br_tree_finish(&b, root, &g->of.tree, NULL))
        return false;
    const struct br_node *last = &g->of.tree.node[g->of.tree.count - 1];
    g->of.work = e->of.work;
    g->f = (struct br_function){
        .ops = &switching_ops, .self = &g->of, .uses_x = last->uses_x, .uses_t = last->uses_t};
    e->switchings++;
    return true;
}

/* Takes the tree over, even after a failure. */
static struct expression *create(struct br_tree *tree)
{
    const struct br_tree own = *tree;
    struct expression *e = br_allocate(1, sizeof *e);
    if (!e)
        br_tree_clear(tree);
    *tree = (struct br_tree){0};
    if (!e)
        return NULL;
    e->of = (struct enclosed){own, br_allocate(own.count + 1, BR_TREE_WORK * sizeof *e->of.work)};
    e->set = br_elementary_all[br_instruction_set_best()];
    e->room = br_allocate_aligned(own.count * CHUNK, sizeof *e->room);
    e->switching = br_allocate(3 * own.count, sizeof *e->switching);
    bool done = e->of.work && e->room && e->switching;
    for (size_t i = 0; i < own.count && done; i++) {
        const struct br_node *n = &own.node[i];
        if (n->operation == BR_OP_NUMBER)
            fill(values_of(e, i), CHUNK, n->number);
        for (unsigned k = 0; k < br_operations[n->operation].arguments && done; k++)
            done = !needs_switching(&own, n, k) || add_switching(e, n, k);
    }
    if (done)
        return e;
    expression_free(e);
    return NULL;
}

static void *expression_clone(const void *self)
{
    const struct br_tree *from = &((const struct expression *)self)->of.tree;
    struct br_tree copy;
    return br_tree_part(from, (unsigned)from->count - 1, &copy, NULL) ? NULL : create(&copy);
}

static size_t round_up(size_t count, size_t width)
{
    return (count + width - 1) / width * width;
}

static void apply(const struct expression *e, size_t i, size_t count)
{
    const struct br_node *n = &e->of.tree.node[i];
    const double *const argument[] = {values_of(e, n->argument[0]), values_of(e, n->argument[1]),
                                      values_of(e, n->argument[2])};
    e->set->apply(n->operation, count, argument, values_of(e, i));
}

/* Evaluates the nodes that do not use x, and fills the first `count` values of each. */
static void evaluate_once(const struct expression *e, double t, size_t count)
{
    for (size_t i = 0; i < e->of.tree.count; i++) {
        const struct br_node *n = &e->of.tree.node[i];
        double *value = values_of(e, i);
        if (n->uses_x || n->operation == BR_OP_NUMBER)
            continue;
        if (n->operation == BR_OP_T)
            value[0] = t;
        else
            apply(e, i, e->set->width);
        fill(value, count, value[0]);
    }
}

/* At most CHUNK points. The last vector is filled up with the last point. */
static void evaluate_points(const struct expression *e, size_t count, const double *x)
{
    const size_t full = round_up(count, e->set->width);
    for (size_t i = 0; i < e->of.tree.count; i++) {
        const struct br_node *n = &e->of.tree.node[i];
        if (n->operation == BR_OP_X) {
            memcpy(values_of(e, i), x, count * sizeof *x);
            fill(values_of(e, i) + count, full - count, x[count - 1]);
        } else if (n->uses_x) {
            apply(e, i, full);
        }
    }
}

static void expression_evaluate(void *self, size_t count, const double *x, double t, double *value)
{
    const struct expression *e = self;
    const double *root = values_of(e, e->of.tree.count - 1);
    const int rounding = br_round_to_nearest();
    evaluate_once(e, t, count < CHUNK ? round_up(count, e->set->width) : CHUNK);
    for (size_t done = 0; done < count; done += CHUNK) {
        const size_t some = count - done < CHUNK ? count - done : CHUNK;
        evaluate_points(e, some, x + done);
        memcpy(value + done, root, some * sizeof *value);
    }
    br_round_as_before(rounding);
}

static enum br_status expression_derive(const void *self, const struct br_derivation *what,
                                        struct br_function *out, struct br_error *err)
{
    struct br_tree tree;
    const enum br_status status =
        br_tree_derivation(&((const struct expression *)self)->of.tree, what, &tree, err);
    return status ? status : br_tree_function(&tree, out, err);
}

static bool expression_bound(const void *self, struct br_box box, struct br_interval *value)
{
    const struct enclosed *e = self;
    return br_tree_bound(&e->tree, e->work, box, value);
}

static bool expression_taylor(const void *self, enum br_variable along, struct br_box box,
                              size_t order, struct br_interval *coefficient)
{
    const struct enclosed *e = self;
    return br_tree_taylor(&e->tree, e->work, along, box, order, coefficient);
}

static const struct br_function *expression_switching(const void *self, size_t i)
{
    const struct expression *e = self;
    return i < e->switchings ? &e->switching[i].f : NULL;
}

static const struct br_function_ops expression_ops = {
    .evaluate = expression_evaluate,
    .clone = expression_clone,
    .free = expression_free,
    .bound = expression_bound,
    .taylor = expression_taylor,
    .switching = expression_switching,
    .derive = expression_derive,
};

/* A switching function is never evaluated. */
static const struct br_function_ops switching_ops = {
    .bound = expression_bound,
    .taylor = expression_taylor,
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
    return f->ops == &expression_ops ? &((const struct expression *)f->self)->of.tree : NULL;
}
