/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate tables: the paper's Tables 1 and 2 on their printed grids. */
#include <string.h>

#include "cli/command.h"
#include "cli/study_run.h"

static const struct br_study_job printed_tables[] = {
    {"table1", "example1", "reference/printed/table1.csv", "Table 1: Example 1, stick"},
    {"table2", "example2", "reference/printed/table2.csv", "Table 2: Example 2, slip"},
};

/* The printed grids and the printed reference, where the options say nothing else. */
static enum br_status fill_printed_grid(struct br_study_options *o, struct br_error *err)
{
    const struct {
        char **option;
        const char *printed;
    } defaults[] = {
        {&o->n, "100,200,400,800,1600,3200"},
        {&o->k, "0.01,0.005,0.002,0.001,0.0005,0.0001"},
        {&o->reference, "fine:12800,1e-5"},
    };
    for (size_t i = 0; i < sizeof defaults / sizeof *defaults; i++) {
        if (*defaults[i].option)
            continue;
        *defaults[i].option = strdup(defaults[i].printed);
        if (!*defaults[i].option)
            return br_no_memory(err, "the options");
    }
    return BR_OK;
}

static enum br_status run(int argc, const char **argv, struct br_error *err)
{
    struct br_study_options options = {0};
    enum br_status status = br_study_options_parse(
        argc, argv,
        "[OPTION...]\n\nThe paper's Tables 1 and 2 beside the printed values, on the printed "
        "grids\n(n = 100 to 3200, k = 0.01 to 0.0001 s) and with the printed reference\n"
        "(n = 12800, k = 1e-5 s) unless --n, --k or --reference say otherwise, and against\nthe exact "
        "solution, by which the orders are fitted.\n\nExample:\n  "
        "beamrate tables --out results\n",
        &options, NULL, err);
    if (!status && !options.help)
        status = fill_printed_grid(&options, err);
    if (!status && !options.help)
        status = br_study_run_jobs(printed_tables, sizeof printed_tables / sizeof *printed_tables,
                                   &options, true, err);
    br_study_options_clear(&options);
    return status;
}

const struct br_command br_command_tables = {
    .name = "tables",
    .arguments = "",
    .title = "the paper's two error tables beside the printed ones",
    .run = run,
};
