/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of some errors and a verdict on it, by the library; of a table, where one is named. To
 * build and run it: cc example.c $(pkg-config --cflags --libs beamrate) -o example && ./example */
#include <beamrate/beamrate.h>
#include <stdio.h>

static enum beamrate_status find(struct beamrate_orders **orders, struct beamrate_error *err)
{
    static const double h[] = {0.1, 0.05, 0.025, 0.0125},
                        error[] = {1.01e-2, 2.52e-3, 6.3e-4, 1.57e-4};
    const struct beamrate_numbers numbers = {.h = h, .number = error, .count = 4};
    return beamrate_orders_find(orders, &numbers, err);
}

/* A table, as `beamrate orders FILE` reads it. */
static enum beamrate_status read(struct beamrate_orders **orders, const char *path,
                                 struct beamrate_error *err)
{
    static char text[100000];
    FILE *file = fopen(path, "r");
    text[file ? fread(text, 1, sizeof text - 1, file) : 0] = '\0';
    if (file)
        fclose(file);
    const struct beamrate_table table = {.name = path, .text = text};
    return beamrate_orders_read(orders, &table, err);
}

/* Prints the order of the first column, and whether it is 2. */
static enum beamrate_status show(const struct beamrate_orders *orders, struct beamrate_error *err)
{
    const struct beamrate_expectation expected = {BEAMRATE_SPACE, .order = 2, .tolerance = 0.1};
    struct beamrate_check *check;
    struct beamrate_answer answer;
    struct beamrate_case found;
    beamrate_orders_answer(orders, 0, BEAMRATE_SPACE, &answer);
    printf("order %.17g %.17g %.17g\n", answer.order.value, answer.order.low, answer.order.high);
    if (beamrate_orders_check(&check, orders, &expected, 1, err))
        return err->status;
    beamrate_check_case(check, 0, &found);
    printf("verdict %s\n", found.verdict == BEAMRATE_PASS ? "PASS" : found.reason);
    beamrate_check_free(check);
    return BEAMRATE_OK;
}

int main(int argc, char **argv)
{
    struct beamrate_error err;
    struct beamrate_orders *orders;
    printf("beamrate %s\n", beamrate_version());
    const int failed =
        (argc > 1 ? read(&orders, argv[1], &err) : find(&orders, &err)) || show(orders, &err);
    if (failed)
        fprintf(stderr, "example: %s\n", err.message);
    beamrate_orders_free(orders);
    return failed;
}
