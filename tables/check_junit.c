/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JUnit's XML as CI systems read it: a suite a scene, a test case an order. */
#include <math.h>

#include "study/scene/quote.h"
#include "tables/check_emitter.h"

static void property(FILE *out, const char *name, const char *value)
{
    fprintf(out, "        <property name=\"%s\" value=\"", name);
    br_quote(out, &br_for_xml, value);
    fputs("\"/>\n", out);
}

static void number(FILE *out, const char *name, double value)
{
    char text[64] = "none";
    if (isfinite(value))
        snprintf(text, sizeof text, "%.12g", value);
    property(out, name, text);
}

static void line(void *self, const char *text)
{
    br_quote(self, &br_for_xml, text);
    fputc('\n', self);
}

static void print_case(FILE *out, const struct br_check *check, const struct br_case *c)
{
    char name[64], order[64];
    fputs("    <testcase classname=\"beamrate.", out);
    br_quote(out, &br_for_xml, check->scene->name);
    fprintf(out, "\" name=\"%s\" time=\"0\" file=\"", br_case_name(c, name, sizeof name));
    br_quote(out, &br_for_xml, check->path);
    fprintf(out, "\" line=\"%zu\">\n      <properties>\n", c->expected.line);
    number(out, "order", c->order.value);
    number(out, "low", c->order.low);
    number(out, "high", c->order.high);
    number(out, "expected", c->expected.order);
    number(out, "tolerance", c->expected.tolerance);
    number(out, "margin", c->margin);
    number(out, "constant", c->constant);
    number(out, "floor", c->expected.floor);
    number(out, "ceiling", c->expected.ceiling);
    property(out, "verdict", br_verdict_names[c->verdict]);
    fputs("      </properties>\n", out);
    if (c->verdict != BR_PASS) {
        fprintf(out, "      <failure type=\"%s\" message=\"", br_verdict_names[c->verdict]);
        br_quote(out, &br_for_xml, c->reason);
        fprintf(out, "\">observed order %s\n", br_order_text(&c->order, order, sizeof order));
        br_case_lines(c, line, out);
        fputs("</failure>\n", out);
    } else {
        fputs("      <system-out>", out);
        br_case_lines(c, line, out);
        fputs("</system-out>\n", out);
    }
    fputs("    </testcase>\n", out);
}

/* A scene that cannot be verified is a test case that could not be run. */
static void print_error(FILE *out, const struct br_check *check)
{
    fputs("    <testcase classname=\"beamrate.", out);
    br_quote(out, &br_for_xml, check->scene->name);
    fputs("\" name=\"verify\" time=\"0\"><error type=\"bad input\" message=\"", out);
    br_quote(out, &br_for_xml, check->failure.message);
    fputs("\"/></testcase>\n", out);
}

static void print_suite(FILE *out, const struct br_check_page *page, const struct br_check *check)
{
    const size_t failed = check->count - br_check_tally(check, 1, BR_PASS);
    const int errors = check->failure.status ? 1 : 0;
    fputs("  <testsuite name=\"", out);
    br_quote(out, &br_for_xml, check->scene->name);
    fprintf(out,
            "\" tests=\"%zu\" failures=\"%zu\" errors=\"%d\" skipped=\"0\" time=\"%.3f\" "
            "timestamp=\"%.19s\">\n",
            check->count + (size_t)errors, failed, errors, check->seconds, page->provenance->date);
    if (errors)
        print_error(out, check);
    for (size_t i = 0; i < check->count; i++)
        print_case(out, check, &check->cases[i]);
    fputs("  </testsuite>\n", out);
}

static void print_skipped(FILE *out, const struct br_check_page *page)
{
    fprintf(
        out,
        "  <testsuite name=\"skipped\" tests=\"%zu\" failures=\"0\" errors=\"0\" skipped=\"%zu\" "
        "time=\"0\">\n",
        page->skips, page->skips);
    for (size_t i = 0; i < page->skips; i++) {
        fputs("    <testcase classname=\"beamrate\" name=\"", out);
        br_quote(out, &br_for_xml, page->skipped[i].scene);
        fputs("\" time=\"0\"><skipped message=\"", out);
        br_quote(out, &br_for_xml, page->skipped[i].reason);
        fputs("\"/></testcase>\n", out);
    }
    fputs("  </testsuite>\n", out);
}

static enum br_status emit(FILE *out, const struct br_check_page *page, struct br_error *err)
{
    (void)err;
    size_t all = page->skips;
    for (size_t i = 0; i < page->count; i++)
        all += page->checks[i].count;
    const size_t failed = all - page->skips - br_check_tally(page->checks, page->count, BR_PASS);
    const struct br_check *first;
    const size_t errors = br_check_failures(page->checks, page->count, &first);
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"beamrate check\" "
            "tests=\"%zu\" failures=\"%zu\" errors=\"%zu\" skipped=\"%zu\" time=\"%.3f\">\n",
            all + errors, failed, errors, page->skips, page->wall_seconds);
    for (size_t i = 0; i < page->count; i++)
        print_suite(out, page, &page->checks[i]);
    if (page->skips)
        print_skipped(out, page);
    fputs("</testsuites>\n", out);
    return BR_OK;
}

const struct br_check_emitter br_check_emit_junit = {
    .name = "junit",
    .title = "JUnit's XML, for CI systems",
    .emit = emit,
};
