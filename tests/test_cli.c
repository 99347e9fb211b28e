/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program as a user meets it: exit codes, messages, files. $BEAMRATE is its path. */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "reference/judge.h"
#include "support.h"
#include "tables/emitter.h"

enum { MOST_OUTPUT = 1 << 16, MOST_WORDS = 24 };

static char folder[] = "/tmp/beamrate cli XXXXXX"; /* the working folder of every run */

/* How the program is run besides its words. */
struct circumstances {
    const char *path;    /* PATH; NULL: as it is */
    const char *data;    /* BEAMRATE_DATA; NULL: as it is */
    rlim_t file_size;    /* largest file, bytes; 0: any */
    int interrupt_after; /* ms; 0: never */
};

struct outcome {
    int exit_code;            /* or -signal */
    char output[MOST_OUTPUT]; /* standard output and error */
};

static void become_program(const char *const *word, const struct circumstances *c, int output)
{
    if (chdir(folder) != 0)
        _exit(120);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    const char *program = getenv("BEAMRATE");
    if (c->data)
        setenv("BEAMRATE_DATA", c->data, 1);
    if (c->path)
        setenv("PATH", c->path, 1);
    if (c->file_size)
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){c->file_size, c->file_size});
    const char *argv[MOST_WORDS + 2] = {program};
    for (int i = 0; i < MOST_WORDS && word[i]; i++)
        argv[i + 1] = word[i];
    execv(program, (char *const *)argv);
    _exit(121);
}

/* Runs `beamrate word...` (in, NULL-terminated). */
static void run(const char *const *word, const struct circumstances *c, struct outcome *out)
{
    static const struct circumstances usual;
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        become_program(word, c ? c : &usual, ends[1]);
    close(ends[1]);
    if (c && c->interrupt_after) {
        usleep((useconds_t)c->interrupt_after * 1000);
        kill(child, SIGINT);
    }
    size_t used = 0;
    for (ssize_t got; (got = read(ends[0], out->output + used, MOST_OUTPUT - 1 - used)) > 0;)
        used += (size_t)got;
    out->output[used] = '\0';
    close(ends[0]);
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    out->exit_code = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

/* Splits at single blanks; a word of '' is empty. */
static void split(char *text, const char *word[MOST_WORDS + 1])
{
    int count = 0;
    for (char *w = strtok(text, " "); w && count < MOST_WORDS; w = strtok(NULL, " "))
        word[count++] = strcmp(w, "''") == 0 ? "" : w;
    word[count] = NULL;
}

static void run_line(const char *line, const struct circumstances *c, struct outcome *out)
{
    char text[512];
    const char *word[MOST_WORDS + 1];
    snprintf(text, sizeof text, "%s", line);
    split(text, word);
    run(word, c, out);
}

static void expect(const char *line, const struct circumstances *c, int exit_code,
                   const char *message)
{
    static struct outcome out;
    run_line(line, c, &out);
    if (out.exit_code != exit_code || !strstr(out.output, message))
        fail_msg("beamrate %s: exit code %d, expected %d with '%s'; it said:\n%s", line,
                 out.exit_code, exit_code, message, out.output);
}

static void path_in_folder(const char *name, char path[512])
{
    snprintf(path, 512, "%s/%s", folder, name);
}

static bool is_there(const char *name)
{
    char path[512];
    struct stat info;
    path_in_folder(name, path);
    return stat(path, &info) == 0;
}

/* Files in a folder below the working one, hidden ones included. */
static size_t count_files(const char *name)
{
    char path[512];
    path_in_folder(name, path);
    DIR *d = opendir(path);
    if (!d)
        return 0;
    size_t count = 0;
    for (struct dirent *e; (e = readdir(d));)
        count += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    closedir(d);
    return count;
}

static void write_file(const char *name, const char *text)
{
    char path[512];
    path_in_folder(name, path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* The file without its timings: the column before the first flag. */
static char *read_without_seconds(const char *name)
{
    char path[512], line[1024];
    char *text = NULL;
    size_t size;
    path_in_folder(name, path);
    FILE *in = fopen(path, "r"), *out = open_memstream(&text, &size);
    assert_non_null(in);
    assert_non_null(out);
    while (fgets(line, sizeof line, in)) {
        int column = 0;
        for (const char *c = line; *c; c++) {
            column += *c == ',';
            if (column != 7)
                fputc(*c, out);
        }
    }
    fclose(in);
    fclose(out);
    return text;
}

#define SMALL "--n 5,10 --k 0.1,0.05 --quiet --no-plots"

static void test_bad_options(void **state)
{
    (void)state;
    static const struct {
        const char *line, *message;
    } rows[] = {
        {"", "Usage:"},
        {"frobnicate", "'frobnicate' is no command"},
        {"study", "no scene is given"},
        {"study nowhere", "scene 'nowhere' is no file and no bundled scene"},
        {"study example1 more", "found 'more', expected nothing more"},
        {"tables more", "found 'more'"},
        {"study example1 --bogus", "--bogus: unknown option"},
        {"study example1 --n", "--n: missing argument"},
        {"study example1 --n 0", "--n: found '0', expected positive numbers"},
        {"study example1 --n -3", "--n: found '-3'"},
        {"study example1 --n nan", "--n: found 'nan'"},
        {"study example1 --n inf", "--n: found 'inf'"},
        {"study example1 --n 2.5", "--n: found 2.5, expected whole numbers"},
        {"study example1 --n 1e12", "--n: found 1e+12, expected whole numbers from 1 to 1e9"},
        {"study example1 --n ''", "--n: found '', expected positive numbers"},
        {"study example1 --n 10,", "--n: found ''"},
        {"study example1 --n 10,10", "--n: 10 is given twice"},
        {"study example1 --k 0", "--k: found '0'"},
        {"study example1 --k 1e400", "--k: found '1e400'"},
        {"study example1 --k 0.1,0.1000000000001", "--k: 0.1 is given twice"},
        {"study example1 --k 2", "--k: k = 2 s is longer than the duration, 1 s"},
        {"study example1 --k 0.3", "the nearest that do are 0.3333333333 and 0.25"},
        {"study example1 --n 7 --k .1 --reference fine:100,.1",
         "n = 7 does not nest in the reference's 100 elements; the nearest that do are 5 and 10"},
        {"study example1 --n 10 --k .1 --reference fine:100,.04", "the nearest k that would do"},
        {"study example1 --reference fine", "expected fine:N,K"},
        {"study example1 --reference fine:100", "expected fine:N,K"},
        {"study example1 --reference fine:100,", "expected fine:N,K"},
        {"study example1 --reference fine:100,0.1x", "expected fine:N,K"},
        {"study example1 --reference fine:0,0.1", "expected fine:N,K"},
        {"study example1 --reference fine:100,0.3", "--reference: k = 0.3 s does not divide"},
        {"study example1 --reference exact:3", "expected one of: exact, fine:N,K, "},
        {"study example1 --norm l2,h1", "--norm: found 'h1', expected one of: l2, energy, tip"},
        {"study example1 --norm tip,l2,tip", "--norm: tip is given twice"},
        {"study example1 --norm ''", "--norm: found '', expected one of"},
        {"study example1 --norm l2,", "--norm: found '', expected one of"},
        {"study example1 --reference none --n 10,15", "n = 10 does not divide n = 15"},
        {"study example1 --reference none --k .01,.004", "not all among those of k = 0.004 s"},
        {"study example1 --reference none --n 10", "found 1 meshes and 4 time steps, expected"},
        {"study example1 --reference guess", "--reference: found 'guess'"},
        {"study example1 --solver lu", "--solver: found 'lu', expected one of: riccati, umfpack"},
        {"study example1 --contact soft", "expected one of: lagged, implicit"},
        {"study example1 --friction dry", "expected one of: exact, regularised"},
        {"study example1 --format pdf", "expected one of: text, csv, markdown, latex, json"},
        {"study example1 --scaling sum", "--scaling: solver riccati does not heed it"},
        {"study example1 --solver umfpack --scaling big", "expected one of: none, sum, max"},
        {"study example1 --refinement -1", "--refinement: found '-1'"},
        {"study example1 --threads -1", "--threads: found '-1'"},
        {"study example1 --threads x",
         "--threads: found 'x', expected a whole number from 0 to 4096"},
        {"study example1 --out /proc/nowhere/at/all " SMALL, "--out: cannot make the folder"},
        {"study example1 --out '' " SMALL, "--out: found ''"},
    };
    const size_t before = count_files(".");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        expect(rows[i].line, NULL, 2, rows[i].message);
    assert_int_equal(count_files("."), before); /* nothing was begun */
}

static void test_bad_scene(void **state)
{
    (void)state;
    write_file("bad.yaml", "title: x\nlength: 1 m\nduration: 1 s\ndensity: 1 kg\n");
    expect("study bad.yaml", NULL, 2,
           "bad.yaml:4: density: found '1 kg', expected a number and its "
           "unit, kg/m");
    write_file("bad.yaml", "title: x\nlength: 1 m\ncolour: red\n");
    expect("study bad.yaml", NULL, 2, "bad.yaml:3: colour: unknown key");
    char path[512];
    path_in_folder("bad.yaml", path);
    remove(path);
}

static void test_good_run(void **state)
{
    (void)state;
    expect("study example2 --out r " SMALL " --contact implicit --friction regularised", NULL, 0,
           "");
    static const char *const files[] = {"r/example2.txt", "r/example2.csv", "r/example2.md",
                                        "r/example2.tex", "r/example2.json"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        assert_true(is_there(files[i]));
    assert_int_equal(count_files("r"), 5);                /* no hidden folder is left */
    expect("study example2 --out r " SMALL, NULL, 0, ""); /* replaces them */
    assert_int_equal(count_files("r"), 5);
    expect("study example3 --out one --format csv " SMALL, NULL, 0, "");
    assert_int_equal(count_files("one"), 1);
}

static void test_tables(void **state)
{
    (void)state;
    expect("tables --n 5,10,20 --k 0.1,0.05,0.025 --reference fine:40,0.0125 --out t", NULL, 0,
           "Written to t/");
    static const char *const stems[] = {"t/table1", "t/table2"};
    static const char *const endings[] = {".csv",  ".md",   ".tex",        ".json", ".txt",
                                          "-h.gp", "-k.gp", "-printed.gp", "-h.dat"};
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; j < sizeof endings / sizeof *endings; j++) {
            char name[64];
            snprintf(name, sizeof name, "%s%s", stems[i], endings[j]);
            if (!is_there(name))
                fail_msg("%s is missing", name);
        }
}

/* One cell contradicts nothing, and the table does not say that it does. */
static void test_single_cell(void **state)
{
    (void)state;
    static struct outcome out;
    run_line("tables --n 100 --k 0.01 --reference fine:200,0.005 --no-plots --out single", NULL,
             &out);
    assert_int_equal(out.exit_code, 0);
    assert_non_null(strstr(out.output, "DIFFER"));
    assert_null(strstr(out.output, "No choice of reference"));
}

static void test_threads(void **state)
{
    (void)state;
    char *first = NULL;
    for (int threads = 1; threads <= 4; threads++) {
        char line[256];
        snprintf(line, sizeof line,
                 "tables --n 5,10,20 --k 0.1,0.05,0.01 --reference fine:40,0.01 --out threads "
                 "--quiet --no-plots --threads %d",
                 threads);
        expect(line, NULL, 0, "");
        char *text = read_without_seconds("threads/table2.csv");
        if (first)
            assert_string_equal(text, first);
        else
            first = strdup(text);
        free(text);
    }
    free(first);
}

static void test_failures(void **state)
{
    (void)state;
    /* a disk that is full: exit code 3, and nothing half-written */
    expect("study example1 --out full " SMALL, &(struct circumstances){.file_size = 2048}, 3,
           "could not be written whole");
    assert_int_equal(count_files("full"), 0);
    /* no gnuplot: the plots are written, but not drawn */
    expect("study example1 --out bare --n 5,10 --k 0.1,0.05 --quiet",
           &(struct circumstances){.path = "/nonexistent"}, 0, "gnuplot is not installed");
    assert_true(is_there("bare/example1-h.gp") && !is_there("bare/example1-h.png"));
    /* Ctrl-C: ends by the signal and leaves nothing */
    expect("tables --out stopped --quiet", &(struct circumstances){.interrupt_after = 700}, -SIGINT,
           "interrupted; nothing was written");
    assert_int_equal(count_files("stopped"), 0);
    /* a file where the folder should be */
    write_file("file", "");
    expect("study example1 --out file " SMALL, NULL, 2, "--out: cannot");
    /* a cell that blows up is marked, and told after all has been written */
    write_file("stiff.yaml", "title: stiff\nlength: 1 m\nduration: 1000 s\ndensity: 1 kg/m\n"
                             "axial:\n  stiffness: 1 N\n  viscosity: 0 N s\n  load: 1 [N/m]\n"
                             "contact:\n  gap: 0.1 m\n  stiffness: 1000 N/m\n");
    expect("study stiff.yaml --n 4 --k 1.25 --reference fine:4,0.01 --out s --quiet --no-plots",
           NULL, 3, "1 cells failed; the first is n = 4: the error at t");
    assert_true(is_there("s/stiff.csv"));
}

/* Every row of every registry is in the help. */
static bool file_contains(const char *name, const char *text)
{
    char path[512];
    path_in_folder(name, path);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    static char contents[1 << 18];
    contents[fread(contents, 1, sizeof contents - 1, file)] = '\0';
    fclose(file);
    return strstr(contents, text) != NULL;
}

/* A report for each norm, and without a reference for each direction. */
static void test_norms(void **state)
{
    (void)state;
    expect("study example2 --norm energy,l2 --n 5,10 --k 0.1,0.05 --format csv --no-plots --quiet "
           "--out norms",
           NULL, 0, "");
    assert_int_equal(count_files("norms"), 2);
    expect("study example2 --norm energy,tip --reference none --n 5,10,20 --k 0.1,0.05 "
           "--format text --no-plots --out none",
           NULL, 0, "Example 2, slip: differences of successive time steps");
    assert_int_equal(count_files("none"), 4);
    assert_true(file_contains("none/example2-tip-meshes.txt", "Error at the tip"));
    assert_true(file_contains("none/example2-energy-steps.txt", "Error (25)"));
}

static void test_help(void **state)
{
    (void)state;
    static struct outcome out;
    run_line("--help", NULL, &out);
    assert_int_equal(out.exit_code, 0);
    assert_non_null(strstr(out.output, "tables"));
    assert_non_null(strstr(out.output, "study"));
    static const char *const commands[] = {"tables --help", "study --help"};
    for (size_t i = 0; i < 2; i++) {
        run_line(commands[i], NULL, &out);
        assert_int_equal(out.exit_code, 0);
        assert_non_null(
            strstr(out.output, i ? "Usage: beamrate study SCENE [" : "Usage: beamrate tables ["));
        for (size_t j = 0; br_linear_solvers[j]; j++)
            assert_non_null(strstr(out.output, br_linear_solvers[j]->title));
        for (size_t j = 0; br_contact_rules[j]; j++)
            assert_non_null(strstr(out.output, br_contact_rules[j]->title));
        for (size_t j = 0; br_friction_rules[j]; j++)
            assert_non_null(strstr(out.output, br_friction_rules[j]->title));
        for (size_t j = 0; br_judges[j]; j++)
            assert_non_null(strstr(out.output, br_judges[j]->title));
        for (size_t j = 0; br_emitters[j]; j++)
            assert_non_null(strstr(out.output, br_emitters[j]->title));
    }
    expect("--version", NULL, 0, "beamrate ");
}

static void test_data_folder(void **state)
{
    (void)state;
    expect("study example1 " SMALL, &(struct circumstances){.data = folder}, 2,
           "is no file and no bundled scene");
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command);
}

/* Ctrl-C reaches gnuplot, too: its failure must not hide that the user wanted to stop. */
static void test_interrupted_plots(void **state)
{
    (void)state;
    char path[1024], program[512];
    path_in_folder("bin", program);
    assert_int_equal(mkdir(program, 0777), 0);
    snprintf(path, sizeof path, "%s:/usr/bin:/bin", program);
    write_file("bin/gnuplot", "#!/bin/sh\nkill -INT $PPID\nexit 1\n");
    path_in_folder("bin/gnuplot", program);
    assert_int_equal(chmod(program, 0755), 0);
    expect("study example2 --n 5,10 --k 0.1,0.05 --quiet --out drawing",
           &(struct circumstances){.path = path}, -SIGINT, "interrupted; nothing was written");
    assert_int_equal(count_files("drawing"), 0);
}

/* A title with a format's own characters, in a file whose name is not UTF-8. */
static void test_odd_names(void **state)
{
    (void)state;
    write_file("b\xe4m.yaml", "title: 'A_b *t* `s` <i>'\nlength: 1 m\nduration: 1 s\n"
                              "density: 1 kg/m\naxial:\n  stiffness: 1 N\n  viscosity: 1 N s\n"
                              "  load: 1 [N/m]\n");
    expect("study b\xe4m.yaml --out odd " SMALL, NULL, 0, "");
    assert_true(file_contains("odd/b\xe4m.md", "# A\\_b \\*t\\* \\`s\\` \\<i>\n"));
    assert_true(file_contains("odd/b\xe4m.tex", "A\\_b *t*"));
    assert_true(file_contains("odd/b\xe4m.json", "\"name\": \"b?m\""));
    assert_true(file_contains("odd/b\xe4m.json", "\"path\": \"b?m.yaml\""));
    assert_true(file_contains("odd/b\xe4m.json", "\"text\": \"title: 'A_b"));
    assert_true(file_contains("odd/b\xe4m.json", "study b?m.yaml"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_options), cmocka_unit_test(test_bad_scene),
        cmocka_unit_test(test_good_run),    cmocka_unit_test(test_tables),
        cmocka_unit_test(test_threads),     cmocka_unit_test(test_single_cell),
        cmocka_unit_test(test_failures),    cmocka_unit_test(test_help),
        cmocka_unit_test(test_data_folder), cmocka_unit_test(test_interrupted_plots),
        cmocka_unit_test(test_odd_names),   cmocka_unit_test(test_norms),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
