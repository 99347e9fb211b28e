/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The exact reference under loads that nobody sees by sampling: short blows, narrow patches, jumps,
 * moving fronts and pulses, at random places, in random lengths, durations, masses and stiffnesses.
 * An oracle that knows where its loads are judges the tip. An answer is right within what it
 * states, or it is refused. */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "reference/exact/exact.h"
#include "study/scene_file.h"
#include "support.h"
#include "tests/modal_oracle.h"

/* Kinds of hard loads, and what share of them may be refused. */
#define KINDS(X)                            \
    X(BLOW, "blow in t", 0.05)              \
    X(STRONG, "dominant blow in t", 0.05)   \
    X(PATCH, "patch in x", 0.05)            \
    X(BOTH, "blow on a patch", 0.05)        \
    X(JUMPS_T, "1 to 100 jumps in t", 0.05) \
    X(JUMPS_X, "1 to 100 jumps in x", 0.05) \
    X(SUM, "sum of all these", 0.05)        \
    X(FRONT, "moving front", 1)             \
    X(PULSE, "moving pulse", 1)

enum kind {
#define X(name, text, share) name,
    KINDS(X)
#undef X
        COUNT_OF_KINDS
};
static const struct {
    const char *text;
    double refused_at_most;
} kinds[] = {
#define X(name, text, share) {text, share},
    KINDS(X)
#undef X
};

/* An expression has at most 1023 characters. */
enum { MOST_TERMS = 6, MOST_STEPS = 104, MOST_SUMMANDS = 10, TIMES = 6, TEXT = 16000 };

static const long double pi = 3.14159265358979323846264338327950288L;

struct trial {
    enum kind kind;
    size_t number;
    double duration; /* T, s */
    double unit;     /* a smooth load of this size, N/m, or at the tip N or N m, by place */
    struct oracle_problem problem;
    struct oracle_term term[MOST_TERMS];
    struct oracle_step step[MOST_TERMS][2][MOST_STEPS]; /* of a term's space and time */
    double sharp[MOST_TERMS]; /* a term's narrowest feature, relative to L or T */
    size_t terms, times;
    double t[TIMES];          /* ascending */
    double quick[MOST_TERMS]; /* s, a blow's middle; 0: none */
    char text[TEXT];
    struct br_test_random random;
};

/* ---- drawing a factor, and writing the expression that it is ---- */

static double uniform(struct trial *c, double low, double high)
{
    return br_test_uniform(&c->random, low, high);
}

static double decades(struct trial *c, double low, double high)
{
    return br_test_log_uniform(&c->random, low, high);
}

static bool coin(struct trial *c)
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
static struct oracle_factor draw_smooth(struct trial *c, double range, const char *v, char *text)
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

static struct oracle_factor draw_hat(struct trial *c, double middle, double width, const char *v,
                                     char *text)
{
    sprintf(text,
            coin(c) ? "max(0, 1 - abs(%s - %.17g)/%.17g)" : "(1 - min(1, abs(%s - %.17g)/%.17g))",
            v, middle, width);
    return (struct oracle_factor){.kind = ORACLE_HAT, .p = {middle, width}};
}

/* 1 within half a width of the middle. */
static struct oracle_factor draw_box(struct trial *c, double middle, double width, const char *v,
                                     struct oracle_step *step, char *text)
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

static struct oracle_factor draw_narrow(struct trial *c, double middle, double width, const char *v,
                                        struct oracle_step *step, char *text)
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
static struct oracle_factor draw_jumps(struct trial *c, double range, const char *v,
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

static double first_root(const struct trial *c)
{
    return (double)oracle_root(c->problem.bending, 1);
}

/* Length, mass and stiffness over decades; the time and the damping by what they mean: omega T and
 * the first mode's damping ratio. */
static void draw_beam(struct trial *c, bool moving)
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
    char space[TEXT / 2], time[TEXT / 2];
};

/* Appends a term to the trial and to the text of its place. */
static void add_term(struct trial *c, struct oracle_term term, const struct drawn *d,
                     char load[3][TEXT])
{
    char *text = load[term.place] + strlen(load[term.place]);
    text += sprintf(text, " %s %.17g*%s", *load[term.place] ? "+" : "", term.amplitude, d->time);
    if (term.place == ORACLE_SPREAD)
        sprintf(text, "*%s", d->space);
    c->sharp[c->terms] = d->sharp;
    c->term[c->terms++] = term;
}

static double unit_of(const struct trial *c, const struct oracle_term *term)
{
    return c->unit * pow(c->problem.length, term->place);
}

static void draw_place(struct trial *c, struct oracle_term *term)
{
    const size_t places = c->problem.bending ? 3 : 2;
    term->place = (int)(coin(c) ? 0 : br_test_index(&c->random, places));
}

static void add_smooth(struct trial *c, char load[3][TEXT])
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
static void draw_blow(struct trial *c, struct oracle_term *term, struct drawn *d)
{
    const double width = brief(decades(c, 1e-8, 1) * c->duration);
    const double middle = brief(uniform(c, 0.05, 0.95) * c->duration);
    term->time = br_test_index(&c->random, 4) ? draw_gauss(middle, width, "t", d->time)
                                              : draw_hat(c, middle, width, "t", d->time);
    d->sharp = fmin(d->sharp, width / c->duration);
    term->amplitude *=
        c->kind == BLOW ? decades(c, 1, 1e4) : decades(c, 1e-3, 10) * c->duration / width;
    c->quick[c->terms] = middle;
}

static void draw_patch(struct trial *c, struct oracle_term *term, struct drawn *d)
{
    const double length = c->problem.length, width = decades(c, 1e-8, 0.99) * length;
    double middle = uniform(c, width / 2, length - width / 2);
    if (br_test_index(&c->random, 8) == 0)
        middle = coin(c) ? width / 2 : length - width / 2;
    term->space = draw_narrow(c, middle, width, "x", c->step[c->terms][0], d->space);
    d->sharp = fmin(d->sharp, width / length);
    term->amplitude *= decades(c, 1e-2, 10) * length / width;
}

static void add_hard(struct trial *c, enum kind kind, char load[3][TEXT])
{
    static struct drawn d;
    d.sharp = 1;
    struct oracle_term term = {.place = ORACLE_SPREAD};
    const bool spread = kind == PATCH || kind == BOTH || kind == JUMPS_X;
    if (!spread)
        draw_place(c, &term);
    term.amplitude = unit_of(c, &term);
    strcpy(d.space, "1");
    term.space = oracle_one();
    if (!spread && term.place == ORACLE_SPREAD)
        term.space = draw_smooth(c, c->problem.length, "x", d.space);
    term.time = draw_smooth(c, c->duration, "t", d.time);
    if (kind == PATCH || kind == BOTH)
        draw_patch(c, &term, &d);
    if (kind == JUMPS_X)
        term.space = draw_jumps(c, c->problem.length, "x", c->step[c->terms][0], d.space);
    if (kind == JUMPS_T)
        term.time = draw_jumps(c, c->duration, "t", c->step[c->terms][1], d.time);
    if (kind == BLOW || kind == STRONG || kind == BOTH)
        draw_blow(c, &term, &d);
    term.amplitude /= size_of(&term.space, c->problem.length) * size_of(&term.time, c->duration);
    add_term(c, term, &d, load);
}

/* A front or a pulse that runs through the beam, either way, perhaps from inside; or swings. */
static void add_moving(struct trial *c, char load[3][TEXT])
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
    if (c->kind == FRONT) {
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
static void write_initial(struct trial *c, char *text)
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

static void write_scene(struct trial *c, char load[3][TEXT])
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
            text += snprintf(text, (size_t)(c->text + TEXT - text), "  %s: \"%s [%s]\"\n",
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
static void draw_times(struct trial *c)
{
    for (size_t i = 0; i < c->terms && c->times < TIMES - 3; i++) {
        const double width = c->sharp[i] * c->duration;
        const double wait = c->problem.bending ? width : fmax(width, 1e-4 * c->duration);
        if (c->quick[i] != 0)
            c->t[c->times++] =
                c->quick[i] + uniform(c, wait > width ? 0.1 : -1, 9) * fmin(wait, c->quick[i] / 10);
    }
    for (c->t[c->times++] = c->duration; c->times < TIMES; c->times++)
        c->t[c->times] = uniform(c, 0.001, 1) * c->duration;
    for (size_t i = 0; i < TIMES; i++)
        c->t[i] = fmin(c->t[i], c->duration);
    qsort(c->t, TIMES, sizeof *c->t, ascending_times);
}

static void draw(struct trial *c, size_t number)
{
    static char load[3][TEXT];
    memset(c, 0, sizeof *c);
    c->random.state = 20261122 + 7919 * number;
    c->number = number;
    c->kind = (enum kind)(number % COUNT_OF_KINDS);
    load[0][0] = load[1][0] = load[2][0] = '\0';
    draw_beam(c, c->kind == FRONT || c->kind == PULSE);
    if (c->kind == FRONT || c->kind == PULSE)
        add_moving(c, load);
    else if (c->kind != SUM)
        add_hard(c, c->kind, load);
    for (enum kind kind = STRONG; c->kind == SUM && kind <= JUMPS_X; kind++)
        if (br_test_index(&c->random, 3))
            add_hard(c, kind, load);
    if (c->kind == BLOW || c->kind == STRONG || c->terms == 0 || br_test_index(&c->random, 3))
        add_smooth(c, load);
    write_scene(c, load);
    draw_times(c);
}

/* ---- the truth ---- */

struct truth {
    struct oracle_tip tip[TIMES];
    /* What the scene's own numbers leave open: that a narrow load moves by 4 units in the last
     * place of the length or of the duration; and round-off of the largest value. */
    long double round_off[2]; /* of displacement, m, and velocity, m/s */
};

static long double largest(const struct oracle_tip *tip, bool velocity)
{
    long double most = 0;
    for (size_t k = 0; k < TIMES; k++)
        most = fmaxl(most, fabsl(velocity ? tip[k].velocity : tip[k].displacement));
    return most;
}

static void find_truth(const struct trial *c, bool finer, struct truth *truth)
{
    struct oracle_problem problem = c->problem;
    problem.finer = finer;
    *truth = (struct truth){0};
    oracle_initial(&problem, TIMES, c->t, truth->tip);
    for (size_t i = 0; i < c->terms; i++) {
        struct oracle_tip tip[TIMES] = {0};
        oracle_term(&problem, &c->term[i], TIMES, c->t, tip);
        for (size_t k = 0; k < TIMES; k++) {
            truth->tip[k].displacement += tip[k].displacement;
            truth->tip[k].velocity += tip[k].velocity;
            truth->tip[k].displacement_error += tip[k].displacement_error;
            truth->tip[k].velocity_error += tip[k].velocity_error;
        }
        for (int v = 0; v < 2; v++)
            truth->round_off[v] +=
                largest(tip, v) * (1e-13L + 4 * 2.2e-16L / (long double)c->sharp[i]);
    }
    for (int v = 0; v < 2; v++)
        truth->round_off[v] += 1e-13L * largest(truth->tip, v);
}

/* ---- the oracle against closed forms ---- */

static void near(const char *what, long double value, long double truth, double allowed)
{
    if (!(fabsl(value - truth) <= allowed * fabsl(truth)))
        fail_msg("%s: %.18Lg, expected %.18Lg", what, value, truth);
}

static struct oracle_problem some_problem(struct trial *c, bool bending)
{
    return (struct oracle_problem){.bending = bending,
                                   .length = decades(c, 0.1, 10),
                                   .density = decades(c, 0.1, 10),
                                   .stiffness = decades(c, 0.1, 10),
                                   .viscosity = decades(c, 0.1, 10)};
}

/* Long after the load was put on, the tip is where statics has it. */
static void test_oracle_statics(void **state)
{
    (void)state;
    static struct trial c;
    for (int i = 0; i < 20; i++) {
        const bool bending = i % 2;
        const struct oracle_problem p = some_problem(&c, bending);
        const long double a = p.stiffness, l = p.length;
        const double slowest =
            p.viscosity / p.stiffness + p.density * pow(p.length, bending ? 4 : 2) / p.viscosity;
        const double t[] = {300 * slowest};
        const double from = uniform(&c, 0, 0.5) * p.length, to = uniform(&c, 0.6, 1) * p.length;
        const struct oracle_step patch[] = {{from, 2}, {to, -2}};
        const struct oracle_factor one = oracle_one(), steps = {.step = patch, .steps = 2};
        struct oracle_term term[] = {
            {.place = ORACLE_SPREAD, .amplitude = 3, .space = one, .time = one},
            {.place = ORACLE_FORCE, .amplitude = 3, .time = one},
            {.place = ORACLE_MOMENT, .amplitude = 3, .time = one},
            {.place = ORACLE_SPREAD, .amplitude = 3, .space = steps, .time = one}};
        const long double high = to, low = from;
        const long double expected[2][4] = {
            {l * l / 2, l, 0, high * high - low * low},
            {l * l * l * l / 8, l * l * l / 3, l * l / 2,
             (l * (powl(high, 3) - powl(low, 3)) - (powl(high, 4) - powl(low, 4)) / 4) / 3}};
        for (int k = 0; k < 4; k++) {
            struct oracle_tip tip = {0};
            if (expected[bending][k] == 0)
                continue;
            oracle_term(&p, &term[k], 1, t, &tip);
            near("static tip", tip.displacement, 3 * expected[bending][k] / a, 1e-14);
            assert_true(fabsl(tip.velocity) <= 1e-14L * fabsl(tip.displacement) / t[0]);
        }
    }
}

/* One mode under a step, a wave and a short blow: a scalar oscillator. */
static void test_oracle_oscillator(void **state)
{
    (void)state;
    static struct trial c;
    for (int i = 0; i < 30; i++) {
        struct oracle_problem p = some_problem(&c, false);
        const double l = p.length;
        const long double k = pi / 2 / l, lambda = k * k, rho = p.density;
        p.viscosity =
            p.stiffness * decades(&c, 0.03, 0.9) / sqrt(p.stiffness / p.density * (double)lambda);
        const double t[] = {uniform(&c, 0.1, 20) * sqrt(p.density / p.stiffness / (double)lambda)};
        const long double half = p.viscosity * lambda / rho / 2, s = p.stiffness * lambda;
        const long double w = sqrtl(s / rho - half * half), decay = expl(-half * t[0]);
        const long double cosine = decay * cosl(w * t[0]), sine = decay * sinl(w * t[0]) / w;
        struct oracle_term term = {.place = ORACLE_SPREAD, .amplitude = 1, .time = oracle_one()};
        term.space = (struct oracle_factor){.kind = ORACLE_WAVE, .p = {(double)k}};
        struct oracle_tip tip;
        oracle_term(&p, &term, 1, t, &tip);
        near("a step", tip.displacement, (1 - cosine - half * sine) / s, 1e-13);
        near("its rate", tip.velocity, sine / rho, 1e-12);

        const double rate = uniform(&c, 0.2, 3) * (double)w;
        const long double complex forced =
            1 / (s - rho * rate * (long double)rate + 2 * half * rho * rate * 1.0iL);
        const long double at_0 = cimagl(forced), slope_0 = rate * creall(forced);
        term.time = (struct oracle_factor){.kind = ORACLE_WAVE, .p = {rate}};
        oracle_term(&p, &term, 1, t, &tip);
        const long double wave = cimagl(forced * cexpl(1.0iL * rate * t[0])) - at_0 * cosine -
                                 (slope_0 + half * at_0) * sine;
        assert_true(fabsl(tip.displacement - wave) <= 1e-13L * cabsl(forced));

        const double width = 1e-9 * t[0];
        term.time = (struct oracle_factor){.kind = ORACLE_GAUSS, .p = {t[0] / 1e6, width}};
        oracle_term(&p, &term, 1, t, &tip);
        const long double since = t[0] - t[0] / 1e6L;
        assert_true(fabsl(tip.displacement -
                          width * sqrtl(pi) * expl(-half * since) * sinl(w * since) / w / rho) <=
                    1e-10L * width / w / rho);
    }
}

/* A front on a rod without mass: one equation of first order. */
static void test_oracle_front(void **state)
{
    (void)state;
    static struct trial c;
    const struct oracle_step front[] = {{-INFINITY, 1}, {0, -1}};
    for (int i = 0; i < 5; i++) {
        struct oracle_problem p = some_problem(&c, false);
        p.density *= 1e-14;
        const double speed = uniform(&c, 0.5, 2);
        const long double a = p.stiffness, v = p.viscosity, l = p.length, end = l / speed;
        const double t[] = {0.7 * (double)end, 1.4 * (double)end};
        const struct oracle_term term = {.place = ORACLE_SPREAD,
                                         .amplitude = 1,
                                         .space = {.step = front, .steps = 2},
                                         .time = oracle_one(),
                                         .moving = true,
                                         .speed = speed};
        struct oracle_tip tip[2];
        oracle_term(&p, &term, 2, t, tip);
        long double inside[2];
        for (int k = 0; k < 2; k++) {
            const long double s = k == 0 ? t[0] : end;
            inside[k] =
                speed * (long double)speed / 2 *
                (s * s / a - 2 * v * s / (a * a) - 2 * v * v / (a * a * a) * expm1l(-a * s / v));
        }
        const long double left = expl(-a * (t[1] - end) / v);
        near("inside", tip[0].displacement, inside[0], 1e-10);
        near("it has left", tip[1].displacement, inside[1] * left + l * l / 2 / a * (1 - left),
             1e-10);
    }
}

/* The trials' own truth, at two resolutions: what the coarse one states is what they differ by. */
static void test_oracle_resolutions(void **state)
{
    (void)state;
    static struct trial c;
    static struct truth coarse, fine;
    for (size_t i = 0; i < (br_test_long() ? 200 : 9); i++) {
        draw(&c, i);
        find_truth(&c, false, &coarse);
        find_truth(&c, true, &fine);
        for (size_t k = 0; k < TIMES; k++) {
            const struct oracle_tip *tip = &coarse.tip[k];
            const long double most[] = {largest(fine.tip, false), largest(fine.tip, true)};
            const long double off[] = {fabsl(tip->displacement - fine.tip[k].displacement),
                                       fabsl(tip->velocity - fine.tip[k].velocity)};
            if (!(off[0] <=
                      tip->displacement_error + 1e-14L * most[0] + 0.1L * coarse.round_off[0] &&
                  off[1] <= tip->velocity_error + 1e-12L * most[1] + 0.1L * coarse.round_off[1] &&
                  tip->displacement_error <= 1e-11L * most[0]))
                fail_msg("case %zu, t = %g T: %Lg +- %Lg, finer %Lg of the largest", c.number,
                         c.t[k] / c.duration, tip->displacement / most[0],
                         tip->displacement_error / most[0], off[0] / most[0]);
        }
    }
}

/* ---- the judge ---- */

enum outcome { RIGHT, REFUSED, WRONG, OUTCOMES };

/* An estimate is the distance of two solutions; a good one may be that much too small. */
static const double estimate_factor = 3;

enum { PATIENCE = 60 }; /* s of processor time: what takes longer counts as wrong */

static bool out_of_patience(void *self)
{
    return (double)(clock() - *(clock_t *)self) > PATIENCE * (double)CLOCKS_PER_SEC;
}

/* Whether the estimate of the velocity leaves this time out: within a blow of less than 1e-6 T,
 * or 1e-6 T after a jump. */
static bool is_layer(const struct trial *c, double t)
{
    const double close = 1e-6 * c->duration;
    for (size_t i = 0; i < c->terms; i++) {
        const struct oracle_factor *f = &c->term[i].time;
        for (size_t j = 0; j < f->steps; j++)
            if (t - (double)f->step[j].at >= 0 && t - (double)f->step[j].at <= close)
                return true;
        if ((f->kind == ORACLE_GAUSS || f->kind == ORACLE_HAT) && f->p[1] < close &&
            fabs(t - f->p[0]) <= 8 * close)
            return true;
    }
    return false;
}

static void tell(const struct trial *c, const char *what)
{
    print_message("# case %zu, %s: %s\n", c->number, kinds[c->kind].text, what);
}

/* One value against the truth: NaN is wrong. */
static bool is_right(const struct trial *c, double t, const char *what, const double value[3],
                     const long double truth[2])
{
    const long double allowed = estimate_factor * value[1] + value[2] + truth[1];
    const long double off = fabsl(value[0] - truth[0]);
    if (off <= allowed)
        return true;
    char text[300];
    snprintf(text, sizeof text,
             "WRONG: %s at t = %.9g T is %.12g, truth %.12Lg: off by %.2Lg of it; stated %.2g, "
             "round-off %.2g, oracle %.2Lg of it",
             what, t / c->duration, value[0], truth[0], off / fabsl(truth[0]),
             value[1] / (double)fabsl(truth[0]), value[2] / (double)fabsl(truth[0]),
             truth[1] / fabsl(truth[0]));
    tell(c, text);
    return false;
}

static enum outcome compare(const struct trial *c, const struct br_exact *exact,
                            const struct truth *truth)
{
    struct br_error err = {0};
    struct br_exact_state *state;
    const enum br_exact_field field = c->problem.bending ? BR_EXACT_BENDING : BR_EXACT_AXIAL;
    const struct br_exact_size error = br_exact_report(exact, field).error;
    bool right = true;
    MUST(br_exact_state_create(&state, exact, &err));
    for (size_t k = 0; k < TIMES && right; k++) {
        const struct oracle_tip *tip = &truth->tip[k];
        br_exact_at(exact, c->t[k], state);
        right = is_right(c, c->t[k], "displacement",
                         (double[]){state->tip[field].displacement, error.displacement,
                                    (double)truth->round_off[0]},
                         (long double[]){tip->displacement, tip->displacement_error});
        if (right && !is_layer(c, c->t[k]))
            right = is_right(
                c, c->t[k], "velocity",
                (double[]){state->tip[field].velocity, error.velocity, (double)truth->round_off[1]},
                (long double[]){tip->velocity, tip->velocity_error});
    }
    br_exact_state_free(state);
    return right ? RIGHT : WRONG;
}

static enum outcome refused(const struct trial *c, const struct br_error *err)
{
    const bool reason =
        (err->status == BR_BAD_INPUT || err->status == BR_NOT_FINITE) && *err->message;
    char text[400];
    snprintf(text, sizeof text, "%s: %.300s", reason ? "refused" : "WRONG", err->message);
    tell(c, text);
    return reason ? REFUSED : WRONG;
}

static enum outcome try(const struct trial *c)
{
    struct br_error err = {0};
    struct br_scene scene = {0};
    struct br_exact *exact = NULL;
    clock_t start = clock();
    const struct br_exact_options options = {
        .acceptable = 1e-8, .stop = out_of_patience, .stop_self = &start};
    enum br_status status = br_scene_read_text("blows", c->text, &scene, &err);
    if (!status)
        status = br_exact_create(&exact, &scene, &options, &err);
    enum outcome outcome = status ? refused(c, &err) : RIGHT;
    if (!status) {
        struct truth truth;
        find_truth(c, false, &truth);
        outcome = compare(c, exact, &truth);
    }
    if (outcome == WRONG && getenv("BR_TEST_SHOW"))
        print_message("%s\n", c->text);
    br_exact_free(exact);
    br_scene_clear(&scene);
    return outcome;
}

static void test_hard_loads(void **state)
{
    (void)state;
    static struct trial c;
    size_t count[COUNT_OF_KINDS][OUTCOMES] = {0}, wrong = 0, refusals = 0;
    const size_t cases = br_test_long() ? 2000 : 60;
    for (size_t i = 0; i < cases; i++) {
        draw(&c, i);
        count[c.kind][try(&c)]++;
    }
    for (size_t k = 0; k < COUNT_OF_KINDS; k++) {
        const size_t all = count[k][RIGHT] + count[k][REFUSED] + count[k][WRONG];
        print_message("# %-20s %4zu right %4zu refused %4zu silently wrong\n", kinds[k].text,
                      count[k][RIGHT], count[k][REFUSED], count[k][WRONG]);
        wrong += count[k][WRONG];
        refusals += (double)count[k][REFUSED] > kinds[k].refused_at_most * (double)all;
    }
    assert_int_equal(wrong, 0);
    assert_int_equal(refusals, 0); /* kinds of which too many are refused */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_oracle_statics), cmocka_unit_test(test_oracle_oscillator),
        cmocka_unit_test(test_oracle_front),   cmocka_unit_test(test_oracle_resolutions),
        cmocka_unit_test(test_hard_loads),
    };
    return br_test_quick() ? 0 : cmocka_run_group_tests(tests, NULL, NULL);
}
