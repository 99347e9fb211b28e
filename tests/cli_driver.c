/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli_driver.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support.h"

static char folder[] = "/tmp/beamrate cli XXXXXX";

const char *cli_folder(void)
{
    return folder;
}

static void become_program(const char *const *word, const struct cli_circumstances *c, int output)
{
    if (chdir(folder) != 0)
        _exit(120);
    dup2(output, STDOUT_FILENO);
    const int errors =
        c->errors ? open(c->errors, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600) : output;
    if (errors < 0 || dup2(errors, STDERR_FILENO) < 0)
        _exit(122);
    const char *program = getenv("BEAMRATE");
    if (c->data)
        setenv("BEAMRATE_DATA", c->data, 1);
    if (c->path)
        setenv("PATH", c->path, 1);
    if (c->file_size)
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){c->file_size, c->file_size});
    const char *argv[CLI_MOST_WORDS + 2] = {program};
    for (int i = 0; i < CLI_MOST_WORDS && word[i]; i++)
        argv[i + 1] = word[i];
    execv(program, (char *const *)argv);
    _exit(121);
}

/* Whether the program catches SIGINT already, or has ended. */
static bool catches_signals(pid_t child)
{
    char path[64], line[256];
    unsigned long long caught;
    bool caught_or_ended = false;
    snprintf(path, sizeof path, "/proc/%d/status", (int)child);
    FILE *status = fopen(path, "r");
    if (!status)
        return true; /* this system has no such file */
    while (fgets(line, sizeof line, status)) {
        caught_or_ended = caught_or_ended || strncmp(line, "State:\tZ", 8) == 0;
        if (sscanf(line, "SigCgt: %llx", &caught) == 1)
            caught_or_ended = caught_or_ended || (caught >> (SIGINT - 1) & 1);
    }
    fclose(status);
    return caught_or_ended;
}

static void interrupt(pid_t child, int after)
{
    while (!catches_signals(child))
        usleep(1000);
    usleep((useconds_t)after * 1000);
    kill(child, SIGINT);
}

/* Runs `beamrate word...` (in, NULL-terminated). */
void cli_run(const char *const *word, const struct cli_circumstances *c, struct cli_outcome *out)
{
    static const struct cli_circumstances usual;
    int ends[2];
    assert_non_null(getenv("BEAMRATE"));
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        become_program(word, c ? c : &usual, ends[1]);
    close(ends[1]);
    if (c && c->interrupt_after)
        interrupt(child, c->interrupt_after);
    size_t used = 0;
    for (ssize_t got; (got = read(ends[0], out->output + used, CLI_MOST_OUTPUT - 1 - used)) > 0;)
        used += (size_t)got;
    out->output[used] = '\0';
    close(ends[0]);
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    out->exit_code = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

/* Splits at single blanks; a word of '' is empty. */
static void split(char *text, const char *word[CLI_MOST_WORDS + 1])
{
    int count = 0;
    for (char *w = strtok(text, " "); w && count < CLI_MOST_WORDS; w = strtok(NULL, " "))
        word[count++] = strcmp(w, "''") == 0 ? "" : w;
    word[count] = NULL;
}

void cli_run_line(const char *line, const struct cli_circumstances *c, struct cli_outcome *out)
{
    char text[512];
    const char *word[CLI_MOST_WORDS + 1];
    assert_true(strlen(line) < sizeof text);
    strcpy(text, line);
    split(text, word);
    cli_run(word, c, out);
}

void cli_expect(const char *line, const struct cli_circumstances *c, int exit_code,
                const char *message)
{
    static struct cli_outcome out;
    cli_run_line(line, c, &out);
    if (out.exit_code != exit_code || !strstr(out.output, message))
        fail_msg("beamrate %s: exit code %d, expected %d with '%s'; it said:\n%s", line,
                 out.exit_code, exit_code, message, out.output);
}

void cli_path(const char *name, char path[512])
{
    snprintf(path, 512, "%s/%s", folder, name);
}

bool cli_is_there(const char *name)
{
    char path[512];
    struct stat info;
    cli_path(name, path);
    return stat(path, &info) == 0;
}

/* Files in a folder below the working one: hidden ones too, but not the list of sets, nor the
 * folder of cached work. */
size_t cli_count_files(const char *name)
{
    char path[512];
    cli_path(name, path);
    DIR *d = opendir(path);
    if (!d)
        return 0;
    size_t count = 0;
    for (struct dirent *e; (e = readdir(d));)
        count += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0 &&
                 strcmp(e->d_name, ".cache") != 0 && strcmp(e->d_name, ".beamrate-set") != 0;
    closedir(d);
    return count;
}

void cli_write_file(const char *name, const char *text)
{
    char path[512];
    cli_path(name, path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

const char *cli_read(const char *name)
{
    static char contents[1 << 18];
    char path[512];
    cli_path(name, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    contents[fread(contents, 1, sizeof contents - 1, file)] = '\0';
    fclose(file);
    return contents;
}

int cli_make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

int cli_remove_folder(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command);
}
