/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes as YAML files; the format is described by the table in schema.c. */
#ifndef BR_STUDY_SCENE_FILE_H
#define BR_STUDY_SCENE_FILE_H

#include "study/scene/schema.h"
#include "study/verify/verify.h"

/* Reads and checks a scene. Every refusal (BR_BAD_INPUT) names file, line, key,
 * what was found and what was expected. The caller clears the scene with
 * br_scene_clear, even after a failure. */
enum br_status br_scene_read(const char *path, struct br_scene *scene, struct br_error *err);

/* The same from a text, which messages call `name`. */
enum br_status br_scene_read_text(const char *name, const char *text, struct br_scene *scene,
                                  struct br_error *err);

/* What else is asked of a text; zeros: nothing. */
struct br_scene_asked {
    struct br_verify *verify; /* out: what is expected of the scene: its `verify` part, or else the
                                 default; to be cleared, even after a failure */
    const struct br_scene_key *varied; /* a key, whose section must be there, that is to have ... */
    const char *value;                 /* this value */
};
enum br_status br_scene_parse(const char *name, const char *text,
                              const struct br_scene_asked *asked, struct br_scene *scene,
                              struct br_error *err);

enum { BR_LONGEST_SCENE = 1 << 20 }; /* bytes */

/* Finds a scene, reads its file once, and the scene from that: path (out, size bytes), *text (out):
 * the whole file; owned by the caller, as the scene is, even after a failure. Fails as
 * br_scene_find, br_scene_load and br_scene_read do. */
enum br_status br_scene_open(const char *name, char *path, size_t size, char **text,
                             struct br_scene *scene, struct br_error *err);

/* The whole text of a file, of standard input or a pipe, which can be read once; *text (out): owned
 * by the caller. Fails with BR_BAD_INPUT where it is longer than so many bytes or no text, and then
 * says what is expected, "scene"; with BR_IO, BR_INTERRUPTED or BR_NO_MEMORY. */
enum br_status br_text_load(const char *path, size_t longest, const char *what, char **text,
                            struct br_error *err);

/* The same of at most BR_LONGEST_SCENE bytes. */
enum br_status br_scene_load(const char *path, char **text, struct br_error *err);

/* Writes the path of a scene into `path` (out, size bytes): `name` itself where it
 * names a file, /dev/stdin where it is "-", else the bundled scene of that name. Fails with
 * BR_BAD_INPUT. */
enum br_status br_scene_find(const char *name, char *path, size_t size, struct br_error *err);

/* The names of all bundled scenes, in the order of the alphabet; *names and each of them is owned
 * by the caller (br_scene_list_free). Fails with BR_BAD_INPUT where their folder is not there. */
enum br_status br_scene_list(char ***names, size_t *count, struct br_error *err);
void br_scene_list_free(char **names, size_t count); /* accepts NULL */

/* The folder of the program's data files: $BEAMRATE_DATA, or where the program
 * was built or installed. `relative` is appended. */
void br_data_path(const char *relative, char *path, size_t size);

#endif
