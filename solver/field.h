/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One discretised field (axial or bending) on n equal elements, and the element's exact integrals.
 * Nodal arrays contain, node by node from the clamped end, u for axial and the pair (w, s) with the
 * scaled slope s = h w_x for bending, all in metres; the clamped node 0 is stored and stays zero. A
 * rod of quadratic elements has the pair (u, b), where b is the bubble of the element that ends at
 * the node, the one to its left: with xi in [0, 1] along it,
 *     u = (1 - xi) u0 + xi u1 - xi (1 - xi) b,    h u_x = (u1 - u0) + (2 xi - 1) b,
 * so that u is the nodes' chord, less b/4 in the middle. (Szabo and Babuska 1991: the bubble is an
 * integrated Legendre polynomial, orthogonal to the chord in energy.) */
#ifndef BR_SOLVER_FIELD_H
#define BR_SOLVER_FIELD_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "solver/kind.h"

struct br_function;
struct br_scene;

/* The operator of one Euler step in velocity form: M/k + C + k K. */
struct br_field {
    enum br_field_kind kind;
    size_t n;         /* elements */
    double h;         /* element length, m */
    double density;   /* rho, kg/m */
    double stiffness; /* a, N or N m^2 */
    double viscosity; /* c, N s or N m^2 s */
    double k;         /* time step, s */
    int degree;       /* of axial elements: 1 (or 0) or 2; not used for bending */
};

/* The field of the given kind of a scene, on n elements with the time step k. */
struct br_field br_field_of_scene(const struct br_scene *scene, enum br_field_kind kind, size_t n,
                                  double k, int axial_degree);

/* A rod of quadratic elements. */
static inline bool br_field_is_quadratic(const struct br_field *field)
{
    return field->kind == BR_AXIAL && field->degree == 2;
}

/* Unknowns a node, which is also the number of strains an element: 1 axial, 2 bending; 2 axial if
 * quadratic. */
size_t br_field_unknowns(const struct br_field *field);

/* mu^2 of the lowest mode with a free tip, so that its elastic frequency is sqrt(a mu^2 / rho):
 * (pi/2)^2 / L^2 axial, 1.875^4 / L^4 bending; 1/m^2 or 1/m^4. */
double br_field_lowest_mode(const struct br_field *field);

/* The ratio of inertia to stiffness in one step, in the lowest mode: rho / (k (c + k a) mu^2). */
double br_field_inertia(const struct br_field *field);

/* Length of a nodal array, clamped node included: unknowns * (n + 1). */
size_t br_field_size(const struct br_field *field);

/* Consistent mass of one element over h: symmetric, for (u0, u1) and for
 * (w0, s0, w1, s1), so that rho h * mass is the element's matrix. */
extern const double br_axial_mass[2][2];
extern const double br_bending_mass[4][4];

/* An element's two curvature coefficients, m, from its nodal values: with xi in
 * [0, 1] along the element, h^2 w_xx = curvature[0] + curvature[1] (2 xi - 1).
 * node: in, (w0, s0, w1, s1), m. */
static inline void br_curvature(const double node[4], double curvature[2])
{
    curvature[0] = node[3] - node[1];
    curvature[1] = 3 * (node[1] + node[3]) - 6 * (node[2] - node[0]);
}

/* Load vector of f = space(x, t), N/m, on the field's mesh into `vector` (out,
 * br_field_size values; N, and N for the scaled slope): closed form where space
 * does not use x, five Gauss points an element otherwise.
 * Fails with BR_NOT_FINITE, naming x and t; BR_NO_MEMORY. */
enum br_status br_assemble_load(const struct br_field *field, const struct br_function *space,
                                double t, double *vector, struct br_error *err);

/* Interpolant (Lagrange, with the midpoints if quadratic, or Hermite) of a function of x, m or m/s,
 * into `nodal` (out, br_field_size values). slope: the function's derivative, used for bending.
 * The clamped node is set to zero. Clones of the functions are evaluated, so that other
 * threads may use the functions. Fails with BR_NOT_FINITE; BR_NO_MEMORY. */
enum br_status br_interpolate(const struct br_field *field, const struct br_function *value,
                              const struct br_function *slope, double *nodal, struct br_error *err);

#endif
