/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "plots/render.h"

extern char **environ;

static bool (*stops)(void);

void br_gnuplot_stop_when(bool (*stop)(void))
{
    stops = stop;
}

/* In a process group of its own, so that it can be ended with all that it has started. */
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

/* Starts gnuplot without a shell; what it says goes to `saying`. Returns an errno. */
static int start(const char *folder, const char *script, int saying, pid_t *child)
{
    char copy[BR_SCRIPT_NAME], gnuplot[] = "gnuplot", defaults[] = "--default-settings";
    if (strlen(script) >= sizeof copy)
        return ENAMETOOLONG;
    strcpy(copy, script);
    char *const words[] = {gnuplot, defaults, copy, NULL};
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
        failure = start_group(child, &actions, words);
    posix_spawn_file_actions_destroy(&actions);
    return failure;
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

/* How whole pictures end, but for white space. A WebP says its length at the start instead. */
static const struct {
    const char *extension, *ending;
} endings[] = {{".svg", "</svg>"},
               {".png", "IEND\xae\x42\x60\x82"},
               {".pdf", "%%EOF"},
               {".gif", ";"},
               {".webp", ""}};

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

/* gnuplot does not look whether its files were written. */
enum br_status br_picture_check(const char *path, struct br_error *err)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; i < sizeof endings / sizeof *endings && dot; i++)
        if (strcmp(dot, endings[i].extension) == 0 && ends_with(path, endings[i].ending))
            return BR_OK;
    return br_fail(err, BR_IO, "gnuplot wrote no complete %.900s; the disk may be full", path);
}

/* The i-th picture of a script; false: there are no more. */
static bool picture(const char *folder, const char *script, size_t i, char *path, size_t size)
{
    static const char *const extensions[] = {"svg", "png", "pdf"};
    const char *dot = strrchr(script, '.');
    const int stem = (int)(dot ? (size_t)(dot - script) : strlen(script));
    if (i < sizeof extensions / sizeof *extensions)
        snprintf(path, size, "%s/%.*s.%s", folder, stem, script, extensions[i]);
    return i < sizeof extensions / sizeof *extensions;
}

enum { PATH = 4096 + BR_SCRIPT_NAME + 8 };

/* A script draws no PDF where gnuplot has no terminal for it; where it has one, gnuplot itself
 * fails if it cannot make the file. */
static bool is_missing_pdf(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcmp(dot, ".pdf") == 0 && access(path, F_OK) != 0;
}

static enum br_status check_pictures(const char *folder, const char *script, struct br_error *err)
{
    char path[PATH];
    enum br_status status = BR_OK;
    for (size_t i = 0; !status && picture(folder, script, i, path, sizeof path); i++)
        if (!is_missing_pdf(path))
            status = br_picture_check(path, err);
    return status;
}

/* Half a picture is none. */
static void remove_pictures(const struct br_rendering *r)
{
    char path[PATH];
    for (size_t i = 0; picture(r->folder, r->script, i, path, sizeof path); i++)
        unlink(path);
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* How long gnuplot may take for one script, s. */
static double time_limit(void)
{
    const char *text = getenv("BEAMRATE_GNUPLOT_SECONDS");
    const double seconds = text ? strtod(text, NULL) : 0;
    return seconds > 0 ? seconds : 60;
}

/* Starts gnuplot on a script. */
static enum br_status begin(struct br_rendering *r, bool *missing, struct br_error *err)
{
    int ends[2];
    struct stat there;
    if (stat(r->folder, &there) != 0) /* else a missing folder looks like a missing gnuplot */
        return br_fail(err, BR_IO, "%s: %s", r->folder, strerror(errno));
    if (pipe2(ends, O_CLOEXEC) != 0 || fcntl(ends[0], F_SETFL, O_NONBLOCK) != 0)
        return br_fail(err, BR_IO, "no pipe for gnuplot: %s", strerror(errno));
    const int failure = start(r->folder, r->script, ends[1], &r->child);
    close(ends[1]);
    r->said = ends[0];
    r->started = now();
    if (!failure)
        return BR_OK;
    close(ends[0]);
    *missing = failure == ENOENT || failure == ENOTDIR; /* PATH may name what is no folder */
    return br_fail(err, BR_IO, "gnuplot cannot be run: %s",
                   *missing ? "it is not installed" : strerror(failure));
}

/* What gnuplot says: the beginning of it. */
struct saying {
    char text[4096];
    size_t length;
};

/* Reads on; whether there may be more to come. */
static bool listen_on(const struct br_rendering *r, struct saying *said)
{
    char piece[1024];
    const ssize_t got = read(r->said, piece, sizeof piece);
    if (got <= 0)
        return got < 0 && (errno == EINTR || errno == EAGAIN);
    const size_t room = sizeof said->text - 1 - said->length;
    const size_t kept = (size_t)got < room ? (size_t)got : room;
    memcpy(said->text + said->length, piece, kept);
    said->length += kept;
    return true;
}

static enum br_status check_time(const struct br_rendering *r, struct br_error *err)
{
    if (stops && stops())
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (now() - r->started < time_limit())
        return BR_OK;
    return br_fail(err, BR_IO, "gnuplot did not end on %s within %g s (BEAMRATE_GNUPLOT_SECONDS)",
                   r->script, time_limit());
}

/* Waits for its end, or makes it. */
static enum br_status wait_for(const struct br_rendering *r, struct br_error *err)
{
    enum { SOON = 50, AT_ONCE = 2 }; /* ms */
    struct saying said = {.length = 0};
    enum br_status status = BR_OK;
    int ending = 0;
    bool open = true;
    for (pid_t ended = 0; ended == 0 || (ended < 0 && errno == EINTR);) {
        struct pollfd pipe = {.fd = open ? r->said : -1, .events = POLLIN};
        if (!status && (status = check_time(r, err)))
            kill(-r->child, SIGKILL);
        if (poll(&pipe, 1, open ? SOON : AT_ONCE) > 0)
            open = listen_on(r, &said);
        ended = waitpid(r->child, &ending, WNOHANG);
    }
    while (open && (open = listen_on(r, &said) && errno != EAGAIN))
        ;
    close(r->said);
    if (!status && !(WIFEXITED(ending) && WEXITSTATUS(ending) == 0))
        status = br_fail(err, BR_IO, "gnuplot failed on %s: %s", r->script, reason(said.text));
    return status;
}

/* The same, and its pictures must be whole. */
static enum br_status end(const struct br_rendering *r, struct br_error *err)
{
    enum br_status status = wait_for(r, err);
    if (!status)
        status = check_pictures(r->folder, r->script, err);
    if (status)
        remove_pictures(r);
    return status;
}

/* Starts gnuplot on a script whose name has room. */
static enum br_status begin_named(struct br_rendering *r, const char *folder, const char *script,
                                  bool *missing, struct br_error *err)
{
    const int folder_length = snprintf(r->folder, sizeof r->folder, "%s", folder);
    const int script_length = snprintf(r->script, sizeof r->script, "%s", script);
    if ((size_t)folder_length >= sizeof r->folder || (size_t)script_length >= sizeof r->script)
        return br_fail(err, BR_IO, "gnuplot cannot be run: %s", strerror(ENAMETOOLONG));
    return begin(r, missing, err);
}

enum br_status br_gnuplot_run(const char *folder, const char *script, bool *missing,
                              struct br_error *err)
{
    struct br_rendering r = {0};
    *missing = false;
    const enum br_status status = begin_named(&r, folder, script, missing, err);
    return status ? status : wait_for(&r, err);
}

enum br_status br_renderer_end_oldest(struct br_renderer *r, struct br_error *err)
{
    const enum br_status status = end(&r->at_work[0], err);
    memmove(r->at_work, r->at_work + 1, --r->count * sizeof *r->at_work);
    return status;
}

enum br_status br_renderer_add(struct br_renderer *r, const char *folder, const char *script,
                               bool *missing, struct br_error *err)
{
    *missing = false;
    if (r->count == BR_MOST_RENDERINGS) {
        const enum br_status status = br_renderer_end_oldest(r, err);
        if (status)
            return status;
    }
    const enum br_status status = begin_named(&r->at_work[r->count], folder, script, missing, err);
    r->count += status == BR_OK;
    return status;
}

enum br_status br_renderer_finish(struct br_renderer *r, struct br_error *err)
{
    enum br_status status = BR_OK;
    while (r->count) {
        struct br_error failure = {0};
        if (br_renderer_end_oldest(r, &failure) && !status)
            status = br_fail(err, failure.status, "%s", failure.message);
    }
    return status;
}

enum br_status br_plot_render(const char *folder, const char *script, bool *missing,
                              struct br_error *err)
{
    struct br_renderer renderer = {0};
    const enum br_status status = br_renderer_add(&renderer, folder, script, missing, err);
    return status ? status : br_renderer_finish(&renderer, err);
}
