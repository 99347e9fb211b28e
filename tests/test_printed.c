/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The printed tables: all cells, their corners, and what stands between them. */
#include <math.h>

#include "reference/printed.h"
#include "support.h"

static const struct {
    const struct br_printed *table;
    double corner[4]; /* coarse and fine mesh with the largest step, then with the smallest one */
} tables[] = {
    {&br_printed_table1, {5.042e-3, 2.028e-4, 5.042e-3, 2.003e-4}},
    {&br_printed_table2, {1.522e-2, 1.498e-2, 5.944e-3, 5.549e-3}},
};

TEST(test_cells)
{
    static const double k[] = {0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001};
    for (size_t i = 0; i < 2; i++) {
        const struct br_printed *p = tables[i].table;
        assert_int_equal(p->count, 36);
        for (size_t n = 100; n <= 3200; n *= 2)
            for (int j = 0; j < 6; j++)
                assert_true(br_printed_error(p, n, k[j]) > 0);
        for (int c = 0; c < 4; c++)
            CLOSE(br_printed_error(p, c % 2 ? 3200 : 100, c < 2 ? 0.01 : 0.0001),
                  tables[i].corner[c], 0);
    }
}

TEST(test_what_is_not_printed)
{
    const struct br_printed *p = &br_printed_table1, none = {0};
    CLOSE(br_printed_error(p, 100, 0.01 * (1 + 1e-12)), 5.042e-3, 0); /* k = T/steps, rounded */
    assert_true(isnan(br_printed_error(p, 100, 0.0101)));
    assert_true(isnan(br_printed_error(p, 101, 0.01)));
    assert_true(isnan(br_printed_error(p, 6400, 0.01)));
    assert_true(isnan(br_printed_error(&none, 100, 0.01)));
}
