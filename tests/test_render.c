/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts that are rendered side by side. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checks.h"
#include "plots/pictures.h"

static void make_folder(char folder[64])
{
    strcpy(folder, "/tmp/beamrate plots XXXXXX");
    assert_non_null(mkdtemp(folder));
}

static bool is_there(const char *folder, const char *name)
{
    char path[256];
    struct stat info;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &info) == 0 && info.st_size > 0;
}

static void write_script(const char *folder, const char *name, const char *text)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void check_missing(const char *folder)
{
    struct br_gnuplot g;
    bool missing = false;
    FREED char *path = strdup(getenv("PATH"));
    setenv("PATH", "/dev/null", 1);
    REFUSED(br_gnuplot_start(&g, folder, "s0.gp", &missing, &err), BR_IO, "gnuplot");
    setenv("PATH", path, 1);
    assert_true(missing);
}

/* One of several scripts fails and says why; the others succeed. */
TEST(test_side_by_side)
{
    enum { SCRIPTS = 4, BAD = 2 };
    struct br_gnuplot at_work[SCRIPTS];
    char folder[64], script[64], path[256];
    bool missing = false;
    make_folder(folder);
    for (int i = 0; i < SCRIPTS; i++) {
        snprintf(script, sizeof script, "s%d.gp", i);
        write_script(folder, script,
                     i == BAD ? "plot nonsense\n"
                              : "stem = ARG0[1:strlen(ARG0)-3]\n"
                                "set terminal svg\nset output stem.'.svg'\nplot x\n"
                                "set terminal pngcairo\nset output stem.'.png'\nplot x\n"
                                "unset output\n");
        const enum br_status status = br_gnuplot_start(&at_work[i], folder, script, &missing, &err);
        if (!missing)
            MUST(status);
    }
    for (int i = 0; i < SCRIPTS; i++) {
        static const char *const endings[] = {"png", "svg", "gp"};
        if (!missing && i == BAD)
            REFUSED(br_gnuplot_end(&at_work[i], &err), BR_IO, "\"s2.gp\"");
        else if (!missing)
            MUST(br_gnuplot_end(&at_work[i], &err));
        for (size_t j = 0; j < 3; j++) {
            snprintf(script, sizeof script, "s%d.%s", i, endings[j]);
            assert_int_equal(is_there(folder, script), (!missing && i != BAD) || j == 2);
            snprintf(path, sizeof path, "%s/%s", folder, script);
            remove(path);
        }
    }
    check_missing(folder);
    assert_int_equal(rmdir(folder), 0);
    if (missing)
        SKIP("gnuplot is not installed");
}
