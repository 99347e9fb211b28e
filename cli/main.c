/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program beamrate: the orders of anybody's numbers, and the beam. */
#include "cli/beam/beam.h"

extern const struct br_command br_command_check, br_command_completions, br_command_extremes,
    br_command_figures, br_command_help, br_command_orders, br_command_run, br_command_scenes,
    br_command_study, br_command_tables, br_command_trade;

static const struct br_command *const commands[] = {
    &br_command_orders, &br_command_check,       &br_command_run,     &br_command_study,
    &br_command_trade,  &br_command_tables,      &br_command_figures, &br_command_extremes,
    &br_command_scenes, &br_command_completions, &br_command_help,    NULL,
};

const struct br_program br_program = {
    .name = "beamrate",
    .about =
        "the order of convergence of any program's numbers; and a solver of its own, of a viscoelastic "
        "beam that is pressed against an obstacle",
    .hint = "'beamrate help methods' lists schemes, solvers, rules, references, norms and formats.",
    .commands = commands,
    .example = {"orders errors.csv", "orders errors.csv --expect 'l2: h 2 +- 0.1'", "run example3",
                "study example2 --norm l2,energy,tip",
                "tables --n 100,200,400 --k 0.01,0.005 --reference fine:1600,1e-3",
                "scenes --new my_scene.yaml"},
    .beam = &br_beam,
};

int main(int argc, const char **argv)
{
    return br_run_program(argc, argv);
}
