/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plots/page.h"

#include <math.h>
#include <string.h>

enum { HEIGHT = BR_PAGE_HEIGHT, FONT = BR_PAGE_FONT };

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
        .size = 3.4 - 1.8 * along,
    };
}

void br_write_quoted(FILE *out, const char *text)
{
    fputc('\'', out);
    for (; *text; text++) {
        if (*text == '\'')
            fputc('\'', out);
        fputc(*text == '\n' || *text == '\r' ? ' ' : *text, out);
    }
    fputc('\'', out);
}

void br_write_head(FILE *out, const struct br_report *report, const struct br_plot *plot,
                   const char *stem)
{
    fputs("# SPDX-License-Identifier: GPL-3.0-or-later\n# ", out);
    br_write_comment(out, report->caption);
    fprintf(out,
            "# %s\n"
            "# Reads %s.dat and writes %s.svg and %s.png. Edit it, and draw them again with\n"
            "#     gnuplot %s.gp\n"
            "# in this folder.\n\n"
            "set encoding utf8\n"
            "data = ",
            plot->title, stem, stem, stem, stem);
    br_write_quoted(out, stem);
    fputs(".'.dat'\n\n"
          "# A cell with a flag, left out of the fits, has a hollow mark.\n"
          "mark(filled, flag) = flag eq '-' ? filled : filled - 1\n"
          "set pointintervalbox 1.3\n"
          "set style line 101 lw 2 lc rgb '#444444' # slopes\n"
          "set style line 102 lw 1 lc rgb '#d0d0d0' # grid\n",
          out);
}

void br_write_pens(FILE *out, size_t pens)
{
    fputs("# One pen a curve; pi -1: the line leaves room for the marks.\n", out);
    for (size_t i = 0; i < pens; i++) {
        const struct br_pen pen = br_pen_of(i, pens);
        fprintf(out, "set style line %zu lw 2.5 lc rgb '%s' dt %s pt %d ps %.2f*size pi -1\n", i + 1,
                pen.colour, pen.dash, pen.mark, pen.size);
    }
}

void br_write_loop(FILE *out, const char *stem, int width)
{
    fprintf(out,
            "\ndo for [format in 'svg png'] {\n"
            "if (format eq 'svg') {\n"
            "    set terminal svg size %d,%d font 'DejaVu Sans,%d' background rgb 'white'\n"
            "    size = 0.42 # this terminal draws marks larger, and letters smaller\n"
            "} else {\n"
            "    set terminal pngcairo size %d,%d font 'DejaVu Sans,%d' fontscale 0.75\n"
            "    size = 1\n"
            "}\n"
            "set output ",
            width, HEIGHT, FONT, width, HEIGHT, FONT);
    br_write_quoted(out, stem);
    fputs(".'.'.format\nunset label\nunset arrow\n", out);
}

void br_write_foot(FILE *out)
{
    fputs("unset output\n}\n", out);
}

void br_write_caption(FILE *out, const struct br_report *report, int width)
{
    const double letters = (double)strlen(report->caption), fit = width / 0.62 / (FONT + 2);
    const double size = fmax(12, (FONT + 2) * fmin(1, fit / letters));
    fputs("set label ", out);
    br_write_quoted(out, report->caption);
    fprintf(out, " noenhanced at screen 0.02,0.955 left font ',%.0f'\n", floor(size));
}

static void write_estimate(FILE *out, const char *name, const struct br_estimate *estimate)
{
    fprintf(out, "%s %.2f", name, estimate->value);
    if (isfinite(estimate->low) && isfinite(estimate->high))
        fprintf(out, " [%.2f, %.2f]", estimate->low, estimate->high);
}

void br_write_orders(FILE *out, const struct br_report *report, enum br_part part, double y)
{
    const struct br_joint_fit *fit = &report->fits[part].joint;
    const bool space = fit->converged && isfinite(fit->p.value);
    const bool time = fit->converged && isfinite(fit->q.value);
    fprintf(out, "set label 'Fitted orders (95 %%), %s:", br_part_names[part]);
    if (space)
        write_estimate(out, " in h", &fit->p);
    if (time)
        write_estimate(out, space ? ", in k" : " in k", &fit->q);
    fprintf(out, "%s' at screen 0.02,%.3f left font ',%d'\n", space || time ? "" : " none",
            y, BR_PAGE_SMALL);
}
