/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work cut into batches for ranks, in one process: how it is cut, that the parts put together again
 * have the bits of the whole, and what the environment says of launchers. No MPI. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/linear/linear_solver.h"
#include "solver/scene.h"
#include "study/grid/batches.h"
#include "study/grid/costs.h"
#include "study/grid/sweep.h"
#include "study/ranks/ranks.h"
#include "support.h"

static const size_t grid_n[] = {10, 20, 30, 40}, grid_steps[] = {20, 50, 100, 200};

/* A study with cells, as br_study_run prepares it. */
static struct br_study prepared(const struct br_scene *scene,
                                const struct br_reference *reference_kind,
                                struct br_resolution reference)
{
    struct br_study s = br_test_study(scene, reference_kind, 4, grid_n, 4, grid_steps);
    s.reference = reference;
    s.cell = br_allocate(16, sizeof *s.cell);
    assert_non_null(s.cell);
    for (size_t i = 0; i < 16; i++)
        s.cell[i].at = (struct br_resolution){grid_n[i / 4], grid_steps[i % 4]};
    return s;
}

static const struct br_resolution of_levels = {0, 200};

static void expect_same(const struct br_study *a, const struct br_study *b)
{
    assert_int_equal(a->failure.status, b->failure.status);
    if (a->failure.status)
        return; /* the rest means nothing */
    assert_memory_equal(&a->reference_scale, &b->reference_scale, sizeof a->reference_scale);
    assert_memory_equal(a->reference_tip, b->reference_tip, sizeof a->reference_tip);
    assert_memory_equal(a->reference_error, b->reference_error, sizeof a->reference_error);
    assert_string_equal(a->events ? a->events : "", b->events ? b->events : "");
    assert_true(a->reference_check == b->reference_check);
    for (size_t i = 0; i < 16; i++) {
        const struct br_cell *c = &a->cell[i], *d = &b->cell[i];
        assert_int_equal(c->at.steps, d->at.steps);
        assert_memory_equal(c->error, d->error, sizeof c->error);
        assert_memory_equal(c->tip, d->tip, sizeof c->tip);
        assert_memory_equal(c->worst_time, d->worst_time, sizeof c->worst_time);
    }
}

/* All batches in turn, the last one first, as ranks might end; then what is cut off is no result.
 */
static void march_one_by_one(struct br_study *studies, size_t count,
                             const struct br_batches *batches)
{
    FREED char *bytes = NULL;
    size_t size;
    FILE *results = open_memstream(&bytes, &size);
    assert_non_null(results);
    for (size_t b = batches->count; b-- > 0;)
        MUST(br_batch_march(studies, count, batches, b, 2, NULL, results, &err));
    fclose(results);
    for (size_t i = 0; i < 20; i++)
        REFUSED(br_batches_read(studies, count, batches, bytes, size * i / 20, &err), BR_IO,
                "cut off");
    MUST(br_batches_read(studies, count, batches, bytes, size, &err));
}

/* A study that fails is a result of its own, and the others go on. */
TEST(test_same_bits)
{
    enum { STUDIES = 4, FIRST = 3 };
    struct br_scene scene = br_test_bundled("example3"), bad = scene;
    bad.friction.regularisation = 0;
    for (int ranks = 1; ranks <= 5; ranks += 2) {
        struct br_study whole[STUDIES], parts[STUDIES];
        struct br_study *const sets[] = {whole, parts};
        for (int i = 0; i < 2; i++) {
            struct br_study *s = sets[i];
            s[0] = prepared(&scene, &br_reference_exact, of_levels);
            s[1] = prepared(&scene, &br_reference_fine, (struct br_resolution){120, 200});
            s[1].reference_check = &br_reference_exact;
            s[2] = prepared(&bad, &br_reference_exact, of_levels);
            s[2].method.friction = br_friction_rule_find("regularised");
            s[3] = prepared(&scene, &br_reference_exact, of_levels);
            s[3].norm = &br_norm_energy;
            s[0].next_norm = &s[3]; /* a chain */
        }
        MUST(br_march_studies(whole, FIRST, 1, NULL, &err));
        OWNED(br_batches) batches;
        MUST(br_batches_create(&batches, parts, FIRST, ranks, 1, &err));
        assert_true(batches.count == FIRST || ranks > 1);
        march_one_by_one(parts, FIRST, &batches);
        assert_int_equal(whole[2].failure.status, BR_BAD_INPUT);
        for (int i = 0; i < STUDIES; i++) {
            expect_same(&whole[i], &parts[i]);
            br_study_clear(&whole[i]);
            br_study_clear(&parts[i]);
        }
    }
    br_scene_clear(&scene);
}

/* ---- how it is cut ---- */

/* Batches that have some of the 16 cells. */
static size_t batches_of(const struct br_batches *batches, const size_t *of)
{
    size_t count = 0;
    for (size_t b = 0; b < batches->count; b++) {
        bool has = false;
        for (size_t i = 0; i < 16; i++)
            has |= of[i] == b;
        count += has;
    }
    for (size_t i = 0; i < 16; i++)
        assert_true(of[i] < batches->count);
    return count;
}

TEST(test_cutting)
{
    OWNED(br_scene) scene = br_test_bundled("example1");
    const size_t n[] = {100, 200, 400, 800}, steps[] = {5000, 6000, 8000, 10000};
    struct br_study s[] = {
        prepared(&scene, &br_reference_exact, (struct br_resolution){0, 120000}),
        prepared(&scene, &br_reference_fine, (struct br_resolution){24000, 120000})};
    for (int i = 0; i < 2; i++) {
        s[i].n = n;
        s[i].steps = steps;
        for (size_t c = 0; c < 16; c++)
            s[i].cell[c].at = (struct br_resolution){n[c / 4], steps[c % 4]};
    }
    const struct {
        size_t studies;
        int ranks, threads;
        size_t exact, fine; /* batches, at least; 1: exactly */
    } rows[] = {
        {1, 1, 1, 1, 0}, {1, 2, 1, 2, 0}, {1, 4, 1, 3, 0}, {2, 4, 1, 1, 1}, {2, 8, 4, 1, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        OWNED(br_batches) batches;
        MUST(br_batches_create(&batches, s, rows[i].studies, rows[i].ranks, rows[i].threads, &err));
        const size_t exact = batches_of(&batches, batches.of);
        const size_t fine = rows[i].fine ? batches_of(&batches, batches.of + 16) : 0;
        assert_int_equal(exact + fine, batches.count);
        assert_true(rows[i].exact == 1 ? exact == 1 : exact >= rows[i].exact);
        assert_int_equal(fine, rows[i].fine);
        for (size_t b = 0; b < batches.count; b++)
            assert_true(batches.cost[b] > 0);
    }
    OWNED(br_batches) none;
    MUST(br_batches_create(&none, s, 0, 4, 1, &err));
    assert_int_equal(none.count, 0);
    br_study_clear(&s[0]);
    br_study_clear(&s[1]);
}

TEST(test_slices)
{
    OWNED(br_scene) scene = br_test_bundled("example1");
    OWNED(br_study) s = prepared(&scene, &br_reference_exact, of_levels);
    double all = 0;
    for (size_t i = 0; i < 16; i++)
        all += br_cell_seconds(&s, i);
    for (size_t slices = 1; slices <= 16; slices++) {
        size_t slice[16];
        double load[16] = {0};
        const double most = br_slice_cells(&s, slices, slice);
        for (size_t i = 0; i < 16; i++) {
            assert_true(slice[i] < slices);
            load[slice[i]] += br_cell_seconds(&s, i);
        }
        for (size_t i = 0; i < slices; i++)
            assert_true(load[i] > 0 && load[i] <= most * (1 + 16 * DBL_EPSILON)); /* other sums */
        const double ideal = fmax(all / (double)slices, br_cell_seconds(&s, 15));
        assert_true(most <= 4.0 / 3 * ideal * (1 + 1e-12)); /* Graham's bound */
    }
}

/* ---- what comes from elsewhere ---- */

TEST(test_fingerprint)
{
    struct br_scene scene = br_test_bundled("example4"), other = br_test_bundled("example4");
    OWNED(br_study) s = prepared(&scene, &br_reference_exact, of_levels);
    const unsigned long long print = br_studies_fingerprint(&s, 1);
    for (int change = 0; change < 5; change++) {
        struct br_study t = s;
        t.scene = &other;
        t.k_count -= change == 1;
        t.method.solver = change == 2 ? &br_umfpack : t.method.solver;
        other.friction.coefficient = scene.friction.coefficient * (change == 3 ? 1 + 1e-6 : 1);
        other.axial.tip_force.constant = change == 4;
        assert_true((br_studies_fingerprint(&t, 1) == print) == (change == 0));
    }
    br_scene_clear(&scene);
    br_scene_clear(&other);
}

TEST(test_launchers)
{
    static const char *const variables[] = {
        "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMI_SIZE", "PMI_RANK",
        "SLURM_STEP_NUM_TASKS", "SLURM_PROCID"};
    static const struct {
        const char *value[6]; /* of those; NULL: not set */
        int size, rank;
    } rows[] = {
        {{NULL}, 1, 0},
        {{"4", "3"}, 4, 3},
        {{"1", "0"}, 1, 0},
        {{NULL, NULL, "2", "1"}, 2, 1},
        {{NULL, NULL, NULL, NULL, "8", "7"}, 8, 7},
        {{"4", "2", NULL, NULL, "2", "1"}, 4, 2}, /* mpirun in a Slurm job */
        {{"1", "0", NULL, NULL, "2", "1"}, 1, 0},
        {{NULL, NULL, NULL, NULL, NULL, "0"}, 1, 0}, /* a batch script */
        {{"many"}, 1, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (size_t v = 0; v < 6; v++)
            if (rows[i].value[v])
                setenv(variables[v], rows[i].value[v], 1);
            else
                unsetenv(variables[v]);
        const struct br_launch launch = br_launch_read();
        assert_int_equal(launch.size, rows[i].size);
        assert_int_equal(launch.rank, rows[i].rank);
        assert_true((launch.launcher != NULL) == (launch.size > 1));
    }
}
