/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "cli/completion.h"
#include "cli/extremes_part.h"
#include "cli/rounding_option.h"
#include "study/grid/study.h"
#include "tables/document.h"

enum { MOST_WORDS = 256 };

static void join(char text[MOST_WORDS], const char *name)
{
    const size_t used = strlen(text);
    snprintf(text + used, MOST_WORDS - used, "%s%s", used ? " " : "", name);
}

/* The names of a registry's rows. */
#define NAMES(function, type, registry)                       \
    static const char *function(void)                         \
    {                                                         \
        static char text[MOST_WORDS];                         \
        text[0] = '\0';                                       \
        for (const struct type *const *r = registry; *r; r++) \
            join(text, (*r)->name);                           \
        return text;                                          \
    }
NAMES(schemes, br_time_scheme, br_time_schemes)
NAMES(solvers, br_linear_solver, br_linear_solvers)
NAMES(kernels, br_kernel, br_kernels)
NAMES(contacts, br_contact_rule, br_contact_rules)
NAMES(frictions, br_friction_rule, br_friction_rules)
NAMES(norms, br_norm, br_norms)
NAMES(formats, br_document_format, br_document_formats)

/* Those that want numbers end with their colon. */
static const char *references(void)
{
    static char text[MOST_WORDS];
    text[0] = '\0';
    for (const struct br_judge *const *j = br_judges; *j; j++) {
        join(text, (*j)->name);
        if ((*j)->nests)
            strcat(text, ":");
    }
    return text;
}

static const char *scalings(void)
{
    return "none sum max";
}

static const char *degrees(void)
{
    return "1 2";
}

/* Options by name, the same in all commands. */
static const struct {
    const char *option;
    const char *(*words)(void);
} values[] = {
    {"solver", solvers},
    {"reference-solver", solvers},
    {"kernel", kernels},
    {"contact", contacts},
    {"friction", frictions},
    {"norm", norms},
    {"format", formats},
    {"reference", references},
    {"scaling", scalings},
    {"scheme", schemes},
    {"axial-degree", degrees},
    {"methods", schemes},
    {"rounding", br_rounding_words},
};

enum br_value_kind br_option_values(const struct br_help_option *option, const char **words)
{
    *words = "";
    if (strcmp(option->argument, "FILE") == 0)
        return BR_VALUE_FILE;
    if (strcmp(option->argument, "DIR") == 0)
        return BR_VALUE_DIR;
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (*option->argument && strcmp(option->name, values[i].option) == 0) {
            *words = values[i].words();
            return strcmp(option->argument, "LIST") == 0 ? BR_VALUE_LIST : BR_VALUE_WORD;
        }
    return BR_VALUE_NONE;
}

NAMES(parts, br_extremes_part, br_extremes_parts)

void br_argument_words(const char *arguments, char *words, size_t size)
{
    words[0] = '\0';
    if (strstr(arguments, "PART"))
        snprintf(words, size, "%s", parts());
    else if (strspn(arguments, "abcdefghijklmnopqrstuvwxyz|") == strlen(arguments))
        snprintf(words, size, "%s", arguments);
    for (char *c = words; *c; c++)
        if (*c == '|')
            *c = ' ';
}
