/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A text as one YAML document, and how its values are refused. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/words.h"
#include "base/yaml_text.h"

const char *br_yaml_place(const struct br_yaml *r, size_t line, char text[BR_PLACE])
{
    const char *set = r->set;
    if (line <= BR_LAST_LINE) {
        snprintf(text, BR_PLACE, "%zu", line);
        return text;
    }
    for (size_t i = BR_LAST_LINE + 1; i < line; i++)
        set = strchr(set, '\n') + 1;
    snprintf(text, BR_PLACE, "--set %.*s", (int)strcspn(set, "\n"), set);
    return text;
}

/* Writes what ends the refusal of a value of the file, which may be due to what is set: " (with
 * --set KEY=VALUE, ...)"; set NULL: nothing. text: out, cut where it is full. */
static void write_sets(const char *set, char text[BR_PLACE])
{
    *text = '\0';
    for (const char *c = set, *end; c; c = *end ? end + 1 : NULL) {
        end = strchrnul(c, '\n');
        br_append(text, BR_PLACE - 1, "%s--set %.*s", *text ? ", " : " (with ", (int)(end - c), c);
    }
    if (set)
        br_append(text, BR_PLACE, ")");
}

enum br_status br_yaml_refuse(const struct br_yaml *r, size_t line, const char *key,
                              const char *format, ...)
{
    char *text = NULL, place[BR_PLACE], sets[BR_PLACE];
    const char *colon = line > BR_LAST_LINE ? ": " : ":";
    va_list args;
    va_start(args, format);
    const int length = vasprintf(&text, format, args);
    va_end(args);
    if (length < 0)
        return br_no_memory(r->err, "a message");
    /* A long value must not hide what was expected, which is at the end of the text. */
    enum { HEAD = 200, TAIL = 400 };
    br_yaml_place(r, line, place);
    write_sets(line > BR_LAST_LINE ? NULL : r->set, sets);
    if (length > HEAD + TAIL)
        br_fail(r->err, BR_BAD_INPUT, "%s%s%s: %.100s: %.*s ... %s%s", r->path, colon, place, key,
                HEAD, text, text + length - TAIL, sets);
    else
        br_fail(r->err, BR_BAD_INPUT, "%s%s%s: %.100s: %s%s", r->path, colon, place, key, text,
                sets);
    free(text);
    return BR_BAD_INPUT;
}

enum br_status br_yaml_pass_on(const struct br_yaml *r, size_t line, const char *key,
                               const struct br_error *inner)
{
    if (inner->status == BR_BAD_INPUT)
        return br_yaml_refuse(r, line, key, "%s", inner->message);
    return inner->status ? br_fail(r->err, inner->status, "%s", inner->message) : BR_OK;
}

size_t br_yaml_line(const yaml_node_t *node)
{
    return node->start_mark.line + 1;
}

const char *br_yaml_text(const yaml_node_t *node)
{
    return (const char *)node->data.scalar.value;
}

const yaml_node_t *br_yaml_value(const struct br_yaml *r, const yaml_node_t *node, const char *key)
{
    node = node ? node : yaml_document_get_root_node(r->document);
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
         p++)
        if (strcmp(br_yaml_text(yaml_document_get_node(r->document, p->key)), key) == 0)
            return yaml_document_get_node(r->document, p->value);
    return NULL;
}

/* libyaml's loader states no error when it has no memory. */
static enum br_status not_yaml(const struct br_yaml *r, const yaml_parser_t *parser)
{
    if (parser->error == YAML_MEMORY_ERROR || parser->error == YAML_NO_ERROR)
        return br_no_memory(r->err, "the YAML parser");
    const bool block = parser->context && strstr(parser->context, "block scalar");
    return br_fail(r->err, BR_BAD_INPUT, "%s:%zu: not YAML: %s%s", r->path,
                   parser->problem_mark.line + 1, parser->problem ? parser->problem : "unreadable",
                   block ? "; a text that begins with '>' or '|' needs quotes, as in '>= 1.8'"
                         : "");
}

/* Checks what the loader does not. The loader's time grows with the square of the nesting depth. A
 * second document would be ignored. A zero byte, which YAML can write as \0 in quotes, would end a
 * text early. */
static enum br_status check_event(const struct br_yaml *r, const yaml_event_t *event, int depth,
                                  int documents)
{
    enum { DEEPEST = 32 };
    const size_t line = event->start_mark.line + 1;
    const char *text = (const char *)event->data.scalar.value;
    if (depth > DEEPEST)
        return br_yaml_refuse(r, line, "YAML",
                              "found lists or mappings nested more than %d deep, expected fewer",
                              DEEPEST);
    if (documents > 1)
        return br_yaml_refuse(r, line, "YAML", "a second document begins, expected one");
    if (event->type == YAML_SCALAR_EVENT && strlen(text) != event->data.scalar.length)
        return br_yaml_refuse(r, line, "YAML", "found '%s' followed by a zero byte, expected text",
                              text);
    return BR_OK;
}

static enum br_status check_events(const struct br_yaml *r, yaml_parser_t *parser)
{
    enum br_status status = BR_OK;
    int depth = 0, documents = 0;
    for (bool more = true; more && !status;) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event))
            return not_yaml(r, parser);
        depth += event.type == YAML_SEQUENCE_START_EVENT || event.type == YAML_MAPPING_START_EVENT;
        depth -= event.type == YAML_SEQUENCE_END_EVENT || event.type == YAML_MAPPING_END_EVENT;
        documents += event.type == YAML_DOCUMENT_START_EVENT;
        more = event.type != YAML_STREAM_END_EVENT;
        status = check_event(r, &event, depth, documents);
        yaml_event_delete(&event);
    }
    return status;
}

static enum br_status load(const struct br_yaml *r, yaml_parser_t *parser, br_yaml_take *take,
                           void *self)
{
    if (!yaml_parser_load(parser, r->document))
        return not_yaml(r, parser);
    const enum br_status status = take(r, self);
    yaml_document_delete(r->document);
    return status;
}

enum br_status br_yaml_read(const char *path, const char *text, br_yaml_take *take, void *self,
                            struct br_error *err)
{
    yaml_document_t document;
    const struct br_yaml r = {.path = path, .document = &document, .err = err};
    enum br_status status = BR_OK;
    for (int pass = 0; pass < 2 && !status; pass++) {
        yaml_parser_t parser;
        if (!yaml_parser_initialize(&parser))
            return br_no_memory(err, "the YAML parser");
        yaml_parser_set_input_string(&parser, (const unsigned char *)text, strlen(text));
        status = pass == 0 ? check_events(&r, &parser) : load(&r, &parser, take, self);
        yaml_parser_delete(&parser);
    }
    return status;
}
