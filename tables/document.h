/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report, whatever it is of, and in whatever format it will be printed.
 *
 * One straight function builds it, from top to bottom:
 *
 *     br_document_begin(d, "example1", "beamrate trade", 1, "What a digit costs");
 *     br_put_answer(d, "%s needs the least time", method);
 *     br_put_more(d, isfinite(error) ? ", its error is %.2e." : ".", error);
 *     BR_FACT(d, br_count(count), .key = "trials", .heading = "trials");
 *     br_put_table(d, "trials", "All trials", BR_FILES_ONLY);
 *     for (...) {
 *         br_put_row(d);
 *         BR_PUT(d, br_text(trial->name), .key = "method");
 *         BR_PUT(d, br_number(k), .key = "k", .heading = "time step", .unit = "s");
 *         BR_PUT(d, br_number(trial->error), .key = "error", .format = "%.2e");
 *     }
 *     br_put_provenance(d, &provenance);
 *
 * The first row brings the columns of its table; a table that may have no row begins with them
 * (BR_TABLE), and its rows are values in their order (BR_PUT_ROW).
 *
 * Each call copies what it is given. None of them fails: the document remembers the first failure
 * (no memory, a key that no column has), does nothing from then on, and tells it when it is
 * printed.
 *
 * Numbers stay numbers until a format prints them: people get the digits of the column's format,
 * programs (CSV, JSON) all 17. Foreign text is quoted by the formats (study/scene/quote.h). */
#ifndef BR_TABLES_DOCUMENT_H
#define BR_TABLES_DOCUMENT_H

#include <stdbool.h>
#include <stdio.h>

#include "solver/status.h"

/* ---- values ---- */

enum br_value_type { BR_NOTHING, BR_NUMBER, BR_COUNT, BR_TRUTH, BR_TEXT };

struct br_value {
    enum br_value_type kind;
    union {
        double number;
        long long count;
        bool truth;
        const char *text;
    };
};

static inline struct br_value br_nothing(void)
{
    return (struct br_value){.kind = BR_NOTHING};
}

/* What is not finite is nothing: "-" for people, an empty field in CSV, null in JSON. */
static inline struct br_value br_number(double number)
{
    return (struct br_value){.kind = BR_NUMBER, .number = number};
}

static inline struct br_value br_count(size_t count)
{
    return (struct br_value){.kind = BR_COUNT, .count = (long long)count};
}

static inline struct br_value br_truth(bool truth)
{
    return (struct br_value){.kind = BR_TRUTH, .truth = truth};
}

/* NULL is nothing. */
static inline struct br_value br_text(const char *text)
{
    return (struct br_value){.kind = text ? BR_TEXT : BR_NOTHING, .text = text};
}

/* The value where it is known, or else nothing. */
static inline struct br_value br_if(bool known, struct br_value value)
{
    return known ? value : br_nothing();
}

/* ---- what a document holds ---- */

enum {
    BR_FILES_ONLY = 1,   /* a table or column that a terminal does not show */
    BR_FOR_PEOPLE = 2,   /* not in CSV and JSON: a grid whose values another table has as a list */
    BR_FOR_PROGRAMS = 4, /* in CSV and JSON only */
    BR_MAIN = 8,         /* the table whose CSV file is NAME.csv; others are NAME-TABLE.csv */
    BR_WRAP = 16,        /* a column of long texts, which people get on several lines */
    BR_FILLED = 32,      /* a column with a value; set by br_put_cell */
    BR_TEXTUAL = 64,     /* a column with a text or a truth, set to the left; set by br_put_cell */
    BR_LONG = 128,       /* a table that a terminal shows however long it is */
};
enum { BR_LONG_TABLE = 24 /* rows: a terminal does not show more, a page folds them */ };

/* A column of a table, or what a fact is. Strings may be NULL, but for the key of what programs
 * get, or else the heading. */
struct br_column {
    const char *key;     /* one word, for programs */
    const char *heading; /* for people; NULL: the key */
    const char *unit;    /* as "m/s" or "m^(3/2)"; NULL or "": none */
    const char *format;  /* of a number, for people: one %e, %f or %g and text; NULL: "%.6g" */
    unsigned flags;      /* BR_FILES_ONLY, BR_FOR_PEOPLE, BR_FOR_PROGRAMS, BR_WRAP */
};

struct br_document_cell {
    struct br_value value;
    const char *shown; /* to people instead of the value; NULL: the value by its format */
    const char *mark;  /* to people, behind the value; NULL: none */
};

struct br_document_row {
    struct br_document_cell *cell; /* by columns */
    bool rule;                     /* a line above it */
};

struct br_document_table {
    const char *key, *title;
    unsigned flags;
    struct br_column *column;
    struct br_document_row *row;
    size_t columns, rows, column_room, cell_room, row_room;
    bool grows; /* the first row, for building: it makes the columns */
};

enum br_outcome {
    BR_OUTCOME_PASS,
    BR_OUTCOME_FAIL,
    BR_OUTCOME_INCONCLUSIVE,
    BR_OUTCOME_ERROR,
    BR_OUTCOME_SKIPPED
};
extern const char *const br_outcome_names[]; /* "PASS", ... */

/* A verdict, for people, JSON, and writers of their own (JUnit, TAP). */
struct br_document_verdict {
    enum br_outcome outcome;
    const char *group, *name; /* as a scene, and what of it was tested */
    const char *message;      /* why it did not pass, or a remark; NULL: none */
    const char *file;         /* where what was expected stands; NULL: nowhere */
    size_t line;              /* of the file */
    double seconds;           /* NaN: not measured */
    bool of_row;              /* its numbers are in the row that was put last, ... */
    size_t table, row;        /* ... which is this one of block[table].table; filled by put */
    const char **detail;      /* lines; filled by br_put_verdict_detail */
    size_t details, room;
};

enum br_block_kind {
    BR_BLOCK_SECTION, /* text: its title */
    BR_BLOCK_NOTE,    /* text */
    BR_BLOCK_TABLE,   /* table */
    BR_BLOCK_FACT,    /* what, cell */
    BR_BLOCK_COMMAND, /* what, cell: lines to be copied, which no format breaks */
    BR_BLOCK_PICTURE, /* text: its caption; what.key: its file's stem */
};

struct br_block {
    enum br_block_kind kind;
    const char *text;
    struct br_column what;
    struct br_document_cell cell;
    struct br_document_table *table;
};

/* All that is needed to repeat a run. Strings are borrowed. */
struct br_provenance {
    const char *version, *commit;
    const char *compiler, *flags;
    const char *command_line;
    const char *machine; /* operating system, processor, cores */
    const char *date;    /* UTC, ISO 8601 */
    int threads;
    const char *scene_path;
    const char *scene_text; /* the scene's file, whole */
};

/* Its texts, by name; ends with NULL. */
extern const struct br_provenance_text {
    const char *key;
    size_t at; /* bytes */
} br_provenance_texts[];

enum { BR_MOST_ANSWERS = 10 };

/* Begins as zeros; formats read it, builders only put. */
struct br_document {
    const char *name;    /* of its files, without extension */
    const char *format;  /* what kind of document it is: "beamrate trade" */
    int version;         /* of that kind's keys: a program that reads them may rely on it */
    const char *caption; /* one line */
    const char *answer[BR_MOST_ANSWERS];
    size_t answers;
    struct br_block *block;
    size_t blocks, block_room;
    struct br_document_verdict *verdict;
    size_t verdicts, verdict_room;
    struct br_provenance provenance;
    size_t longest; /* bytes of its longest text */
    /* for building */
    struct br_document_memory *memory;
    struct br_document_cell *last; /* that was put */
    const char **open;             /* the text that br_put_more goes on with; NULL: none */
    size_t next;                   /* column */
    bool blank;                    /* what is put into the row is nothing */
    struct br_error failure;
};

/* ---- building ---- */

/* Begins or, after a failure, repeats nothing: clear it first. */
void br_document_begin(struct br_document *d, const char *name, const char *format, int version,
                       const char *caption);

/* Releases all; accepts zeros. */
void br_document_clear(struct br_document *d);

/* A text that the document keeps; what rounds to zero in it has no sign. NULL after a failure. */
__attribute__((format(printf, 2, 3))) const char *br_format(struct br_document *d,
                                                            const char *format, ...);

/* A short sentence of what was found; the verdict comes first. Reports begin with them, a terminal
 * shows them last. The eleventh becomes a note. */
#define br_put_answer(d, ...) br_put_answer_text((d), br_format((d), __VA_ARGS__))
void br_put_answer_text(struct br_document *d, const char *text); /* of br_format, as all these */

/* A title over what follows. */
void br_put_section(struct br_document *d, const char *title);

/* A paragraph; files have it, a terminal does not. */
#define br_put_note(d, ...) br_put_note_text((d), br_format((d), __VA_ARGS__))
void br_put_note_text(struct br_document *d, const char *text);

/* Goes on with the answer, note or command that was put last. */
#define br_put_more(d, ...) br_put_more_text((d), br_format((d), __VA_ARGS__))
void br_put_more_text(struct br_document *d, const char *text);

/* One value: "label: value unit" for people, "key": value at the top of the JSON; a key with dots
 * (tip.displacement) is an object in an object. `what` is as a column: with BR_FOR_PROGRAMS,
 * without a heading, or of nothing it is in JSON only. CSV has no facts. */
void br_put_fact(struct br_document *d, const struct br_column *what, struct br_value value);
#define BR_FACT(d, value, ...) br_put_fact((d), &(struct br_column){__VA_ARGS__}, (value))

/* A fact whose key is formatted; for programs alone where there is no heading. unit: NULL, none. */
#define br_put_fact_as(d, value, heading, unit, ...) \
    br_put_fact_of((d), (value), (heading), (unit), br_format((d), __VA_ARGS__))
#define br_hide_fact(d, value, unit, ...) br_put_fact_as((d), (value), NULL, (unit), __VA_ARGS__)
void br_put_fact_of(struct br_document *d, struct br_value value, const char *heading,
                    const char *unit, const char *key);

/* A command line, or several lines, to be copied; a fact of JSON. NULL or "": nothing is put. */
void br_put_command(struct br_document *d, const char *key, const char *label, const char *lines);

/* Begins a table, and gives it columns, as many as are known, before its first row. People do not
 * see a table without rows; CSV has its header. */
void br_put_table(struct br_document *d, const char *key, const char *title, unsigned flags);
void br_put_columns(struct br_document *d, const struct br_column *columns, size_t count);
#define BR_TABLE(d, key, title, flags, columns)  \
    (br_put_table((d), (key), (title), (flags)), \
     br_put_columns((d), (columns), sizeof(columns) / sizeof *(columns)))

/* Begins a row: all its cells are nothing. With a rule above it where people see lines. */
void br_put_row(struct br_document *d);
void br_put_rule(struct br_document *d);

/* Puts a value into the row, under the column of that key (or heading, where there is no key). In a
 * table that began without columns the first row makes them. */
void br_put_cell(struct br_document *d, const struct br_column *column, struct br_value value);
#define BR_PUT(d, value, ...) br_put_cell((d), &(struct br_column){__VA_ARGS__}, (value))

/* Puts values under the next columns, in their order; of a new row, or of the one that is there. */
void br_put_cells(struct br_document *d, size_t count, const struct br_value *values);
#define BR_PUT_CELLS(d, ...)                                                              \
    br_put_cells((d), sizeof((struct br_value[]){__VA_ARGS__}) / sizeof(struct br_value), \
                 (const struct br_value[]){__VA_ARGS__})
#define BR_PUT_ROW(d, ...) (br_put_row(d), BR_PUT_CELLS(d, __VA_ARGS__))

/* BR_PUT of a column for programs. unit: NULL, none. */
void br_hide(struct br_document *d, const char *key, const char *unit, struct br_value value);

/* Whether what is put from now on is nothing, up to the end of the row. */
void br_put_blank(struct br_document *d, bool blank);

/* What people see instead of the value that was put last ("refused", "tol 1e-05"); an adornment
 * behind it ("R"). Programs do not see either: give them a column. */
#define br_put_shown(d, ...) br_put_shown_text((d), br_format((d), __VA_ARGS__))
void br_put_shown_text(struct br_document *d, const char *text);
void br_put_mark(struct br_document *d, const char *mark);

/* A verdict, and lines that explain it. */
void br_put_verdict(struct br_document *d, const struct br_document_verdict *verdict);
#define br_put_verdict_detail(d, ...) br_put_verdict_detail_text((d), br_format((d), __VA_ARGS__))
void br_put_verdict_detail_text(struct br_document *d, const char *text);

/* A picture that stands beside the report: STEM.svg, STEM.png. */
void br_put_picture(struct br_document *d, const char *stem, const char *caption);

void br_put_provenance(struct br_document *d, const struct br_provenance *provenance);

/* ---- printing ---- */

/* A format: one const record. */
struct br_markup;
struct br_document_format {
    const char *name;               /* as on the command line */
    const char *extension;          /* of its files, with the dot */
    const char *title;              /* one line for a person */
    bool by_table;                  /* a file has one table */
    const struct br_markup *markup; /* of tables/markup.h; NULL: it has a function of its own */
    /* Of a sound document, through br_document_print. The table is NULL unless by_table. */
    enum br_status (*write)(FILE *out, const struct br_document *d,
                            const struct br_document_table *table, struct br_error *err);
};

extern const struct br_document_format br_document_text, br_document_csv, br_document_markdown,
    br_document_latex, br_document_json, br_document_html;

/* Of the verdicts alone, for CI systems: JUnit's XML (a suite a group) and the Test Anything
 * Protocol, version 14, with the numbers of their rows by their keys; and annotations of what did
 * not pass (GitHub, Workflow commands for GitHub Actions). */
extern const struct br_document_format br_document_junit, br_document_tap, br_document_github;

/* NULL-terminated; those of any report. */
extern const struct br_document_format *const br_document_formats[];

/* What the document remembers: BR_OK, BR_NO_MEMORY, or BR_IO where it was built wrongly. */
enum br_status br_document_status(const struct br_document *d, struct br_error *err);

/* Prints it, or one table of it where the format is by_table. Fails with what the document
 * remembers, or BR_NO_MEMORY; write errors stay in `out`. */
enum br_status br_document_print(FILE *out, const struct br_document_format *format,
                                 const struct br_document *d, const struct br_document_table *table,
                                 struct br_error *err);

/* One page of HTML with all of them, at least one, of one command, and with the pictures that are
 * drawn in `folder` (NULL: none). Fails as print. */
enum br_status br_document_print_page(FILE *out, const struct br_document *documents, size_t count,
                                      const char *folder, struct br_error *err);

/* For a terminal: the tables that are short and not for files only, facts, verdicts that did not
 * pass, and last the answer and the commands. Fails as print. */
enum br_status br_document_show(FILE *out, const struct br_document *d, struct br_error *err);

/* The table that the file of a by_table format would have next, from block *block on (in/out,
 * begins as 0); NULL: no more, or the document has failed. */
const struct br_document_table *br_document_next_table(const struct br_document *d, size_t *block);

/* ---- for formats ---- */

static inline bool br_for_people(unsigned flags)
{
    return !(flags & BR_FOR_PROGRAMS);
}

static inline bool br_for_programs(unsigned flags)
{
    return !(flags & BR_FOR_PEOPLE);
}

static inline const struct br_document_cell *br_document_cell_at(
    const struct br_document_table *table, size_t row, size_t column)
{
    return &table->row[row].cell[column];
}

/* Whether people see a column: it is for them, and not without any value. */
static inline bool br_document_is_seen(const struct br_document_table *table, size_t column)
{
    const unsigned flags = table->column[column].flags;
    return br_for_people(flags) && flags & BR_FILLED;
}

/* What people see of a cell, without its mark. */
enum { BR_SHOWN = 400 };
const char *br_document_shown(const struct br_column *column, const struct br_document_cell *cell,
                              char buffer[BR_SHOWN]);

/* For programs: a number with all its digits, a text quoted for the target. */
struct br_quoting;
void br_document_print_value(FILE *out, const struct br_quoting *target, const char *nothing,
                             const struct br_value *value);

#endif
