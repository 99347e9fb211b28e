/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "solver/laws.h"
#include "study/scene/schema.h"
#include "study/verify/verify.h"
#include "tables/beam/reports.h"

enum { COLUMN = 46 }; /* where comments begin */

/* Or what makes it; the template gives the number itself. */
static bool must_be_given(const struct br_scene_key *key)
{
    return key->need != BR_OPTIONAL && key->need != BR_MAKES;
}

/* What holds where the key is left out; "": it must be given. */
static void write_default(FILE *out, const struct br_scene_key *key)
{
    const bool expression =
        key->kind == BR_KEY_LOAD || key->kind == BR_KEY_INITIAL || key->kind == BR_KEY_HISTORY;
    const char *with = ", with law: ";
    for (enum br_friction_law law = 0; law < BR_FRICTION_LAWS; law++)
        if (key->laws & 1u << law) {
            fprintf(out, "%s%s", with, br_friction_models[law].name);
            with = " or ";
        }
    if (must_be_given(key))
        return;
    if (key->kind == BR_KEY_SECTION)
        fprintf(out, "; default: not modelled");
    else if (expression)
        fprintf(out, "; default: 0 [%s]", key->unit);
    else if (*key->unit && key->kind != BR_KEY_SOLUTION && key->need != BR_MAKES)
        fprintf(out, "; default: 0 %s", key->unit);
    else
        fprintf(out, "; default: none");
}

/* "  name: value  # help", as a comment where it is optional. */
static void write_key(FILE *out, const struct br_scene_key *key)
{
    const bool other_law = key->laws && !(key->laws & 1u << BR_COULOMB); /* that of the example */
    const bool live = (must_be_given(key) && !other_law) || key->kind == BR_KEY_SECTION ||
                      key->kind == BR_KEY_LOAD;
    const char *constraint = key->kind == BR_KEY_POSITIVE       ? ", > 0"
                             : key->kind == BR_KEY_NOT_NEGATIVE ? ", >= 0"
                             : key->kind == BR_KEY_LOAD
                                 ? ", or {shape: \"F(x) [1]\", history: \"G(t) [N/m]\"}"
                             : key->kind == BR_KEY_HISTORY ? ", of t"
                                                           : "";
    const int width = fprintf(out, "%s%s%s:%s%s", *key->section ? "  " : "", live ? "" : "# ",
                              key->name, *key->example ? " " : "", key->example);
    fprintf(out, "%*s# %s%s", width < COLUMN ? COLUMN - width : 1, "",
            br_scene_key_help(key, (char[BR_KEY_HELP]){0}), constraint);
    write_default(out, key);
    fputc('\n', out);
}

/* As a comment: orders are measured first, by a scene without it. */
static void write_verify(FILE *out, const struct br_scene_key *key)
{
    static const char *const lists[BR_VERIFY_KINDS][2] = {
        [BR_VERIFY_SPACE] = {"10, 20, 40, 80, 160", "0.01 s"},
        [BR_VERIFY_TIME] = {"10", "1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5 s"},
        [BR_VERIFY_JOINT] = {"10, 20, 40, 80", "4e-3, 1e-3, 2.5e-4, 6.25e-5 s"},
    };
    fprintf(
        out,
        "\n# %s: %s; without it 'beamrate check' says what it expects.\n"
        "# A line is a norm, a part (none: the total), its order, and perhaps its constant.\n"
        "# The method of a study: scheme, solver and the like, as 'beamrate help methods' lists them.\n"
        "# %s:\n",
        key->name, key->help, key->name);
    for (int kind = 0; kind < BR_VERIFY_KINDS; kind++) {
        fprintf(out, "#   %s:\n#     n: %s\n#     k: %s\n", br_verify_names[kind], lists[kind][0],
                lists[kind][1]);
        if (kind == BR_VERIFY_SPACE)
            fprintf(out, "#     %s %s: 2 +- 0.1\n", br_norms[0]->name,
                    br_part_names[BR_PART_AXIAL]);
        else
            fprintf(out, "#     %s: 1 +- 0.1, at most 1 %s\n", br_norms[0]->name,
                    br_norms[0]->unit);
    }
}

void br_scene_template_write(FILE *out)
{
    fprintf(
        out,
        "# A scene of beamrate. Every number carries its unit; an expression, in x (m) and t (s),\n"
        "# carries it in brackets. Keys behind a # are optional, values after them are examples.\n"
        "# Delete the parts that you do not need: they then cost nothing.\n");
    for (const struct br_scene_key *k = br_scene_keys; k->name; k++) {
        if (*k->section)
            continue;
        if (k->kind == BR_KEY_VERIFY) {
            write_verify(out, k);
            continue;
        }
        if (k->kind == BR_KEY_SECTION)
            fputc('\n', out);
        write_key(out, k);
        for (const struct br_scene_key *in = br_scene_keys; in->name; in++)
            if (strcmp(in->section, k->name) == 0)
                write_key(out, in);
    }
}
