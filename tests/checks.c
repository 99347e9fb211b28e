/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "checks.h"

#include <ctype.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* As the program and the library do. */
__attribute__((constructor)) static void let_gsl_return(void)
{
    gsl_set_error_handler_off();
}

_Thread_local struct br_error err;

void br_test_free(void *pointer)
{
    void *memory;
    memcpy(&memory, pointer, sizeof memory);
    free(memory);
}

void br_test_close(const char *what, double actual, double expected, double tolerance,
                   const char *file, int line)
{
    const double error = fabs(actual - expected);
    if (!(error <= tolerance)) {
        print_error("%s:%d: %s is %.17g, expected %.17g +- %.3g (off by %.3g)\n", file, line, what,
                    actual, expected, tolerance, error);
        _fail(file, line);
    }
}

void br_test_at_most(const char *what, double actual, double limit, const char *file, int line)
{
    if (!(actual <= limit)) {
        print_error("%s:%d: %s is %.6g, expected at most %.6g\n", file, line, what, actual, limit);
        _fail(file, line);
    }
}

void br_test_must(enum br_status status, const struct br_error *why, const char *what,
                  const char *file, int line)
{
    if (status != BR_OK) {
        print_error("%s:%d: %s: status %d: %s\n", file, line, what, status, why->message);
        _fail(file, line);
    }
}

void br_test_refused(enum br_status status, enum br_status expected, struct br_error *why,
                     const char *text, const char *what, const char *file, int line)
{
    const bool right = status == expected && why->status == expected && strstr(why->message, text);
    if (!right) {
        print_error("%s:%d: %s: status %d with \"%s\", expected %d with \"%s\"\n", file, line, what,
                    status, why->message, expected, text);
        _fail(file, line);
    }
    why->status = BR_OK;
}

static uint64_t next(struct br_test_random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double br_test_uniform(struct br_test_random *random, double low, double high)
{
    return low + (high - low) * (double)(next(random) >> 11) * 0x1p-53;
}

double br_test_log_uniform(struct br_test_random *random, double low, double high)
{
    return exp(br_test_uniform(random, log(low), log(high)));
}

double br_test_decades(struct br_test_random *random, double low, double high)
{
    return pow(10, br_test_uniform(random, low, high));
}

size_t br_test_index(struct br_test_random *random, size_t count)
{
    return (size_t)(next(random) % count);
}

bool br_test_once_in(struct br_test_random *random, size_t times)
{
    return br_test_index(random, times) == 0;
}

struct br_test_random br_test_random_of(uint64_t seed, size_t index)
{
    struct br_test_random random = {seed};
    random.state = next(&random) ^ ((uint64_t)index * 0xd1342543de82ef95u);
    next(&random);
    return random;
}

bool br_test_quick(void)
{
    return getenv("BR_TEST_QUICK") != NULL;
}

bool br_test_long(void)
{
    return getenv("BR_TEST_LONG") != NULL;
}

double br_test_slack(void)
{
    volatile long double one = 1, tiny = 1e-18L;
    return one + tiny == one ? 1e4 : 1;
}

/* ---- files ---- */

static char scene_file[] = "/tmp/br_test_scene_XXXXXX.yaml";

static void remove_scene_file(void)
{
    remove(scene_file);
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

const char *br_test_scene_file(const char *text)
{
    static bool made;
    if (!made) {
        const int descriptor = mkstemps(scene_file, 5);
        assert_true(descriptor >= 0 && close(descriptor) == 0);
        assert_int_equal(atexit(remove_scene_file), 0);
        made = true;
    }
    write_file(scene_file, text);
    return scene_file;
}

/* ---- rows ---- */

char *br_test_part(char *row)
{
    char *bar = strstr(row, " | ");
    if (!bar)
        return row + strlen(row);
    *bar = '\0';
    return bar + 3;
}

char *br_test_unescape(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++)
        if (strncmp(from, "\\n", 2) == 0) {
            *to++ = '\n';
            from++;
        } else
            *to++ = *from;
    *to = '\0';
    return text;
}

void br_test_rows(const char *section, void (*check)(char *row))
{
    char path[1024], *row = NULL;
    size_t room = 0, rows = 0;
    bool inside = false;
    snprintf(path, sizeof path, "%s/tests/data/text_refusals.txt", getenv("BEAMRATE_DATA"));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (getline(&row, &room, file) > 0) {
        row[strcspn(row, "\n")] = '\0';
        if (strncmp(row, "= ", 2) == 0) {
            inside = strcmp(row + 2, section) == 0;
        } else if (inside && *row && strncmp(row, "##", 2) != 0) {
            check(row);
            rows++;
        }
    }
    assert_true(rows > 20);
    free(row);
    fclose(file);
}

/* ---- stored texts ---- */

/* The number of bytes up to the first difference; numbers may differ within the tolerance. */
static size_t same_bytes(const char *text, const char *stored, double tolerance)
{
    const char *at = text;
    while (*at && *stored) {
        char *end, *stored_end;
        const double number = strtod(at, &end), other = strtod(stored, &stored_end);
        if (tolerance > 0 && isdigit((unsigned char)*at) && isdigit((unsigned char)*stored) &&
            fabs(number - other) <= tolerance * other) {
            at = end;
            stored = stored_end;
        } else if (*at != *stored) {
            return (size_t)(at - text);
        } else {
            at++;
            stored++;
        }
    }
    return (size_t)(at - text) + (*stored != '\0');
}

enum { MOST_LINES = 8192, LEAST_FOLDED = 3 };

/* Cuts a text into its lines, each with an end; returns their number. */
static size_t cut(char *text, char *line[MOST_LINES])
{
    size_t lines = 0;
    for (char *row; (row = strsep(&text, "\n")) && text;) {
        assert_true(lines < MOST_LINES);
        line[lines++] = row;
    }
    return lines;
}

/* Of the lines from i on, how many stand before, or are empty; *from is the first of them. */
static size_t longest_copy(char *const *line, size_t lines, size_t i, size_t *from)
{
    size_t longest = 0, count = 0;
    while (i + count < lines && !*line[i + count])
        count++;
    if (count > 0)
        return count;
    for (size_t j = 0; j < i; j++) {
        for (count = 0; j + count < i && i + count < lines; count++)
            if (strcmp(line[j + count], line[i + count]) != 0)
                break;
        if (count > longest) {
            longest = count;
            *from = j;
        }
    }
    return longest;
}

/* Prints the text without what stands twice in it: some lines that stand before are named, and
 * empty lines are counted. */
static void fold(FILE *out, char *text)
{
    static char *line[MOST_LINES];
    const size_t lines = cut(text, line);
    size_t count = 0, from = 0;
    for (size_t i = 0; i < lines; i += count) {
        count = longest_copy(line, lines, i, &from);
        if (!*line[i] && count > 1) {
            fprintf(out, "[%zu empty lines]\n", count);
        } else if (*line[i] && count >= LEAST_FOLDED) {
            fprintf(out, "[lines %zu to %zu]\n", from + 1, from + count);
        } else {
            fprintf(out, "%s\n", line[i]);
            count = 1;
        }
    }
}

/* Prints what was folded. */
static void unfold(FILE *out, char *text)
{
    static char *row[MOST_LINES], *line[MOST_LINES], empty[] = "";
    const size_t rows = cut(text, row);
    size_t lines = 0;
    for (size_t i = 0; i < rows; i++) {
        size_t first, last;
        char bracket;
        const bool again = sscanf(row[i], "[lines %zu to %zu%c", &first, &last, &bracket) == 3;
        const bool none = !again && sscanf(row[i], "[%zu empty lines%c", &last, &bracket) == 2;
        if (!again)
            first = 1;
        if (!again && !none)
            last = 1;
        assert_true(first > 0 && lines + last < MOST_LINES);
        for (size_t j = first; j <= last; j++)
            line[lines++] = again ? line[j - 1] : none ? empty : row[i];
    }
    for (size_t i = 0; i < lines; i++)
        fprintf(out, "%s\n", line[i]);
}

/* What a change of the text prints, to be freed; the text is lost. */
static char *changed(void (*change)(FILE *out, char *text), char *text)
{
    char *other = NULL;
    size_t size;
    FILE *out = open_memstream(&other, &size);
    assert_non_null(out);
    change(out, text);
    assert_int_equal(fclose(out), 0);
    return other;
}

void br_test_stored(const char *name, void (*print)(FILE *out), double tolerance)
{
    static char stored[1 << 18];
    char path[1024], *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    print(out);
    fputc('\n', out);
    assert_int_equal(fclose(out), 0);
    snprintf(path, sizeof path, "%s/tests/golden/made/%s.txt", getenv("BEAMRATE_DATA"), name);
    if (getenv("BR_TEST_UPDATE")) {
        char *copy = strdup(text), *short_one = changed(fold, copy);
        write_file(path, short_one);
        free(short_one);
        free(copy);
    }
    FILE *file = fopen(path, "r");
    if (!file)
        fail_msg("%s is not there", path);
    stored[fread(stored, 1, sizeof stored - 1, file)] = '\0';
    fclose(file);
    char *whole = changed(unfold, stored);
    const size_t same = same_bytes(text, whole, tolerance);
    if (same != size)
        fail_msg("%s is otherwise from here on (./bootstrap update writes it anew): %.200s", path,
                 text + (same < size ? same : size));
    free(whole);
    free(text);
}

/* ---- memory ---- */

void br_test_without_memory(enum br_status (*attempt)(const void *data, struct br_error *why),
                            const void *data, long least)
{
    long failed = 0, left = -1;
    for (long i = 0; left < 0; i++) {
        err = (struct br_error){0};
        br_allocation_fails_at(i);
        const enum br_status status = attempt(data, &err);
        left = br_allocation_fails_at(-1);
        if (status)
            REFUSED(status, BR_NO_MEMORY, "out of memory");
        failed += status != BR_OK;
        assert_true(i < 10000 && !(status && left >= 0));
    }
    if (failed < least)
        fail_msg("%ld allocations failed, expected at least %ld", failed, least);
}
