/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/observer.h"
#include "plots/pictures.h"

extern char **environ;

/* Starts a program in its own process group, so that its child processes can be ended, too. */
static int start_group(pid_t *child, const posix_spawn_file_actions_t *actions, char *const words[])
{
    posix_spawnattr_t attributes;
    int failure = posix_spawnattr_init(&attributes);
    if (failure)
        return failure;
    failure = posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    if (!failure)
        failure = posix_spawnp(child, words[0], actions, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    return failure;
}

/* Starts gnuplot without a shell. It reads nothing, and its output goes to g->said. Returns an
 * errno. */
static int spawn(struct br_gnuplot *g, char *const words[])
{
    posix_spawn_file_actions_t actions;
    int failure = posix_spawn_file_actions_init(&actions);
    if (failure)
        return failure;
    failure = posix_spawn_file_actions_addchdir_np(&actions, g->folder);
    if (!failure)
        failure = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    for (int end = 1; end <= 2 && !failure; end++)
        failure = posix_spawn_file_actions_adddup2(&actions, fileno(g->said), end);
    if (!failure)
        failure = start_group(&g->child, &actions, words);
    posix_spawn_file_actions_destroy(&actions);
    return failure;
}

/* Finds the reason in gnuplot's output: gnuplot repeats the command first; the line with the reason
 * begins with the script's name in quotes. */
static const char *reason(char *text)
{
    char *why = NULL, *rest;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        if (*line == '"')
            return line;
        if (!why)
            why = line;
    }
    return why ? why : "it gives no reason";
}

/* Extensions of pictures, and the last bytes of whole ones, without white space. */
static const struct {
    const char *extension, *ending;
} pictures[] = {{"svg", "</svg>"}, {"png", "IEND\xae\x42\x60\x82"}, {"pdf", "%%EOF"}};
enum { PICTURES = sizeof pictures / sizeof *pictures, PDF = 2 };

static bool ends_with(const char *path, const char *ending)
{
    char tail[32];
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    size_t got = 0;
    if (fseek(file, -(long)sizeof tail, SEEK_END) == 0)
        got = fread(tail, 1, sizeof tail, file);
    fclose(file);
    while (got > 0 && isspace((unsigned char)tail[got - 1]))
        got--;
    const size_t size = strlen(ending);
    return got > 0 && got >= size && memcmp(tail + got - size, ending, size) == 0;
}

/* How long gnuplot may take for one script, s. */
static double time_limit(void)
{
    const char *text = getenv("BEAMRATE_GNUPLOT_SECONDS");
    const double seconds = text ? strtod(text, NULL) : 0;
    return seconds > 0 ? seconds : 60;
}

enum br_status br_gnuplot_start(struct br_gnuplot *g, const char *folder, const char *script,
                                bool *missing, struct br_error *err)
{
    static char gnuplot[] = "gnuplot", defaults[] = "--default-settings";
    *g = (struct br_gnuplot){.child = 0};
    char *const words[] = {gnuplot, defaults, g->script, NULL};
    const int folder_length = snprintf(g->folder, sizeof g->folder, "%s", folder);
    const int script_length = snprintf(g->script, sizeof g->script, "%s", script);
    struct stat there;
    *missing = false;
    if ((size_t)folder_length >= sizeof g->folder || (size_t)script_length >= sizeof g->script)
        return br_fail(err, BR_IO, "gnuplot cannot be run: %s", strerror(ENAMETOOLONG));
    if (stat(g->folder, &there) != 0) /* else a missing folder seems a missing program */
        return br_fail(err, BR_IO, "%s: %s", g->folder, strerror(errno));
    g->said = tmpfile();
    if (!g->said)
        return br_fail(err, BR_IO, "no file for what gnuplot says: %s", strerror(errno));
    const int failure = spawn(g, words);
    g->started = br_seconds();
    if (!failure)
        return BR_OK;
    fclose(g->said);
    *missing = failure == ENOENT || failure == ENOTDIR; /* PATH may name a file as a folder */
    return br_fail(err, BR_IO, "gnuplot cannot be run: %s",
                   *missing ? "it is not installed" : strerror(failure));
}

static enum br_status check_time(const struct br_gnuplot *g, struct br_error *err)
{
    if (br_must_stop())
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (br_seconds() - g->started < time_limit())
        return BR_OK;
    return br_fail(err, BR_IO, "gnuplot did not end on %s within %g s (BEAMRATE_GNUPLOT_SECONDS)",
                   g->script, time_limit());
}

static enum br_status end_program(struct br_gnuplot *g, struct br_error *err)
{
    static const struct timespec soon = {.tv_nsec = 5000000};
    enum br_status status = BR_OK;
    int ending = 0;
    char text[4096] = "";
    for (pid_t ended = 0; ended == 0 || (ended < 0 && errno == EINTR);) {
        ended = waitpid(g->child, &ending, WNOHANG);
        if (ended == 0 && !status && (status = check_time(g, err)))
            kill(-g->child, SIGKILL);
        if (ended == 0)
            nanosleep(&soon, NULL);
    }
    rewind(g->said);
    text[fread(text, 1, sizeof text - 1, g->said)] = '\0';
    fclose(g->said);
    if (status || (WIFEXITED(ending) && WEXITSTATUS(ending) == 0))
        return status;
    return br_fail(err, BR_IO, "gnuplot failed on %s: %s", g->script, reason(text));
}

/* The PDF may be missing: without a terminal for PDF gnuplot draws none; with one, it fails if it
 * cannot make the file. */
enum br_status br_gnuplot_end(struct br_gnuplot *g, struct br_error *err)
{
    char path[PICTURES][sizeof g->folder + sizeof g->script];
    const int stem = (int)(strrchr(g->script, '.') - g->script);
    enum br_status status = end_program(g, err);
    for (size_t i = 0; i < PICTURES; i++) {
        snprintf(path[i], sizeof path[i], "%s/%.*s.%s", g->folder, stem, g->script,
                 pictures[i].extension);
        if (!status && (i != PDF || access(path[i], F_OK) == 0) &&
            !ends_with(path[i], pictures[i].ending))
            status = br_fail(err, BR_IO, "no complete %.900s was written; the disk may be full",
                             path[i]);
    }
    for (size_t i = 0; i < PICTURES && status; i++)
        unlink(path[i]);
    return status;
}
