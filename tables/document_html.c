/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One page of HTML that needs nothing else: no script, no other file. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "tables/markup.h"

/* Wide tables reach to the right edge of the window, beyond the column of text; their first column
 * stays visible. All colours of text have a contrast of at least 4.5 to both backgrounds
 * (tests/html_page.py). */
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
    "dt { color: var(--quiet); }\n"
    ".scroll, .card, pre { overflow-x: auto; }\n"
    ".scroll { max-width: calc(50vw + min(50vw, 37.5rem) - 3rem); width: max-content; }\n"
    "table { border-collapse: collapse; font-variant-numeric: tabular-nums; }\n"
    "th, td { overflow-wrap: normal; padding: 0.15rem 0.6rem; text-align: right;\n"
    "  vertical-align: top; white-space: nowrap; }\n"
    "th { border-bottom: 2px solid var(--line); vertical-align: bottom; white-space: normal; }\n"
    ".text { text-align: left; }\n"
    ".detail { color: var(--quiet); list-style: none; margin-left: 1.5rem; }\n"
    ".wrap { min-width: 13rem; white-space: normal; }\n"
    "tr { background: var(--ground); }\n"
    "tr > :first-child { background: inherit; left: 0; position: sticky; }\n"
    "tbody tr:nth-child(even), pre { background: var(--shade); }\n"
    "pre { padding: 0.6rem; overflow-wrap: normal; }\n"
    "summary :is(h2, h3, h4) { display: inline; }\n"
    "details { margin: 1rem 0; }\n"
    "dl div { display: flex; flex-wrap: wrap; gap: 0 0.6rem; }\n"
    "dt { flex: 0 1 16rem; }\n"
    "dd, figure { margin: 0; }\n"
    ".card { background: #ffffff; color: #000000; margin: 1.5rem 0 0.5rem; max-width: 60rem; }\n"
    "figcaption { color: var(--quiet); margin-bottom: 1.5rem; max-width: 60rem; }\n"
    "svg { display: block; height: auto; }\n"
    "@media screen and (prefers-color-scheme: dark) {\n"
    ".card { filter: invert(0.9) hue-rotate(180deg); } }\n"
    "@media print {\n"
    ".scroll, .card, pre { max-width: none; overflow: visible; }\n"
    "pre { white-space: pre-wrap; }\n"
    "figure, tr { break-inside: avoid; }\n"
    "h2, h3, h4, summary, thead { break-after: avoid; }\n"
    "::details-content { content-visibility: visible; } }\n";

static bool is_folded(const struct br_document_table *t)
{
    return t->rows > BR_LONG_TABLE;
}

static void open_table(const struct br_markup_page *p, const struct br_document_table *t, int level)
{
    fputs(is_folded(t) ? "<details><summary>" : "", p->out);
    br_markup_heading(p, level, t->title);
    if (is_folded(t))
        fprintf(p->out, "(%zu rows)</summary>\n", t->rows);
    br_markup_put(p,
                  "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"%s\"><table>\n"
                  "<thead><tr>\n",
                  t->title);
}

static void close_table(const struct br_markup_page *p, const struct br_document_table *t)
{
    fputs(is_folded(t) ? "</details>\n" : "", p->out);
}

/* The text of STEM.svg, which the caller frees; NULL: there is none. */
static char *read_svg(struct br_markup_page *p, const char *stem)
{
    char path[4096], *svg = NULL;
    size_t room = 0;
    snprintf(path, sizeof path, "%s/%s.svg", p->folder ? p->folder : "", stem);
    FILE *file = p->folder ? fopen(path, "r") : NULL;
    if (!file)
        return NULL;
    const bool there = getdelim(&svg, &room, '\0', file) > 0;
    if (!there && errno == ENOMEM)
        p->status = br_no_memory(p->err, "a picture");
    fclose(file);
    if (there)
        return svg;
    free(svg);
    return NULL;
}

/* Prints the contents of a picture behind its opening tag. All pictures of gnuplot have the same
 * ids: so within tags, each id and each reference to one gets a prefix. Only texts in the picture
 * are printed, not titles, which a browser would show under the mouse. */
static void print_unique(const struct br_markup_page *p, const char *svg)
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

/* Prints a picture in a frame of its shape, at any size. Returns whether the text is a picture. */
static bool print_svg(const struct br_markup_page *p, const char *svg, const char *caption)
{
    static const char key[] = "viewBox=\"";
    const char *view = svg ? strstr(svg, key) : NULL;
    const char *rest = view ? strchr(view, '>') : NULL;
    if (!rest || !strstr(rest, "</svg>"))
        return false;
    view += strlen(key);
    fprintf(p->out, "<div class=\"card\"><svg viewBox=\"%.*s\" role=\"img\" aria-label=\"",
            (int)strcspn(view, "\""), view);
    br_markup_put(p, "%s\">", caption);
    print_unique(p, rest + 1);
    fputs("</div>\n", p->out);
    return true;
}

static void print_picture(struct br_markup_page *p, const struct br_block *b)
{
    char *svg = read_svg(p, b->what.key);
    p->pictures++;
    fputs("<figure>\n", p->out);
    const bool drawn = print_svg(p, svg, b->text);
    br_markup_put(p, drawn ? "<figcaption>%s" : "<figcaption>Not drawn here: %s", b->text);
    if (!drawn)
        br_markup_put(
            p, ". Where gnuplot is installed, its script draws it: <code>gnuplot %s.gp</code>",
            b->what.key);
    fputs("</figcaption>\n</figure>\n", p->out);
    free(svg);
}

static void end(const struct br_markup_page *p)
{
    const struct br_provenance *from = &p->d->provenance;
    if (!from->scene_text)
        return;
    br_markup_put(p, "<details><summary>Scene %s</summary>\n", from->scene_path);
    br_markup_lines(p, from->scene_text);
    fputs("</details>\n", p->out);
}

static void print_provenance(const struct br_markup_page *p, const struct br_provenance *from)
{
    const char *const rows[][2] = {{"Version", from->version}, {"Commit", from->commit},
                                   {"Date", from->date},       {"Compiler", from->compiler},
                                   {"Flags", from->flags},     {"Machine", from->machine}};
    if (!from->version)
        return;
    br_markup_heading(p, 2, "How this was made");
    if (from->command_line)
        br_markup_lines(p, from->command_line);
    fputs("<dl>\n", p->out);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        br_markup_put(p, "<div><dt>%s</dt>\n<dd>%s</dd></div>\n", rows[i][0], rows[i][1]);
    fprintf(p->out, "<div><dt>Threads</dt>\n<dd>%d</dd></div>\n</dl>\n", from->threads);
}

/* The class of a cell is its alignment. */
static const char *const classes[] = {" class=\"number\"", " class=\"text\"",
                                      " class=\"text wrap\""};

static const struct br_markup html = {
    .quoting = &br_for_xml,
    .of_lines = &br_for_xml,
    .heading = {"<h%d>", "</h%d>\n"},
    .answers = {"<ul class=\"answer\">\n", "</ul>\n"},
    .answer = {"<li>", "</li>\n"},
    .note = {"<p>", "</p>\n"},
    .facts = {"<dl>\n", "</dl>\n"},
    .fact = {"<div>", "</dd></div>\n"},
    .label = "<dt>%s</dt>\n<dd>",
    .command = "<p>%s</p>\n",
    .lines = {"<pre>", "</pre>\n"},
    .line = {"", "\n"},
    .verdicts = {"<ul>\n", "</ul>\n"},
    .verdict = {"<li>", "</li>\n"},
    .detail = "<li class=\"detail\">%s</li>\n",
    .head = {"<th scope=\"col\"%s>", "</th>\n"},
    .cell = {"<td%s>", "</td>"},
    .mark = " <small>%s</small>",
    .row = {"<tr>", "</tr>\n"},
    .rows = {"</tr></thead>\n<tbody>\n", "</tbody></table></div>\n"},
    .word = "<strong class=\"%s\">%s</strong>",
    .open_table = open_table,
    .close_table = close_table,
    .picture = print_picture,
    .picture_first = true,
    .end = end,
    .classes = classes,
};

/* The title; of several reports "beamrate extremes" of the format "beamrate extremes floors". */
static void print_title(const struct br_markup_page *p, const struct br_document *d, size_t count)
{
    const size_t first = strcspn(d->format, " "), blank = d->format[first] == ' ';
    if (count == 1)
        br_markup_put(p, "%s", d->caption);
    else
        fprintf(p->out, "%.*s: %zu reports",
                (int)(first + blank + strcspn(d->format + first + blank, " ")), d->format, count);
}

/* Prints a list of the reports, with the tally of the verdicts or the first answer of each. */
static void print_contents(struct br_markup_page *p, const struct br_document *d, size_t count)
{
    fputs("<h1>", p->out);
    print_title(p, d, count);
    fputs("</h1>\n<nav aria-label=\"Contents\"><ol>\n", p->out);
    for (size_t i = 0; i < count; i++) {
        br_markup_put(p, "<li><a href=\"#report%zu\">%s</a> (%s)<br>", i + 1, d[i].caption,
                      d[i].name);
        p->d = &d[i];
        if (p->d->verdicts)
            br_markup_tally(p);
        else
            br_markup_put(p, "%s", p->d->answers ? p->d->answer[0] : "");
        fputs("</li>\n", p->out);
    }
    fputs("</ol></nav>\n", p->out);
}

/* All reports of a page are of one command, so its provenance is printed once. */
enum br_status br_document_print_page(FILE *out, const struct br_document *d, size_t count,
                                      const char *folder, struct br_error *err)
{
    struct br_markup_page p = {
        .out = out, .markup = &html, .folder = folder, .level = count > 1 ? 2 : 1, .err = err};
    for (size_t i = 0; i < count && !p.status; i++)
        p.status = br_document_status(&d[i], err);
    if (p.status)
        return p.status;
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
          "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          out);
    print_title(&p, d, count);
    fprintf(out, "</title>\n<style>\n%s</style>\n</head>\n<body>\n<main>\n", style);
    if (count > 1)
        print_contents(&p, d, count);
    for (size_t i = 0; i < count && !p.status; i++) {
        fprintf(out, "<article id=\"report%zu\">\n", i + 1);
        p.d = &d[i];
        br_markup_print(&p);
        fputs("</article>\n", out);
    }
    print_provenance(&p, &d->provenance);
    fputs("</main>\n</body>\n</html>\n", out);
    return p.status;
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
