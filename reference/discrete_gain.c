/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "reference/discrete_element.h"

enum { MOST = BR_DISCRETE_MOST };

/* The textbook's matrices, times 6 and times 420; of the beam for (w, h w_x). */
static const long double rod_mass[2][2] = {{2, 1}, {1, 2}};
static const long double beam_mass[4][4] = {
    {156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};

long double br_discrete_mass(size_t d, size_t a, size_t b)
{
    return d == 1 ? rod_mass[a][b] / 6 : beam_mass[a][b] / 420;
}

/* D of strain c. */
long double br_discrete_rigidity(const struct br_discrete_field *f, size_t c)
{
    return f->d == 1 ? 1 / f->h : 1 / (f->h * f->h * f->h) / (c == 0 ? 1 : 3);
}

/* x'y by the element's mass rho h/tau of nodal values x, y, the strains' R, and the value P of what
 * lies right of it. */
struct energy {
    size_t d;
    long double mass, stiff[MOST], value[MOST][MOST];
};

/* An element's motion: nodes and strains. */
struct motion {
    long double node[2 * MOST], q[MOST];
};

static long double product(const struct energy *e, const struct motion *x, const struct motion *y)
{
    const size_t d = e->d;
    long double sum = 0;
    for (size_t a = 0; a < 2 * d; a++)
        for (size_t b = 0; b < 2 * d; b++)
            sum += e->mass * br_discrete_mass(d, a, b) * x->node[a] * y->node[b];
    for (size_t a = 0; a < d; a++) {
        sum += e->stiff[a] * x->q[a] * y->q[a];
        for (size_t b = 0; b < d; b++)
            sum += x->node[d + a] * e->value[a][b] * y->node[d + b];
    }
    return sum;
}

/* The motion with its left node and its strain given. */
static struct motion motion(size_t d, const long double *left, const long double *q)
{
    struct motion m = {0};
    memcpy(m.node, left, d * sizeof *left);
    memcpy(m.q, q, d * sizeof *q);
    br_discrete_cross(d, m.node, m.q, m.node + d);
    return m;
}

static bool invert(size_t d, long double s[MOST][MOST], long double inverse[MOST][MOST])
{
    if (d == 1) {
        inverse[0][0] = 1 / s[0][0];
        return s[0][0] > 0;
    }
    const long double det = s[0][0] * s[1][1] - s[0][1] * s[1][0];
    inverse[0][0] = s[1][1] / det;
    inverse[1][1] = s[0][0] / det;
    inverse[0][1] = inverse[1][0] = -s[0][1] / det;
    return s[0][0] > 0 && det > 0;
}

/* The gains of one element; its own value then takes the place of what lies right of it: that of
 * the best motions for unit left nodes, as a sum of energies. */
bool br_discrete_add_element(const struct br_discrete_field *f, long double tau,
                             struct br_discrete_value *right, struct br_discrete_gain *g)
{
    static const long double unit[MOST][MOST] = {{1, 0}, {0, 1}}, none[MOST] = {0};
    const size_t d = f->d;
    struct energy energy = {.d = d, .mass = f->density * f->h / tau}, *e = &energy;
    for (size_t c = 0; c < d; c++)
        e->stiff[c] = (f->viscosity + tau * f->stiffness) * br_discrete_rigidity(f, c);
    memcpy(e->value, right->p, sizeof e->value);
    struct motion strain[MOST], left[MOST];
    long double s[MOST][MOST] = {{0}}, value[MOST][MOST];
    for (size_t a = 0; a < d; a++) {
        strain[a] = motion(d, none, unit[a]);
        left[a] = motion(d, unit[a], none);
    }
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            s[a][b] = product(e, &strain[a], &strain[b]);
    if (!invert(d, s, g->inverse))
        return false;
    for (size_t b = 0; b < d; b++) {
        long double q[MOST] = {0};
        for (size_t a = 0; a < d; a++) {
            g->gain[a][b] = 0;
            for (size_t c = 0; c < d; c++)
                g->gain[a][b] += g->inverse[a][c] * product(e, &strain[c], &left[b]);
            q[a] = -g->gain[a][b];
        }
        left[b] = motion(d, unit[b], q);
    }
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            value[a][b] = product(e, &left[a], &left[b]);
    memcpy(right->p, value, sizeof value);
    return true;
}
