/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One page of HTML that needs nothing else: no script, no other file. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "study/scene/quote.h"
#include "tables/document.h"

enum { LONG_TABLE = 24 /* rows: a longer one is folded */ };

/* A page on its way out. */
struct page {
    FILE *out;
    const char *folder; /* of the pictures; NULL: none */
    char *line;         /* room for any text */
    int level;          /* of a report's headings */
    size_t pictures;
};

/* All colours of letters have a contrast of at least 4.5 to both grounds (tests/html_page.py). */
static const char style[] =
    ":root { color-scheme: light dark; --ground: #ffffff; --shade: #f3f5f7; --line: #ccd1d6;\n"
    "  --ink: #1a1c1f; --quiet: #53585d; --link: #0a55a8;\n"
    "  --good: #17652f; --bad: #b3001e; --doubt: #7a4f00; }\n"
    "@media screen and (prefers-color-scheme: dark) {\n"
    ":root { --ground: #15181b; --shade: #1f2428; --line: #434a51;\n"
    "  --ink: #e4e6e8; --quiet: #a9afb5; --link: #82b8f5;\n"
    "  --good: #74d492; --bad: #ff9494; --doubt: #eebd62; } }\n"
    "body { margin: 0 auto; max-width: 75rem; padding: 1rem; background: var(--ground);\n"
    "  color: var(--ink); font: 1rem/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }\n"
    "h1, h2, h3, h4 { line-height: 1.25; margin: 1.6em 0 0.5em; }\n"
    "h1 { margin-top: 0; }\n"
    "nav ~ article { border-top: 2px solid var(--line); margin-top: 3rem; }\n"
    "a { color: var(--link); }\n"
    ".answer { border-left: 0.25rem solid var(--link); font-size: 1.1rem; list-style: none;\n"
    "  padding: 0.1rem 1rem; }\n"
    ".PASS { color: var(--good); font-weight: 600; }\n"
    ".FAIL, .ERROR { color: var(--bad); font-weight: 600; }\n"
    ".INCONCLUSIVE { color: var(--doubt); font-weight: 600; }\n"
    ".SKIPPED, dt { color: var(--quiet); }\n"
    ".scroll, .card, pre { overflow-x: auto; }\n"
    "table { border-collapse: collapse; font-variant-numeric: tabular-nums; }\n"
    "th, td { overflow-wrap: normal; padding: 0.15rem 0.6rem; text-align: right;\n"
    "  vertical-align: top; white-space: nowrap; }\n"
    "th { border-bottom: 2px solid var(--line); vertical-align: bottom; white-space: normal; }\n"
    ".rule td { border-top: 2px solid var(--line); }\n"
    ".text { text-align: left; }\n"
    ".wrap { min-width: 18rem; white-space: normal; }\n"
    "tbody tr:nth-child(even), pre { background: var(--shade); }\n"
    "pre { padding: 0.6rem; overflow-wrap: normal; }\n"
    "summary :is(h2, h3, h4) { display: inline; }\n"
    "details { margin: 1rem 0; }\n"
    "dl div { display: flex; flex-wrap: wrap; gap: 0 0.6rem; }\n"
    "dt { flex: 0 1 16rem; }\n"
    "dd, figure { margin: 0; }\n"
    ".card { background: #ffffff; color: #000000; margin: 1.5rem 0; max-width: 60rem; }\n"
    "svg { display: block; height: auto; min-width: 44rem; }\n"
    "@media print {\n"
    ".scroll, .card, pre { overflow: visible; }\n"
    "pre { white-space: pre-wrap; }\n"
    "svg { min-width: 0; }\n"
    "figure, tr { break-inside: avoid; }\n"
    "::details-content { content-visibility: visible; } }\n";

/* ---- pieces ---- */

static void print(const struct page *p, const char *text)
{
    br_quote(p->out, &br_for_xml, text ? text : "");
}

/* An element of one text; `tag` may have attributes. */
static void print_element(const struct page *p, const char *tag, const char *text)
{
    fprintf(p->out, "<%s>", tag);
    print(p, text);
    fprintf(p->out, "</%.*s>\n", (int)strcspn(tag, " "), tag);
}

static void print_heading(const struct page *p, int level, const char *text)
{
    char tag[8];
    snprintf(tag, sizeof tag, "h%d", level);
    print_element(p, tag, text);
}

/* Lines as they are. */
static void print_lines(const struct page *p, const char *lines)
{
    fputs("<pre>", p->out);
    for (const char *rest = lines; *rest;) {
        const size_t length = strcspn(rest, "\n");
        memcpy(p->line, rest, length);
        p->line[length] = '\0';
        print(p, p->line);
        fputc('\n', p->out);
        rest += length + (rest[length] == '\n');
    }
    fputs("</pre>\n", p->out);
}

static void print_answer(const struct page *p, const struct br_document *d)
{
    if (!d->answers)
        return;
    fputs("<ul class=\"answer\">\n", p->out);
    for (size_t i = 0; i < d->answers; i++)
        print_element(p, "li", d->answer[i]);
    fputs("</ul>\n", p->out);
}

/* ---- tables ---- */

static void print_head(const struct page *p, const struct br_document_table *t)
{
    fputs("<thead><tr>\n", p->out);
    for (size_t c = 0; c < t->columns; c++) {
        if (!br_document_is_seen(t, c))
            continue;
        fprintf(p->out, "<th scope=\"col\"%s>", br_document_is_text(t, c) ? " class=\"text\"" : "");
        print(p, t->column[c].heading);
        fputs(t->column[c].unit ? ", " : "", p->out);
        print(p, t->column[c].unit);
        fputs("</th>\n", p->out);
    }
    fputs("</tr></thead>\n", p->out);
}

/* The words of verdicts are their classes, too; "" of any other text. */
static const char *class_of_word(const char *text)
{
    for (int i = BR_OUTCOME_PASS; i <= BR_OUTCOME_SKIPPED; i++)
        if (strcmp(text, br_outcome_names[i]) == 0)
            return br_outcome_names[i];
    return "";
}

static void print_value(const struct page *p, const struct br_column *column,
                        const struct br_document_cell *cell)
{
    char buffer[BR_SHOWN];
    print(p, br_document_shown(column, cell, buffer));
    if (!cell->mark)
        return;
    fputs(" <sup>", p->out);
    print(p, cell->mark);
    fputs("</sup>", p->out);
}

static void print_row(const struct page *p, const struct br_document_table *t, size_t r)
{
    char buffer[BR_SHOWN];
    fputs(t->rule[r] ? "<tr class=\"rule\">" : "<tr>", p->out);
    for (size_t c = 0; c < t->columns; c++) {
        const struct br_document_cell *cell = br_document_cell_at(t, r, c);
        if (!br_document_is_seen(t, c))
            continue;
        const char *word = class_of_word(br_document_shown(&t->column[c], cell, buffer));
        fprintf(p->out, "<td class=\"%s%s%s%s\">", br_document_is_text(t, c) ? "text" : "number",
                t->column[c].flags & BR_WRAP ? " wrap" : "", *word ? " " : "", word);
        print_value(p, &t->column[c], cell);
        fputs("</td>", p->out);
    }
    fputs("</tr>\n", p->out);
}

static void print_table(const struct page *p, const struct br_document_table *t, int level)
{
    const bool folded = t->rows > LONG_TABLE;
    fputs(folded ? "<details><summary>" : "", p->out);
    print_heading(p, level, t->title);
    if (folded)
        fprintf(p->out, "(%zu rows)</summary>\n", t->rows);
    fputs("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"", p->out);
    print(p, t->title);
    fputs("\"><table>\n", p->out);
    print_head(p, t);
    fputs("<tbody>\n", p->out);
    for (size_t r = 0; r < t->rows; r++)
        print_row(p, t, r);
    fputs("</tbody></table></div>\n", p->out);
    fputs(folded ? "</details>\n" : "", p->out);
}

/* ---- pictures ---- */

/* STEM.svg as a text, to be freed; NULL: there is none. */
static enum br_status read_svg(const struct page *p, const char *stem, char **svg,
                               struct br_error *err)
{
    char path[4096];
    size_t room = 0;
    *svg = NULL;
    snprintf(path, sizeof path, "%s/%s.svg", p->folder ? p->folder : "", stem);
    FILE *file = p->folder ? fopen(path, "r") : NULL;
    if (!file)
        return BR_OK;
    const bool there = getdelim(svg, &room, '\0', file) > 0, lacked = !there && errno == ENOMEM;
    fclose(file);
    if (!there) {
        free(*svg);
        *svg = NULL;
    }
    return lacked ? br_no_memory(err, "a picture") : BR_OK;
}

/* What is behind a picture's opening tag. All pictures of gnuplot have the same ids: within tags,
 * each id and each reference to one gets a prefix. Of texts only those in the picture stay, no
 * titles, which would be shown under the mouse. */
static void print_unique(const struct page *p, const char *svg)
{
    static const char *const before[] = {" id='", " id=\"", "href='#", "href=\"#", "url(#"};
    bool in_tag = false, in_text = false;
    for (const char *c = svg; *c; c++) {
        in_tag |= *c == '<';
        if (*c == '<')
            in_text = strncmp(c, "<text", 5) == 0 || (in_text && strncmp(c, "</text", 6) != 0);
        if (in_tag || in_text || *c == '\n')
            fputc(*c == '\t' ? ' ' : *c, p->out);
        in_tag &= *c != '>';
        for (size_t i = 0; in_tag && i < sizeof before / sizeof *before; i++) {
            const size_t size = strlen(before[i]);
            if ((size_t)(c - svg) >= size && memcmp(c + 1 - size, before[i], size) == 0)
                fprintf(p->out, "picture%zu-", p->pictures);
        }
    }
}

/* In a frame that keeps its shape, not its size. Whether it is a picture. */
static bool print_svg(const struct page *p, const char *svg, const char *caption)
{
    static const char key[] = "viewBox=\"";
    const char *view = svg ? strstr(svg, key) : NULL;
    const char *rest = view ? strchr(view, '>') : NULL;
    if (!rest || !strstr(rest, "</svg>"))
        return false;
    view += strlen(key);
    fprintf(p->out, "<div class=\"card\"><svg viewBox=\"%.*s\" role=\"img\" aria-label=\"",
            (int)strcspn(view, "\""), view);
    print(p, caption);
    fputs("\">", p->out);
    print_unique(p, rest + 1);
    fputs("</div>\n", p->out);
    return true;
}

static enum br_status print_picture(struct page *p, const struct br_block *b, struct br_error *err)
{
    char *svg;
    const enum br_status status = read_svg(p, b->what.key, &svg, err);
    p->pictures++;
    fputs("<figure>\n", p->out);
    if (!print_svg(p, svg, b->text)) {
        fputs("<figcaption>Not drawn here: ", p->out);
        print(p, b->text);
        fputs(". Where gnuplot is installed, its script draws it: <code>gnuplot ", p->out);
        print(p, b->what.key);
        fputs(".gp</code></figcaption>\n", p->out);
    }
    fputs("</figure>\n", p->out);
    free(svg);
    return status;
}

/* ---- the rest ---- */

static void print_fact(const struct page *p, const struct br_block *b)
{
    fputs("<div>", p->out);
    print_element(p, "dt", b->what.heading);
    fputs("<dd>", p->out);
    print_value(p, &b->what, &b->cell);
    fputs(b->what.unit ? " " : "", p->out);
    print(p, b->what.unit);
    fputs("</dd></div>\n", p->out);
}

static bool is_shown(const struct br_block *b)
{
    return b->kind == BR_BLOCK_TABLE ? br_for_people(b->table->flags) && b->table->rows > 0
                                     : br_for_people(b->what.flags);
}

/* under: a section, whose tables are a level lower. */
static enum br_status print_block(struct page *p, const struct br_block *b, bool under,
                                  struct br_error *err)
{
    switch (b->kind) {
    case BR_BLOCK_TABLE:
        print_table(p, b->table, p->level + 1 + under);
        break;
    case BR_BLOCK_SECTION:
        print_heading(p, p->level + 1, b->text);
        break;
    case BR_BLOCK_NOTE:
        print_element(p, "p", b->text);
        break;
    case BR_BLOCK_FACT:
        print_fact(p, b);
        break;
    case BR_BLOCK_COMMAND:
        print_element(p, "p", b->what.heading);
        print_lines(p, b->cell.value.text);
        break;
    case BR_BLOCK_PICTURE:
        return print_picture(p, b, err);
    }
    return BR_OK;
}

/* Facts that follow each other are one list. */
static enum br_status print_blocks(struct page *p, const struct br_document *d,
                                   struct br_error *err)
{
    enum br_status status = BR_OK;
    bool facts = false, under = false;
    for (size_t i = 0; i < d->blocks && !status; i++) {
        const struct br_block *b = &d->block[i];
        if (!is_shown(b))
            continue;
        if (facts != (b->kind == BR_BLOCK_FACT))
            fputs(facts ? "</dl>\n" : "<dl>\n", p->out);
        facts = b->kind == BR_BLOCK_FACT;
        under |= b->kind == BR_BLOCK_SECTION;
        status = print_block(p, b, under, err);
    }
    fputs(facts ? "</dl>\n" : "", p->out);
    return status;
}

static void print_word(const struct page *p, enum br_outcome outcome)
{
    fprintf(p->out, "<strong class=\"%s\">%s</strong> ", br_outcome_names[outcome],
            br_outcome_names[outcome]);
}

static void print_verdict(const struct page *p, const struct br_document_verdict *v)
{
    fputs("<li>", p->out);
    print_word(p, v->outcome);
    print(p, v->group);
    fputs(v->group ? ", " : "", p->out);
    print(p, v->name);
    fputs(v->message ? ": " : "", p->out);
    print(p, v->message);
    for (size_t i = 0; i < v->details; i++)
        print_lines(p, v->detail[i]);
    fputs("</li>\n", p->out);
}

/* How many there are of each kind, and those that a person should hear of. */
static void print_verdicts(const struct page *p, const struct br_document *d)
{
    size_t count[BR_OUTCOME_SKIPPED + 1] = {0}, matter = 0;
    for (size_t i = 0; i < d->verdicts; i++) {
        count[d->verdict[i].outcome]++;
        matter += br_document_verdict_matters(&d->verdict[i]);
    }
    if (!d->verdicts)
        return;
    print_heading(p, p->level + 1, "Verdicts");
    fputs("<p>", p->out);
    for (int i = BR_OUTCOME_PASS; i <= BR_OUTCOME_SKIPPED; i++)
        if (count[i]) {
            fprintf(p->out, "%zu ", count[i]);
            print_word(p, (enum br_outcome)i);
        }
    fputs(matter ? "</p>\n<ul>\n" : "</p>\n", p->out);
    for (size_t i = 0; i < d->verdicts; i++)
        if (br_document_verdict_matters(&d->verdict[i]))
            print_verdict(p, &d->verdict[i]);
    fputs(matter ? "</ul>\n" : "", p->out);
}

static void print_scene(const struct page *p, const struct br_provenance *from)
{
    if (!from->scene_text)
        return;
    fputs("<details><summary>Scene ", p->out);
    print(p, from->scene_path);
    fputs("</summary>\n", p->out);
    print_lines(p, from->scene_text);
    fputs("</details>\n", p->out);
}

static void print_provenance(const struct page *p, const struct br_provenance *from)
{
    const char *const rows[][2] = {{"Version", from->version}, {"Commit", from->commit},
                                   {"Date", from->date},       {"Compiler", from->compiler},
                                   {"Flags", from->flags},     {"Machine", from->machine}};
    if (!from->version)
        return;
    print_heading(p, 2, "Where this comes from");
    if (from->command_line)
        print_lines(p, from->command_line);
    fputs("<dl>\n", p->out);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        fputs("<div>", p->out);
        print_element(p, "dt", rows[i][0]);
        print_element(p, "dd", rows[i][1]);
        fputs("</div>\n", p->out);
    }
    fprintf(p->out, "<div><dt>Threads</dt><dd>%d</dd></div>\n</dl>\n", from->threads);
}

/* ---- the page ---- */

static enum br_status print_document(struct page *p, const struct br_document *d,
                                     struct br_error *err)
{
    print_heading(p, p->level, d->caption);
    print_answer(p, d);
    print_verdicts(p, d);
    const enum br_status status = print_blocks(p, d, err);
    print_scene(p, &d->provenance);
    return status;
}

/* "beamrate extremes" of "beamrate extremes map". */
static void print_title(const struct page *p, const struct br_document *d, size_t count)
{
    const size_t first = strcspn(d->format, " "), blank = d->format[first] == ' ';
    if (count == 1)
        print(p, d->caption);
    else
        fprintf(p->out, "%.*s: %zu reports",
                (int)(first + blank + strcspn(d->format + first + blank, " ")), d->format, count);
}

/* The reports, and what is said first of each. */
static void print_contents(const struct page *p, const struct br_document *d, size_t count)
{
    fputs("<h1>", p->out);
    print_title(p, d, count);
    fputs("</h1>\n<nav aria-label=\"Contents\"><ol>\n", p->out);
    for (size_t i = 0; i < count; i++) {
        fprintf(p->out, "<li><a href=\"#report%zu\">", i + 1);
        print(p, d[i].caption);
        fputs("</a> (", p->out);
        print(p, d[i].name);
        fputs(")<br>", p->out);
        print(p, d[i].answers ? d[i].answer[0] : "");
        fputs("</li>\n", p->out);
    }
    fputs("</ol></nav>\n", p->out);
}

/* All reports of a page are of one command, so where they come from stands once. */
static enum br_status print_page(struct page *p, const struct br_document *d, size_t count,
                                 struct br_error *err)
{
    enum br_status status = BR_OK;
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          p->out);
    print_title(p, d, count);
    fprintf(p->out, "</title>\n<style>\n%s</style>\n</head>\n<body>\n<main>\n", style);
    if (count > 1)
        print_contents(p, d, count);
    for (size_t i = 0; i < count && !status; i++) {
        fprintf(p->out, "<article id=\"report%zu\">\n", i + 1);
        status = print_document(p, &d[i], err);
        fputs("</article>\n", p->out);
    }
    print_provenance(p, &d->provenance);
    fputs("</main>\n</body>\n</html>\n", p->out);
    return status;
}

enum br_status br_document_print_page(FILE *out, const struct br_document *d, size_t count,
                                      const char *folder, struct br_error *err)
{
    struct page p = {.out = out, .folder = folder, .level = count > 1 ? 2 : 1};
    enum br_status status = BR_OK;
    size_t longest = 0;
    for (size_t i = 0; i < count && !status; i++) {
        status = br_document_status(&d[i], err);
        longest = d[i].longest > longest ? d[i].longest : longest;
    }
    p.line = status ? NULL : br_allocate(1, longest + 1);
    if (!status)
        status = p.line ? print_page(&p, d, count, err) : br_no_memory(err, "a page");
    free(p.line);
    return status;
}

static enum br_status write(FILE *out, const struct br_document *d,
                            const struct br_document_table *table, struct br_error *err)
{
    (void)table;
    return br_document_print_page(out, d, 1, NULL, err);
}

const struct br_document_format br_document_html = {
    .name = "html",
    .extension = ".html",
    .title = "a page with the pictures in it; all reports are on report.html",
    .write = write,
};
