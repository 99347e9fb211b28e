/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene/tree.h"

#include <string.h>

static const struct {
    unsigned arguments;
    const char *word;
} operations[] = {
#define X(name, arguments, word) {arguments, word},
    BR_OPERATION_LIST(X)
#undef X
};

unsigned br_operation_arguments(enum br_operation operation)
{
    return operations[operation].arguments;
}

const char *br_operation_word(enum br_operation operation)
{
    return operations[operation].word;
}

void br_tree_clear(struct br_tree *tree)
{
    free(tree->node);
    *tree = (struct br_tree){0};
}

/* By bits: 0 is not -0. */
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

unsigned br_tree_node(struct br_tree_builder *b, enum br_operation operation, unsigned first,
                      unsigned second, unsigned third)
{
    const unsigned argument[] = {first, second, third};
    struct br_node node = {
        .operation = operation, .uses_x = operation == BR_OP_X, .uses_t = operation == BR_OP_T};
    double number[3] = {0};
    size_t numbers = 0;
    for (unsigned i = 0; i < operations[operation].arguments; i++) {
        if (b->status || argument[i] == BR_NO_NODE)
            return BR_NO_NODE;
        const struct br_node *a = &b->tree.node[argument[i]];
        node.argument[i] = argument[i];
        node.uses_x |= a->uses_x;
        node.uses_t |= a->uses_t;
        numbers += a->operation == BR_OP_NUMBER;
        number[i] = a->number;
    }
    if (numbers && numbers == operations[operation].arguments)
        return br_tree_number(b, br_operation_value(operation, number[0], number[1], number[2]));
    return b->status ? BR_NO_NODE : find_or_append(b, &node);
}

unsigned br_tree_graft(struct br_tree_builder *b, const struct br_tree *from, unsigned root)
{
    unsigned *place = br_allocate(root + 1, sizeof *place);
    if (!place)
        return give_up(b, BR_NO_MEMORY);
    place[root] = 1; /* first: whether it is used */
    for (unsigned i = root + 1; i-- > 0;)
        for (unsigned k = 0; place[i] && k < operations[from->node[i].operation].arguments; k++)
            place[from->node[i].argument[k]] = 1;
    for (unsigned i = 0; i <= root; i++) { /* then: where it went */
        const struct br_node *n = &from->node[i];
        if (place[i] && n->operation == BR_OP_NUMBER)
            place[i] = br_tree_number(b, n->number);
        else if (place[i])
            place[i] = br_tree_node(b, n->operation, place[n->argument[0]], place[n->argument[1]],
                                    place[n->argument[2]]);
    }
    const unsigned out = place[root];
    free(place);
    return out;
}

enum br_status br_tree_finish(struct br_tree_builder *b, unsigned root, struct br_tree *tree,
                              struct br_error *err)
{
    struct br_tree_builder out = {0};
    if (!b->status)
        br_tree_graft(&out, &b->tree, root);
    const enum br_status status = b->status ? b->status : out.status;
    br_tree_clear(&b->tree);
    *b = (struct br_tree_builder){0};
    if (status)
        br_tree_clear(&out.tree);
    *tree = out.tree;
    return status == BR_NO_MEMORY ? br_no_memory(err, "an expression")
           : status ? br_fail(err, status, "it has more than %d operations", BR_TREE_MOST_NODES)
                    : BR_OK;
}
