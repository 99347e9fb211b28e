/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Logs of runs with several lines each, "Solving with h = 0.1" and "L2 error: 1.2e-3": the lines of
 * a run become one. A run begins with its size; what it states once is its own. */
#include <stdio.h>
#include <string.h>

#include "orders/reading/lines.h"
#include "orders/reading/roles.h"

enum { MOST_NAMES = 64, NO_NAME = MOST_NAMES };

/* The lines that begin with one name. */
struct statement {
    char name[80];
    bool is_size;             /* they have sizes, and nothing that may be an error */
    bool is_error;            /* they may have one */
    bool is_unsure;           /* a run has several of them */
    size_t lines, runs, last; /* last: the run of the last one, from 1 on */
};

struct log {
    struct statement of[MOST_NAMES + 1]; /* the last: of lines without a name */
    size_t names;
    size_t *name; /* by line */
    size_t begin; /* the name that begins a run */
};

static void take_statement(struct log *g, size_t line, const struct br_token *token, size_t count)
{
    size_t i = 0;
    bool is_size = false, is_error = false;
    for (size_t k = 0; k < count; k++) {
        const bool size = br_size_name_odds(token[k].name) >= BR_USUAL_NAME;
        const enum br_kind kind = br_kind_of(token[k].name);
        is_size |= size;
        is_error |= kind == BR_KIND_ERROR ||
                    (kind == BR_KIND_UNKNOWN && br_size_name_odds(token[k].name) <= BR_ANY_NAME);
    }
    while (i < g->names && strcmp(g->of[i].name, token->name) != 0)
        i++;
    if (i == MOST_NAMES || strlen(token->name) >= sizeof g->of->name)
        return;
    struct statement *s = &g->of[i];
    if (i == g->names) {
        g->names++;
        s->is_size = true;
        strcpy(s->name, token->name);
    }
    s->is_size &= is_size && !is_error;
    s->is_error |= is_error;
    s->lines++;
    g->name[line] = i;
}

static void read_statements(struct log *g, const struct br_line *line, size_t lines, char *room,
                            struct br_token *token)
{
    for (size_t i = 0; i < lines; i++) {
        g->name[i] = NO_NAME;
        const size_t count = line[i].kind == BR_LINE_TEXT
                                 ? br_line_split(line[i].text, BR_BY_WORDS, '.', room, token)
                                 : 0;
        if (count)
            take_statement(g, i, token, count);
    }
}

static void count_runs(struct log *g, size_t lines)
{
    size_t run = 0;
    while (g->begin < g->names && !(g->of[g->begin].is_size && g->of[g->begin].lines > 1))
        g->begin++;
    for (size_t i = 0; i < lines; i++) {
        struct statement *s = &g->of[g->name[i]];
        run += g->name[i] == g->begin;
        if (!run || g->name[i] == NO_NAME || g->name[i] == g->begin)
            continue;
        s->is_unsure |= s->last == run;
        s->runs += s->last != run;
        s->last = run;
    }
}

/* Whether sizes and errors stand on lines of their own, each behind its size, and most sizes have
 * one: others are of a reference, perhaps. */
static bool has_runs(const struct log *g)
{
    bool errors = false;
    for (size_t i = 0; i < g->names; i++) {
        const struct statement *s = &g->of[i];
        if (s->runs && s->lines > s->runs && !s->is_unsure)
            return false; /* one stands before the first size: that of a run may be the next one */
        errors |=
            s->is_error && s->runs > 1 && !s->is_unsure && 2 * s->runs > g->of[g->begin].lines;
    }
    return errors;
}

/* Adds a line to that of its run, without a time in front. */
static bool join(struct br_line *run, struct br_line *line, struct br_store *store)
{
    const char *const stamp = *line->text == '[' ? strchr(line->text, ']') : NULL;
    const char *const text = stamp ? stamp + 1 : line->text;
    char *const all = br_store_take(store, strlen(run->text) + strlen(text) + 3, 1);
    size_t end = strlen(run->text);
    if (!all)
        return false;
    while (end && strchr(":.,;", run->text[end - 1]))
        end--;
    sprintf(all, "%.*s; %s", (int)end, run->text, text);
    run->text = all;
    line->kind = BR_LINE_EMPTY;
    return true;
}

enum br_status br_log_fold(struct br_line *line, size_t lines, struct br_store *store,
                           struct br_error *err)
{
    size_t longest = 0;
    for (size_t i = 0; i < lines; i++) {
        const size_t size = BR_ROOM(line[i].text);
        longest = size > longest ? size : longest;
    }
    struct br_token *token = br_store_take(store, BR_MOST_COLUMNS + 3, sizeof *token);
    struct log *g = br_store_take(store, 1, sizeof *g);
    char *room = br_store_take(store, longest, 1);
    size_t *name = br_store_take(store, lines + 1, sizeof *name);
    if (store->failed)
        return br_no_memory(err, "the table");
    g->name = name;
    read_statements(g, line, lines, room, token);
    count_runs(g, lines);
    struct br_line *run = NULL;
    const bool folds = has_runs(g);
    for (size_t i = 0; i < lines && folds; i++) {
        const struct statement *s = &g->of[name[i]];
        run = name[i] == g->begin ? &line[i] : run;
        if (!run || run == &line[i] || name[i] == NO_NAME || s->runs < 2)
            continue;
        if (s->is_unsure)
            line[i].kind = BR_LINE_COMMENT; /* the steps of a solver, say */
        else if (!join(run, &line[i], store))
            return br_no_memory(err, "the table");
    }
    return BR_OK;
}
