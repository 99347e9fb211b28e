/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A march, a study and the order of some numbers, by the library. To build and run it:
 *     cc example.c $(pkg-config --cflags --libs beamrate) -o example && ./example example2 */
#include <beamrate/beamrate.h>
#include <stdio.h>

/* The tip at the end of a march of 20 elements and 40 steps. */
static enum beamrate_status march(const struct beamrate_scene *scene, struct beamrate_error *err)
{
    struct beamrate_march *march;
    struct beamrate_tip tip;
    if (beamrate_march_create(&march, scene, 20, 40, NULL, err))
        return err->status;
    if (!beamrate_march_step(march, 40, err)) {
        beamrate_march_tip(march, &tip);
        printf("tip.axial %.17g\n", tip.displacement[BEAMRATE_AXIAL]);
        printf("tip.bending %.17g\n", tip.displacement[BEAMRATE_BENDING]);
        printf("contact_force %.17g\n", tip.contact_force);
        printf("friction_force %.17g\n", tip.friction_force);
    }
    beamrate_march_free(march);
    return err->status;
}

/* The errors of a grid, and their order in k. */
static enum beamrate_status study(const struct beamrate_scene *scene, struct beamrate_error *err)
{
    const size_t n[] = {10, 20, 40}, steps[] = {20, 40, 80};
    const struct beamrate_study_request request = {
        .n = n, .n_count = 3, .steps = steps, .steps_count = 3};
    struct beamrate_study *study;
    struct beamrate_cell cell;
    struct beamrate_fit fit;
    if (beamrate_study_run(&study, scene, &request, err))
        return err->status;
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++) {
            beamrate_study_cell(study, i, j, &cell);
            printf("error %zu %zu %.17g\n", cell.n, cell.steps, cell.error[BEAMRATE_TOTAL]);
        }
    beamrate_study_fit(study, BEAMRATE_TOTAL, &fit);
    printf("q %.17g %.17g %.17g\n", fit.q.value, fit.q.low, fit.q.high);
    beamrate_study_free(study);
    return BEAMRATE_OK;
}

/* The order of errors of another program, and a verdict on it. */
static enum beamrate_status orders(struct beamrate_error *err)
{
    const double h[] = {0.1, 0.05, 0.025, 0.0125}, error[] = {1.01e-2, 2.52e-3, 6.3e-4, 1.57e-4};
    const struct beamrate_numbers numbers = {.h = h, .number = error, .count = 4};
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, .order = 2, .tolerance = 0.1};
    struct beamrate_orders *orders;
    struct beamrate_check *check;
    struct beamrate_case found;
    if (beamrate_orders_find(&orders, &numbers, err))
        return err->status;
    if (!beamrate_orders_check(&check, orders, &expected, 1, err)) {
        beamrate_check_case(check, 0, &found);
        printf("order %.17g %.17g %.17g\n", found.order.value, found.order.low, found.order.high);
        printf("verdict %s\n", found.verdict == BEAMRATE_PASS ? "PASS" : found.reason);
        beamrate_check_free(check);
    }
    beamrate_orders_free(orders);
    return err->status;
}

int main(int argc, char **argv)
{
    struct beamrate_error err = {0};
    struct beamrate_scene *scene = NULL;
    printf("beamrate %s\n", beamrate_version());
    const int failed = beamrate_scene_open(&scene, argc > 1 ? argv[1] : "example2", &err) ||
                       march(scene, &err) || study(scene, &err) || orders(&err);
    if (failed)
        fprintf(stderr, "example: %s\n", err.message);
    beamrate_scene_free(scene);
    return failed;
}
