/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/load.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/observer.h"
#include "base/quote.h"

static enum br_status fail_with_errno(const char *path, struct br_error *err)
{
    const int why = errno;
    char suggestion[BR_SUGGESTION] = "";
    if (!*path)
        return br_fail(err, BR_BAD_INPUT, "found '', expected a file's name");
    if (why == ENOENT)
        br_suggest_file(path, suggestion);
    return br_fail(err, br_status_of_errno(why), "%s: %s%s", path, strerror(why), suggestion);
}

char *br_suggest_file(const char *path, char text[BR_SUGGESTION])
{
    enum { MOST = 4096 }; /* of the files of a folder */
    char folder[1024];
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(name - path) : 1, slash ? path : ".");
    struct dirent **entry = NULL;
    const char **names = NULL;
    const int found = scandir(folder, &entry, NULL, alphasort);
    const size_t count = found > 0 && found <= MOST ? (size_t)found : 0;
    *text = '\0';
    if (count && (names = br_allocate(count, sizeof *names))) {
        for (size_t i = 0; i < count; i++)
            names[i] = entry[i]->d_name;
        br_suggestion(name, names, count, text);
    }
    for (int i = 0; i < found; i++)
        free(entry[i]);
    free(entry);
    free(names);
    return text;
}

/* Waits for bytes or for the end, however long a writer takes, but not for ever for a writer. A
 * signal that came before poll does not interrupt it. */
static enum br_status wait_for(const char *path, int file, bool writer, struct br_error *err)
{
    enum { PATIENCE = 5 /* s */, PARTS = 10 /* of a second */ };
    struct pollfd wanted = {.fd = file, .events = POLLIN};
    int ready = 0;
    for (int i = 0; !ready && (writer || i < PARTS * PATIENCE); i++) {
        if (br_must_stop())
            return br_fail(err, BR_INTERRUPTED, "interrupted");
        ready = poll(&wanted, 1, 1000 / PARTS);
    }
    if (ready < 0)
        return fail_with_errno(path, err);
    return ready ? BR_OK
                 : br_fail(err, BR_BAD_INPUT, "%s: nothing was written to this pipe within %d s",
                           path, PATIENCE);
}

/* Reads the stream once, to its end: a pipe cannot be read again. A named pipe has an end where it
 * has no writer: before its first one, too. */
static enum br_status read_all(const char *path, int file, size_t longest, const char *what,
                               char *text, struct br_error *err)
{
    struct stat info;
    size_t length = 0;
    bool writer = fstat(file, &info) != 0 || !S_ISFIFO(info.st_mode) || file == STDIN_FILENO;
    for (ssize_t got = 1; length <= longest;) {
        got = read(file, text + length, longest + 1 - length);
        length += got > 0 ? (size_t)got : 0;
        if (got < 0 && errno != EAGAIN)
            return fail_with_errno(path, err);
        if (got == 0 && writer)
            break;
        writer |= got != 0;
        if (got <= 0 && wait_for(path, file, writer, err))
            return err->status;
        writer = true;
    }
    if (length > longest)
        return br_fail(err, BR_BAD_INPUT, "%s: found more than %zu bytes, expected a %s", path,
                       longest, what);
    const char *bad = br_not_utf8(text), *zero = memchr(text, 0, length);
    size_t line = 1;
    bad = bad ? bad : zero;
    for (const char *c = text; bad && c < bad; c++)
        line += *c == '\n';
    return bad ? br_fail(err, BR_BAD_INPUT,
                         "%s:%zu: found the byte 0x%02x (byte %td of the file), expected text in "
                         "UTF-8",
                         path, line, (unsigned char)*bad, bad - text + 1)
               : BR_OK;
}

enum br_status br_text_load(const char *path, size_t longest, const char *what, char **text,
                            struct br_error *err)
{
    const bool standard = strcmp(path, BR_STANDARD_INPUT) == 0;
    *text = NULL;
    const int file = standard ? STDIN_FILENO : open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return fail_with_errno(path, err);
    *text = br_allocate(longest + 2, 1); /* memory that is not written is not used */
    enum br_status status =
        *text ? read_all(path, file, longest, what, *text, err) : br_no_memory(err, "a file");
    if (!standard)
        close(file);
    if (status) {
        free(*text);
        *text = NULL;
    }
    return status;
}
