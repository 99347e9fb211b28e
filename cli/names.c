/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/names.h"

#include "study/grid/norm.h"
#include "study/trade/contender.h"

#include <stdio.h>
#include <string.h>

#include "study/grid/study.h"
#include "tables/document.h"

/* The names of a registry as "a, b", for help and messages. */
static void join(char *text, size_t size, const char *name)
{
    const size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", used ? ", " : "", name);
}

const char *br_solver_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_linear_solver *const *s = br_linear_solvers; *s; s++)
        join(text, sizeof text, (*s)->name);
    return text;
}

const char *br_scheme_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_time_scheme *const *s = br_time_schemes; *s; s++)
        join(text, sizeof text, (*s)->name);
    return text;
}

const char *br_kernel_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_kernel *const *k = br_kernels; *k; k++)
        if ((*k)->available())
            join(text, sizeof text, (*k)->name);
    return text;
}

const char *br_contact_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_contact_rule *const *c = br_contact_rules; *c; c++)
        join(text, sizeof text, (*c)->name);
    return text;
}

const char *br_friction_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_friction_rule *const *f = br_friction_rules; *f; f++)
        join(text, sizeof text, (*f)->name);
    return text;
}

const char *br_judge_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_judge *const *j = br_judges; *j; j++)
        join(text, sizeof text, (*j)->syntax);
    return text;
}

const char *br_norm_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_norm *const *n = br_norms; *n; n++)
        join(text, sizeof text, (*n)->name);
    return text;
}

const char *br_format_names(void)
{
    static char text[256];
    text[0] = '\0';
    for (const struct br_document_format *const *e = br_document_formats; *e; e++)
        join(text, sizeof text, (*e)->name);
    return text;
}

void br_print_contender_words(FILE *out)
{
    char words[256];
    fprintf(out, "\nA method's name: these words, joined by '+', at most one of a kind:\n");
    for (size_t i = 0; i < br_contender_kinds(); i++) {
        const char *title = br_contender_kind(i, words, sizeof words);
        fprintf(out, "  %-30s %s\n", title, words);
    }
    fprintf(out, "Norms (--norm):\n");
    for (const struct br_norm *const *n = br_norms; *n; n++)
        fprintf(out, "  %-12s %s\n", (*n)->name, (*n)->title);
}
