/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/printed.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MOST_CELLS = 4096 };

/* One line "n,k,error". */
static bool parse_line(const char *line, struct br_printed_cell *cell)
{
    int end = 0;
    if (!isdigit((unsigned char)*line)) /* %zu would take a minus */
        return false;
    const int fields = sscanf(line, "%zu,%lf,%lf %n", &cell->n, &cell->k, &cell->error, &end);
    return fields == 3 && line[end] == '\0' && cell->n > 0 && isfinite(cell->k) && cell->k > 0 &&
           isfinite(cell->error) && cell->error > 0;
}

static enum br_status read_lines(FILE *file, const char *path, struct br_printed *printed,
                                 struct br_error *err)
{
    char line[256];
    size_t number = 1;
    for (; fgets(line, sizeof line, file); number++) {
        if (strlen(line) + 1 == sizeof line && line[sizeof line - 2] != '\n')
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: the line is too long, expected n,k,error",
                           path, number);
        line[strcspn(line, "\r\n")] = '\0';
        if (number == 1 && strcmp(line, "n,k,error") != 0)
            return br_fail(err, BR_BAD_INPUT, "%s:1: found '%s', expected n,k,error", path, line);
        if (number == 1)
            continue;
        if (printed->count == MOST_CELLS)
            return br_fail(err, BR_BAD_INPUT, "%s: more than %d cells", path, MOST_CELLS);
        if (!parse_line(line, &printed->cell[printed->count]))
            return br_fail(err, BR_BAD_INPUT, "%s:%zu: found '%s', expected n,k,error", path,
                           number, line);
        printed->count++;
    }
    if (ferror(file))
        return br_fail(err, BR_IO, "%s: %s", path, strerror(errno));
    if (number == 1)
        return br_fail(err, BR_BAD_INPUT, "%s:1: found nothing, expected n,k,error", path);
    return BR_OK;
}

enum br_status br_printed_read(const char *path, struct br_printed *printed, struct br_error *err)
{
    *printed = (struct br_printed){0};
    FILE *file = fopen(path, "r");
    if (!file)
        return br_fail(err, BR_BAD_INPUT, "%s: %s", path, strerror(errno));
    printed->cell = br_allocate(MOST_CELLS, sizeof *printed->cell);
    const enum br_status status =
        printed->cell ? read_lines(file, path, printed, err) : br_no_memory(err, "a printed table");
    fclose(file);
    return status;
}

void br_printed_clear(struct br_printed *printed)
{
    free(printed->cell);
    *printed = (struct br_printed){0};
}

double br_printed_error(const struct br_printed *printed, size_t n, double k)
{
    for (size_t i = 0; i < printed->count; i++)
        if (printed->cell[i].n == n && fabs(printed->cell[i].k - k) <= 1e-9 * k)
            return printed->cell[i].error;
    return NAN;
}
