/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `figures`, and the pictures of `run`, where there is gnuplot; see also data/gnuplot.txt. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli_driver.h"
#include "plots/pictures.h"
#include "support.h"

static bool has_gnuplot(void)
{
    return getenv("GNUPLOT") != NULL;
}

/* Draws a script again; whether gnuplot had nothing to say, but how many frames a GIF has. */
static bool is_silent(const char *folder, const char *script)
{
    char command[1024], path[512], said[1024] = "";
    cli_path(folder, path);
    snprintf(command, sizeof command, "cd '%s' && '%s' --default-settings '%s' 2>&1", path,
             getenv("GNUPLOT"), script);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    const size_t got = fread(said, 1, sizeof said - 1, pipe);
    const bool silent = got == 0 || strstr(said, " frames in animation sequence\n");
    if (!silent || strstr(said, "arning"))
        print_error("%s: %s\n", script, said);
    return pclose(pipe) == 0 && silent && !strstr(said, "arning");
}

TEST(test_figures)
{
    cli_expect("figures --out figures", NULL, 0, "11 agree, 5 differ, 0 undecided");
    for (const struct br_paper_figure *f = br_paper_figures; f->number; f++) {
        char name[64];
        static const char *const kinds[] = {"gp", "dat", "svg", "png"};
        for (size_t k = 0; k < (has_gnuplot() ? 4 : 2); k++) {
            snprintf(name, sizeof name, "figures/figure%d.%s", f->number, kinds[k]);
            if (!cli_is_there(name))
                fail_msg("%s is not there", name);
        }
        snprintf(name, sizeof name, "figure%d.gp", f->number);
        assert_true(!has_gnuplot() || is_silent("figures", name));
    }
}

/* The frames of a GIF: image descriptors, found by walking its blocks (GIF89a). */
static int gif_frames(const char *name)
{
    static unsigned char bytes[1 << 22];
    char path[512];
    cli_path(name, path);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_true(size > 13 && size < sizeof bytes && memcmp(bytes, "GIF89a", 6) == 0);
    size_t at = 13 + (bytes[10] & 0x80 ? (size_t)3 << ((bytes[10] & 7) + 1) : 0);
    int frames = 0;
    while (at < size && bytes[at] != 0x3b) {
        if (bytes[at] == 0x2c) {
            const unsigned char flags = bytes[at + 9];
            frames++;
            at += 10 + (flags & 0x80 ? (size_t)3 << ((flags & 7) + 1) : 0) + 1;
        } else
            at += 2; /* an extension */
        while (at < size && bytes[at])
            at += bytes[at] + 1u;
        at++;
    }
    assert_true(at == size - 1);
    return frames;
}

TEST(test_animation)
{
    if (!has_gnuplot())
        return; /* not skip(): it counts as a failure for who reads TAP */
    /* 50 steps: every one, and t = 0 */
    cli_expect("run example2 --n 10 --k 0.02 --quiet --animate moving.gif", NULL, 0, "");
    assert_int_equal(gif_frames("moving.gif"), 51);
    /* 1000 steps: every ninth, and the last */
    cli_expect("run example3 --n 10 --quiet --animate long.gif", NULL, 0, "");
    assert_int_equal(gif_frames("long.gif"), 113);
    assert_true(is_silent(".", "moving.gp"));
    cli_expect("run example1 --n 10 --k 0.25 --quiet --animate frames/", NULL, 0, "");
    assert_int_equal(cli_count_files("frames"), 5 + 2);
    assert_true(cli_is_there("frames/frame-0005.png"));
    if (system("ffmpeg -version >/dev/null 2>&1") == 0) {
        cli_expect("run example1 --n 10 --k 0.25 --quiet --animate film/f.mp4", NULL, 0, "");
        assert_int_equal(cli_count_files("film"), 3); /* no frames are left */
        assert_true(cli_is_there("film/f.mp4"));
    }
    /* whole or not at all */
    cli_expect("run example2 --n 10 --k 0.1 --quiet --animate full.gif",
               &(struct cli_circumstances){.file_size = 10000}, 3, "");
    assert_false(cli_is_there("full.gif") || cli_is_there("full.gp"));
}

TEST(test_plot)
{
    if (!has_gnuplot())
        return; /* not skip(): it counts as a failure for who reads TAP */
    cli_expect("run example4 --n 10 --plot", NULL, 0, "friction force and its bound (N)");
    cli_expect("run example3 --n 10 --plot", NULL, 0, "vertical displacement of the tip");
}

AROUND_TESTS(cli_make_folder, cli_remove_folder)
