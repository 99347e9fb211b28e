/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beamrate scenes: lists or shows the bundled scenes, and writes a template. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/quote.h"
#include "cli/command.h"
#include "cli/output.h"
#include "study/ranks/ranks.h"
#include "study/scene/file.h"
#include "tables/beam/reports.h"

/* ---- the list ---- */

static enum br_status print_line(const char *name, size_t width, struct br_error *err)
{
    char path[1024];
    struct br_scene scene = {0};
    const bool failed =
        br_scene_find(name, path, sizeof path, err) || br_scene_read(path, &scene, err);
    if (!failed) {
        int left = (int)width + 2; /* columns of a terminal: characters, not bytes */
        char visible[4096];
        for (const char *c = br_quoted(visible, sizeof visible, &br_for_text, name); *c; c++)
            left -= ((unsigned char)*c & 0xc0) != 0x80;
        printf("%s%*s", visible, left, "");
        br_print(stdout, &br_for_text, "%s\n", scene.title);
    }
    br_scene_clear(&scene);
    return failed ? err->status : BR_OK;
}

static enum br_status list(struct br_error *err)
{
    char **name;
    size_t count, width = 0;
    enum br_status status = br_scene_list(&name, &count, err);
    for (size_t i = 0; i < count; i++)
        width = strlen(name[i]) > width ? strlen(name[i]) : width;
    for (size_t i = 0; i < count && !status; i++)
        status = print_line(name[i], width, err);
    br_scene_list_free(name, count);
    return status;
}

/* ---- one scene ---- */

/* Prints the file to the byte; on a terminal, control characters are escaped. */
static enum br_status show(const char *name, struct br_error *err)
{
    char path[1024], *text;
    if (br_scene_find(name, path, sizeof path, err) || br_scene_load(path, &text, err))
        return err->status;
    if (!isatty(STDOUT_FILENO))
        fputs(text, stdout);
    else
        for (char *rest = text; rest && *rest;)
            br_print(stdout, &br_for_text, "%s\n", strsep(&rest, "\n"));
    free(text);
    return BR_OK;
}

/* ---- a new one ---- */

static enum br_status begin(const char *path, struct br_error *err)
{
    if (strcmp(path, "-") != 0 && access(path, F_OK) == 0)
        return br_fail(err, BR_BAD_INPUT, "--new: %s exists already and is not replaced", path);
    char shown[1024];
    struct br_whole_file file = {0};
    enum br_status status = br_whole_file_open(&file, "new", path, err);
    if (!status) {
        br_scene_template_write(file.file);
        status = br_whole_file_commit(&file, err);
    }
    br_whole_file_discard(&file);
    const bool is_file = !status && strcmp(path, "-") != 0;
    if (is_file)
        printf("This scene has every key. Edit it, and then march it: beamrate run %s\n",
               br_quoted(shown, sizeof shown, &br_for_shell, path));
    return status;
}

static enum br_status run(const struct br_options *o, struct br_session *session,
                          struct br_error *err)
{
    (void)session;
    const char *file = br_option_text(o, BR_OPT_NEW);
    if (file && o->words)
        return br_fail(err, BR_BAD_INPUT, "expected one of: a scene, --new");
    if (!br_ranks_first())
        return BR_OK;
    return file ? begin(file, err) : o->words ? show(o->word[0], err) : list(err);
}

const struct br_command br_command_scenes = {
    .bit = BR_FOR_SCENES,
    .name = "scenes",
    .arguments = "[SCENE]",
    .title = "lists the bundled scenes, shows one, begins a new one",
    .about = "Lists the bundled scenes, a line each; shows one; or begins a new one.",
    .example = {"scenes", "scenes example2", "scenes --new my_scene.yaml"},
    .most_words = 1,
    .run = run,
};
