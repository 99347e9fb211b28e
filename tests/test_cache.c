/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs that are kept: nothing that is damaged is taken. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/cache.h"
#include "orders/program/process.h"
#include "orders/request.h"
#include "support.h"

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

static struct br_cache open_cache(void)
{
    struct br_cache cache = {.take = true};
    snprintf(cache.folder, sizeof cache.folder, "%s/.cache", folder);
    return cache;
}

/* A run that is over in a moment. Returns whether it was taken. */
static bool is_taken(struct br_cache *cache)
{
    static const struct br_resolution_column cells = {.name = "n", .axis = BR_AXIS_SPACE};
    static const struct br_reading reading = {
        .name = "err", .what = "(.*)", .kind = BR_READING_REGEX};
    static const double one = 4;
    OWNED(br_numbers) numbers = {.rows = 0};
    const struct br_orders_request request = {.command = "/bin/echo {n}",
                                              .axis[BR_AXIS_SPACE] = {&cells, &one, 1},
                                              .dimension = 1,
                                              .reading = &reading,
                                              .readings = 1,
                                              .jobs = 1,
                                              .seconds = 600,
                                              .cache = cache->folder,
                                              .anew = !cache->take};
    MUST(br_program_run(&request, &numbers, &err));
    assert_true(isfinite(numbers.row[0].number[0]) && numbers.row[0].seconds >= 0);
    const bool taken = numbers.row[0].cached;
    return taken;
}

/* Empties the folder and fills it with the entry of the run. */
static void fill(struct br_cache *cache)
{
    br_remove_folder(cache->folder);
    assert_int_equal(mkdir(cache->folder, 0700), 0);
    assert_false(is_taken(cache));
    assert_true(is_taken(cache));
}

/* A file's bytes, with its right sum again. */
static void write_entry(const char *path, char *bytes, size_t size)
{
    char sum[BR_SHA256_TEXT];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    if (size >= BR_SHA256_TEXT) {
        br_sha256_of(bytes + BR_SHA256_TEXT, size - BR_SHA256_TEXT, sum);
        memcpy(bytes, sum, BR_SHA256_TEXT - 1);
    }
    fwrite(bytes, 1, size, file);
    fclose(file);
}

/* The entries of a folder, at most `most`. */
static size_t list(const struct br_cache *cache, char path[][1300], size_t most)
{
    size_t count = 0;
    DIR *all = opendir(cache->folder);
    for (struct dirent *e; (e = readdir(all));)
        if (e->d_name[0] != '.' && count < most)
            snprintf(path[count++], 1300, "%.1100s/%.100s", cache->folder, e->d_name);
    closedir(all);
    return count;
}

/* Spoils an entry: 0: random numbers; 1: some byte of its text; 2: cut off or longer; 3: one number
 * that may be right, or not. */
static size_t spoil(char *bytes, size_t size, int how, struct br_test_random *random)
{
    static const double special[] = {-1, 1e300, 0.5, -0.0};
    const size_t head = BR_SHA256_TEXT + strlen(bytes + BR_SHA256_TEXT) + 1;
    const size_t at = head + sizeof(double) * br_test_index(random, (size - head) / sizeof(double));
    for (size_t i = head; i < size && how == 0; i++)
        bytes[i] = (char)br_test_index(random, 256);
    if (how == 1)
        bytes[BR_SHA256_TEXT + br_test_index(random, head - BR_SHA256_TEXT)] ^= 1;
    if (how == 3)
        memcpy(bytes + at, &special[br_test_index(random, 4)], sizeof(double));
    return how != 2 ? size : br_test_index(random, 2) ? size + 8 : br_test_index(random, size);
}

/* FIPS 180-2, B.1 and B.2. */
TEST(test_sums)
{
    char sum[BR_SHA256_TEXT];
    br_sha256_of("abc", 3, sum);
    assert_string_equal(sum, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    br_sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 56, sum);
    assert_string_equal(sum, "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

static void is_asked(struct br_record *record, void *self)
{
    (void)record;
    *(bool *)self = true;
}

TEST(test_without_a_folder)
{
    const struct br_cache none = {.take = true};
    bool asked = false;
    assert_true(br_cache_put(&none, "run", is_asked, &asked));
    assert_true(br_cache_put(NULL, "run", is_asked, &asked));
    assert_false(br_cache_take(&none, "run", is_asked, &asked));
    assert_false(asked);
}

/* Whatever the bytes behind a right sum are: no crash, and of random ones nothing is taken. More
 * files with FUZZ=2000. */
TEST(test_damaged_with_a_right_sum)
{
    enum { LONGEST = 20000 };
    static char path[1][1300], whole[LONGEST + 8], bytes[LONGEST + 8];
    struct br_test_random random = {31};
    const size_t files = getenv("FUZZ") ? (size_t)atol(getenv("FUZZ")) : 24;
    for (size_t i = 0; i < files; i++) {
        const int how = (int)(i % 4);
        struct br_cache cache = open_cache();
        fill(&cache);
        assert_int_equal(list(&cache, path, 1), 1);
        FILE *file = fopen(path[0], "r");
        const size_t size = fread(whole, 1, LONGEST, file);
        fclose(file);
        memset(bytes, 0, sizeof bytes);
        memcpy(bytes, whole, size);
        write_entry(path[0], bytes, spoil(bytes, size, how, &random));
        const bool taken = is_taken(&cache);
        if (how < 3)
            assert_false(taken);
    }
}

static void pass_seven(struct br_record *r, void *self)
{
    br_record_number(r, self, 0, 7);
}

static void pass_count(struct br_record *r, void *self)
{
    br_record_count(r, self, 2, 7);
}

/* One bit of an entry is enough; so are another's name, and a number out of its range. */
TEST(test_damaged)
{
    struct br_cache k = open_cache();
    double seven = 7, found = 0;
    char path[2][1300];
    br_remove_folder(k.folder);
    assert_true(br_cache_put(&k, "a", pass_seven, &seven));
    assert_true(br_cache_take(&k, "a", pass_seven, &found));
    assert_true(found == 7);
    assert_int_equal(list(&k, path, 1), 1);
    snprintf(path[1], sizeof path[1], "%.1000s/%s", k.folder,
             "3e23e8160039594a33894f6564e1b1348bbd7a0088d42c4acb73eeaed59c009d"); /* of b */
    assert_int_equal(link(path[0], path[1]), 0);
    assert_false(br_cache_take(&k, "b", pass_seven, &found));
    for (long at = 0, size = BR_SHA256_TEXT + 2 + sizeof seven; at < size; at++) {
        FILE *file = fopen(path[0], "r+");
        assert_non_null(file);
        fseek(file, at, SEEK_SET);
        const int was = fgetc(file);
        fseek(file, at, SEEK_SET);
        fputc(was ^ 1, file);
        fflush(file);
        assert_false(br_cache_take(&k, "a", pass_seven, &found));
        fseek(file, at, SEEK_SET);
        fputc(was, file);
        fclose(file);
    }
    assert_true(br_cache_take(&k, "a", pass_seven, &found));
    for (size_t i = 0; i < 4; i++) {
        seven = (double[]){7.5, -1, (double)NAN, (double)INFINITY}[i];
        assert_true(br_cache_put(&k, "c", pass_seven, &seven)); /* it is no failure, but ... */
        assert_false(br_cache_take(&k, "c", pass_seven, &found));
    }
    for (size_t count = 1, read = 0; count <= 8; count++) {
        const bool right = count >= 2 && count <= 7;
        assert_true(br_cache_put(&k, "d", pass_count, &count));
        assert_int_equal(br_cache_take(&k, "d", pass_count, &read), right || count == 8);
        assert_int_equal(read, right ? count : count == 8 ? 7 : 0);
    }
    assert_int_equal(truncate(path[0], 20), 0);
    assert_false(br_cache_take(&k, "a", pass_seven, &found));
    assert_false(br_cache_take(&k, NULL, pass_seven, &found));
    strcpy(k.folder, "/dev/null/.cache");
    seven = 7;
    assert_false(br_cache_put(&k, "a", pass_seven, &seven));
}

AROUND_TESTS(make_folder, remove_folder)
