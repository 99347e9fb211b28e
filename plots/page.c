/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/page.h"

#include <math.h>
#include <string.h>

#include "study/scene/quote.h"

enum { FONT = BR_PAGE_FONT };

/* Plasma's dark two thirds: readable for the colour-blind, and in grey, since the
 * lightness rises steadily. */
static const char *const colours[] = {"#0d0887", "#4b03a1", "#7d03a8", "#a82296",
                                      "#cb4679", "#de5f65", "#e8704f"};
static const char *const dashes[] = {"solid",      "(12,4)", "(4,3)",
                                     "(12,4,3,4)", "(20,5)", "(8,3,2,3,2,3)"};
static const int marks[] = {7, 5, 9, 13, 11, 15};
enum {
    COLOURS = sizeof colours / sizeof *colours,
    DASHES = sizeof dashes / sizeof *dashes,
    MARKS = sizeof marks / sizeof *marks
};

struct br_pen br_pen_of(size_t i, size_t count)
{
    const double along = count > 1 ? (double)i / (double)(count - 1) : 0;
    return (struct br_pen){
        .colour = colours[lround(along * (COLOURS - 1))],
        .dash = dashes[i % DASHES],
        .mark = marks[i % MARKS],
        .size = 3.4 - 1.6 * along,
    };
}

void br_write_script_head(FILE *out, const char *caption, const char *title, const char *stem)
{
    char name[256];
    br_quoted(name, sizeof name, &br_for_text, stem);
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, caption);
    if (title)
        fprintf(out, "# %s\n", title);
    fprintf(out,
            "# Draws %s.svg and %s.png from %s.dat;\n"
            "# edit it, and draw them again, in this folder, with\n"
            "#     gnuplot %s.gp\n\n"
            "set encoding utf8\n"
            "stem = ",
            name, name, name, name);
    br_quote(out, &br_for_gnuplot, stem);
    fputs("\ndata = stem.'.dat'\n", out);
}

void br_write_head(FILE *out, const struct br_report *report, const struct br_plot *plot,
                   const char *stem)
{
    br_write_script_head(out, report->caption, plot->title, stem);
    fputs("\n"
          "# A cell with a flag, left out of the fits, has a hollow mark.\n"
          "mark(filled, flag) = flag eq '-' ? filled : filled - 1\n"
          "set style line 101 lw 2 lc rgb '#444444' # slopes\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n",
          out);
}

void br_write_pens(FILE *out, size_t pens)
{
    fputs("# One pen a curve; pi -1: the line leaves room for the marks.\n", out);
    for (size_t i = 0; i < pens; i++) {
        const struct br_pen pen = br_pen_of(i, pens);
        fprintf(out, "set style line %zu lw 2.5 lc rgb '%s' dt %s pt %d ps %.2f*size pi -1\n",
                i + 1, pen.colour, pen.dash, pen.mark, pen.size);
    }
}

void br_write_loop(FILE *out, int width, int height)
{
    fprintf(out,
            "\n# The default font only scales marks; every text has its own size.\n"
            "do for [format in 'svg png'] {\n"
            "if (format eq 'svg') {\n"
            "    set terminal svg size %d,%d font 'DejaVu Sans,12' background rgb 'white'\n"
            "    size = 0.75\n"
            "    set pointintervalbox 1.6\n"
            "} else {\n"
            "    set terminal pngcairo size %d,%d font 'DejaVu Sans,12' fontscale 0.75\n"
            "    size = 1\n"
            "    set pointintervalbox 1.7\n"
            "}\n"
            "set output stem.'.'.format\n"
            "unset label\n"
            "unset arrow\n",
            width, height, width, height);
}

void br_write_foot(FILE *out)
{
    fputs("unset output\n}\n", out);
}

/* One line of the caption, at most `size` pixels high and as wide as the page. */
static void write_caption_line(FILE *out, const char *text, int width, double size, double y)
{
    const double fits = 0.96 * width / 0.6 / (double)(strlen(text) + 1);
    fputs("set label ", out);
    br_quote(out, &br_for_gnuplot, text);
    fprintf(out, " noenhanced at screen 0.02,%.3f left font ',%.0f'\n", y,
            floor(fmax(10, fmin(size, fits))));
}

void br_write_caption(FILE *out, const struct br_report *report, int width)
{
    char line[1024];
    const double size = FONT + 2;
    snprintf(line, sizeof line, "%s", report->caption);
    char *second = line + strlen(line) / 2;
    while (*second && *second != ' ')
        second++;
    if (!*second || 0.6 * size * (double)strlen(line) < 0.96 * width) {
        write_caption_line(out, line, width, size, 0.955);
        return;
    }
    *second++ = '\0';
    write_caption_line(out, line, width, BR_PAGE_SMALL, 0.972);
    write_caption_line(out, second, width, BR_PAGE_SMALL, 0.939);
}

/* Whether a curve of these parts has a hollow mark. */
static bool has_hollow(const struct br_report *report, const struct br_columns *columns)
{
    const struct br_study *study = br_report_fitted(report);
    for (size_t i = 0; i < study->n_count * study->k_count; i++)
        for (size_t p = 0; p < columns->parts; p++) {
            const enum br_flag flag = study->cell[i].flag[columns->part[p]];
            if (flag != BR_FLAG_NONE && flag != BR_FLAG_FAILED)
                return true;
        }
    return false;
}

void br_write_hollow(FILE *out, const struct br_report *report, const struct br_columns *columns,
                     double x, double y)
{
    if (has_hollow(report, columns))
        fprintf(out, "set label 'hollow: not in the fits' at screen %.3f,%.3f right font ',%d'\n",
                x, y, BR_PAGE_SMALL);
}

static void write_order(FILE *out, const char *before, const struct br_estimate *order,
                        const char *variable)
{
    char text[64];
    fprintf(out, "%s %s in %s", before, br_order_text(order, text, sizeof text), variable);
}

/* What the fit says, or why it says nothing. */
static const char *fit_verdict(const struct br_joint_fit *fit)
{
    if (!fit->converged)
        return "none could be made";
    return br_joint_describes(fit) ? "order" : "does not describe these errors";
}

void br_write_orders(FILE *out, const struct br_report *report, enum br_part part, double y)
{
    const struct br_joint_fit *fit = &report->fits[part].joint;
    const bool described = br_joint_describes(fit);
    const bool space = described && br_order_determined(&fit->p);
    const bool time = described && br_order_determined(&fit->q);
    fprintf(out, "set label 'Joint fit (95 %%), %s: ", br_part_names[part]);
    fputs(fit_verdict(fit), out);
    if (space)
        write_order(out, "", &fit->p, "h");
    if (time)
        write_order(out, space ? "," : "", &fit->q, "k");
    fprintf(out, "' at screen 0.02,%.3f left font ',%d'\n", y, BR_PAGE_SMALL);
}
