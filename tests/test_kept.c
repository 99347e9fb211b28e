/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies that were stopped go on with what is kept, and have the bits of one go; what is damaged,
 * of another name, another scene or another version is not taken. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/grid/sweep.h"
#include "study/kept/kept.h"
#include "study/orders/process.h"
#include "study/orders/request.h"
#include "support.h"

static const size_t grid_n[] = {10, 20, 30, 40, 60}, grid_steps[] = {20, 50, 100, 200};
enum { N = 4, STEPS = 4 };

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/beamrate-kept-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    br_remove_folder(folder);
    return 0;
}

/* All norms of one study, and where they are kept. */
static void prepare(struct br_study s[BR_TEST_NORMS], const struct br_scene *scene, size_t n,
                    struct br_kept *kept)
{
    s[0] = br_test_study(scene, br_judge_best(scene), n, grid_n, STEPS, grid_steps);
    s[0].kept = kept;
    br_test_all_norms(s);
}

static void clear(struct br_study s[BR_TEST_NORMS])
{
    for (size_t m = 0; m < BR_TEST_NORMS; m++)
        br_study_clear(&s[m]);
}

static struct br_kept open_kept(bool take, const char *machine, const char *scene)
{
    struct br_kept kept = {0};
    struct br_error err;
    assert_int_equal(br_kept_open(&kept, folder, take, machine, &err), BR_OK);
    br_kept_add(&kept.base, scene);
    kept.slice = 0; /* a slice for each cell, whatever the reference costs */
    kept.most_reference = 1e30;
    return kept;
}

static size_t count_entries(void)
{
    char path[100];
    size_t count = 0;
    snprintf(path, sizeof path, "%s/.kept", folder);
    DIR *all = opendir(path);
    for (struct dirent *e; all && (e = readdir(all));)
        count += e->d_name[0] != '.';
    if (all)
        closedir(all);
    return count;
}

static void expect_same(const struct br_study a[BR_TEST_NORMS],
                        const struct br_study b[BR_TEST_NORMS], size_t cells)
{
    for (const struct br_study *x = a, *y = b; x < a + BR_TEST_NORMS; x++, y++) {
        assert_memory_equal(&x->reference_scale, &y->reference_scale, sizeof x->reference_scale);
        assert_memory_equal(x->reference_size, y->reference_size, sizeof x->reference_size);
        assert_memory_equal(x->reference_tip, y->reference_tip, sizeof x->reference_tip);
        assert_string_equal(x->events, y->events);
        for (size_t c = 0; c < cells; c++) {
            const struct br_cell *p = &x->cell[c], *q = &y->cell[c];
            assert_memory_equal(&p->at, &q->at, sizeof p->at);
            assert_memory_equal(p->error, q->error, sizeof p->error);
            assert_memory_equal(p->worst_time, q->worst_time, sizeof p->worst_time);
            assert_memory_equal(p->tip, q->tip, sizeof p->tip);
            assert_int_equal(p->unstable, q->unstable);
            assert_int_equal(p->failure.status, BR_OK);
        }
    }
}

/* Stops when so many entries are there. */
static size_t stop_at;

static bool stop_when_kept(void *self)
{
    (void)self;
    return count_entries() >= stop_at;
}

/* Runs n meshes with what is kept; returns how many cells were taken. */
static size_t run(struct br_study s[BR_TEST_NORMS], const struct br_scene *scene, size_t n,
                  struct br_kept *kept)
{
    struct br_error err = {0};
    prepare(s, scene, n, kept);
    MUST(br_study_run(s, 1, 2, NULL, &err));
    return kept ? atomic_load(&kept->taken) : 0;
}

/* A study in one go, and one that is stopped in the middle and resumed; then all of it is there,
 * and a larger one goes on from it. */
TEST(test_stopped_and_resumed)
{
    struct br_error err;
    struct br_study whole[BR_TEST_NORMS], s[BR_TEST_NORMS];
    const struct br_observer observer = {.stop = stop_when_kept};
    struct br_scene scene = br_test_bundled("example2");
    struct br_kept first = open_kept(false, "here", "scene"),
                   second = open_kept(true, "here", "scene"),
                   third = open_kept(true, "here", "scene"),
                   more = open_kept(true, "here", "scene");
    run(whole, &scene, N, NULL);
    stop_at = 6;
    prepare(s, &scene, N, &first);
    assert_int_equal(br_study_run(s, 1, 2, &observer, &err), BR_INTERRUPTED);
    const size_t kept = count_entries();
    if (!(kept >= stop_at && kept < BR_TEST_NORMS * N * STEPS))
        fail_msg("%zu entries were kept", kept);
    assert_int_equal(run(s, &scene, N, &second), kept / BR_TEST_NORMS);
    assert_int_equal(atomic_load(&second.bad), 0);
    expect_same(whole, s, N * STEPS);
    assert_int_equal(count_entries(), BR_TEST_NORMS * (N * STEPS + 1));
    clear(s);
    assert_int_equal(run(s, &scene, N, &third), N * STEPS);
    expect_same(whole, s, N * STEPS);
    clear(s);
    assert_int_equal(run(s, &scene, N + 1, &more), N * STEPS);
    for (size_t c = 0; c < N * STEPS; c++)
        CLOSE(s[0].cell[c].error[BR_PART_TOTAL], whole[0].cell[c].error[BR_PART_TOTAL], 1e-12);
    clear(s);
    clear(whole);
    br_scene_clear(&scene);
}

/* What follows from something else has another name. */
TEST(test_not_taken)
{
    struct br_study s[BR_TEST_NORMS];
    struct br_scene scene = br_test_bundled("example2");
    struct br_kept other[] = {open_kept(true, "there", "scene"), open_kept(true, "here", "another"),
                              open_kept(false, "here", "scene")};
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        assert_int_equal(run(s, &scene, N, &other[i]), 0);
        clear(s);
    }
    br_scene_clear(&scene);
}

TEST(test_damaged)
{
    char key[BR_SHA256_TEXT], twin[BR_SHA256_TEXT], path[1300], there[1300], text[8] = "", end;
    struct br_kept k = open_kept(true, "here", "scene");
    br_kept_key(&k.base, "a", key);
    br_kept_key(&k.base, "b", twin);
    snprintf(path, sizeof path, "%s/%s", k.folder, key);
    snprintf(there, sizeof there, "%s/%s", k.folder, twin);
    br_kept_write(&k, key, "seven!", 7);
    assert_true(br_kept_read_into(&k, key, text, 7));
    assert_string_equal(text, "seven!");
    assert_false(br_kept_read_into(&k, key, text, 6)); /* of another kind */
    assert_int_equal(link(path, there), 0);
    assert_false(br_kept_read_into(&k, twin, text, 7)); /* under another's name */
    assert_int_equal(atomic_load(&k.bad), 1);
    for (long at = 0; at < 150; at += 7) {
        FILE *file = fopen(path, "r+");
        assert_non_null(file);
        fseek(file, at, SEEK_SET);
        const int was = fgetc(file);
        if (was == EOF) {
            fclose(file);
            break;
        }
        fseek(file, at, SEEK_SET);
        fputc(was ^ 1, file);
        fclose(file);
        assert_false(br_kept_read_into(&k, key, text, 7));
        file = fopen(path, "r+");
        fseek(file, at, SEEK_SET);
        fputc(was, file);
        fclose(file);
    }
    assert_true(br_kept_read_into(&k, key, text, 7));
    assert_int_equal(truncate(path, 20), 0);
    assert_false(br_kept_read_into(&k, key, &end, 1));
    br_kept_key(&k.base, "c", key);
    assert_false(br_kept_read_into(&k, key, &end, 1)); /* not there: nobody's fault */
    strcpy(k.folder, "/dev/null/.kept");
    br_kept_write(&k, key, "x", 1);
    assert_int_equal(atomic_load(&k.lost), 1);
}

AROUND_TESTS(make_folder, remove_folder)
