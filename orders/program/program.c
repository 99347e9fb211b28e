/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A source of numbers: a program that is run at each resolution. */
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/each.h"
#include "base/kept.h"
#include "base/quote.h"
#include "orders/program/process.h"
#include "orders/request.h"

enum {
    TAIL = 301,             /* bytes of a failed run's last lines, with the zero at the end */
    MOST_PRINTED = 1 << 24, /* bytes of a run */
    GRACE = 2               /* s from SIGTERM to SIGKILL */
};

struct job {
    const struct br_orders_request *program;
    struct br_numbers *numbers; /* a row for each run; those of one cell are neighbours */
    char **environment;         /* owned; its texts are not */
    struct br_kept *kept;
};

/* ---- one run ---- */

enum end { BY_ITSELF, STOPPED, TOO_LONG, TOO_MUCH };

struct run {
    int *file; /* open ones: standard output, standard error, copies of what the run wrote; owned */
    struct br_process process;
    double own_peak; /* of this process when the run began, bytes */
    double wall;     /* s */
    enum end end;
    int status; /* as of wait4 */
    struct rusage usage;
};
enum { PRINTED = 2 }; /* files */

/* Where programs get their folders. */
static const char *temporary(void)
{
    const char *set = getenv("TMPDIR");
    return set && *set ? set : "/tmp";
}

static enum br_status cannot_run(const struct br_process *p, int failure, struct br_error *err)
{
    const bool wrong = failure == ENOENT || failure == ENOEXEC || failure == EACCES;
    return br_fail(err, wrong ? BR_BAD_INPUT : BR_IO, "%.900s cannot be run: %s%s", p->program,
                   strerror(failure), failure == ENOENT ? " (its interpreter?)" : "");
}

static enum br_status begin(const struct job *j, const struct br_command_words *cell, struct run *r,
                            struct br_error *err)
{
    struct rusage own;
    for (size_t i = 0; i < PRINTED + cell->files; i++) {
        /* A file without a name, which the program cannot find in its folder. */
        r->file[i] = memfd_create("printed", MFD_CLOEXEC);
        if (r->file[i] < 0 || fcntl(r->file[i], F_SETFL, O_APPEND) != 0)
            return br_fail(err, BR_IO, "no file for what a program prints: %s", strerror(errno));
    }
    r->process = (struct br_process){.program = cell->program,
                                     .word = cell->word,
                                     .environment = j->environment,
                                     .where = temporary(),
                                     .output = {r->file[0], r->file[1]},
                                     .file = (const char *const *)cell->file,
                                     .copy = r->file + PRINTED,
                                     .files = cell->files,
                                     .most = MOST_PRINTED};
    const int failure = br_process_start(&r->process);
    /* The kernel counts memory of this process that the child had before it became the program. */
    getrusage(RUSAGE_SELF, &own);
    r->own_peak = 1024.0 * (double)own.ru_maxrss;
    return failure ? cannot_run(&r->process, failure, err) : BR_OK;
}

static size_t size_of(int file)
{
    struct stat info;
    return fstat(file, &info) == 0 ? (size_t)info.st_size : SIZE_MAX;
}

static bool prints_too_much(const struct run *r)
{
    return size_of(r->file[0]) > MOST_PRINTED || size_of(r->file[1]) > MOST_PRINTED;
}

/* Why a run must be ended; BY_ITSELF: it need not be. */
static enum end end_of(const struct br_orders_request *p, const struct run *r, double late)
{
    if (br_observer_stops(p->observer))
        return STOPPED;
    if (r->end)
        return r->end;
    return prints_too_much(r) ? TOO_MUCH : late > 0 ? TOO_LONG : BY_ITSELF;
}

static enum br_status watch(const struct br_orders_request *p, struct run *r, struct br_error *err)
{
    const double start = br_seconds();
    struct timespec pause = {.tv_nsec = 1000000};
    while (!br_process_has_ended(&r->process)) {
        const double late = br_seconds() - start - p->seconds; /* s */
        const enum end before = r->end;
        r->end = end_of(p, r, late);
        if (r->end == TOO_LONG && !before) /* not twice: some programs then do not clean up */
            br_process_terminate(&r->process);
        else if (r->end && (r->end != TOO_LONG || late > GRACE))
            br_process_kill(&r->process);
        nanosleep(&pause, NULL);
        if (pause.tv_nsec < 16000000)
            pause.tv_nsec *= 2;
    }
    const struct br_process_end end = br_process_wait(&r->process);
    r->wall = br_seconds() - start;
    r->status = end.status;
    r->usage = end.usage;
    if (!r->end && prints_too_much(r))
        r->end = TOO_MUCH;
    if (r->end == STOPPED)
        return br_fail(err, BR_INTERRUPTED, "interrupted");
    if (end.failure && !*end.folder)
        return br_fail(err, BR_IO, "%.900s: no folder to run a program in: %s", temporary(),
                       strerror(end.failure));
    if (end.failure)
        return cannot_run(&r->process, end.failure, err);
    if (end.known)
        return BR_OK;
    br_remove_folder(end.folder);
    return br_fail(err, BR_IO, "the process that watches a program was killed");
}

/* ---- its output ---- */

/* The last three lines of a file, quoted, or as much of them as `shown` has room for. */
static void last_lines(int file, char shown[TAIL])
{
    char text[TAIL];
    const size_t size = size_of(file), from = size < TAIL ? 0 : size - (TAIL - 1);
    ssize_t length = pread(file, text, TAIL - 1, (off_t)from);
    while (length > 0 && strchr(" \t\r\n", text[length - 1]))
        length--;
    text[length > 0 ? length : 0] = '\0';
    char *begin = text;
    for (ssize_t i = length - 1, lines = 1; i >= 0; i--) {
        if (text[i] == '\0')
            text[i] = '?';
        if (text[i] == '\n' && begin == text && lines++ == 3)
            begin = text + i + 1;
    }
    while ((*begin & 0xc0) == 0x80) /* the end of a character whose start is cut off */
        begin++;
    br_quoted(shown, TAIL, &br_for_text, begin);
}

/* Sets why a run failed; why: what was wrong with its numbers. */
static enum br_status set_failure(const struct br_orders_request *p, const struct run *r,
                                  const char *why, struct br_numbers_row *row, struct br_error *err)
{
    char what[sizeof err->message], tail[TAIL];
    if (r->end == TOO_LONG)
        snprintf(what, sizeof what, "it did not end within %g s", p->seconds);
    else if (r->end == TOO_MUCH)
        snprintf(what, sizeof what, "it printed more than %d MiB", MOST_PRINTED >> 20);
    else if (WIFSIGNALED(r->status))
        snprintf(what, sizeof what, "signal %d (%s)", WTERMSIG(r->status),
                 strsignal(WTERMSIG(r->status)));
    else if (WEXITSTATUS(r->status) != 0)
        snprintf(what, sizeof what, "exit code %d", WEXITSTATUS(r->status));
    else
        snprintf(what, sizeof what, "%s", why);
    last_lines(r->file[1], tail);
    if (!*tail)
        last_lines(r->file[0], tail);
    if (asprintf(&row->failure, "%s; %s%s", what, *tail ? "it printed: " : "it printed nothing",
                 tail) >= 0)
        return BR_OK;
    row->failure = NULL;
    return br_no_memory(err, "why a run failed");
}

/* *text (out, owned): all of a file. */
static enum br_status load(int file, char **text, size_t *length, struct br_error *why)
{
    const size_t size = size_of(file);
    *length = 0;
    if (size > MOST_PRINTED)
        return br_fail(why, BR_BAD_INPUT, "a file of it has more than %d MiB", MOST_PRINTED >> 20);
    if (!(*text = br_allocate(size + 1, 1)))
        return br_no_memory(why, "a program's output");
    for (ssize_t got = 1; *length < size && got > 0; *length += got > 0 ? (size_t)got : 0)
        got = pread(file, *text + *length, size - *length, (off_t)*length);
    return *length == size ? BR_OK : br_fail(why, BR_IO, "a program's output: %s", strerror(errno));
}

/* Reads the numbers of a run: its quantities, and the resolutions that it states itself. */
static enum br_status read_numbers(const struct br_orders_request *p, const struct run *r,
                                   struct br_numbers_row *row, struct br_error *why)
{
    enum br_status status = BR_OK;
    for (size_t i = 0, file = PRINTED, quantity = 0; i < p->readings && !status; i++) {
        const struct br_reading *reading = &p->reading[i];
        const struct br_resolution_column *size = br_resolution_column_find(reading->name);
        char *text = NULL;
        size_t length = 0;
        status = load(r->file[reading->file ? file++ : reading->complaints], &text, &length, why);
        if (!status)
            status = br_reading_take(
                p, i, text, length, size ? &row->given[size->axis] : &row->number[quantity++], why);
        if (!status && size && !(row->given[size->axis] > 0))
            status = br_fail(why, BR_BAD_INPUT, "%s: found %g, expected a number above 0",
                             reading->name, row->given[size->axis]);
        free(text);
    }
    return status;
}

static enum br_status finish(const struct br_orders_request *p, const struct run *r,
                             struct br_numbers_row *row, struct br_error *err)
{
    struct br_error why = {0};
    const struct timeval *user = &r->usage.ru_utime, *system = &r->usage.ru_stime;
    const double peak = 1024.0 * (double)r->usage.ru_maxrss;
    row->seconds =
        (double)(user->tv_sec + system->tv_sec) + 1e-6 * (double)(user->tv_usec + system->tv_usec);
    row->wall = r->wall;
    row->bytes = peak > r->own_peak ? peak : (double)NAN;
    if (!r->end && WIFEXITED(r->status) && WEXITSTATUS(r->status) == 0) {
        const enum br_status status = read_numbers(p, r, row, &why);
        if (!status)
            return BR_OK;
        if (status != BR_BAD_INPUT)
            return br_fail(err, status, "%s", why.message);
    }
    for (size_t i = 0; i < p->readings; i++)
        row->number[i] = (double)NAN;
    for (int axis = 0; axis < BR_AXES; axis++)
        row->given[axis] = NAN;
    return set_failure(p, r, why.message, row, err);
}

static enum br_status run_words(const struct job *j, const struct br_command_words *cell,
                                struct br_numbers_row *row, struct br_error *err)
{
    struct run r = {.file = br_allocate(PRINTED + cell->files, sizeof *r.file)};
    if (!r.file)
        return br_no_memory(err, "a run");
    enum br_status status = begin(j, cell, &r, err);
    if (!status)
        status = watch(j->program, &r, err);
    if (!status)
        status = finish(j->program, &r, row, err);
    for (size_t i = 0; i < PRINTED + cell->files; i++)
        if (r.file[i] > 0)
            close(r.file[i]);
    free(r.file);
    return status;
}

/* ---- finished cells ---- */

/* *text (out, owned): all that a cell's numbers follow from: the command, with the files that it
 * names, and the readings. Other files that the program reads are not known. */
static enum br_status text_of(const struct job *j, const struct br_command_words *cell,
                              size_t repeat, char **text, struct br_error *err)
{
    static const char *const kinds[] = {"regex", "json", "csv"};
    struct br_statement s;
    br_kept_begin(j->kept, "run", &s);
    const enum br_status status = br_command_state(&s, cell, NULL, err);
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

/* Keeps a cell that has run, but not where its program has changed during the run. */
static enum br_status keep(const struct job *j, const struct br_command_words *words,
                           const char *text, struct row *of, struct br_error *err)
{
    char *now = NULL;
    enum br_status status = text_of(j, words, of->row->repeat, &now, err);
    if (!status && strcmp(text, now) == 0 && !br_kept_put(j->kept, text, pass_row, of))
        status = br_fail(err, BR_IO, "%.800s: a finished cell could not be kept: %s",
                         j->program->kept, strerror(errno));
    free(now);
    return status;
}

static enum br_status take_turn(void *self, size_t i, struct br_error *err)
{
    const struct job *j = self;
    struct row of = {&j->numbers->row[i], j->numbers->quantities};
    struct br_command_words words = {NULL};
    char *text = NULL;
    enum br_status status = br_command_split(j->program, of.row, &words, err);
    if (!status && j->program->kept)
        status = text_of(j, &words, of.row->repeat, &text, err);
    of.row->kept = !status && br_kept_take(j->kept, text, pass_row, &of);
    if (!status && !of.row->kept)
        status = run_words(j, &words, of.row, err);
    if (!status && text && !of.row->kept && !of.row->failure)
        status = keep(j, &words, text, &of, err);
    free(text);
    br_command_clear(&words);
    return status;
}

/* ---- the grid ---- */

static size_t count_of(const struct br_program_axis *axis)
{
    return axis->column ? axis->count : 1;
}

enum br_status br_program_rows(const struct br_orders_request *p, struct br_numbers *numbers,
                               struct br_error *err)
{
    const size_t repeat = p->repeat > 1 ? (size_t)p->repeat : 1;
    const size_t inner = count_of(&p->axis[BR_AXIS_TIME]);
    const size_t rows = count_of(&p->axis[BR_AXIS_SPACE]) * inner * repeat;
    const enum br_status status = br_numbers_make_room(numbers, rows, p->readings, err);
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
        status = br_fail(err, BR_BAD_INPUT, "all readings are resolutions, expected a number, too");
    if (!status)
        status = br_orders_check_lists(p, numbers, name, numbers->quantities, err);
    free(name);
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
            row.bytes = fmax(row.bytes, other->bytes);
            row.kept &= other->kept;
            if (!row.failure) {
                row.failure = other->failure;
                other->failure = NULL;
            }
            free(other->number);
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
}

/* Refuses a command that is not valid at any resolution, before one is run. */
static enum br_status check_commands(const struct job *j, struct br_error *err)
{
    enum br_status status = BR_OK;
    for (size_t i = 0; i < j->numbers->rows && !status; i++) {
        struct br_command_words words = {NULL};
        status = br_command_split(j->program, &j->numbers->row[i], &words, err);
        br_command_clear(&words);
    }
    return status;
}

/* Cells are kept for all versions of beamrate. */
static enum br_status open_kept(struct job *j, struct br_error *err)
{
    const char *folder = j->program->kept;
    const int length = snprintf(j->kept->folder, sizeof j->kept->folder, "%s", folder);
    const bool fits = (size_t)length < sizeof j->kept->folder;
    if (fits && (mkdir(folder, 0777) == 0 || errno == EEXIST))
        return BR_OK;
    return br_fail(err, BR_IO, "%.900s: %s", folder, strerror(fits ? errno : ENAMETOOLONG));
}

static enum br_status make_environment(struct job *j, struct br_error *err)
{
    static char plain[] = "LC_ALL=C";
    size_t count = 0, kept = 0;
    while (environ[count])
        count++;
    j->environment = br_allocate(count + 2, sizeof *j->environment);
    if (!j->environment)
        return br_no_memory(err, "a program's environment");
    for (size_t i = 0; i < count; i++)
        if (strncmp(environ[i], "LC_ALL=", 7) != 0)
            j->environment[kept++] = environ[i];
    j->environment[kept] = plain;
    return BR_OK;
}

enum br_status br_program_run(const struct br_orders_request *program, struct br_numbers *numbers,
                              struct br_error *err)
{
    struct br_kept kept = {.take = !program->anew};
    struct job j = {.program = program, .numbers = numbers, .kept = &kept};
    *numbers = (struct br_numbers){.rows = 0};
    if (!program->axis[BR_AXIS_SPACE].column && !program->axis[BR_AXIS_TIME].column)
        return br_fail(err, BR_BAD_INPUT, "found no list of resolutions, expected one or two");
    if (program->readings == 0)
        return br_fail(err, BR_BAD_INPUT, "found no reading, expected a number to look for");
    bool failed = br_program_rows(program, numbers, err) ||
                  make_quantities(program, numbers, err) || check_commands(&j, err) ||
                  make_environment(&j, err) || (program->kept && open_kept(&j, err));
    const struct br_each each = {.count = numbers->rows,
                                 .threads = program->jobs,
                                 .observer = program->observer,
                                 .turn = take_turn,
                                 .self = &j};
    failed = failed || br_each(&each, err);
    free(j.environment);
    if (failed)
        br_numbers_clear(numbers);
    else
        finish_rows(program, numbers);
    return failed ? err->status : BR_OK;
}
