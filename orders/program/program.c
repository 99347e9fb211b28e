/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a program that is run at each resolution. */
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/cache.h"
#include "base/each.h"
#include "orders/program/process.h"
#include "orders/request.h"

/* Times of the processor and of the clock, with halves of their 95 % intervals, s. */
struct times {
    double time[2], half[2];
};

struct job {
    const struct br_orders_request *program;
    struct br_numbers *numbers; /* a row for each run; those of one cell are neighbours */
    uint64_t *stamp;            /* of each row's files, when the study began; owned */
    struct br_cache *cache;
    struct times start; /* of a trade: of a process that does nothing */
};

/* ---- the files of a command: its program, and those that its words name, also behind a "=". What
 * these read or start is not known. ---- */

enum { LARGEST = 1 << 26 }; /* bytes; of a larger one the contents are not read */

/* The i-th regular file; "": none; NULL: there are no more. */
static const char *named(const struct br_command_words *c, size_t i, struct stat *info)
{
    const char *path = i ? c->word[(i - 1) / 2] : c->program;
    if (path && i && i % 2 == 0)
        path = strchr(path, '=') ? strchr(path, '=') + 1 : "";
    /* what is relative is no file where the program runs */
    const bool is = path && *path == '/' && stat(path, info) == 0 && S_ISREG(info->st_mode);
    return path && !is ? "" : path;
}

static bool sum_of(const char *path, char text[BR_SHA256_TEXT])
{
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool read = file >= 0 && br_sha256_file(file, text);
    if (file >= 0)
        close(file);
    return read;
}

/* States the words, and the bytes of the files, of large ones their size and time. */
static enum br_status state_files(struct br_statement *s, const struct br_command_words *c,
                                  struct br_error *err)
{
    struct stat info;
    char text[BR_SHA256_TEXT];
    const char *path;
    br_state(s, "program", "%s", c->program);
    for (char **word = c->word; *word; word++)
        br_state(s, "word", "%s", *word);
    for (size_t i = 0; (path = named(c, i, &info)); i++)
        if (*path && i && info.st_size > LARGEST)
            br_state(s, "file", "%lld bytes of %lld.%09ld", (long long)info.st_size,
                     (long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
        else if (*path && !sum_of(path, text))
            return br_fail(err, BR_IO, "%.800s cannot be read: %s", path, strerror(errno));
        else if (*path)
            br_state(s, "file", "%s", text);
    return BR_OK;
}

/* Another number where one of the files was replaced or written. */
static uint64_t stamp_of(const struct br_command_words *c)
{
    struct stat info = {0};
    uint64_t stamp = 14695981039346656037u; /* FNV-1a, by numbers */
    const char *path;
    for (size_t i = 0; (path = named(c, i, &info)); i++) {
        const uint64_t part[] = {(uint64_t)info.st_dev, (uint64_t)info.st_ino,
                                 (uint64_t)info.st_size, (uint64_t)info.st_mtim.tv_sec,
                                 (uint64_t)info.st_mtim.tv_nsec};
        for (size_t j = 0; j < sizeof part / sizeof *part; j++)
            stamp = (stamp ^ (*path ? part[j] : 0)) * 1099511628211u;
    }
    return stamp;
}

/* ---- finished cells ---- */

/* *text (out, owned): all that a cell's numbers follow from: the command, with the files that it
 * names, and the readings. Other files that the program reads are not known. */
static enum br_status text_of(const struct job *j, const struct br_command_words *cell,
                              size_t repeat, char **text, struct br_error *err)
{
    static const char *const kinds[] = {"regex", "json", "csv"};
    struct br_statement s;
    br_statement_begin(&s);
    br_state(&s, "beamrate-cache", "%s", "4");
    br_state(&s, "work", "%s", "run");
    const enum br_status status = state_files(&s, cell, err);
    for (size_t i = 0; i < j->program->readings; i++) {
        const struct br_reading *reading = &j->program->reading[i];
        br_state(&s, "name", "%s", reading->name);
        br_state(&s, kinds[reading->kind], "%s", reading->what);
        if (reading->file || reading->complaints || reading->last)
            br_state(&s, "from", "%s%s%s", reading->last ? "the last of " : "",
                     reading->file         ? "file "
                     : reading->complaints ? "stderr"
                                           : "stdout",
                     reading->file ? reading->file : "");
    }
    if (repeat)
        br_state(&s, "repeat", "%zu", repeat);
    *text = br_statement_end(&s);
    return *text || status ? status : br_no_memory(err, "a finished cell");
}

struct row {
    struct br_numbers_row *row;
    size_t numbers;
};

static void pass_row(struct br_record *r, void *self)
{
    const struct row *of = self;
    size_t numbers = of->numbers;
    br_record_count(r, &numbers, numbers, numbers);
    br_record_number(r, &of->row->seconds, 0, DBL_MAX);
    br_record_number(r, &of->row->wall, 0, DBL_MAX);
    br_record_or_nan(r, &of->row->bytes, 0, DBL_MAX);
    for (int axis = 0; axis < BR_AXES; axis++)
        br_record_or_nan(r, &of->row->given[axis], 0, DBL_MAX);
    for (size_t i = 0; i < numbers; i++)
        br_record_number(r, &of->row->number[i], -DBL_MAX, DBL_MAX);
}

/* ---- times of a trade ---- */

enum { LEAST_RUNS = 6, MOST_RUNS = 30 };                       /* six hold the median with 97 % */
static const double longest = 10;                              /* all runs of a cell, s */
static const double known = 0.05, scatter = 0.1, least = 1e-4; /* s: less is not known */

/* The median of times, which it sorts; *half (out): of its 95 % interval, by ranks. Of a few runs
 * the clock's usual scatter at least. */
static double median(double *time, size_t runs, double *half)
{
    const double count = (double)runs, rank = floor((count - 1.96 * sqrt(count)) / 2);
    const size_t low = rank > 1 ? (size_t)rank - 1 : 0;
    qsort(time, runs, sizeof *time, br_by_number);
    const double middle = (time[(runs - 1) / 2] + time[runs / 2]) / 2;
    *half = fmax((time[runs - 1 - low] - time[low]) / 2, least);
    if (runs < LEAST_RUNS)
        *half = fmax(*half, scatter * middle);
    return middle;
}

/* Repeats a run, which has warmed up, until the medians of its times are known to 5 %; one that
 * takes long, once or never. */
static enum br_status time_runs(const struct br_orders_request *program,
                                const struct br_command_words *words, struct br_numbers_row *row,
                                struct times *t, struct br_error *err)
{
    struct br_orders_request bare = *program;
    struct br_numbers_row one = {.failure = NULL};
    double time[2][MOST_RUNS], spent = t->time[1];
    bool settled = false;
    bare.readings = 0;
    for (size_t runs = 0; runs < MOST_RUNS && spent <= longest && !settled;) {
        if (br_run_command(&bare, words, &one, err))
            return err->status;
        if (one.failure) {
            br_run_failed(program, row, err, "when its time was measured: %s", one.failure);
            free(one.failure);
            return err->status;
        }
        time[0][runs] = one.seconds;
        time[1][runs++] = one.wall;
        spent += one.wall;
        settled = runs >= LEAST_RUNS;
        for (int i = 0; i < 2; i++) {
            t->time[i] = median(time[i], runs, &t->half[i]);
            settled &= t->half[i] <= fmax(known * t->time[i], least);
        }
    }
    return BR_OK;
}

/* Whether runs are repeated: not where the cost is a number that they print. */
static bool is_timed(const struct br_orders_request *program)
{
    bool timed = program->cost;
    for (size_t i = 0; i < program->readings && timed; i++)
        timed = strcmp(program->reading[i].name, program->cost) != 0;
    return timed;
}

/* The times of a process that does nothing: they are taken away from all others. */
static enum br_status time_start(struct job *j, struct br_error *err)
{
    static char path[] = "/bin/true", *word[] = {path, NULL};
    const struct br_command_words words = {.word = word, .program = path};
    struct br_numbers_row row = {.failure = NULL};
    const bool timed = is_timed(j->program) && access(path, X_OK) == 0;
    return timed ? time_runs(j->program, &words, &row, &j->start, err) : BR_OK;
}

/* Measures the times of a row, with the deviations of its costs. */
static enum br_status time_row(const struct job *j, const struct br_command_words *words,
                               struct br_numbers_row *row, struct br_error *err)
{
    struct times t = {{row->seconds, row->wall}, {scatter * row->seconds, scatter * row->wall}};
    double *const time[2] = {&row->seconds, &row->wall};
    if (time_runs(j->program, words, row, &t, err))
        return err->status;
    for (int i = 0; i < 2; i++) {
        const double half = hypot(t.half[i], j->start.half[i]);
        *time[i] = fmax(t.time[i] - j->start.time[i], half);
        row->deviation[j->numbers->quantities + (size_t)i] = half / 2;
    }
    return BR_OK;
}

/* Takes a finished cell, or runs it and keeps it. text: of the cell; NULL: it is not cached. A row
 * is of the files with which the study began, or it has failed. */
static enum br_status get_row(const struct job *j, const struct br_command_words *words,
                              const char *text, size_t i, struct br_error *err)
{
    struct row of = {&j->numbers->row[i], j->numbers->quantities};
    of.row->cached = br_cache_take(j->cache, text, pass_row, &of);
    if (!of.row->cached && !br_run_command(j->program, words, of.row, err) &&
        is_timed(j->program) && !of.row->failure)
        time_row(j, words, of.row, err);
    if ((!err->status || err->status == BR_BAD_INPUT) && stamp_of(words) != j->stamp[i]) {
        of.row->cached = false;
        return br_run_failed(j->program, of.row, err,
                             "%s, or a file that the command names, changed during the study",
                             words->program);
    }
    if (!err->status && text && !of.row->cached && !of.row->failure &&
        !br_cache_put(j->cache, text, pass_row, &of))
        br_fail(err, BR_IO, "%.800s: a finished cell could not be cached: %s", j->program->cache,
                strerror(errno));
    return err->status;
}

static enum br_status take_turn(void *self, size_t i, struct br_error *err)
{
    const struct job *j = self;
    struct br_numbers_row *row = &j->numbers->row[i];
    struct br_command_words words = {.word = NULL};
    char *text = NULL;
    enum br_status status = br_command_split(j->program, row, &words, err);
    if (status == BR_BAD_INPUT) /* it was valid before: its program is gone */
        status = br_run_failed(j->program, row, err, "%s", err->message);
    else if (!status && j->program->cache)
        status = text_of(j, &words, row->repeat, &text, err);
    if (!status && !row->failure)
        status = get_row(j, &words, text, i, err);
    free(text);
    br_command_clear(&words);
    return status;
}

/* ---- the grid ---- */

static size_t count_of(const struct br_program_axis *axis)
{
    return axis->column ? axis->count : 1;
}

/* Makes a row for each run of the list or grid, from coarse to fine, with its resolution. */
static enum br_status make_rows(const struct br_orders_request *p, struct br_numbers *numbers,
                                struct br_error *err)
{
    const size_t repeat = p->repeat > 1 ? (size_t)p->repeat : 1;
    const size_t inner = count_of(&p->axis[BR_AXIS_TIME]);
    const size_t rows = count_of(&p->axis[BR_AXIS_SPACE]) * inner * repeat;
    const enum br_status status = br_numbers_make_room(numbers, rows, p->readings + 4, err);
    for (size_t r = 0; r < rows && !status; r++) {
        const size_t at[BR_AXES] = {
            [BR_AXIS_SPACE] = r / repeat / inner, [BR_AXIS_TIME] = r / repeat % inner};
        struct br_numbers_row *row = &numbers->row[r];
        row->repeat = repeat > 1 ? r % repeat + 1 : 0;
        for (int i = 0; i < BR_AXES; i++) {
            const struct br_resolution_column *column = p->axis[i].column;
            numbers->listed[i] = numbers->column[i] = column;
            if (!column)
                continue;
            row->listed[i] = row->given[i] = p->axis[i].given[at[i]];
            row->z[i] = br_numbers_z(column, row->given[i], br_orders_dimension(p, column));
        }
    }
    if (!status)
        br_numbers_sort(numbers);
    return status;
}

static enum br_status make_quantities(const struct br_orders_request *p, struct br_numbers *numbers,
                                      struct br_error *err)
{
    const char **name = br_allocate(p->readings, sizeof *name);
    const struct br_resolution_column *stated[BR_AXES] = {NULL};
    enum br_status status = name ? BR_OK : br_no_memory(err, "what is read");
    for (size_t i = 0; i < p->readings && !status; i++) {
        const char *text = p->reading[i].name;
        const struct br_resolution_column *size = br_resolution_column_find(text);
        status = br_reading_check(&p->reading[i], err);
        const struct br_resolution_column *other = size ? stated[size->axis] : NULL;
        if (other && !status)
            status = br_fail(err, BR_BAD_INPUT,
                             "%s is read beside %s, expected one resolution of an axis", text,
                             other->name);
        if (size)
            numbers->column[size->axis] = stated[size->axis] = size;
        else if (!status) {
            name[numbers->quantities] = text;
            status = br_numbers_add_quantity(numbers, text, NULL, br_lists(p->values, text), err);
        }
    }
    const struct br_resolution_column *mesh = numbers->column[BR_AXIS_SPACE];
    if (mesh) {
        numbers->dimension = br_orders_dimension(p, mesh);
        numbers->assumed = mesh->is_volume && p->assumed_dimension;
        if (numbers->assumed)
            numbers->unsettled =
                "h follows from numbers of unknowns or cells: state the dimension of "
                "the mesh (--dimension, or 'dimension:')";
    }
    if (!status && !numbers->quantities)
        status = br_fail(err, BR_BAD_INPUT,
                         "every number that is read is a resolution, expected an error or a value");
    if (!status)
        status = br_orders_check_lists(p, numbers, name, numbers->quantities, err);
    free(name);
    static const char *const names[] = {"cpu", "wall", "memory", "dofs"}; /* as of finish_rows */
    const size_t costs = !p->cost ? 0 : mesh && strcmp(mesh->name, "dofs") == 0 ? 4 : 3;
    const size_t read = numbers->quantities;
    for (size_t i = 0; i < costs && !status; i++)
        status = br_numbers_add_quantity(numbers, names[i], i == 2 ? "B" : NULL, false, err);
    numbers->costs = numbers->quantities - read;
    numbers->quantities = read;
    return status;
}

/* Takes the sizes that the runs state. A run that failed states none: it stands where its list puts
 * it, times what the run before it has; where all failed, where its list puts it. */
static void take_stated_sizes(const struct br_orders_request *p, struct br_numbers *n, int axis)
{
    const struct br_resolution_column *stated = n->column[axis], *list = p->axis[axis].column;
    double factor = NAN;
    for (size_t i = n->rows; i-- > 0 && stated && stated != list;) {
        const struct br_numbers_row *row = &n->row[i];
        const double z = br_numbers_z(stated, row->given[axis], n->dimension);
        factor = isnan(z) ? factor : z / (list ? row->z[axis] : 1);
    }
    n->column[axis] = stated = isnan(factor) ? list : stated;
    for (size_t i = 0; i < n->rows && stated; i++) {
        struct br_numbers_row *row = &n->row[i];
        const double listed = list ? row->z[axis] : 1;
        double z = stated == list ? listed : br_numbers_z(stated, row->given[axis], n->dimension);
        factor = isnan(z) ? factor : z / listed;
        row->z[axis] = z = isnan(z) ? listed * factor : z;
        if (stated == list)
            row->given[axis] = row->listed[axis];
    }
}

/* Joins the runs of each cell: their mean, with its standard deviation. One that failed fails the
 * cell. */
static void join_repeated(struct br_numbers *n, size_t repeat)
{
    const size_t rows = n->rows;
    n->rows = 0;
    for (size_t first = 0; first < rows; first += repeat) {
        struct br_numbers_row row = n->row[first];
        for (size_t q = 0; q < n->quantities; q++) {
            double mean = 0, squares = 0;
            for (size_t i = 0; i < repeat; i++)
                mean += n->row[first + i].number[q] / (double)repeat;
            for (size_t i = 0; i < repeat; i++)
                squares += pow(n->row[first + i].number[q] - mean, 2);
            row.deviation[q] = sqrt(squares / (double)(repeat - 1) / (double)repeat);
            row.number[q] = mean;
        }
        for (size_t i = 1; i < repeat; i++) {
            struct br_numbers_row *other = &n->row[first + i];
            row.seconds += other->seconds;
            row.wall += other->wall;
            for (size_t q = n->quantities; q < n->quantities + n->costs; q++)
                row.deviation[q] = fmax(row.deviation[q], other->deviation[q]);
            row.bytes = fmax(row.bytes, other->bytes);
            row.cached &= other->cached;
            if (!row.failure) {
                row.failure = other->failure;
                other->failure = NULL;
            }
            free(other->number);
            free(other->out);
            free(other->failure);
        }
        row.repeat = repeat;
        row.seconds /= (double)repeat;
        row.wall /= (double)repeat;
        n->row[n->rows++] = row;
    }
}

/* After all runs. */
static void finish_rows(const struct br_orders_request *p, struct br_numbers *n)
{
    for (int axis = 0; axis < BR_AXES; axis++)
        take_stated_sizes(p, n, axis);
    if (p->repeat > 1)
        join_repeated(n, (size_t)p->repeat);
    for (struct br_numbers_row *row = n->row; row < n->row + n->rows && n->costs; row++) {
        const double costs[] = {row->seconds, row->wall, row->bytes, row->given[BR_AXIS_SPACE]};
        memcpy(row->number + n->quantities, costs, n->costs * sizeof *costs);
    }
}

/* Refuses a command that is not valid at any resolution, before one is run. */
static enum br_status check_commands(struct job *j, struct br_error *err)
{
    enum br_status status = BR_OK;
    j->stamp = br_allocate(j->numbers->rows, sizeof *j->stamp);
    if (!j->stamp)
        return br_no_memory(err, "the runs");
    for (size_t i = 0; i < j->numbers->rows && !status; i++) {
        struct br_command_words words = {.word = NULL};
        status = br_command_split(j->program, &j->numbers->row[i], &words, err);
        if (!status)
            j->stamp[i] = stamp_of(&words);
        br_command_clear(&words);
    }
    return status;
}

/* Cells are cached for all versions of beamrate. */
static enum br_status open_cache(struct job *j, struct br_error *err)
{
    const char *folder = j->program->cache;
    const int length = snprintf(j->cache->folder, sizeof j->cache->folder, "%s", folder);
    const bool fits = (size_t)length < sizeof j->cache->folder;
    if (fits && (mkdir(folder, 0777) == 0 || errno == EEXIST))
        return BR_OK;
    return br_fail(err, BR_IO, "%.900s: %s", folder, strerror(fits ? errno : ENAMETOOLONG));
}

enum br_status br_program_run(const struct br_orders_request *program, struct br_numbers *numbers,
                              struct br_error *err)
{
    struct br_cache cache = {.take = !program->anew};
    struct job j = {.program = program, .numbers = numbers, .cache = &cache};
    *numbers = (struct br_numbers){.rows = 0};
    if (!program->axis[BR_AXIS_SPACE].column && !program->axis[BR_AXIS_TIME].column)
        return br_fail(err, BR_BAD_INPUT, "found no list of resolutions, expected one or two");
    if (program->readings == 0)
        return br_fail(err, BR_BAD_INPUT,
                       "found nothing to read, expected the name of a number and where it is");
    bool failed = make_rows(program, numbers, err) || make_quantities(program, numbers, err) ||
                  check_commands(&j, err) || (program->cache && open_cache(&j, err));
    const struct br_each each = {.count = numbers->rows,
                                 .threads = program->cost ? 1 : program->jobs,
                                 .observer = program->observer,
                                 .turn = take_turn,
                                 .self = &j};
    if (!failed)
        br_run_folders_clean();
    failed = failed || time_start(&j, err) || br_each(&each, err);
    free(j.stamp);
    if (failed) {
        br_numbers_clear(numbers);
        return err->status;
    }
    finish_rows(program, numbers);
    return BR_OK;
}
