/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report's verdicts for CI systems: JUnit's XML and GitHub's annotations. JUnit has the numbers
 * of a verdict's row by their keys. Both have the lines that explain a verdict. */
#include <math.h>
#include <string.h>

#include "study/base/quote.h"
#include "tables/document.h"

/* Prints "key: value", a line for each column of the verdict's row. */
static void print_row(FILE *out, const struct br_quoting *target, const struct br_document *d,
                      const struct br_document_verdict *v)
{
    const struct br_document_table *t = v->of_row ? d->block[v->table].table : NULL;
    for (size_t c = 0; t && c < t->columns; c++)
        if (br_for_programs(t->column[c].flags)) {
            fprintf(out, "  %s: ", t->column[c].key);
            br_document_print_value(out, target, "null", &br_document_cell_at(t, v->row, c)->value);
            fputc('\n', out);
        }
}

/* "  name: text" */
static void print_line(FILE *out, const struct br_quoting *target, const char *name,
                       const char *text)
{
    fprintf(out, "  %s: ", name);
    br_quote(out, target, text);
    fputc('\n', out);
}

/* ---- JUnit ---- */

static void print_attribute(FILE *out, const char *name, const char *text)
{
    fprintf(out, " %s=\"", name);
    br_quote(out, &br_for_xml, text);
    fputc('"', out);
}

/* Prints counts of the verdicts from `begin` to `end`; returns how many were skipped. */
static size_t print_counts(FILE *out, const struct br_document *d, size_t begin, size_t end)
{
    size_t of[BR_OUTCOME_SKIPPED + 1] = {0};
    double seconds = 0;
    for (size_t i = begin; i < end; i++) {
        of[d->verdict[i].outcome]++;
        seconds += isfinite(d->verdict[i].seconds) ? d->verdict[i].seconds : 0;
    }
    fprintf(out, " tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" time=\"%.6f\"", end - begin,
            of[BR_OUTCOME_FAIL] + of[BR_OUTCOME_INCONCLUSIVE], of[BR_OUTCOME_ERROR], seconds);
    return of[BR_OUTCOME_SKIPPED];
}

/* Prints where it is expected, as the schemas have no attributes for that, and the explanations. */
static void print_details(FILE *out, const struct br_document_verdict *v)
{
    if (v->file)
        print_line(out, &br_for_xml, "file", v->file);
    if (v->line)
        fprintf(out, "  line: %zu\n", v->line);
    for (size_t i = 0; i < v->details; i++)
        print_line(out, &br_for_xml, "detail", v->detail[i]);
}

static void print_testcase(FILE *out, const struct br_document *d,
                           const struct br_document_verdict *v)
{
    static const char *const elements[] = {NULL, "failure", "failure", "error", "skipped"};
    const char *element = elements[v->outcome];
    fprintf(out, "    <testcase classname=\"beamrate%s", v->group ? "." : "");
    br_quote(out, &br_for_xml, v->group ? v->group : "");
    fputc('"', out);
    print_attribute(out, "name", v->name);
    if (isfinite(v->seconds))
        fprintf(out, " time=\"%.6f\"", v->seconds);
    fputs(">\n", out);
    if (element) {
        fprintf(out, "      <%s", element);
        if (v->outcome != BR_OUTCOME_SKIPPED)
            print_attribute(out, "type", br_outcome_names[v->outcome]);
        print_attribute(out, "message", v->message ? v->message : "");
        fputs(">\n", out);
        print_details(out, v);
        fprintf(out, "      </%s>\n", element);
    }
    fputs("      <system-out>\n", out);
    if (!element && v->message)
        print_line(out, &br_for_xml, "message", v->message);
    if (!element)
        print_details(out, v);
    print_row(out, &br_for_xml, d, v);
    fputs("      </system-out>\n    </testcase>\n", out);
}

static enum br_status write_junit(FILE *out, const struct br_document *d,
                                  const struct br_document_table *table, struct br_error *err)
{
    (void)table, (void)err;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites", out);
    print_attribute(out, "name", d->format);
    print_counts(out, d, 0, d->verdicts);
    fputs(">\n", out);
    for (size_t begin = 0, end; begin < d->verdicts; begin = end) {
        const char *group = d->verdict[begin].group, *other = group;
        for (end = begin + 1; end < d->verdicts; end++) {
            other = d->verdict[end].group;
            if (group && other ? strcmp(group, other) != 0 : group != other)
                break;
        }
        fputs("  <testsuite", out);
        print_attribute(out, "name", group ? group : d->name);
        const size_t skipped = print_counts(out, d, begin, end);
        fprintf(out, " skipped=\"%zu\"", skipped);
        if (d->provenance.date)
            fprintf(out, " timestamp=\"%.19s\"", d->provenance.date);
        fputs(">\n", out);
        for (size_t i = begin; i < end; i++)
            print_testcase(out, d, &d->verdict[i]);
        fputs("  </testsuite>\n", out);
    }
    fputs("</testsuites>\n", out);
    return BR_OK;
}

const struct br_document_format br_document_junit = {
    .name = "junit",
    .extension = ".xml",
    .title = "JUnit's XML, for CI systems",
    .write = write_junit,
};

/* ---- GitHub: a line for each verdict that did not pass, shown at the line of its file ---- */

static enum br_status write_annotations(FILE *out, const struct br_document *d,
                                        const struct br_document_table *table, struct br_error *err)
{
    static const char *const levels[] = {NULL, "error", "warning", "error", "notice"};
    (void)table, (void)err;
    for (size_t i = 0; i < d->verdicts; i++) {
        const struct br_document_verdict *v = &d->verdict[i];
        if (!levels[v->outcome])
            continue;
        fprintf(out, "::%s ", levels[v->outcome]);
        if (v->file) {
            fputs("file=", out);
            br_quote(out, &br_for_github_property, v->file);
            fputc(',', out);
        }
        if (v->file && v->line)
            fprintf(out, "line=%zu,", v->line);
        fputs("title=", out);
        br_quote(out, &br_for_github_property, v->group ? v->group : "beamrate");
        fputs("::", out);
        br_quote(out, &br_for_github, v->name);
        fprintf(out, " %s", br_outcome_names[v->outcome]);
        fputs(v->message ? ": " : "", out);
        br_quote(out, &br_for_github, v->message ? v->message : "");
        for (size_t j = 0; j < v->details; j++) {
            fputs("%0A", out);
            br_quote(out, &br_for_github, v->detail[j]);
        }
        fputc('\n', out);
    }
    return BR_OK;
}

const struct br_document_format br_document_github = {
    .name = "github",
    .extension = ".txt",
    .title = "annotations of what did not pass, for GitHub's pages",
    .write = write_annotations,
};
