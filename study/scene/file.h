/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes as YAML files; the format is described by the table in schema.c. */
#ifndef BR_STUDY_SCENE_FILE_H
#define BR_STUDY_SCENE_FILE_H

#include "base/load.h"
#include "study/scene/schema.h"

/* Reads and checks a scene. Every refusal (BR_BAD_INPUT) names file, line, key,
 * what was found and what was expected. The caller clears the scene with
 * br_scene_clear, even after a failure. */
enum br_status br_scene_read(const char *path, struct br_scene *scene, struct br_error *err);

/* The same from a text, which messages call `name`. */
enum br_status br_scene_read_text(const char *name, const char *text, struct br_scene *scene,
                                  struct br_error *err);

struct br_scene_reader;
struct yaml_node_s;

/* Reads a part of a scene's file that the scene itself does not need, when the scene is whole
 * (study/scene/value.h). node: the part's; NULL: the file has none. */
typedef enum br_status br_scene_take(const struct br_scene_reader *r,
                                     const struct yaml_node_s *node, void *self);

/* Further requests to br_scene_parse; zeros: none. */
struct br_scene_asked {
    br_scene_take *take_verify; /* reads the part `verify` */
    void *self;                 /* its own */
    const char *set; /* of --set: KEY=VALUE, a line each, which is read as if it stood in the
                        file; NULL: none */
    char **text;     /* out, with set: what stands in the scene then, owned by the caller */
};
enum br_status br_scene_parse(const char *name, const char *text,
                              const struct br_scene_asked *asked, struct br_scene *scene,
                              struct br_error *err);

enum { BR_LONGEST_SCENE = 1 << 20 }; /* bytes */

/* As br_text_load for a scene, of at most BR_LONGEST_SCENE bytes. */
enum br_status br_scene_load(const char *path, char **text, struct br_error *err);

/* Writes the path of a scene into `path` (out, size bytes): `name` itself if it names a file,
 * /dev/stdin if it is "-", else the bundled scene of that name. Fails with BR_BAD_INPUT. */
enum br_status br_scene_find(const char *name, char *path, size_t size, struct br_error *err);

/* Lists the names of all bundled scenes alphabetically. The caller owns *names and each name
 * (br_scene_list_free). Fails with BR_BAD_INPUT if their folder is missing. */
enum br_status br_scene_list(char ***names, size_t *count, struct br_error *err);
void br_scene_list_free(char **names, size_t count); /* accepts NULL */

/* Writes the path of the data file `relative`: in $BEAMRATE_DATA, or else where the program was
 * built, or else in share/beamrate above the program or the shared library, or where it was
 * installed. */
void br_data_path(const char *relative, char *path, size_t size);

#endif
