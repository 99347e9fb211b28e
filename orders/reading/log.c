/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Logs of runs with several lines each, "Solving with h = 0.1" and "L2 error: 1.2e-3": the lines of
 * a run become one. A run begins with its size; what it states once is its own. */
#include <stdio.h>
#include <string.h>

#include "orders/reading/lines.h"
#include "orders/reading/roles.h"

enum { MOST_NAMES = 64 };

/* The lines that begin with one name. */
struct statement {
    char name[80];
    bool has_size, has_error; /* it may be one */
    bool repeats;             /* a run has several of them */
    size_t lines, runs, last; /* last: the run of the last one, from 1 on */
};

struct log {
    struct br_line *line;
    size_t lines, names;
    struct statement of[MOST_NAMES], **by_line; /* NULL: it states nothing */
    const struct statement *begin;              /* of a run */
};

static struct statement *take_statement(struct log *g, const struct br_token *token, size_t count)
{
    size_t i = 0;
    while (i < g->names && strcmp(g->of[i].name, token->name) != 0)
        i++;
    if (!*token->name || i == MOST_NAMES || strlen(token->name) >= sizeof g->of->name)
        return NULL;
    struct statement *s = &g->of[i];
    g->names += i == g->names;
    strcpy(s->name, token->name);
    s->lines++;
    for (; count-- > 0; token++) {
        const double odds = br_size_name_odds(token->name);
        const enum br_kind kind = br_kind_of(token->name);
        s->has_size |= odds >= BR_USUAL_NAME;
        s->has_error |= kind == BR_KIND_ERROR || (kind == BR_KIND_UNKNOWN && odds <= BR_ANY_NAME);
    }
    return s;
}

static enum br_status read_statements(struct log *g, struct br_store *store, struct br_error *err)
{
    size_t longest = 0;
    for (size_t i = 0; i < g->lines; i++) {
        const size_t size = BR_ROOM(g->line[i].text);
        longest = size > longest ? size : longest;
    }
    struct br_token *token = br_store_take(store, BR_MOST_COLUMNS + 3, sizeof *token);
    char *room = br_store_take(store, longest, 1);
    g->by_line = br_store_take(store, g->lines + 1, sizeof *g->by_line);
    if (store->failed)
        return br_no_memory(err, "the table");
    for (size_t i = 0, count; i < g->lines; i++)
        if (g->line[i].kind == BR_LINE_TEXT &&
            (count = br_line_split(g->line[i].text, BR_BY_WORDS, '.', room, token)))
            g->by_line[i] = take_statement(g, token, count);
    return BR_OK;
}

/* Whether sizes and errors stand on lines of their own, each behind its size, and most sizes have
 * one: others are of a reference, perhaps. */
static bool find_runs(struct log *g)
{
    size_t run = 0;
    bool errors = false;
    for (size_t i = g->names; i-- > 0;)
        if (g->of[i].has_size && !g->of[i].has_error && g->of[i].lines > 1)
            g->begin = &g->of[i];
    for (size_t i = 0; i < g->lines; i++) {
        struct statement *s = g->by_line[i];
        run += s && s == g->begin;
        if (!run || !s || s == g->begin)
            continue;
        s->repeats |= s->last == run;
        s->runs += s->last != run;
        s->last = run;
    }
    for (const struct statement *s = g->of; s < g->of + g->names; s++) {
        if (s->runs && s->lines > s->runs && !s->repeats)
            return false; /* one stands before the first size: that of a run may be the next one */
        errors |= s->has_error && s->runs > 1 && !s->repeats && 2 * s->runs > g->begin->lines;
    }
    return errors;
}

/* Adds a line to that of its run, without a time in front. */
static enum br_status join(struct br_line *run, struct br_line *line, struct br_store *store,
                           struct br_error *err)
{
    const char *const stamp = *line->text == '[' ? strchr(line->text, ']') : NULL;
    const char *const text = stamp ? stamp + 1 : line->text;
    char *const all = br_store_take(store, strlen(run->text) + strlen(text) + 3, 1);
    size_t end = strlen(run->text);
    if (!all)
        return br_no_memory(err, "the table");
    while (end && strchr(":.,;", run->text[end - 1]))
        end--;
    sprintf(all, "%.*s; %s", (int)end, run->text, text);
    run->text = all;
    line->kind = BR_LINE_EMPTY;
    return BR_OK;
}

enum br_status br_log_fold(struct br_line *line, size_t lines, struct br_store *store,
                           struct br_error *err)
{
    struct br_line *run = NULL;
    struct log *g = br_store_take(store, 1, sizeof *g);
    if (!g)
        return br_no_memory(err, "the table");
    *g = (struct log){.line = line, .lines = lines};
    if (read_statements(g, store, err) || !find_runs(g))
        return err->status;
    for (size_t i = 0; i < lines; i++) {
        const struct statement *s = g->by_line[i];
        run = s && s == g->begin ? &line[i] : run;
        if (!run || !s || s == g->begin || s->runs < 2)
            continue;
        if (s->repeats)
            line[i].kind = BR_LINE_COMMENT; /* the steps of a solver, say */
        else if (join(run, &line[i], store, err))
            return err->status;
    }
    return BR_OK;
}
