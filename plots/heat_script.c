/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A heat map's script. Colours: viridis, whose lightness rises steadily, so that a grey print tells
 * the same (Smith and van der Walt, 2015). */
#include <math.h>
#include <string.h>

#include "plots/heat.h"
#include "plots/page.h"
#include "study/scene/quote.h"

static const char *const viridis[] = {"#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
                                      "#28ae80", "#5ec962", "#addc30", "#fde725"};
enum { COLOURS = sizeof viridis / sizeof *viridis };

static const char *const dashes[BR_HEAT_LINES] = {"solid", "(10,5)", "(3,4)", "(12,4,3,4)"};

/* ---- the key: kinds, empty cells, and lines by their titles, whichever panel has them ---- */

struct key {
    const char *title[BR_HEAT_PANELS * BR_HEAT_LINES];
    size_t lines;
    bool empty;
    size_t columns, rows;
};

static size_t line_place(const struct key *key, const char *title)
{
    size_t i = 0;
    while (i < key->lines && strcmp(key->title[i], title) != 0)
        i++;
    return i;
}

enum { MOST_COLUMNS = 4, LETTER = 12, SAMPLE = 95, KEY_ROW = 30 }; /* pixels */

/* As many columns as the longest title leaves room for. */
static void arrange(const struct br_heat *heat, struct key *key)
{
    const size_t entries = heat->kinds + key->empty + key->lines;
    size_t longest = 1;
    for (size_t i = 0; i < heat->kinds; i++)
        longest = strlen(heat->kind[i]) > longest ? strlen(heat->kind[i]) : longest;
    for (size_t i = 0; i < key->lines; i++)
        longest = strlen(key->title[i]) > longest ? strlen(key->title[i]) : longest;
    const size_t fit = BR_PAGE_WIDE / (longest * LETTER + SAMPLE);
    key->columns = fit < 1 ? 1 : fit > MOST_COLUMNS ? MOST_COLUMNS : fit;
    key->rows = (entries + key->columns - 1) / key->columns;
}

static void collect(const struct br_heat *heat, struct key *key)
{
    *key = (struct key){.lines = 0};
    for (size_t i = 0; i < heat->panels; i++) {
        const struct br_heat_panel *p = &heat->panel[i];
        for (size_t j = 0; j < p->lines; j++) {
            const size_t at = line_place(key, p->line[j].title);
            key->title[at] = p->line[j].title;
            key->lines += at == key->lines;
        }
        for (size_t c = 0; c < p->rows * p->columns; c++)
            key->empty |= !br_heat_told(heat, p->value[c]);
    }
    arrange(heat, key);
}

/* Where panels stand on the page: rows of at most three. */
struct layout {
    size_t across, down;
    int height;                                 /* of the page, pixels */
    double left, right, top, bottom, gap, rise; /* of all panels, and between them; screen units */
    double key;                                 /* the height of the key, below them */
};

static struct layout lay_out(const struct br_heat *heat, const struct key *key)
{
    const size_t n = heat->panels ? heat->panels : 1;
    struct layout l = {.across = n <= 3 ? n : n == 4 ? 2 : 3};
    l.down = (n + l.across - 1) / l.across;
    l.height = l.down > 1 ? 1250 : BR_PAGE_HEIGHT;
    const double pixel = 1.0 / l.height;
    l.left = 0.095;
    l.right = heat->kinds ? 0.97 : 0.87;
    l.top = 1 - 125 * pixel;
    l.key = (20 + KEY_ROW * (double)(key->rows > 2 ? key->rows : 2)) * pixel;
    l.bottom = l.key + 125 * pixel;
    l.gap = l.across > 2 ? 0.085 : 0.1;
    l.rise = 165 * pixel;
    return l;
}

/* A panel's sides: left, right, bottom, top. */
static void place(const struct layout *l, size_t i, double side[4])
{
    const double across = (double)l->across, down = (double)l->down;
    const double width = (l->right - l->left - (across - 1) * l->gap) / across;
    const double height = (l->top - l->bottom - (down - 1) * l->rise) / down;
    side[0] = l->left + (double)(i % l->across) * (width + l->gap);
    side[1] = side[0] + width;
    side[3] = l->top - (double)(i / l->across) * (height + l->rise);
    side[2] = side[3] - height;
}

/* Kinds are spread over the colours, the last one the brightest. */
static const char *kind_colour(const struct br_heat *heat, size_t kind)
{
    const double along = heat->kinds > 1 ? (double)kind / (double)(heat->kinds - 1) : 0;
    return viridis[lround(along * (COLOURS - 1))];
}

/* ---- the key ---- */

static void write_pen(FILE *out, size_t line)
{
    fprintf(out, "lw 3 lc rgb 'black' dt %s", dashes[line % BR_HEAT_LINES]);
}

static const char empty_style[] = "lc rgb '#999999' fs pattern 4 border";

static void write_key(FILE *out, const struct br_heat *heat, const struct key *key,
                      const struct layout *l)
{
    const char *before = "plot ";
    fprintf(
        out,
        "\nunset label\nunset logscale\nunset tics\nunset border\nunset colorbox\n"
        "set lmargin at screen 0.02; set rmargin at screen 0.98\n"
        "set bmargin at screen 0; set tmargin at screen %.4f\n"
        "set xrange [0:1]; set yrange [0:1]\n"
        "set key at graph 0.5,0.55 center center horizontal Left reverse samplen 2.5 maxcols %zu "
        "spacing 1.2 font ',%d'\n",
        l->key, key->columns, BR_PAGE_SMALL);
    for (size_t k = 0; k < heat->kinds; k++) {
        fprintf(out, "%sNaN with boxes lc rgb '%s' fs solid 1 border title ", before,
                kind_colour(heat, k));
        br_quote(out, &br_for_gnuplot, heat->kind[k]);
        before = ", \\\n     ";
    }
    if (key->empty) {
        fprintf(out, "%sNaN with boxes %s title 'not told'", before, empty_style);
        before = ", \\\n     ";
    }
    for (size_t i = 0; i < key->lines; i++) {
        fprintf(out, "%sNaN with lines ", before);
        write_pen(out, i);
        fputs(" title ", out);
        br_quote(out, &br_for_gnuplot, key->title[i]);
        before = ", \\\n     ";
    }
    fputs("\nset border; set tics\n", out);
}

/* ---- panels ---- */

static void write_label(FILE *out, const char *text, double x, double y, const char *how, int font)
{
    fputs("set label ", out);
    br_quote(out, &br_for_gnuplot, text);
    fprintf(out, " at screen %.4f,%.4f %s font ',%d'\n", x, y, how, font);
}

static void write_axes(FILE *out, const struct br_heat_panel *p, const double side[4],
                       const struct layout *l)
{
    const double pixel = 1.0 / l->height, middle = (side[0] + side[1]) / 2;
    fprintf(out,
            "set lmargin at screen %.4f; set rmargin at screen %.4f\n"
            "set bmargin at screen %.4f; set tmargin at screen %.4f\n"
            "set format x '%s'; set format y '%s'\n",
            side[0], side[1], side[2], side[3], p->log_x ? "10^{%L}" : "%g",
            p->log_y ? "10^{%L}" : "%g");
    if (p->log_x) /* a label every three decades where there are many */
        fprintf(out, "set xtics %g\n", p->x[p->columns] / p->x[0] > 1e9 ? 1e3 : 10.0);
    else
        fputs("set xtics autofreq\n", out);
    if (p->log_x || p->log_y)
        fprintf(out, "set logscale %s%s\n", p->log_x ? "x" : "", p->log_y ? "y" : "");
    fprintf(out, "set xrange [%.12g:%.12g]; set yrange [%.12g:%.12g]\n", p->x[0], p->x[p->columns],
            p->y[0], p->y[p->rows]);
    write_label(out, p->x_label, middle, side[2] - 72 * pixel, "center", BR_PAGE_FONT);
    write_label(out, p->y_label, side[0] - (l->across > 2 ? 0.06 : 0.073), (side[2] + side[3]) / 2,
                "center rotate", BR_PAGE_FONT);
    write_label(out, p->title, middle, side[3] + 28 * pixel, "center", BR_PAGE_FONT);
}

/* One bar for all panels, right of them. */
static void write_bar(FILE *out, const struct br_heat *heat, const struct layout *l)
{
    double low, high;
    br_heat_range(heat, &low, &high);
    fprintf(out, "set cbrange [%.12g:%.12g]\nset format cb '%s'\n", low, high,
            heat->log_value ? "10^{%L}" : "%g");
    if (heat->log_value)
        fputs("set logscale cb\n", out);
    fprintf(out, "set colorbox user origin screen 0.895,%.4f size screen 0.02,%.4f\n", l->bottom,
            l->top - l->bottom);
    write_label(out, heat->value_label, 0.978, (l->top + l->bottom) / 2, "center rotate",
                BR_PAGE_FONT);
}

/* The cells of one kind, or all whose value is told; borders hide the seams between cells. */
static void write_clause(FILE *out, size_t index, const char *test, const char *colour,
                         const char *style)
{
    fprintf(out, "data index %zu using (%s ? $1 : NaN):2:3:4:5:6%s with boxxyerror %s notitle",
            index, test, colour, style);
}

static void write_cells(FILE *out, const struct br_heat *heat, size_t index)
{
    char test[64], style[96];
    fputs("plot ", out);
    write_clause(out, index, "$9 == 0", "", empty_style);
    if (!heat->kinds) {
        fputs(", \\\n     ", out);
        write_clause(out, index, "$9 == 1", ":8", "lc palette lw 0.5 fs solid 1 border");
    }
    for (size_t k = 0; k < heat->kinds; k++) {
        snprintf(test, sizeof test, "$9 == 1 && $8 == %zu", k);
        snprintf(style, sizeof style, "lc rgb '%s' lw 0.5 fs solid 1 border", kind_colour(heat, k));
        fputs(", \\\n     ", out);
        write_clause(out, index, test, "", style);
    }
}

static void write_lines(FILE *out, const struct br_heat_panel *p, const struct key *key,
                        size_t index)
{
    for (size_t j = 0; j < p->lines; j++) {
        fprintf(out,
                ", \\\n     data index %zu using 1:2 with lines lw 8 lc rgb 'white' notitle"
                ", \\\n     data index %zu using 1:2 with lines ",
                index + j, index + j);
        write_pen(out, line_place(key, p->line[j].title));
        fputs(" notitle", out);
    }
    fputc('\n', out);
}

static void write_panel(FILE *out, const struct br_heat *heat, size_t i, size_t index,
                        const struct layout *l)
{
    const struct br_heat_panel *p = &heat->panel[i];
    struct key key;
    double side[4];
    collect(heat, &key);
    place(l, i, side);
    fputs("\nunset label\nunset logscale\nunset key\nunset colorbox\n", out);
    if (i == 0) {
        fputs("set label ", out);
        br_quote(out, &br_for_gnuplot, heat->title);
        fprintf(out, " noenhanced at screen 0.02,%.4f left font ',%d'\n", 1 - 36.0 / l->height,
                BR_PAGE_FONT + 2);
    }
    write_axes(out, p, side, l);
    if (!heat->kinds && i == 0)
        write_bar(out, heat, l);
    else if (!heat->kinds && heat->log_value)
        fputs("set logscale cb\n", out);
    write_cells(out, heat, index);
    write_lines(out, p, &key, index + 1);
}

static void write_head(FILE *out, const struct br_heat *heat)
{
    br_write_script_head(out, heat->title, NULL, heat->stem);
    fputs("set palette defined (", out);
    for (int i = 0; i < COLOURS; i++)
        fprintf(out, "%s%d '%s'", i ? ", " : "", i, viridis[i]);
    fputs(")\n", out);
}

void br_heat_write_script(FILE *out, const struct br_heat *heat)
{
    struct key key;
    size_t index = 0;
    collect(heat, &key);
    const struct layout l = lay_out(heat, &key);
    write_head(out, heat);
    br_write_loop(out, BR_PAGE_WIDE, l.height);
    fprintf(out,
            "set tics out nomirror font ',%d'\nset border front lw 1\nset multiplot\n"
            "set xtics autofreq; set ytics autofreq; set cbtics autofreq\n",
            BR_PAGE_SMALL);
    for (size_t i = 0; i < heat->panels; i++) {
        write_panel(out, heat, i, index, &l);
        index += 1 + heat->panel[i].lines;
    }
    if (heat->kinds || key.empty || key.lines)
        write_key(out, heat, &key, &l);
    fputs("unset multiplot\n", out);
    br_write_foot(out);
}
