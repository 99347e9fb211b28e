/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scripts that are rendered side by side. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plots/render.h"
#include "support.h"

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
    struct br_error err = {0};
    bool missing = false;
    char *path = strdup(getenv("PATH"));
    setenv("PATH", "/dev/null", 1);
    REFUSED(br_plot_render(folder, "s0.gp", &missing, &err), BR_IO, "gnuplot");
    setenv("PATH", path, 1);
    free(path);
    assert_true(missing);
}

/* More scripts than are rendered at once; one fails, the others are done all the same, and the
 * first failure is told. */
static void test_renderer(void **state)
{
    (void)state;
    enum { SCRIPTS = 2 * BR_MOST_RENDERINGS + 1, BAD = BR_MOST_RENDERINGS + 3 };
    struct br_error err = {0};
    struct br_renderer renderer = {0};
    char folder[64], script[64], file[64], path[256];
    bool absent = false;
    make_folder(folder);
    for (int i = 0; i < SCRIPTS; i++) {
        bool missing = false;
        snprintf(script, sizeof script, "s%d.gp", i);
        write_script(folder, script,
                     i == BAD || i == SCRIPTS - 1
                         ? "plot nonsense\n"
                         : "stem = ARG0[1:strlen(ARG0)-3]\n"
                           "set terminal svg\nset output stem.'.svg'\nplot x\n"
                           "set terminal pngcairo\nset output stem.'.png'\nplot x\n"
                           "unset output\n");
        const enum br_status status = br_renderer_add(&renderer, folder, script, &missing, &err);
        if (!missing)
            MUST(status);
        absent |= missing;
    }
    snprintf(script, sizeof script, "\"s%d.gp\"", BAD);
    if (!absent)
        REFUSED(br_renderer_finish(&renderer, &err), BR_IO, script);
    assert_int_equal(renderer.count, 0);
    check_missing(folder);
    for (int i = 0; i < SCRIPTS; i++) {
        static const char *const endings[] = {"png", "svg", "gp"};
        const bool drawn = !absent && i != BAD && i != SCRIPTS - 1;
        for (size_t j = 0; j < 3; j++) {
            snprintf(file, sizeof file, "s%d.%s", i, endings[j]);
            assert_int_equal(is_there(folder, file), drawn || j == 2);
            snprintf(path, sizeof path, "%s/%s", folder, file);
            remove(path);
        }
    }
    assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_renderer)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
