/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate tables: the paper's Tables 1 and 2 on their printed grids. */
#include "cli/command.h"
#include "cli/study_run.h"

static const struct br_study_job printed_tables[] = {
    {"table1", "example1", "reference/printed/table1.csv", "Table 1: Example 1, stick"},
    {"table2", "example2", "reference/printed/table2.csv", "Table 2: Example 2, slip"},
};

static enum br_status run(const struct br_options *options, struct br_error *err)
{
    return br_study_run_jobs(printed_tables, sizeof printed_tables / sizeof *printed_tables,
                             options, true, err);
}

const struct br_command br_command_tables = {
    .bit = BR_FOR_TABLES,
    .name = "tables",
    .arguments = "",
    .title = "the paper's two error tables beside the printed ones",
    .about =
        "The paper's Tables 1 and 2 beside the printed values, on the printed grids and with the "
        "printed reference, and against the exact solution, by which the orders are fitted.",
    .example = {"beamrate tables --out results", "mpirun -n 4 beamrate tables"},
    .run = run,
};
