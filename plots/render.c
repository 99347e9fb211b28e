/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plots/plots.h"

extern char **environ;

/* Starts gnuplot without a shell; what it says goes to `saying`. Returns an errno. */
static int start(const char *folder, const char *script, int saying, pid_t *child)
{
    char copy[4096], gnuplot[] = "gnuplot", defaults[] = "--default-settings";
    if (strlen(script) >= sizeof copy)
        return ENAMETOOLONG;
    strcpy(copy, script);
    char *const arguments[] = {gnuplot, defaults, copy, NULL};
    posix_spawn_file_actions_t actions;
    int failure = posix_spawn_file_actions_init(&actions);
    if (failure)
        return failure;
    failure = posix_spawn_file_actions_addchdir_np(&actions, folder);
    if (!failure)
        failure = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    if (!failure)
        failure = posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    if (!failure)
        failure = posix_spawn_file_actions_adddup2(&actions, saying, 2);
    if (!failure)
        failure = posix_spawnp(child, gnuplot, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failure;
}

/* Reads to the end, and keeps the beginning. */
static void read_all(int from, char *text, size_t size)
{
    char rest[1024];
    size_t length = 0;
    for (;;) {
        const bool full = length + 1 >= size;
        const ssize_t got = full ? read(from, rest, sizeof rest)
                                 : read(from, text + length, size - 1 - length);
        if (got == 0 || (got < 0 && errno != EINTR))
            break;
        if (got > 0 && !full)
            length += (size_t)got;
    }
    text[length] = '\0';
}

/* gnuplot repeats the command first; the line that says why begins with the script's
 * name in quotes. */
static const char *reason(char *text)
{
    char *why = NULL, *rest;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        if (*line == '"')
            return line;
        if (!why)
            why = line;
    }
    return why ? why : "it does not say why";
}

static bool ends_with(const char *folder, const char *script, const char *extension,
                      const char *ending)
{
    char path[4096], tail[16];
    const char *dot = strrchr(script, '.');
    const int stem = (int)(dot ? (size_t)(dot - script) : strlen(script));
    const int length = snprintf(path, sizeof path, "%s/%.*s.%s", folder, stem, script, extension);
    FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "rb") : NULL;
    if (!file)
        return false;
    const size_t size = strlen(ending);
    const bool same = fseek(file, -(long)size, SEEK_END) == 0 &&
                      fread(tail, 1, size, file) == size && memcmp(tail, ending, size) == 0;
    fclose(file);
    return same;
}

/* gnuplot does not look whether its files were written. */
static enum br_status check_pictures(const char *folder, const char *script,
                                     struct br_error *err)
{
    if (!ends_with(folder, script, "svg", "</svg>\n\n"))
        return br_fail(err, BR_IO, "%s/%s: the SVG is not complete; the disk may be full", folder,
                       script);
    if (!ends_with(folder, script, "png", "IEND\xae\x42\x60\x82"))
        return br_fail(err, BR_IO, "%s/%s: the PNG is not complete; the disk may be full", folder,
                       script);
    return BR_OK;
}

enum br_status br_plot_render(const char *folder, const char *script, bool *missing,
                              struct br_error *err)
{
    char said[4096];
    int ends[2], ending = 0;
    pid_t child;
    struct stat there;
    *missing = false;
    if (stat(folder, &there) != 0)
        return br_fail(err, BR_IO, "%s: %s", folder, strerror(errno));
    if (pipe2(ends, O_CLOEXEC) != 0)
        return br_fail(err, BR_IO, "no pipe for gnuplot: %s", strerror(errno));
    const int failure = start(folder, script, ends[1], &child);
    close(ends[1]);
    if (!failure)
        read_all(ends[0], said, sizeof said);
    close(ends[0]);
    *missing = failure == ENOENT;
    if (failure)
        return br_fail(err, BR_IO, "gnuplot cannot be run: %s",
                       *missing ? "it is not installed" : strerror(failure));
    while (waitpid(child, &ending, 0) < 0 && errno == EINTR)
        ;
    if (!(WIFEXITED(ending) && WEXITSTATUS(ending) == 0))
        return br_fail(err, BR_IO, "gnuplot failed in %s: %s", folder, reason(said));
    return check_pictures(folder, script, err);
}
