/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One value of a scene file: a number with its unit, an expression, a load, a word. */
#ifndef BR_STUDY_SCENE_VALUE_H
#define BR_STUDY_SCENE_VALUE_H

#include "base/yaml_text.h"
#include "study/scene/schema.h"

/* The input and output of the scene reader. All borrowed. */
struct br_scene_reader {
    struct br_yaml yaml;
    struct br_scene *scene;       /* NULL: the file is not a scene */
    struct br_scene_given *given; /* the numbers that the file gives */
};
#define br_scene_refuse(r, ...) br_yaml_refuse(&(r)->yaml, __VA_ARGS__)
#define br_scene_pass_on(r, ...) br_yaml_pass_on(&(r)->yaml, __VA_ARGS__)

/* ---- keys that --set has set (set.c) ---- */

/* Sets the keys of r->yaml.set in the document. A key that it has not is added, so that its reader
 * checks it. verifies: the part `verify` is read, too. Fails with BR_BAD_INPUT or BR_NO_MEMORY. */
enum br_status br_scene_put_sets(const struct br_scene_reader *r, bool verifies);

/* Puts r->yaml.set behind the title of the scene: no result of it is taken for one of the file.
 * Fails with BR_NO_MEMORY. */
enum br_status br_scene_add_to_title(const struct br_scene_reader *r);

/* Writes the document, which is empty then, as a text. *text (out): owned by the caller; NULL after
 * a failure (BR_NO_MEMORY). */
enum br_status br_scene_write_text(const struct br_scene_reader *r, char **text);

/* The line on which a key of the scene is given; 0: it is not. */
static inline size_t br_scene_line(const struct br_scene_reader *r, const struct br_scene_key *key)
{
    return r->given->row[key - br_scene_keys].line;
}

/* Reads the value of a key that is not a section into the reader's scene. Fails with BR_BAD_INPUT
 * or BR_NO_MEMORY. */
enum br_status br_scene_read_value(const struct br_scene_reader *r, const struct br_scene_key *key,
                                   const yaml_node_t *node);

/* A value that is read; for schema.c, expressions.c and engineering.c. */
struct br_scene_value {
    const struct br_scene_reader *r;
    const struct br_scene_key *key;
    const yaml_node_t *node;
    const char *unit; /* the expected unit */
    bool ratio;       /* a number without unit was found, and the key accepts it */
};

#define BR_REFUSE_VALUE(v, ...) \
    br_scene_refuse((v)->r, br_yaml_line((v)->node), (v)->key->name, __VA_ARGS__)

/* The key's member of the scene. */
static inline void *br_scene_target(const struct br_scene_value *v)
{
    return (char *)v->r->scene + v->key->offset;
}

struct br_unit;
struct br_si_number;

/* Reads "value unit", as far as `end`, which points into the text; NULL: to the end of the text. */
enum br_status br_scene_read_quantity(struct br_scene_value *v, const char *text, const char *end,
                                      struct br_si_number *q);

/* "rectangle 20 mm x 5 mm", "circle 10 mm", "tube 20 mm x 2 mm" */
enum br_status br_scene_read_shape(struct br_scene_value *v);

/* Reads any unit of the expected dimension. */
enum br_status br_scene_read_unit(struct br_scene_value *v, const char *text, struct br_unit *unit);

/* Keeps a text in the scene. */
enum br_status br_scene_keep_text(const struct br_scene_value *v, const char *text);

/* Reads the value of a key that is an expression, or a load. */
enum br_status br_scene_read_expression(struct br_scene_value *v);

/* What the file of a whole scene says of the problem, a line a key ("density: 1 kg/m"); numbers
 * that were derived are the scene's. *data (out): owned by the caller. Fails with BR_NO_MEMORY. */
enum br_status br_scene_data(const struct br_scene_reader *r, char **data);

/* Derives loads, tip forces and initial data from the solutions of a scene (manufactured.c). */
enum br_status br_scene_apply_solutions(const struct br_scene_reader *r);

/* Refuses (BR_BAD_INPUT, at `line` where the file does not give the function) a function that is
 * not proved to be finite everywhere in [0, L] and [0, T] (solver/proof.h), and initial data that
 * move the clamped end, jump, or whose slope is missing or is not the derivative. */
enum br_status br_scene_check_functions(const struct br_scene_reader *r, size_t line);

/* ---- derived numbers ---- */

/* Derives the numbers that a file does not give itself: stiffnesses from a material and a
 * cross-section, viscosities from a damping, the friction bound from a ratio (docs/scenes.md).
 * scene->derived lists them and their sources. Fails with BR_BAD_INPUT if a number is given both
 * directly and by a source, if a source is not used, and if a number is missing. */
enum br_status br_scene_derive(const struct br_scene_reader *r);

#endif
