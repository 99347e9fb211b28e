/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/lab/published.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/checks.h"

/* The sizes of the rows by their words; false: they are no sizes. */
static bool read_sizes(char *words, struct br_error_line *line)
{
    static const double edge[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96};
    const char *kind = strsep(&words, " ");
    for (size_t i = 0; i < line->rows; i++) {
        const double listed = words ? strtod(words, &words) : NAN;
        line->h[i] = strcmp(kind, "halved") == 0     ? pow(0.5, (double)i)
                     : strcmp(kind, "squares") == 0  ? 1 / edge[i + 2]
                     : strcmp(kind, "cubes") == 0    ? 1 / edge[i]
                     : strcmp(kind, "unknowns") == 0 ? 1 / sqrt(listed)
                     : strcmp(kind, "listed") == 0   ? listed
                                                     : NAN;
        if (!(line->h[i] > 0))
            return false;
    }
    return true;
}

/* A row: order | sizes | name | errors. */
static bool read_column(char *row, struct br_published *p)
{
    char *sizes = br_test_part(row), *name = br_test_part(sizes), *errors = br_test_part(name);
    p->line = (struct br_error_line){.truth = strtod(row, NULL)};
    snprintf(p->name, sizeof p->name, "%s", name);
    for (char *at = errors; *at && p->line.rows < BR_MOST_ERRORS; p->line.rows++)
        p->line.e[p->line.rows] = strtod(at, &at);
    return p->line.truth > 0 && p->line.rows >= 4 && read_sizes(sizes, &p->line);
}

size_t br_published_read(struct br_published column[BR_MOST_PUBLISHED])
{
    const char *folder = getenv("BEAMRATE_DATA");
    char path[1024], *row = NULL;
    size_t count = 0, room = 0, group = 0;
    bool good = true;
    snprintf(path, sizeof path, "%s/tests/data/published.txt", folder ? folder : ".");
    FILE *file = fopen(path, "r");
    while (file && good && getline(&row, &room, file) > 0) {
        row[strcspn(row, "\n")] = '\0';
        if (row[0] == '=') {
            group++;
        } else if (row[0] != '#') {
            good = group > 0 && count < BR_MOST_PUBLISHED && read_column(row, &column[count]);
            column[count++].group = (enum br_published_group)(group - 1);
        }
    }
    free(row);
    if (file)
        fclose(file);
    return good ? count : 0;
}
