/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The `verify` part of a scene's file; an example is in study/scenes/example1.yaml. */
#ifndef BR_STUDY_VERIFY_VERIFY_FILE_H
#define BR_STUDY_VERIFY_VERIFY_FILE_H

#include "study/scene/value.h"
#include "study/verify/verify.h"

/* Reads and checks the part; the reader's scene is whole. Fails with BR_BAD_INPUT, naming file,
 * line and key, or BR_NO_MEMORY; the caller clears `verify` even then. */
enum br_status br_verify_read(const struct br_scene_reader *r, const yaml_node_t *node,
                              struct br_verify *verify);

#endif
