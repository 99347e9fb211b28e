/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The manual page and docs/options.md, from the records of the commands, the rows of their options,
 * and the registries. Both have all rows, also of solvers that this machine lacks: the text is the
 * same everywhere. */
#include <string.h>

#include "base/quote.h"
#include "cli/beam/beam.h"
#include "cli/provenance.h"

static const char not_used[] = "An option that the chosen method does not use is refused.\n";

/* The options of a command that belong to no method; those of the method follow them. */
static size_t own_options(const struct br_option *row, size_t count)
{
    while (count && row[count - 1].id >= BR_OPT_METHOD)
        count--;
    return count;
}

/* ---- the manual page ---- */

/* Sections of the manual page that come from no row; each line is a paragraph. */
static const struct {
    const char *title, *text[8];
} sections[] = {
    {"MORE MACHINES",
     {"If mpirun or srun starts the program (with MPI built in), the ranks share the work, and "
      "only rank 0 prints and writes. The results are those of one process, to the bit. --threads "
      "is the number for each rank."}},
    {"FILES",
     {"Every table NAME is written as NAME.txt, .csv, .md, .tex and .json. Every plot is written "
      "as a gnuplot script NAME-*.gp with its data NAME-*.dat and, where gnuplot is installed, as "
      ".svg and .png. If gnuplot fails on a picture, a warning names it and only that picture is "
      "missing; the exit code is that of the results. The NAME of a scene is that of its file, at "
      "most 100 bytes, where _ replaces all but letters, digits, blanks and _ . - +.",
      "A folder holds one set of results, whose files the hidden list .beamrate-set names. A new set "
      "replaces the one before it, completely or not at all. A file that the list does not name is "
      "never replaced or removed: if it is in the way, the results go into the folder set-1 beside "
      "it (or the next free number), and the exit code is 3.",
      "Installed: share/beamrate/study/scenes (the bundled scenes), and the completion of bash."}},
    {"ENVIRONMENT",
     {"BEAMRATE_DATA: the folder that holds study/scenes, instead "
      "of the one the program was built or installed with.",
      "BEAMRATE_SILENCE: seconds after which a rank that sends nothing is regarded as dead, 60 by "
      "default.",
      "BEAMRATE_GNUPLOT_SECONDS: seconds that gnuplot may take for one script, 60 by default; then "
      "it is killed. An interrupt kills it, too.",
      "TMPDIR: the folder for the runs of orders --run, /tmp by default."}},
    {"EXIT STATUS",
     {"0 done; 1 a verdict failed; 2 bad input; 3 the computation failed. If a cell failed, the "
      "exit code is 3 after the results have been written; a march of run that stops early keeps "
      "what it has written. An interrupted program ends by its signal and leaves no file half "
      "written. A second signal may leave a hidden folder; the next command that writes there "
      "removes it, or puts its set in place."}},
    {"SEE ALSO", {"gnuplot(1), mpirun(1)"}},
};

/* Characters that roff would take as markup. */
static const struct br_quoting for_roff = {
    .around = "", .start = ".'", .prefix = "\\&", .stead = {{'-', "\\-"}, {'\\', "\\e"}}};

/* Writes a line of text; NULL: none. */
static void man_line(FILE *out, const char *text)
{
    if (!text)
        return;
    br_quote(out, &for_roff, text);
    fputc('\n', out);
}

static void man_options(FILE *out, const struct br_option *row, size_t count)
{
    for (size_t i = 0; i < count; i++, row++) {
        char help[512];
        fputs(".TP\n.B ", out);
        if (row->letter)
            fprintf(out, "\\-%c, ", row->letter);
        fputs("\\-\\-", out);
        br_quote(out, &for_roff, row->name);
        if (row->argument)
            fprintf(out, " \\fI%s\\fR", row->argument);
        fputc('\n', out);
        br_quote(out, &for_roff, br_option_help(row, help, sizeof help));
        fputs(".\n", out);
        man_line(out, row->more);
    }
}

static void man_words(FILE *out, const struct br_words *words)
{
    for (size_t i = 0; words->name(i); i++) {
        fprintf(out, ".TP\n.B %s\n", words->name(i));
        man_line(out, words->title ? words->title(i) : "an instruction set");
    }
}

static void man_command(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row), own = own_options(row, count);
    fprintf(out, ".SS beamrate %s%s%s\n", c->name, *c->arguments ? " " : "", c->arguments);
    man_line(out, c->about);
    man_line(out, c->more);
    man_options(out, row, own);
    if (own < count)
        fputs(".PP\nThe options of the method apply, too; see below.\n", out);
    if (c->words && c->words->title)
        man_words(out, c->words);
    fputs(".PP\n.nf\n", out);
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++) {
        fputs("beamrate ", out);
        man_line(out, c->example[i]);
    }
    fputs(".fi\n", out);
}

void br_print_manual(FILE *out)
{
    fprintf(out,
            ".\\\" SPDX-License-Identifier: GPL-3.0-or-later\n"
            ".\\\" Written by 'beamrate help man'.\n"
            ".TH BEAMRATE 1 2026 \"beamrate %s\" \"User Commands\"\n.SH NAME\n"
            "beamrate \\- orders of convergence of any program's numbers, and a solver of a "
            "viscoelastic beam\n.SH SYNOPSIS\n"
            ".B beamrate\n.I command\n.RI [ option ...]\n.SH COMMANDS\n",
            br_version());
    for (const struct br_command *const *c = br_program.commands; *c; c++)
        man_command(out, *c);
    struct br_option row[BR_OPTIONS];
    struct br_registry list[BR_REGISTRIES];
    const size_t count = br_options_of(br_find_command("run"), row), own = own_options(row, count);
    const size_t registries = br_registries(list);
    fprintf(out, ".SH OPTIONS OF THE METHOD\n%s", not_used);
    man_options(out, row + own, count - own);
    for (size_t i = 0; i < registries; i++) {
        fprintf(out, ".SS \"\\-\\-%s: %s\"\n", list[i].option, list[i].title);
        man_words(out, list[i].words);
    }
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        fprintf(out, ".SH %s\n", sections[i].title);
        for (const char *const *text = sections[i].text; *text; text++) {
            fputs(text == sections[i].text ? "" : ".PP\n", out);
            man_line(out, *text);
        }
    }
}

/* ---- docs/options.md ---- */

/* Characters that Markdown would take as markup. */
static const struct br_quoting for_page = {
    .around = "", .stead = {{'|', "\\|"}, {'<', "\\<"}, {'*', "\\*"}, {'_', "\\_"}}};

static void page_options(FILE *out, const struct br_option *row, size_t count)
{
    fputs("| option | default | what it does |\n|---|---|---|\n", out);
    for (size_t i = 0; i < count; i++, row++) {
        char text[BR_OPTION_TEXT];
        const char *standard = br_option_default(row, text);
        fputs("| ", out);
        if (row->letter)
            fprintf(out, "`-%c`, ", row->letter);
        fprintf(out, "`--%s%s%s` | %s | ", row->name, row->argument ? " " : "",
                row->argument ? row->argument : "", standard ? standard : "");
        br_quote(out, &for_page, row->help);
        fputs(row->more ? ". " : "", out);
        br_quote(out, &for_page, row->more ? row->more : "");
        fputs(" |\n", out);
    }
}

static void page_words(FILE *out, const struct br_words *words)
{
    fputc('\n', out);
    for (size_t i = 0; words->name(i); i++) {
        fprintf(out, "- `%s`%s", words->name(i), words->title ? ": " : "");
        br_quote(out, &for_page, words->title ? words->title(i) : "");
        fputc('\n', out);
    }
}

static void page_command(FILE *out, const struct br_command *c)
{
    struct br_option row[BR_OPTIONS];
    const size_t count = br_options_of(c, row), own = own_options(row, count);
    fprintf(out, "\n## beamrate %s%s%s\n\n", c->name, *c->arguments ? " " : "", c->arguments);
    br_quote(out, &for_page, c->about);
    fputs(c->more ? " " : "", out);
    br_quote(out, &for_page, c->more ? c->more : "");
    fputs("\n\n```sh\n", out);
    for (size_t i = 0; i < BR_MOST_EXAMPLES && c->example[i]; i++)
        fprintf(out, "beamrate %s\n", c->example[i]);
    fputs("```\n\n", out);
    page_options(out, row, own);
    if (own < count)
        fputs("\nThe [options of the method](#options-of-the-method) apply, too.\n", out);
    if (c->words && c->words->title)
        page_words(out, c->words);
}

void br_print_options_page(FILE *out)
{
    fputs("# Options\n\nWritten by `beamrate help markdown`. `T` is the duration of the scene: "
          "`--k T/100` makes 100 steps.\n",
          out);
    for (const struct br_command *const *c = br_program.commands; *c; c++)
        page_command(out, *c);
    struct br_option row[BR_OPTIONS];
    struct br_registry list[BR_REGISTRIES];
    const size_t count = br_options_of(br_find_command("run"), row), own = own_options(row, count);
    const size_t registries = br_registries(list);
    fprintf(out, "\n## Options of the method\n\n%s\n", not_used);
    page_options(out, row + own, count - own);
    for (size_t i = 0; i < registries; i++) {
        fprintf(out, "\n### --%s: %s\n", list[i].option, list[i].title);
        page_words(out, list[i].words);
    }
}
