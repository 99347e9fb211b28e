/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report's verdicts for CI systems: JUnit's XML and GitHub's annotations. JUnit has the numbers
 * of a verdict's row by their keys. Both have the lines that explain a verdict. */
#include <string.h>

#include "base/quote.h"
#include "tables/document.h"

/* ---- JUnit ---- */

/* Prints "key: value", a line for each column of the verdict's row. */
static void print_row(FILE *out, const struct br_document *d, const struct br_document_verdict *v)
{
    const struct br_document_table *t = v->of_row ? d->block[v->table].table : NULL;
    for (size_t c = 0; t && c < t->columns; c++)
        if (br_for_programs(t->column[c].flags)) {
            fprintf(out, "  %s: ", t->column[c].key);
            br_document_print_value(out, &br_for_xml, "null",
                                    &br_document_cell_at(t, v->row, c)->value);
            fputc('\n', out);
        }
}

/* Prints counts of the verdicts from `begin` to `end`. */
static void print_counts(FILE *out, const struct br_document *d, size_t begin, size_t end)
{
    size_t of[BR_OUTCOMES] = {0};
    double seconds = 0;
    for (size_t i = begin; i < end; i++) {
        of[d->verdict[i].outcome]++;
        seconds += d->verdict[i].seconds;
    }
    fprintf(out, " tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" time=\"%.6f\"", end - begin,
            of[BR_OUTCOME_FAIL] + of[BR_OUTCOME_INCONCLUSIVE], of[BR_OUTCOME_ERROR], seconds);
}

/* Prints where it is expected, as the schemas have no attributes for that, and the explanations. */
static void print_details(FILE *out, const struct br_document_verdict *v)
{
    if (v->file)
        br_print(out, &br_for_xml, "  file: %s\n", v->file);
    if (v->line)
        fprintf(out, "  line: %zu\n", v->line);
    for (size_t i = 0; i < v->details; i++)
        br_print(out, &br_for_xml, "  detail: %s\n", v->detail[i]);
}

static void print_testcase(FILE *out, const struct br_document *d,
                           const struct br_document_verdict *v)
{
    static const char *const elements[] = {NULL, "failure", "failure", "error"};
    const char *element = elements[v->outcome];
    br_print(out, &br_for_xml,
             "    <testcase classname=\"beamrate.%s\" name=\"%s\" time=\"%.6f\">\n", v->group,
             v->name, v->seconds);
    if (element) {
        br_print(out, &br_for_xml, "      <%s type=\"%s\" message=\"%s\">\n", element,
                 br_outcome_names[v->outcome], v->message ? v->message : "");
        print_details(out, v);
        fprintf(out, "      </%s>\n", element);
    }
    fputs("      <system-out>\n", out);
    if (!element && v->message)
        br_print(out, &br_for_xml, "  message: %s\n", v->message);
    if (!element)
        print_details(out, v);
    print_row(out, d, v);
    fputs("      </system-out>\n    </testcase>\n", out);
}

static enum br_status write_junit(FILE *out, const struct br_document *d,
                                  const struct br_document_table *table, struct br_error *err)
{
    (void)table, (void)err;
    br_print(out, &br_for_xml,
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"%s\"", d->format);
    print_counts(out, d, 0, d->verdicts);
    fputs(">\n", out);
    for (size_t begin = 0, end; begin < d->verdicts; begin = end) {
        const char *group = d->verdict[begin].group;
        end = begin + 1;
        while (end < d->verdicts && strcmp(group, d->verdict[end].group) == 0)
            end++;
        br_print(out, &br_for_xml, "  <testsuite name=\"%s\"", group);
        print_counts(out, d, begin, end);
        fputs(" skipped=\"0\"", out);
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
    static const char *const levels[] = {NULL, "error", "warning", "error"};
    (void)table, (void)err;
    for (size_t i = 0; i < d->verdicts; i++) {
        const struct br_document_verdict *v = &d->verdict[i];
        if (!levels[v->outcome])
            continue;
        fprintf(out, "::%s ", levels[v->outcome]);
        if (v->file)
            br_print(out, &br_for_github_property, "file=%s,", v->file);
        if (v->file && v->line)
            fprintf(out, "line=%zu,", v->line);
        br_print(out, &br_for_github_property, "title=%s::", v->group);
        br_print(out, &br_for_github, "%s %s%s%s", v->name, br_outcome_names[v->outcome],
                 v->message ? ": " : "", v->message ? v->message : "");
        for (size_t j = 0; j < v->details; j++)
            br_print(out, &br_for_github, "%%0A%s", v->detail[j]);
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
