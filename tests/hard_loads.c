/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/hard_loads.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct hard_kind_row hard_kinds[HARD_KINDS] = {
#define X(name, text, share) {text, share},
    HARD_KIND_LIST(X)
#undef X
};

/* An expression has at most 1023 characters. */
enum { MOST_SUMMANDS = 10 };

static const long double pi = 3.14159265358979323846264338327950288L;

/* ---- drawing a factor, and writing the expression that it is ---- */

static double uniform(struct hard_load *c, double low, double high)
{
    return br_test_uniform(&c->random, low, high);
}

static double decades(struct hard_load *c, double low, double high)
{
    return br_test_log_uniform(&c->random, low, high);
}

static bool coin(struct hard_load *c)
{
    return br_test_index(&c->random, 2);
}

/* The number that six digits make of one: so that long sums have short texts. */
static double brief(double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.6g", value);
    return strtod(text, NULL);
}

/* A smooth factor of size one in v ("x" or "t") over [0, range]. */
static struct oracle_factor draw_smooth(struct hard_load *c, double range, const char *v,
                                        char *text)
{
    struct oracle_factor f = {.kind = ORACLE_WAVE, .p = {brief(uniform(c, 1, 9) / range)}};
    switch (br_test_index(&c->random, 3)) {
    case 0:
        strcpy(text, "1");
        return oracle_one();
    case 1:
        f = (struct oracle_factor){.kind = ORACLE_POWER, .p = {1 + coin(c)}};
        sprintf(text, "%s^%g", v, f.p[0]);
        return f;
    default:
        sprintf(text, "sin(%.17g*%s)", f.p[0], v);
        return f;
    }
}

/* What a smooth factor's size is. */
static double size_of(const struct oracle_factor *f, double range)
{
    return f->kind == ORACLE_POWER ? pow(range, f->p[0]) : 1;
}

static struct oracle_factor draw_gauss(double middle, double width, const char *v, char *text)
{
    sprintf(text, "exp(-((%s - %.17g)/%.17g)^2)", v, middle, width);
    return (struct oracle_factor){.kind = ORACLE_GAUSS, .p = {middle, width}};
}

static struct oracle_factor draw_hat(struct hard_load *c, double middle, double width,
                                     const char *v, char *text)
{
    sprintf(text,
            coin(c) ? "max(0, 1 - abs(%s - %.17g)/%.17g)" : "(1 - min(1, abs(%s - %.17g)/%.17g))",
            v, middle, width);
    return (struct oracle_factor){.kind = ORACLE_HAT, .p = {middle, width}};
}

/* 1 within half a width of the middle. */
static struct oracle_factor draw_box(struct hard_load *c, double middle, double width,
                                     const char *v, struct oracle_step *step, char *text)
{
    double a = middle - width / 2, b = a + width;
    step[0] = (struct oracle_step){a, 1};
    step[1] = (struct oracle_step){b, -1};
    switch (br_test_index(&c->random, 4)) {
    case 0:
        sprintf(text, "(step(%s - %.17g) - step(%s - %.17g))", v, a, v, b);
        break;
    case 1:
        sprintf(text, "((%s > %.17g) && (%s < %.17g) ? 1 : 0)", v, a, v, b);
        break;
    default:
        sprintf(text,
                coin(c) ? "(abs(%s - %.17g) < %.17g ? 1 : 0)" : "step(-abs(%s - %.17g) + %.17g)", v,
                middle, width / 2);
        step[0].at = (long double)middle - width / 2;
        step[1].at = (long double)middle + width / 2;
    }
    return (struct oracle_factor){.kind = ORACLE_STEPS, .step = step, .steps = 2};
}

static struct oracle_factor draw_narrow(struct hard_load *c, double middle, double width,
                                        const char *v, struct oracle_step *step, char *text)
{
    switch (br_test_index(&c->random, 4)) {
    case 0:
        return draw_hat(c, middle, width, v, text);
    case 1:
        return draw_gauss(middle, width, v, text);
    default:
        return draw_box(c, middle, width, v, step, text);
    }
}

static int ascending(const void *a, const void *b)
{
    const long double x = ((const struct oracle_step *)a)->at,
                      y = ((const struct oracle_step *)b)->at;
    return (x > y) - (x < y);
}

/* 1 to 100 jumps over [0, range]: a square wave, or a sum of steps. */
static struct oracle_factor draw_jumps(struct hard_load *c, double range, const char *v,
                                       struct oracle_step *step, char *text)
{
    const size_t count = (size_t)decades(c, 1, 101);
    struct oracle_factor f = {.kind = ORACLE_STEPS, .step = step};
    if (count > MOST_SUMMANDS || coin(c)) {
        const double rate = brief(3.14159 * ((double)count + uniform(c, 0.05, 0.95)) / range);
        for (; f.steps <= count; f.steps++)
            step[f.steps] =
                (struct oracle_step){(long double)f.steps * pi / rate, f.steps % 2 ? -1 : 1};
        sprintf(text, "step(sin(%.17g*%s))", rate, v);
        return f;
    }
    text += sprintf(text, "(0");
    for (; f.steps < count; f.steps++) {
        const double at = brief(uniform(c, 0, range)), height = brief(uniform(c, -1, 1));
        step[f.steps] = (struct oracle_step){at, height};
        text += sprintf(text, "%+.15g*step(%s-%.15g)", height, v, at);
    }
    strcpy(text, ")");
    qsort(step, count, sizeof *step, ascending);
    return f;
}

/* ---- drawing a trial ---- */

static double first_root(const struct hard_load *c)
{
    return (double)oracle_root(c->problem.bending, 1);
}

/* Length, mass and stiffness over decades; the time and the damping by what they mean: omega T and
 * the first mode's damping ratio. */
static void draw_beam(struct hard_load *c, bool moving)
{
    struct oracle_problem *p = &c->problem;
    p->bending = coin(c);
    p->length = decades(c, 0.01, 100);
    p->density = decades(c, 1e-3, 1e3);
    c->duration = decades(c, 1e-3, 1e3);
    const double damping = decades(c, moving ? 0.1 : 0.03, 10);
    const double omega = decades(c, 0.3, damping > 1 ? 300 : 30) / c->duration;
    const double lambda = pow(first_root(c) / p->length, p->bending ? 4 : 2);
    p->stiffness = p->density * omega * omega / lambda;
    p->viscosity = 2 * damping * p->stiffness / omega;
    c->unit = decades(c, 1e-3, 1e3);
}

struct drawn {
    double sharp;
    char space[HARD_TEXT / 2], time[HARD_TEXT / 2];
};

/* Appends a term to the trial and to the text of its place. */
static void add_term(struct hard_load *c, struct oracle_term term, const struct drawn *d,
                     char load[3][HARD_TEXT])
{
    char *text = load[term.place] + strlen(load[term.place]);
    text += sprintf(text, " %s %.17g*%s", *load[term.place] ? "+" : "", term.amplitude, d->time);
    if (term.place == ORACLE_SPREAD)
        sprintf(text, "*%s", d->space);
    c->sharp[c->terms] = d->sharp;
    c->term[c->terms++] = term;
}

static double unit_of(const struct hard_load *c, const struct oracle_term *term)
{
    return c->unit * pow(c->problem.length, term->place);
}

static void draw_place(struct hard_load *c, struct oracle_term *term)
{
    const size_t places = c->problem.bending ? 3 : 2;
    term->place = (enum oracle_place)(coin(c) ? 0 : br_test_index(&c->random, places));
}

static void add_smooth(struct hard_load *c, char load[3][HARD_TEXT])
{
    static struct drawn d;
    d.sharp = 1;
    struct oracle_term term = {.place = ORACLE_SPREAD};
    draw_place(c, &term);
    term.space = draw_smooth(c, c->problem.length, "x", d.space);
    term.time = draw_smooth(c, c->duration, "t", d.time);
    if (term.place != ORACLE_SPREAD)
        term.space = oracle_one();
    term.amplitude = unit_of(c, &term) / size_of(&term.space, c->problem.length) /
                     size_of(&term.time, c->duration);
    add_term(c, term, &d, load);
}

/* A blow: its amplitude a multiple of the smooth load's, or such that its impulse is a share of
 * the smooth load's. */
static void draw_blow(struct hard_load *c, struct oracle_term *term, struct drawn *d)
{
    const double width = brief(decades(c, 1e-8, 1) * c->duration);
    const double middle = brief(uniform(c, 0.05, 0.95) * c->duration);
    term->time = br_test_index(&c->random, 4) ? draw_gauss(middle, width, "t", d->time)
                                              : draw_hat(c, middle, width, "t", d->time);
    d->sharp = fmin(d->sharp, width / c->duration);
    term->amplitude *=
        c->kind == HARD_BLOW ? decades(c, 1, 1e4) : decades(c, 1e-3, 10) * c->duration / width;
    c->quick[c->terms] = middle;
}

static void draw_patch(struct hard_load *c, struct oracle_term *term, struct drawn *d)
{
    const double length = c->problem.length, width = decades(c, 1e-8, 0.99) * length;
    double middle = uniform(c, width / 2, length - width / 2);
    if (br_test_index(&c->random, 8) == 0)
        middle = coin(c) ? width / 2 : length - width / 2;
    term->space = draw_narrow(c, middle, width, "x", c->step[c->terms][0], d->space);
    d->sharp = fmin(d->sharp, width / length);
    term->amplitude *= decades(c, 1e-2, 10) * length / width;
}

static void add_hard(struct hard_load *c, enum hard_kind kind, char load[3][HARD_TEXT])
{
    static struct drawn d;
    d.sharp = 1;
    struct oracle_term term = {.place = ORACLE_SPREAD};
    const bool spread = kind == HARD_PATCH || kind == HARD_BOTH || kind == HARD_JUMPS_X;
    if (!spread)
        draw_place(c, &term);
    term.amplitude = unit_of(c, &term);
    strcpy(d.space, "1");
    term.space = oracle_one();
    if (!spread && term.place == ORACLE_SPREAD)
        term.space = draw_smooth(c, c->problem.length, "x", d.space);
    term.time = draw_smooth(c, c->duration, "t", d.time);
    if (kind == HARD_PATCH || kind == HARD_BOTH)
        draw_patch(c, &term, &d);
    if (kind == HARD_JUMPS_X)
        term.space = draw_jumps(c, c->problem.length, "x", c->step[c->terms][0], d.space);
    if (kind == HARD_JUMPS_T)
        term.time = draw_jumps(c, c->duration, "t", c->step[c->terms][1], d.time);
    if (kind == HARD_BLOW || kind == HARD_STRONG || kind == HARD_BOTH)
        draw_blow(c, &term, &d);
    term.amplitude /= size_of(&term.space, c->problem.length) * size_of(&term.time, c->duration);
    add_term(c, term, &d, load);
}

/* A front or a pulse that runs through the beam, either way, perhaps from inside; or swings. */
static void add_moving(struct hard_load *c, char load[3][HARD_TEXT])
{
    static struct drawn d;
    const double length = c->problem.length;
    struct oracle_step *step = c->step[c->terms][0];
    struct oracle_term term = {.amplitude = c->unit, .moving = true};
    char place[200];
    d.sharp = 1;
    if (br_test_index(&c->random, 4) == 0) {
        term.start = brief(0.5 * length);
        term.swing = brief(uniform(c, 0.05, 0.3) * length);
        term.rate = brief(uniform(c, 1, 12) / c->duration);
        sprintf(place, "(%.17g + %.17g*sin(%.17g*t))", term.start, term.swing, term.rate);
    } else {
        term.start = brief(coin(c) ? 0 : uniform(c, -0.3, 1) * length);
        term.speed = brief(uniform(c, 0.3, 3) * length / c->duration);
        if (coin(c)) {
            term.start = brief(length - term.start);
            term.speed = -term.speed;
        }
        sprintf(place, "(%.17g + %.17g*t)", term.start, term.speed);
    }
    term.time = draw_smooth(c, c->duration, "t", d.time);
    term.amplitude /= size_of(&term.time, c->duration);
    if (c->kind == HARD_FRONT) {
        const bool right = coin(c);
        step[0] = (struct oracle_step){right ? 0 : -INFINITY, 1};
        step[1] = (struct oracle_step){0, -1};
        term.space =
            (struct oracle_factor){.kind = ORACLE_STEPS, .step = step, .steps = right ? 1 : 2};
        sprintf(d.space,
                coin(c) ? "(x %c %s ? 1 : 0)"
                : right ? "step(x %c %s)"
                        : "step(-(x %c %s))",
                right ? '>' : '<', place);
        char *sign = strstr(d.space, "step") ? strpbrk(d.space, "<>") : NULL;
        if (sign)
            *sign = '-';
    } else {
        /* A wide one costs the oracle much where there are many modes. */
        const double widest = c->problem.bending ? 0.1 : 3e-3;
        const double width = brief(decades(c, 1e-8, widest) * length);
        char v[220];
        sprintf(v, "(x - %s)", place);
        term.space = draw_narrow(c, 0, width, v, step, d.space);
        term.amplitude *= decades(c, 1e-2, 10) * length / width;
        d.sharp = width / length;
    }
    add_term(c, term, &d, load);
}

/* Initial data in the first eigenfunction, which is moved by a small share of what the loads do. */
static void write_initial(struct hard_load *c, char *text)
{
    struct oracle_problem *p = &c->problem;
    const long double b = oracle_root(p->bending, 1), l = p->length;
    const double k = (double)(b / l), ratio = (double)((coshl(b) + cosl(b)) / (sinhl(b) + sinl(b)));
    const double lambda = pow(k, p->bending ? 4 : 2);
    p->displacement = brief(uniform(c, -1, 1) * c->unit / (p->stiffness * lambda));
    p->velocity =
        brief(uniform(c, -1, 1) * c->unit * c->duration / (p->viscosity * lambda * c->duration));
    const double given[] = {p->displacement, p->velocity};
    static const char *const name[] = {"displacement", "velocity"}, *const unit[] = {"m", "m/s"},
                             *const slope_unit[] = {"1", "1/s"};
    for (int i = 0; i < 2; i++)
        if (!p->bending)
            text += sprintf(text, "  %s: sqrt(2)*%.17g*sin(%.17g*x) [%s]\n", name[i], given[i], k,
                            unit[i]);
        else
            text += sprintf(text,
                            "  %s: %.17g*(cosh(%.17g*x) - cos(%.17g*x) - %.17g*(sinh(%.17g*x) - "
                            "sin(%.17g*x))) [%s]\n"
                            "  %s_slope: %.17g*%.17g*(sinh(%.17g*x) + sin(%.17g*x) - "
                            "%.17g*(cosh(%.17g*x) - cos(%.17g*x))) [%s]\n",
                            name[i], given[i], k, k, ratio, k, k, unit[i], name[i], given[i], k, k,
                            k, ratio, k, k, slope_unit[i]);
}

static void write_scene(struct hard_load *c, char load[3][HARD_TEXT])
{
    static const char *const key[][3] = {{"load", "tip_force", ""},
                                         {"load", "tip_force", "tip_moment"}};
    static const char *const unit[] = {"N/m", "N", "N m"};
    struct oracle_problem *p = &c->problem;
    char *text = c->text;
    text += sprintf(text,
                    "title: Hard loads\nlength: %.17g m\nduration: %.17g s\ndensity: %.17g kg/m\n"
                    "%s:\n  stiffness: %.17g N%s\n  viscosity: %.17g N%s s\n",
                    p->length, c->duration, p->density, p->bending ? "bending" : "axial",
                    p->stiffness, p->bending ? " m^2" : "", p->viscosity, p->bending ? " m^2" : "");
    for (int i = 0; i < 3; i++)
        if (*load[i])
            text += snprintf(text, (size_t)(c->text + HARD_TEXT - text), "  %s: \"%s [%s]\"\n",
                             key[p->bending][i], load[i], unit[i]);
    if (c->number % 3 == 0)
        write_initial(c, text);
}

static int ascending_times(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Random times, the last, and one in or just after each blow; in a rod no sooner than the modes of
 * the oracle have followed. */
static void draw_times(struct hard_load *c)
{
    for (size_t i = 0; i < c->terms && c->times < HARD_TIMES - 3; i++) {
        const double width = c->sharp[i] * c->duration;
        const double wait = c->problem.bending ? width : fmax(width, 1e-4 * c->duration);
        if (c->quick[i] != 0)
            c->t[c->times++] =
                c->quick[i] + uniform(c, wait > width ? 0.1 : -1, 9) * fmin(wait, c->quick[i] / 10);
    }
    for (c->t[c->times++] = c->duration; c->times < HARD_TIMES; c->times++)
        c->t[c->times] = uniform(c, 0.001, 1) * c->duration;
    for (size_t i = 0; i < HARD_TIMES; i++)
        c->t[i] = fmin(c->t[i], c->duration);
    qsort(c->t, HARD_TIMES, sizeof *c->t, ascending_times);
}

static void begin(struct hard_load *c, size_t number)
{
    memset(c, 0, sizeof *c);
    c->random.state = 20261122 + 7919 * number;
    c->number = number;
}

void hard_load_draw(struct hard_load *c, size_t number)
{
    static char load[3][HARD_TEXT];
    begin(c, number);
    c->kind = (enum hard_kind)(number % HARD_KINDS);
    load[0][0] = load[1][0] = load[2][0] = '\0';
    draw_beam(c, c->kind == HARD_FRONT || c->kind == HARD_PULSE);
    if (c->kind == HARD_FRONT || c->kind == HARD_PULSE)
        add_moving(c, load);
    else if (c->kind != HARD_SUM)
        add_hard(c, c->kind, load);
    for (enum hard_kind kind = HARD_STRONG; c->kind == HARD_SUM && kind <= HARD_JUMPS_X; kind++)
        if (br_test_index(&c->random, 3))
            add_hard(c, kind, load);
    if (c->kind == HARD_BLOW || c->kind == HARD_STRONG || c->terms == 0 ||
        br_test_index(&c->random, 3))
        add_smooth(c, load);
    write_scene(c, load);
    draw_times(c);
}

void hard_load_draw_at_clamp(struct hard_load *c, size_t number)
{
    static char load[3][HARD_TEXT];
    static struct drawn d;
    begin(c, number);
    c->kind = HARD_PATCH;
    load[0][0] = load[1][0] = load[2][0] = '\0';
    while (!c->problem.bending)
        draw_beam(c, false);
    struct oracle_term term = {.place = ORACLE_SPREAD};
    const double width = decades(c, 1e-8, 1e-2) * c->problem.length;
    const double middle = width * (coin(c) ? 0.5 : uniform(c, 0.5, 20));
    d.sharp = 1; /* numbers this small know their last place */
    term.time = draw_smooth(c, c->duration, "t", d.time);
    term.space = draw_narrow(c, middle, width, "x", c->step[0][0], d.space);
    term.amplitude = c->unit / size_of(&term.time, c->duration) * pow(c->problem.length / width, 3);
    add_term(c, term, &d, load);
    write_scene(c, load);
    draw_times(c);
}
