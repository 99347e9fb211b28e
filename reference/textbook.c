/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/textbook.h"

#include <math.h>
#include <string.h>

#include "solver/scene.h"

static const struct br_textbook implicit_euler = {.rows = 1, .a = {{1}}, .c = {1}};

/* ---- Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021 ---- */

#define SQRT2 1.41421356237309504880168872421L
#define ALPHA2 (1 - SQRT2 / 2)

/* Theorem 5, order two. */
static const struct br_textbook alexander2 = {
    .rows = 2,
    .a = {{ALPHA2}, {SQRT2 / 2, ALPHA2}},
    .c = {ALPHA2, 1},
};

/* Theorem 5, order three: alpha is the root of x^3 - 3x^2 + 3x/2 - 1/6 in (1/6, 1/2). */
#define ALPHA3 0.435866521508458999416019451194L
static const struct br_textbook alexander3 = {
    .rows = 3,
    .a = {{ALPHA3},
          {(1 - ALPHA3) / 2, ALPHA3},
          {-(6 * ALPHA3 * ALPHA3 - 16 * ALPHA3 + 1) / 4,
           (6 * ALPHA3 * ALPHA3 - 20 * ALPHA3 + 5) / 4, ALPHA3}},
    .c = {ALPHA3, (1 + ALPHA3) / 2, 1},
};

/* Hairer and Wanner, Solving Ordinary Differential Equations II, Table IV.6.5. */
static const struct br_textbook hairer_wanner = {
    .rows = 5,
    .a = {{1 / 4.0L},
          {1 / 2.0L, 1 / 4.0L},
          {17 / 50.0L, -1 / 25.0L, 1 / 4.0L},
          {371 / 1360.0L, -137 / 2720.0L, 15 / 544.0L, 1 / 4.0L},
          {25 / 24.0L, -49 / 48.0L, 125 / 16.0L, -85 / 12.0L, 1 / 4.0L}},
    .c = {1 / 4.0L, 3 / 4.0L, 11 / 20.0L, 1 / 2.0L, 1},
};

/* Hosea and Shampine, Appl. Numer. Math. 20 (1996) 21-37: TR-BDF2 as a Runge-Kutta method, with
 * gamma = 2 - sqrt 2, d = gamma / 2 and w = sqrt 2 / 4. */
#define D ((2 - SQRT2) / 2)
#define W (SQRT2 / 4)
static const struct br_textbook hosea_shampine = {
    .rows = 3,
    .a = {{0}, {D, D}, {W, W, D}},
    .c = {0, 2 - SQRT2, 1},
};

/* ---- Kennedy and Carpenter, Appl. Numer. Math. 44 (2003) 139-181, the implicit parts ---- */

/* ARK3(2)4L[2]SA, whose irrational numbers are printed as quotients. */
#define GAMMA (1767732205903 / 4055673282236.0L)
static const struct br_textbook ark3 = {
    .rows = 4,
    .a = {{0},
          {GAMMA, GAMMA},
          {2746238789719 / 10658868560708.0L, -640167445237 / 6845629431997.0L, GAMMA},
          {1471266399579 / 7840856788654.0L, -4482444167858 / 7529755066697.0L,
           11266239266428 / 11593286722821.0L, GAMMA}},
    .c = {0, 1767732205903 / 2027836641118.0L, 3 / 5.0L, 1},
};

/* ARK4(3)6L[2]SA */
static const struct br_textbook ark4 = {
    .rows = 6,
    .a = {{0},
          {1 / 4.0L, 1 / 4.0L},
          {8611 / 62500.0L, -1743 / 31250.0L, 1 / 4.0L},
          {5012029 / 34652500.0L, -654441 / 2922500.0L, 174375 / 388108.0L, 1 / 4.0L},
          {15267082809 / 155376265600.0L, -71443401 / 120774400.0L, 730878875 / 902184768.0L,
           2285395 / 8070912.0L, 1 / 4.0L},
          {82889 / 524892.0L, 0, 15625 / 83664.0L, 69875 / 102672.0L, -2260 / 8211.0L, 1 / 4.0L}},
    .c = {0, 1 / 2.0L, 83 / 250.0L, 31 / 50.0L, 17 / 20.0L, 1},
};

/* ---- backward differences: Curtiss and Hirschfelder, Proc. Natl. Acad. Sci. 38 (1952) 235 ---- */

static const struct br_textbook two_back = {
    .back = 2,
    .past = {4 / 3.0L, -1 / 3.0L},
    .beta = 2 / 3.0L,
};
static const struct br_textbook three_back = {
    .back = 3,
    .past = {18 / 11.0L, -9 / 11.0L, 2 / 11.0L},
    .beta = 6 / 11.0L,
};

/* ---- the schemes: their first, second and later steps ---- */

static const struct {
    const char *name;
    const struct br_textbook *step[3];
} schemes[] = {
    {"euler", {&implicit_euler, &implicit_euler, &implicit_euler}},
    {"bdf2", {&alexander2, &two_back, &two_back}},
    {"bdf3", {&alexander2, &two_back, &three_back}},
    {"trbdf2", {&alexander2, &hosea_shampine, &hosea_shampine}},
    {"sdirk2", {&alexander2, &alexander2, &alexander2}},
    {"esdirk3", {&alexander3, &ark3, &ark3}},
    {"esdirk4", {&hairer_wanner, &ark4, &ark4}},
    {"adaptive", {&hairer_wanner, &ark4, &ark4}},
};

const struct br_textbook *br_textbook_step(const char *scheme, size_t since)
{
    for (size_t i = 0; i < sizeof schemes / sizeof *schemes; i++)
        if (strcmp(schemes[i].name, scheme) == 0)
            return schemes[i].step[since < 2 ? since : 2];
    return NULL;
}

/* ---- the branches of the laws ---- */

enum br_regime br_textbook_regime(const struct br_scene *scene, enum br_field_kind kind,
                                  long double force, long double bound)
{
    if (kind == BR_AXIAL)
        return !scene->contact.modelled ? BR_REGIME_NONE
               : force > 0              ? BR_REGIME_CLOSED
                                        : BR_REGIME_OPEN;
    if (scene->friction.law == BR_FRICTIONLESS || !(bound > 0))
        return BR_REGIME_NONE;
    if (fabsl(force) < bound)
        return BR_REGIME_STICK;
    return force > 0 ? BR_REGIME_FORWARD : BR_REGIME_BACKWARD;
}

/* ---- elements ---- */

static const struct br_element rod = {
    .unknowns = 1,
    .power = 1,
    .entry = {{{2, 1}, {1, 2}}, {{1, -1}, {-1, 1}}},
    .over = {6, 1},
};

/* Szabo and Babuska 1991: the chord and a bubble, here that of the element's second node. */
static const struct br_element quadratic_rod = {
    .unknowns = 2,
    .power = 1,
    .entry = {{{20, 0, 10, -5}, {0}, {10, 0, 20, -5}, {-5, 0, -5, 2}},
              {{3, 0, -3, 0}, {0}, {-3, 0, 3, 0}, {0, 0, 0, 1}}},
    .over = {60, 3},
};

static const struct br_element beam = {
    .unknowns = 2,
    .power = 3,
    .entry = {{{156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}},
              {{12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}}},
    .over = {420, 1},
};

const struct br_element *br_element_of(enum br_field_kind kind, int axial_degree)
{
    return kind == BR_BENDING ? &beam : axial_degree == 2 ? &quadratic_rod : &rod;
}

/* Copies nodal values. For the stiffness, subtracts the rigid motion of the first node, which
 * causes no elastic force; this is exact but for the last bits. */
static inline void take(const struct br_element *e, enum br_element_matrix matrix, size_t size,
                        const double *nodal, long double out[4])
{
    for (size_t i = 0; i < size; i++)
        out[i] = nodal[i];
    if (matrix == BR_MASS)
        return;
    const long double turned = e->power == 3 ? out[1] : 0;
    out[size / 2] = out[size / 2] - out[0] - turned;
    if (size == 4)
        out[3] -= turned;
}

/* `size` is a constant in each call, so that loops are unrolled. Without the rigid motion the first
 * node's values are zero. */
static inline void forces(const struct br_element *e, enum br_element_matrix matrix, size_t size,
                          const long double v[4], long double out[4])
{
    for (size_t i = 0; i < size; i++) {
        out[i] = 0;
        for (size_t j = matrix == BR_MASS ? 0 : size / 2; j < size; j++)
            out[i] += e->entry[matrix][i][j] * v[j];
    }
}

static inline long double product(const struct br_element *e, enum br_element_matrix matrix,
                                  size_t size, const double *a, const double *b)
{
    long double v[4], w[4], force[4], sum = 0;
    take(e, matrix, size, a, v);
    take(e, matrix, size, b, w);
    forces(e, matrix, size, w, force);
    for (size_t i = matrix == BR_MASS ? 0 : size / 2; i < size; i++)
        sum += v[i] * force[i];
    return sum / e->over[matrix];
}

long double br_element_product(const struct br_element *e, enum br_element_matrix matrix,
                               const double *a, const double *b)
{
    if (e->unknowns == 1)
        return product(e, matrix, 2, a, b);
    return matrix == BR_MASS ? product(e, BR_MASS, 4, a, b) : product(e, BR_STIFFNESS, 4, a, b);
}

void br_element_forces(const struct br_element *e, enum br_element_matrix matrix,
                       long double factor, const double *nodal, long double out[4])
{
    long double v[4];
    take(e, matrix, 2 * e->unknowns, nodal, v);
    if (e->unknowns == 1)
        forces(e, matrix, 2, v, out);
    else if (matrix == BR_MASS)
        forces(e, BR_MASS, 4, v, out);
    else
        forces(e, BR_STIFFNESS, 4, v, out);
    for (size_t i = 0; i < 2 * e->unknowns; i++)
        out[i] *= factor;
}
