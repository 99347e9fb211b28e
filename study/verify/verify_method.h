/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a study in a scene's `verify` part that choose its method. */
#ifndef BR_STUDY_VERIFY_VERIFY_METHOD_H
#define BR_STUDY_VERIFY_VERIFY_METHOD_H

#include "solver/march.h"
#include "study/scene/value.h"

/* As br_method_default until keys are read. */
struct br_verify_method {
    struct br_method method;
    unsigned given; /* a bit a key */
};

/* Reads a key if it is one of the method's; *known (out): whether it is. Fails with BR_BAD_INPUT,
 * naming file, line and key. */
enum br_status br_verify_method_read(const struct br_scene_reader *r, const char *key,
                                     const yaml_node_t *node, struct br_verify_method *m,
                                     bool *known);

/* When all keys are read: gives the contact rule that is not given, and refuses (BR_BAD_INPUT,
 * without the line) what does not go together. */
enum br_status br_verify_method_end(struct br_verify_method *m, struct br_error *err);

#endif
