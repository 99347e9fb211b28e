/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A report of any command, for any format.
 *
 * One function builds it, from top to bottom:
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
 * The first row makes the columns of its table. A table that may have no row, and whose columns
 * have units, gets them by a row that is taken back (br_put_no_row).
 *
 * Each call copies its arguments. No call fails: the document stores the first failure (no memory,
 * a key that no column has), ignores all later calls, and reports the failure when it is printed.
 *
 * A number stays a number until a format prints it: people get the digits of the column's format,
 * programs (CSV, JSON) all 17. The formats quote foreign text (base/quote.h). */
#ifndef BR_TABLES_DOCUMENT_H
#define BR_TABLES_DOCUMENT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

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

/* A number that is not finite is nothing: "-" for people, an empty field in CSV, null in JSON. */
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

/* The value if it is known, else nothing. */
static inline struct br_value br_if(bool known, struct br_value value)
{
    return known ? value : br_nothing();
}

/* ---- the contents of a document ---- */

enum {
    BR_FILES_ONLY = 1,   /* a table or column that a terminal does not show */
    BR_FOR_PEOPLE = 2,   /* not in CSV and JSON: a grid of values that another table lists */
    BR_FOR_PROGRAMS = 4, /* in CSV and JSON only */
    BR_MAIN = 8,         /* the table whose CSV file is NAME.csv; others are NAME-TABLE.csv */
    BR_WRAP = 16,        /* a column of long texts, which are wrapped for people */
    BR_FILLED = 32,      /* a column with a value; set by br_put_cell */
    BR_TEXTUAL = 64,     /* a column with a text or a truth, aligned left; set by br_put_cell */
    BR_LONG = 128,       /* a table that a terminal shows at any length */
    BR_VARIES = 256,     /* a column that people see only if its values differ */
    BR_UNLIKE = 512,     /* a column whose values differ; set by br_put_cell */
};
enum { BR_LONG_TABLE = 24 /* rows: a terminal does not show longer tables, a page folds them */ };

/* A column of a table, or the description of a fact. Strings may be NULL, but for the key of a
 * column for programs and the heading of any other. */
struct br_column {
    const char *key;     /* one word, for programs */
    const char *heading; /* for people; NULL: the key */
    const char *unit;    /* as "m/s" or "m^(3/2)"; NULL or "": none */
    const char *format;  /* of a number, for people: text with one %e, %f or %g; NULL: "%.6g" */
    unsigned flags;      /* BR_FILES_ONLY, BR_FOR_PEOPLE, BR_FOR_PROGRAMS, BR_WRAP */
};

struct br_document_cell {
    struct br_value value;
    const char *shown; /* for people instead of the value; NULL: the value by its format */
    const char *mark;  /* for people, behind the value; NULL: none */
};

struct br_document_row {
    struct br_document_cell *cell; /* by columns */
};

struct br_document_table {
    const char *key, *title;
    unsigned flags;
    struct br_column *column;
    struct br_document_row *row;
    size_t columns, rows, column_room, cell_room, row_room;
};

enum br_outcome {
    BR_OUTCOME_PASS,
    BR_OUTCOME_FAIL,
    BR_OUTCOME_INCONCLUSIVE,
    BR_OUTCOME_ERROR,
    BR_OUTCOMES
};
extern const char *const br_outcome_names[]; /* "PASS", ... */

/* A verdict, for people, JSON and JUnit. */
struct br_document_verdict {
    enum br_outcome outcome;
    const char *group, *name; /* such as a scene, and what of it was tested */
    const char *message;      /* why it did not pass, or a remark; NULL: none */
    const char *file;         /* the file of the expectation; NULL: none */
    size_t line;              /* of the file */
    double seconds;
    bool of_row;         /* its numbers are in the last row, ... */
    size_t table, row;   /* ... this row of block[table].table; set by br_put_verdict */
    const char **detail; /* lines; set by br_put_verdict_detail */
    size_t details, room;
};

enum br_block_kind {
    BR_BLOCK_SECTION, /* text: its title */
    BR_BLOCK_NOTE,    /* text */
    BR_BLOCK_TABLE,   /* table */
    BR_BLOCK_FACT,    /* what, cell */
    BR_BLOCK_COMMAND, /* what, cell: lines for a user to copy, which no format breaks */
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
    const char *scene_text; /* the whole text of the scene's file */
};

/* Its texts, by name; ends with NULL. */
extern const struct br_provenance_text {
    const char *key;
    size_t at; /* bytes */
} br_provenance_texts[];

enum { BR_MOST_ANSWERS = 10 };

/* Begins as zeros. Formats read it; builders use the functions below. */
struct br_document {
    const char *name;    /* of its files, without the extension */
    const char *format;  /* its kind: "beamrate trade" */
    int version;         /* of the keys of that kind, for programs that read them */
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
    struct br_store store;
    char *piece; /* of the store; `left` bytes are free */
    size_t left;
    struct br_document_cell *last; /* the last one that was put */
    const char **open;             /* the text that br_put_more extends; NULL: none */
    size_t next;                   /* column */
    bool blank;                    /* whether values that are put into the row become nothing */
    const char *before, *between;  /* items of a list ... */
    size_t items;                  /* of which it has so many */
    struct br_error failure;
};

/* ---- building ---- */

/* Begins a document; an earlier one is cleared. */
void br_document_begin(struct br_document *d, const char *name, const char *format, int version,
                       const char *caption);

/* Releases all; accepts zeros. */
void br_document_clear(struct br_document *d);

/* A formatted text in the memory of the document, without the sign of numbers that round to zero.
 * "" after a failure. */
__attribute__((format(printf, 2, 3))) const char *br_format(struct br_document *d,
                                                            const char *format, ...);

/* A short sentence of what was found, the verdict first. Reports begin with the answers. The
 * eleventh becomes a note. */
#define br_put_answer(d, ...) br_put_answer_text((d), br_format((d), __VA_ARGS__))
void br_put_answer_text(struct br_document *d, const char *text); /* of br_format, as below */

/* A title over what follows. */
void br_put_section(struct br_document *d, const char *title);

/* A paragraph; files have it, a terminal does not. */
#define br_put_note(d, ...) br_put_note_text((d), br_format((d), __VA_ARGS__))
void br_put_note_text(struct br_document *d, const char *text);

/* Extends the last answer, note or command. */
#define br_put_more(d, ...) br_put_more_text((d), br_format((d), __VA_ARGS__))
void br_put_more_text(struct br_document *d, const char *text);

/* A list in the last answer or note: the first item gets the text `before`, the next ones `between`
 * (both borrowed). d->items says how many there are. */
void br_put_list(struct br_document *d, const char *before, const char *between);
#define br_put_item(d, ...) br_put_item_text((d), br_format((d), __VA_ARGS__))
void br_put_item_text(struct br_document *d, const char *text);

/* One value: "label: value unit" for people, "key": value at the top of the JSON; a key with dots
 * (tip.displacement) is an object in an object. `what` is as a column. With BR_FOR_PROGRAMS,
 * without a heading, or without a value, it is in JSON only. CSV has no facts. */
void br_put_fact(struct br_document *d, const struct br_column *what, struct br_value value);
#define BR_FACT(d, value, ...) br_put_fact((d), &(struct br_column){__VA_ARGS__}, (value))

/* A fact with a formatted key; without a heading it is for programs only. unit: NULL, none. */
#define br_put_fact_as(d, value, label, of_unit, ...) \
    BR_FACT(d, value, .key = br_format((d), __VA_ARGS__), .heading = (label), .unit = (of_unit))
#define br_hide_fact(d, value, unit, ...) br_put_fact_as((d), (value), NULL, (unit), __VA_ARGS__)

/* A command line, or several, to copy; a fact in JSON. NULL or "": nothing is put. */
void br_put_command(struct br_document *d, const char *key, const char *label, const char *lines);

/* Begins a table. Without rows it is in JSON only. */
void br_put_table(struct br_document *d, const char *key, const char *title, unsigned flags);

/* Begins a row of cells that are nothing; takes the last row back, but for the columns that it has
 * made. */
void br_put_row(struct br_document *d);
void br_put_no_row(struct br_document *d);

/* Puts a value into the row, under the column of that key (or heading, where there is no key). The
 * first row makes the columns. */
void br_put_cell(struct br_document *d, const struct br_column *column, struct br_value value);
#define BR_PUT(d, value, ...) br_put_cell((d), &(struct br_column){__VA_ARGS__}, (value))

/* BR_PUT of a column for programs. unit: NULL, none. */
void br_hide(struct br_document *d, const char *key, const char *unit, struct br_value value);

/* Whether values become nothing from now on, until the end of the row. */
void br_put_blank(struct br_document *d, bool blank);

/* Ends a table of few rows and many columns: people see a line for each column, and the rows side
 * by side under their first values. A table with less columns a row stays as it is. */
enum { BR_ACROSS = 5 /* columns a row */ };
void br_put_across(struct br_document *d);

/* For people: a text instead of the last value ("refused", "tol 1e-05"), and a mark behind it
 * ("R"). Programs get neither: give them a column. */
#define br_put_shown(d, ...) br_put_shown_text((d), br_format((d), __VA_ARGS__))
void br_put_shown_text(struct br_document *d, const char *text);
void br_put_mark(struct br_document *d, const char *mark);

/* Puts a verdict, and lines that explain it. */
void br_put_verdict(struct br_document *d, const struct br_document_verdict *verdict);
#define br_put_verdict_detail(d, ...) br_put_verdict_detail_text((d), br_format((d), __VA_ARGS__))
void br_put_verdict_detail_text(struct br_document *d, const char *text);

/* A picture in the folder of the report: STEM.svg, STEM.png. */
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
    const struct br_markup *markup; /* of tables/markup.h; NULL: `write` prints it */
    /* For br_document_print: the document has no failure. The table is NULL unless by_table. */
    enum br_status (*write)(FILE *out, const struct br_document *d,
                            const struct br_document_table *table, struct br_error *err);
};

extern const struct br_document_format br_document_text, br_document_csv, br_document_markdown,
    br_document_latex, br_document_json, br_document_html;

/* Formats of the verdicts alone, for CI systems: JUnit's XML, a suite for each group, with the
 * numbers of the rows by their keys; and annotations of verdicts that did not pass (GitHub,
 * Workflow commands for GitHub Actions). */
extern const struct br_document_format br_document_junit, br_document_github;

/* The formats of every report; NULL-terminated. */
extern const struct br_document_format *const br_document_formats[];

/* The failure of the document: BR_OK, BR_NO_MEMORY, BR_INTERRUPTED where the program must stop
 * (br_must_stop, which each table and each row asks), or BR_IO where it was built wrongly. */
enum br_status br_document_status(const struct br_document *d, struct br_error *err);

/* Prints it, or one table of it where the format is by_table. Fails with the failure of the
 * document, BR_INTERRUPTED, or BR_NO_MEMORY; write errors stay in `out`. */
enum br_status br_document_print(FILE *out, const struct br_document_format *format,
                                 const struct br_document *d, const struct br_document_table *table,
                                 struct br_error *err);

/* One page of HTML with all documents of one command, at least one, and with the pictures that are
 * drawn in `folder` (NULL: none). Fails as br_document_print does. */
enum br_status br_document_print_page(FILE *out, const struct br_document *documents, size_t count,
                                      const char *folder, struct br_error *err);

/* How many columns the terminal behind `out` has; 0: there is no terminal, or it does not say. */
int br_document_columns(FILE *out);

/* For a terminal: the answers and the verdicts that did not pass, of all documents of one command;
 * then short tables that are not for files only, facts, and last the commands. Where `out` is a
 * terminal, no table is wider than it: headings and long texts are wrapped, and columns that still
 * find no room stand on further lines of their row. PASS and FAIL have colours there, unless
 * NO_COLOR is set or TERM is dumb. Fails as br_document_print does. */
enum br_status br_document_show(FILE *out, const struct br_document *d, size_t count,
                                struct br_error *err);

/* The next table for a file of a by_table format, from block *block on (in/out, begins as 0); NULL:
 * there is no other one, or the document has failed. */
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

/* Whether people see a column: it is for them, has a value, and tells its rows apart if it has to.
 */
static inline bool br_document_is_shown(const struct br_document_table *table, size_t column)
{
    const unsigned flags = table->column[column].flags;
    const bool same = flags & BR_VARIES && !(flags & BR_UNLIKE) && table->rows > 1;
    return br_for_people(flags) && flags & BR_FILLED && !same;
}

/* The text of a cell for people, without its mark. */
enum { BR_SHOWN = 400 };
const char *br_document_shown(const struct br_column *column, const struct br_document_cell *cell,
                              char buffer[BR_SHOWN]);

/* Prints a value for programs: a number with all its digits, a text quoted for the target. */
struct br_quoting;
void br_document_print_value(FILE *out, const struct br_quoting *target, const char *nothing,
                             const struct br_value *value);

#endif
