/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate completions SHELL: what makes a shell complete commands, options and their values. */
#include <string.h>

#include "cli/completion.h"
#include "cli/parse.h"
#include "study/scene/file.h"
#include "study/scene/quote.h"

const struct br_shell *const br_shells[] = {&br_bash, &br_zsh, &br_fish, NULL};

#define SHELLS "bash|zsh|fish"

static const char usage[] = SHELLS
    "\n\nPrints what makes a shell complete the commands, their options, values and scenes.\n\n"
    "Examples:\n  beamrate completions bash > beamrate.bash\n"
    "  beamrate completions zsh > _beamrate\n  beamrate completions fish > beamrate.fish\n";

static enum br_status read_shell(poptContext context, void *self, struct br_error *err)
{
    const struct br_shell **shell = self;
    const char *word = poptGetArg(context), *more = poptGetArg(context);
    for (size_t i = 0; word && br_shells[i]; i++)
        if (strcmp(br_shells[i]->name, word) == 0)
            *shell = br_shells[i];
    if (!*shell || more)
        return br_fail(err, BR_BAD_INPUT, "found '%s', expected one shell: " SHELLS,
                       more   ? more
                       : word ? word
                              : "");
    return BR_OK;
}

/* *shell (out): NULL where help was asked for. */
static enum br_status read_options(int argc, const char **argv, const struct br_shell **shell,
                                   struct br_error *err)
{
    const struct poptOption table[] = {BR_PARSE_HELP_ROW, POPT_TABLEEND};
    int help = 0;
    *shell = NULL;
    return br_parse(
        argc, argv,
        &(struct br_parse){
            .table = table, .usage = usage, .help = &help, .read_words = read_shell, .self = shell},
        err);
}

static enum br_status collect_scenes(char *text, size_t size, struct br_error *err)
{
    char **name;
    size_t count, used = 0;
    const enum br_status status = br_scene_list(&name, &count, err);
    text[0] = '\0';
    for (size_t i = 0; i < count && !status && used < size; i++)
        if (br_is_name(name[i]) && !strchr(name[i], ' ')) /* else no shell could complete it */
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", name[i]);
    br_scene_list_free(name, count);
    return status;
}

static enum br_status collect(struct br_completions *all, struct br_error *err)
{
    enum br_status status = collect_scenes(all->scenes, sizeof all->scenes, err);
    for (const struct br_command *const *c = br_commands;
         *c && all->count < BR_MOST_COMMANDS && !status; c++) {
        struct br_completion *one = &all->command[all->count++];
        one->command = *c;
        one->scenes = strstr((*c)->arguments, "SCENE") != NULL;
        one->many = strstr((*c)->arguments, "...") != NULL;
        br_argument_words((*c)->arguments, one->words, sizeof one->words);
        status = br_command_help_read(*c, &one->help, err);
    }
    return status;
}

static enum br_status run(int argc, const char **argv, struct br_error *err)
{
    static struct br_completions all;
    const struct br_shell *shell = NULL;
    enum br_status status = read_options(argc, argv, &shell, err);
    if (status || !shell)
        return status;
    all.count = 0;
    status = collect(&all, err);
    if (!status)
        shell->write(stdout, &all);
    return status;
}

const struct br_command br_command_completions = {
    .name = "completions",
    .arguments = SHELLS,
    .title = "makes a shell complete commands, options, values and scenes",
    .run = run,
};
