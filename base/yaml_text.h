/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A text as one YAML document, and how its values are refused. */
#ifndef BR_BASE_YAML_TEXT_H
#define BR_BASE_YAML_TEXT_H

#include <yaml.h>

#include "base/status.h"

/* All borrowed. */
struct br_yaml {
    const char *path;
    yaml_document_t *document;
    struct br_error *err;
    const char *set; /* of --set: KEY=VALUE, a line each; NULL: none */
};

/* Takes a document. Its root node is NULL if the file is empty. */
typedef enum br_status br_yaml_take(const struct br_yaml *yaml, void *self);

/* Parses a text, which must be one YAML document without zero bytes or deep nesting, and calls
 * `take` with it. Fails as `take` does, with BR_BAD_INPUT and the line, or with BR_NO_MEMORY. */
enum br_status br_yaml_read(const char *path, const char *text, br_yaml_take *take, void *self,
                            struct br_error *err);

/* Refuses with "path:line: key: ...", or "path: --set KEY=VALUE: key: ..."; returns BR_BAD_INPUT.
 */
__attribute__((format(printf, 4, 5))) enum br_status br_yaml_refuse(const struct br_yaml *yaml,
                                                                    size_t line, const char *key,
                                                                    const char *format, ...);

/* The same with the error of another function. A status other than BR_BAD_INPUT is passed on as it
 * is. BR_OK if there is no error. */
enum br_status br_yaml_pass_on(const struct br_yaml *yaml, size_t line, const char *key,
                               const struct br_error *inner);

/* The line of a node, from 1, and the text of a scalar. */
size_t br_yaml_line(const yaml_node_t *node);
const char *br_yaml_text(const yaml_node_t *node);

/* The value of a key in a mapping (NULL: the whole document); NULL: not given. */
const yaml_node_t *br_yaml_value(const struct br_yaml *yaml, const yaml_node_t *node,
                                 const char *key);

/* ---- keys that --set has set ---- */

/* Their line in the document is behind all of a file, and says which of them it was. */
enum { BR_LAST_LINE = 1 << 21, BR_PLACE = 200 };

/* Writes "6", the line of a file, or "--set KEY=VALUE"; returns text (out), which is cut where it
 * is full. */
const char *br_yaml_place(const struct br_yaml *yaml, size_t line, char text[BR_PLACE]);

#endif
