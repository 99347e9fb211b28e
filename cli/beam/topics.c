/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The topics of the help besides the commands; and all that the program has of the beam. */
#include <string.h>

#include "cli/beam/beam.h"
#include "study/ranks/ranks.h"
#include "study/scene/named_method.h"

/* "--kernel   --solver auto, riccati": the rows that use field i of a method. */
static void print_users(FILE *out, size_t i)
{
    const struct br_method_field *f = &br_method_fields[i], *by = &br_method_fields[f->by];
    struct br_method m = br_method_default();
    const char *between = " ";
    if (!f->argument || !br_method_field_depends(f))
        return;
    fprintf(out, "  --%-21s --%s", br_method_fields[i].name, br_method_fields[f->by].name);
    for (size_t row = 0; by->words->name(row); row++) {
        by->set(&m, (double)row);
        if (br_method_field_used(f, &m)) {
            fprintf(out, "%s%s", between, by->words->name(row));
            between = ", ";
        }
    }
    fputc('\n', out);
}

static void print_methods(FILE *out)
{
    struct br_registry list[BR_REGISTRIES];
    char text[256];
    const size_t count = br_registries(list);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "--%s: %s\n", list[i].option, list[i].title);
        for (size_t row = 0; list[i].words->name(row); row++) {
            fprintf(out, "  %-15s ", list[i].words->name(row));
            br_print_wrapped(out,
                             list[i].words->title ? list[i].words->title(row)
                             : br_word_available(list[i].words, row)
                                 ? "available here"
                                 : "not available on this machine",
                             18, 18);
        }
    }
    fprintf(out, "\nOptions that some of these use:\n");
    for (size_t i = 0; i < BR_METHOD_FIELDS; i++)
        print_users(out, i);
    fputc('\n', out);
    br_print_wrapped(
        out, "Names of methods (--methods): these words joined by '+', at most one of a kind:", 0,
        0);
    const char *title;
    for (size_t i = 0; (title = br_named_method_kind(i, text, sizeof text)); i++) {
        fprintf(out, "  %-30s ", title);
        br_print_wrapped(out, text, 33, 33);
    }
}

static const char *const topics[] = {"methods", "man", "markdown", NULL};

static void print_topic(const char *topic)
{
    static void (*const print[])(FILE * out) = {print_methods, br_print_manual,
                                                br_print_options_page};
    for (size_t i = 0; topics[i]; i++)
        if (strcmp(topic, topics[i]) == 0)
            print[i](stdout);
}

const struct br_beam br_beam = {
    .add_options = br_beam_add_options,
    .standard = br_beam_standard,
    .check_options = br_beam_check_options,
    .start = br_ranks_start,
    .end = br_ranks_end,
    .first = br_ranks_first,
    .size = br_ranks_size,
    .topics = topics,
    .print_topic = print_topic,
};
