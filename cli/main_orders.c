/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program beamrate-orders: the orders of anybody's numbers alone. */
#include "cli/check.h"
#include "cli/command.h"
#include "cli/trade.h"

static enum br_status check(const struct br_options *options, struct br_session *session,
                            struct br_error *err)
{
    if (options->words == 0)
        return br_fail(err, BR_BAD_INPUT, "no study file is given");
    return br_check_sources(options, session, options->word, options->words, true, NULL, err);
}

static const struct br_command br_command_check = {
    .bit = BR_FOR_CHECK,
    .name = "check",
    .arguments = "STUDY...",
    .title = "a verdict for CI: are the orders as expected?",
    .about =
        "Checks that the numbers of study files converge as their 'verify' parts expect. An order "
        "has the verdict PASS if its 95 % interval lies within the band, FAIL if its 99 % interval "
        "lies outside, and else INCONCLUSIVE. Exit code 0: all orders pass; 1: some do not; 3: "
        "they pass, but a run of a program has failed.",
    .example = {"check study.yaml --junit orders.xml --markdown summary.md"},
    .most_words = BR_MOST_WORDS,
    .run = check,
};

static enum br_status trade(const struct br_options *options, struct br_session *session,
                            struct br_error *err)
{
    if (options->words == 0)
        return br_fail(err, BR_BAD_INPUT, "no program is given, expected study files or tables");
    return br_trade_sources(options, session, NULL, 0, err);
}

static const struct br_command br_command_trade = {
    .bit = BR_FOR_TRADE,
    .name = "trade",
    .arguments = "PROGRAM...",
    .title = "what a digit costs: errors against costs of several programs",
    .about = BR_TRADE_ABOUT,
    .example = {"trade fd.csv sparse4.csv", "trade fd.yaml p1.yaml p2.yaml --trust --out trade"},
    .most_words = BR_MOST_WORDS,
    .run = trade,
};

extern const struct br_command br_command_help, br_command_orders;

static const struct br_command *const commands[] = {
    &br_command_orders, &br_command_check, &br_command_trade, &br_command_help, NULL,
};

static const char *const of_beamrate[] = {"run",      "study",  "tables",      "figures",
                                          "extremes", "scenes", "completions", NULL};

const struct br_program br_program = {
    .name = "beamrate-orders",
    .about = "observed orders of convergence, with their intervals and verdicts",
    .hint = "The program beamrate has these commands, too, and marches a beam.",
    .commands = commands,
    .example = {"orders errors.csv", "orders errors.csv --expect 'l2: h 2 +- 0.1'",
                "check study.yaml"},
    .of_beamrate = of_beamrate,
};

int main(int argc, const char **argv)
{
    return br_run_program(argc, argv);
}
