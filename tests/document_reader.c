/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "document_reader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct br_provenance br_made_provenance = {.version = "1",
                                                 .commit = "c",
                                                 .compiler = "cc",
                                                 .flags = "-O",
                                                 .command_line = "beamrate",
                                                 .machine = "m",
                                                 .date = "2026-01-02T03:04:05Z",
                                                 .threads = 1,
                                                 .scene_path = "p",
                                                 .scene_text = "t"};

char *printed(const struct br_document *d, const struct br_document_format *format)
{
    struct br_error err = {0};
    static char *text;
    static size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    MUST(br_document_print(out, format, d, NULL, &err));
    fclose(out);
    return text;
}

json_t *read_back(struct br_document *d)
{
    char *text = printed(d, &br_document_json);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    if (!root)
        fail_msg("no JSON: %s", text);
    br_document_clear(d);
    free(text);
    return root;
}

const json_t *at_path(const json_t *root, const char *path)
{
    char text[128];
    snprintf(text, sizeof text, "%s", path ? path : "");
    for (char *key = strtok(text, "."); key && root; key = strtok(NULL, "."))
        root = json_is_array(root) ? json_array_get(root, (size_t)atoi(key))
                                   : json_object_get(root, key);
    if (!root)
        fail_msg("no '%s' in the JSON", path);
    return root;
}

void numbers_are(const json_t *root, const char *path, const struct expected *e, size_t count)
{
    const json_t *object = at_path(root, path);
    for (size_t i = 0; i < count; i++) {
        const json_t *value = at_path(object, e[i].key);
        const double found = json_is_null(value)      ? (double)NAN
                             : json_is_boolean(value) ? json_is_true(value)
                                                      : json_number_value(value);
        if (isnan(e[i].value) ? !isnan(found) : !(found == e[i].value))
            fail_msg("%s.%s is %.17g, expected %.17g", path, e[i].key, found, e[i].value);
    }
}

void texts_are(const json_t *root, const char *path, const char *const pairs[])
{
    const json_t *object = at_path(root, path);
    for (size_t i = 0; pairs[i]; i += 2)
        assert_string_equal(json_string_value(at_path(object, pairs[i])), pairs[i + 1]);
}

void answers(const json_t *root, const char *sentence)
{
    const json_t *all = at_path(root, "answer");
    for (size_t i = 0; i < json_array_size(all); i++)
        if (strcmp(json_string_value(json_array_get(all, i)), sentence) == 0)
            return;
    fail_msg("the answer lacks '%s'; it begins with '%s'", sentence,
             json_string_value(json_array_get(all, 0)));
}
