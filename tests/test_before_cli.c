/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the program says and refuses before anything is marched or written. */
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli_driver.h"
#include "support.h"

#define SCENE                                                     \
    "title: a rod\nlength: 1 m\nduration: 1 s\ndensity: 1 kg/m\n" \
    "axial:\n  stiffness: 100 N\n  viscosity: 1 N s\n"

/* What may not stand in a file's name is replaced in those of the results. */
static void test_name(void **state)
{
    (void)state;
    cli_write_file("two\nlines.yaml", SCENE "  load: t [N/m]\n");
    cli_expect("study two\nlines.yaml --n 4,8 --k 0.1,0.05 --out s", NULL, 0, "Written to s/");
    assert_true(cli_is_there("s/two_lines.json") && cli_is_there("s/two_lines-h.gp"));
}

static void test_warned(void **state)
{
    (void)state;
    cli_write_file("stiff.yaml", SCENE "  load: 10*t [N/m]\ncontact:\n  gap: 0 m\n"
                                       "  stiffness: 5e4 N/m\n");
    cli_expect("trade stiff.yaml --split --methods euler+lagged --n 4 --k 0.1 --no-plots --quiet "
               "--out sp",
               NULL, 0, "the lagged contact is beyond its stability limit");
    cli_expect("run mms_pressed --n 10 --contact lagged --quiet", NULL, 0,
               "the lagged contact may gain energy as it opens and closes");
    /* run and study alike */
    cli_write_file("blow.yaml", SCENE "  load: t + 3e5*exp(-((t - 0.1234567)/1e-5)^2) [N/m]\n");
    cli_expect("run blow.yaml --n 4 --k 0.05", NULL, 0, "with k = 0.05 s 91 % of its impulse");
    cli_expect("study blow.yaml --n 4,8 --k 0.1,0.05 --reference fine:16,0.025 --out blow", NULL, 0,
               "with k = 0.05 s 91 % of its impulse, most of it near t = 0.125 s");
}

/* owner: of the program that made it; "": it is no program's. */
static void make_left_behind(const char *name, const char *owner, char path[512])
{
    char file[512];
    cli_path(name, path);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(file, sizeof file, "%s/half.csv", name);
    cli_write_file(file, "half");
    snprintf(file, sizeof file, "%s/.owner", name);
    if (*owner)
        cli_write_file(file, owner);
}

/* A folder that a program left behind is removed by the next one; one that is in use is not. */
static void test_left_behind(void **state)
{
    (void)state;
    char path[512], used[512], other[512];
    cli_path("left", path);
    assert_int_equal(mkdir(path, 0700), 0);
    make_left_behind("left/.beamrate-tip", "process 1", path);
    make_left_behind("left/.beamrate", "process 7 on earth", used);
    make_left_behind("left/.beamrate-mine", "", other);
    const int lock = open(used, O_RDONLY | O_DIRECTORY);
    assert_true(lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0);
    cli_expect("run example1 --n 4 --k 0.1 --quiet --out left", NULL, 2,
               "the folder is in use by process 7 on earth");
    assert_false(cli_is_there("left/.beamrate-tip"));
    assert_true(cli_is_there("left/.beamrate/half.csv"));
    assert_true(cli_is_there("left/.beamrate-mine/half.csv"));
    close(lock);
    cli_expect("run example1 --n 4 --k 0.1 --quiet --out left", NULL, 0, "");
    assert_false(cli_is_there("left/.beamrate"));
    assert_true(cli_is_there("left/.beamrate-mine/half.csv"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_name),
        cmocka_unit_test(test_warned),
        cmocka_unit_test(test_left_behind),
    };
    return cmocka_run_group_tests(tests, cli_make_folder, cli_remove_folder);
}
