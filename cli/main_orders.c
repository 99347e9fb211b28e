/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program beamrate-orders: the orders of anybody's numbers alone. */
#include "cli/command.h"

extern const struct br_command br_command_check, br_command_help, br_command_orders;

static const struct br_command *const commands[] = {
    &br_command_orders,
    &br_command_check,
    &br_command_help,
    NULL,
};

const struct br_program br_program = {
    .name = "beamrate-orders",
    .about = "observed orders of convergence, with their intervals and verdicts",
    .hint = "The program beamrate has these commands, too, and marches a beam.",
    .commands = commands,
    .example = {"beamrate-orders orders errors.csv",
                "beamrate-orders orders errors.csv --expect 'l2: h 2 +- 0.1'",
                "beamrate-orders check study.yaml"},
};

int main(int argc, const char **argv)
{
    return br_run_program(argc, argv);
}
