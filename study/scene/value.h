/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One value of a scene file: a number with its unit, an expression, a load, a word. */
#ifndef BR_STUDY_SCENE_VALUE_H
#define BR_STUDY_SCENE_VALUE_H

#include <yaml.h>

#include "study/scene/schema.h"

/* What is being read, for messages. All borrowed. */
struct br_scene_reader {
    const char *path;
    yaml_document_t *document;
    struct br_scene *scene; /* NULL: of another kind of file */
    struct br_error *err;
    struct br_scene_given *given; /* beside the scene */
    const struct br_scene_key
        *varied; /* whose value is `text`, whatever stands there; NULL: none */
    const char *text;
};

/* Takes what it wants from a document, whose root may be NULL: an empty file. */
typedef enum br_status br_yaml_take(const struct br_scene_reader *r, void *self);

/* Parses a text of one YAML document without zero bytes, nested no deeper than is sound, and hands
 * it over. Fails as `take` does, with BR_BAD_INPUT and the line, or with BR_NO_MEMORY. */
enum br_status br_yaml_read(const char *path, const char *text, br_yaml_take *take, void *self,
                            struct br_error *err);

/* Refuses with "path:line: key: ..."; returns BR_BAD_INPUT. */
__attribute__((format(printf, 4, 5))) enum br_status br_scene_refuse(
    const struct br_scene_reader *r, size_t line, const char *key, const char *format, ...);

/* The same with what another function has failed with; where that is not BR_BAD_INPUT, it fails
 * likewise. BR_OK where it has not failed. */
enum br_status br_scene_pass_on(const struct br_scene_reader *r, size_t line, const char *key,
                                const struct br_error *inner);

/* Where a node stands, from 1, and the text of a scalar. */
size_t br_yaml_line(const yaml_node_t *node);
const char *br_yaml_text(const yaml_node_t *node);

/* Reads the value of a key that is no section into the reader's scene. Fails with
 * BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_scene_read_value(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node);

/* ---- numbers as engineers have them ---- */

/* Makes what a file has not given itself: stiffnesses of a material and a cross-section,
 * viscosities of a damping, the friction bound of a ratio (docs/scenes.md); scene->derived says
 * what and of what. Fails with BR_BAD_INPUT where something is given twice, once by what makes it,
 * where a number that makes others has nothing to make, and where a number is missing. */
enum br_status br_scene_derive(const struct br_scene_reader *r);

#endif
