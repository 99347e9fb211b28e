/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/completion.h"
#include "study/scene/quote.h"

static void write_condition(FILE *out, const struct br_completion *one)
{
    fprintf(out, "complete -c beamrate -n '__fish_seen_subcommand_from %s'", one->command->name);
}

static void write_option(FILE *out, const struct br_completion *one,
                         const struct br_help_option *option)
{
    const char *words;
    const enum br_value_kind kind = br_option_values(option, &words);
    write_condition(out, one);
    fprintf(out, " -l %s", option->name);
    if (kind == BR_VALUE_FILE)
        fprintf(out, " -r -F");
    else if (kind == BR_VALUE_DIR)
        fprintf(out, " -x -a '(__fish_complete_directories)'");
    else if (kind == BR_VALUE_LIST)
        fprintf(out, " -x -a '(__fish_append , %s)'", words);
    else if (kind == BR_VALUE_WORD)
        fprintf(out, " -x -a '%s'", words);
    else if (*option->argument)
        fprintf(out, " -x");
    fprintf(out, " -d ");
    br_quote(out, &br_for_completion, option->help);
    fputc('\n', out);
}

static void write_arguments(FILE *out, const struct br_completion *one)
{
    if (one->scenes) {
        write_condition(out, one);
        fprintf(out, " -a '$__beamrate_scenes (__fish_complete_suffix .yaml)'\n");
    } else if (*one->words) {
        write_condition(out, one);
        fprintf(out, " -a '%s'\n", one->words);
    }
}

static void write_fish(FILE *out, const struct br_completions *all)
{
    fprintf(out,
            "# Completion of beamrate in fish; written by 'beamrate completions fish'.\n"
            "set -g __beamrate_scenes %s\n\ncomplete -c beamrate -f\n"
            "complete -c beamrate -n __fish_use_subcommand -l help -d 'lists the commands'\n"
            "complete -c beamrate -n __fish_use_subcommand -l version -d 'the version'\n",
            all->scenes);
    for (size_t i = 0; i < all->count; i++) {
        const struct br_completion *one = &all->command[i];
        fprintf(out, "\ncomplete -c beamrate -n __fish_use_subcommand -a %s -d ",
                one->command->name);
        br_quote(out, &br_for_completion, one->command->title);
        fputc('\n', out);
        write_arguments(out, one);
        for (size_t j = 0; j < one->help.count; j++)
            write_option(out, one, &one->help.option[j]);
    }
}

const struct br_shell br_fish = {"fish", write_fish};
