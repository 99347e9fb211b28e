/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns of errors that others have published, with the order that the same source states of each.
 *
 * The first ones were looked at while the priors of the laws were chosen:
 *
 * - deal.II step-N: examples/step-N/doc/results.dox of github.com/dealii/dealii at 5820fa31
 * - parallel_in_time: Readme.md there in github.com/dealii/code-gallery at 0a59915c
 * - Trixi: docs/src/index.md of github.com/trixi-framework/Trixi.jl at 37ff4ac5 (advection, of the
 *   mean that it prints)
 * - mirgecom: pull request 112 of github.com/illinois-ceesd/mirgecom ("order N-1")
 * - Ferrite: pull request 787 of github.com/Ferrite-FEM/Ferrite.jl (by its "expected_next")
 * - pycaputo: issue 2 of github.com/alexfikl/pycaputo ("first-order", "alpha + 0.5")
 *
 * The later ones were chosen, all at once, before any of them was tried:
 *
 * - iFEM: docs/_fem of github.com/lyc102/ifem at 21a3f30c, each page of rates there. Of the Poisson
 *   and Maxwell pages the second table, of the Stokes pages the first (RT0: both). Columns: u, of
 *   Stokes also p, and those of which the page states another order than the optimal one.
 * - decay-book: the exercise on rounding, doc/.src/chapters/analysis/exer.do.txt of
 *   github.com/hplgit/decay-book at 75a05c28. Orders of the differences: its chapters analysis and
 *   models. Those of both rules: Davis and Rabinowitz, Methods of Numerical Integration, 1984, 2.1.
 * - EarthSci: docs/content/rules of github.com/EarthSciML/EarthSciDiscretizations at 67b9a6b2, and
 *   an earlier page of weno5_advection_2d ("Theoretical asymptotic order")
 * - weno_singular: README.md of github.com/irfanturk/weno_singular at 1f5fe57b ("capped at first
 *   order")
 * - Castro: Exec/unit_tests/diffusion_test and Exec/gravity_tests/hse_convergence, README.md, of
 *   github.com/AMReX-Astro/Castro at f63fde10 ("4th-order SDC"). The first-order and second-order
 *   columns beside the latter are left out: the text takes their orders from the numbers.
 * - Kirkup: kirkup.info/papers/empirical, table 1 (its conclusion: N^-2 for constant elements)
 * - Monte Carlo: two versions of README.md of github.com/jervisfm/W4142_HW3 ("1 / Sqrt(N)")
 * - Trixi FV: pull requests 2022, 2695 and 2734 of github.com/trixi-framework/Trixi.jl
 *   ("Second-Order Finite Volume"), monotonized central limiter; rho and energy alone
 * - Trixi sphere: pull request 1749 there, polydeg = 3. Its examples expect an EOC of 5 of 4.
 * - mirgecom vortex: pull request 100 of mirgecom, P = 1 and 2 ("(dim,order)")
 *
 * The last 40 were chosen, all at once, before any of them was tried on the mixture of laws, limits
 * and grids:
 *
 * - gFlex: docs/accuracy.rst of github.com/awickert/gFlex at 05bd2115 ("first order",
 * "second-order")
 * - OpenPFC: docs/report/data/heat3d_fd_order_convergence.csv of
 *   github.com/VTT-ProperTune/OpenPFC at a52e335c ("design_order")
 * - DispersiveShallowWater: pull requests 104 and 228 of
 *   github.com/NumericalMathematics/DispersiveShallowWater.jl ("p", accuracy_order = 2)
 * - IPPL: issue 535 of github.com/IPPL-framework/ippl ("the expected behaviour is second-order")
 * - libMesh: pull request 3668 of github.com/libMesh/libmesh. Order: Boffi, Brezzi and Fortin,
 * Mixed Finite Element Methods and Applications, 2013, 2.5.
 * - FNC: Driscoll and Braun, Fundamentals of Numerical Computation, fncbook.github.io/fnc, demos on
 *   finite differences and on the trapezoid formula
 * - Olson: fractal.math.unr.edu/~ejolson/466-14/lab07 ("4th order")
 * - Euler's method: a question of 14 April 2018, "Euler's Method Error", in the data set
 *   nvidia/Nemotron-CC-Math-v1 ("proportional to h^2": there it is the trapezoidal rule)
 * - CADET: pull requests 763 and 630 of github.com/cadet/CADET-Core; of its interface, "WENO 2
 * (order 3)", "WENO 3 (order 5)", Koren "order of 2"; 630: "2nd order", without its last row
 * - MFMFE: MultipointFluxMixedFiniteElementMethods/README.md of github.com/dealii/code-gallery at
 *   e0ceeeeb ("O(h^k)", "superconvergence of order O(h^(k+1))")
 * - Lethe: doc/source/examples/incompressible-flow/2d-taylor-couette-flow of
 *   github.com/chaos-polymtl/lethe at 1014f8f0 ("third order", "second order")
 * - Burkardt: fem1d_bvp_linear_prb_output.txt of github.com/johannesgerer/jburkardt-c at 1ff7c7d6.
 *   Orders: Strang and Fix, An Analysis of the Finite Element Method, 1973, 1.6.
 * - BenchPhaseFlow: docs/src/results/Scalar of github.com/PenguinxCutCell/BenchPhaseFlow.jl at
 *   e6401ea8 and 6bdb8bde. Orders: Johansen and Colella 1998; backward Euler: 1.
 * - Trixi: pull requests 475 and 1733 of Trixi.jl, degree 3
 *
 * Left out are columns of fewer than four rows, and those whose source states no order. */
#ifndef BR_TESTS_LAB_PUBLISHED_H
#define BR_TESTS_LAB_PUBLISHED_H

#include <math.h>
#include <stdlib.h>

#include "tests/lab/errors.h"

/* The sizes of the rows. */
enum br_published_sizes {
    HALVED,   /* each half of the one before */
    SQUARES,  /* 4 x 4, 6 x 6, 8 x 8, 12 x 12, ... cells */
    CUBES,    /* 2, 3, 4, 6, 8, 12, ... along an edge */
    UNKNOWNS, /* their number in two dimensions */
    LISTED,
};

static const struct br_published {
    double order;
    enum br_published_sizes mesh_sequence;
    const char *name, *errors, *sizes;
} br_published[] = {
    {2, UNKNOWNS, "deal.II step-7, Q1, adaptive: L2",
     "1.840e+00 5.336e-02 1.439e-02 8.696e-03 3.245e-03 2.407e-03 8.501e-04 7.113e-04 3.140e-04",
     "81 154 341 678 1240 2306 4216 7909 14870"},
    {2, HALVED, "deal.II step-7, Q1: L2", "1.840e+00 3.570e-02 1.192e-02 3.047e-03 7.660e-04",
     NULL},
    {1, HALVED, "deal.II step-7, Q1: H1", "2.858e+00 1.199e+00 7.565e-01 3.823e-01 1.917e-01",
     NULL},
    {3, UNKNOWNS, "deal.II step-7, Q2, adaptive: L2",
     "1.606e-01 7.916e-03 1.092e-03 5.999e-04 2.100e-04 7.821e-05 2.868e-05 1.146e-05 3.747e-06",
     "289 569 1317 2459 4719 9039 17143 32343 60895"},
    {3, HALVED, "deal.II step-7, Q2: L2", "1.606e-01 7.638e-03 8.601e-04 1.107e-04 1.394e-05",
     NULL},
    {2, HALVED, "deal.II step-7, Q2: H1", "1.278e+00 5.248e-01 1.086e-01 2.756e-02 6.915e-03",
     NULL},
    {2, HALVED, "deal.II step-10, degree 1: pi by area",
     "1.1416e+00 3.1317e-01 8.0125e-02 2.0148e-02 5.0442e-03 1.2615e-03", NULL},
    {4, HALVED, "deal.II step-10, degree 2: pi by area",
     "3.7023e-02 2.4451e-03 1.5494e-04 9.7169e-06 6.0783e-07 3.7998e-08", NULL},
    {6, HALVED, "deal.II step-10, degree 3: pi by area",
     "5.8927e-04 9.6142e-06 1.5185e-07 2.3792e-09 3.7015e-11 5.9952e-13", NULL},
    {8, HALVED, "deal.II step-10, degree 4: pi by area",
     "5.4608e-06 2.2116e-08 8.7166e-11 3.9257e-13 1.8430e-13 2.6201e-14", NULL},
    {2, HALVED, "deal.II step-10, degree 1: pi by perimeter",
     "3.1317e-01 8.0125e-02 2.0148e-02 5.0442e-03 1.2615e-03 3.1540e-04", NULL},
    {4, HALVED, "deal.II step-10, degree 2: pi by perimeter",
     "1.6700e-02 1.1876e-03 7.6890e-05 4.8493e-06 3.0377e-07 1.8997e-08", NULL},
    {6, HALVED, "deal.II step-10, degree 3: pi by perimeter",
     "9.8613e-05 1.3103e-06 1.9417e-08 2.9910e-10 4.6585e-12 7.7272e-14", NULL},
    {8, HALVED, "deal.II step-10, degree 4: pi by perimeter",
     "5.5065e-07 2.2160e-09 8.7232e-12 3.5527e-14 3.5527e-15 8.8818e-16", NULL},
    {1, HALVED, "deal.II step-20, degree 0: L2 of p",
     "1.45344 0.715099 0.356383 0.178055 0.0890105 0.0445032 0.0222513", NULL},
    {2, HALVED, "deal.II step-20, degree 1: L2 of p",
     "0.0831743 0.0245341 0.0063458 0.00159944 0.000400669 0.000100218 2.50576e-05", NULL},
    {3, HALVED, "deal.II step-20, degree 2: L2 of p",
     "0.0235186 0.00293983 0.000367478 4.59349e-05 5.74184e-06 7.17799e-07 9.0164e-08", NULL},
    {1, HALVED, "deal.II step-20, degree 0: L2 of u",
     "0.367423 0.175891 0.0869402 0.0433435 0.0216559 0.010826 0.00541274", NULL},
    {2, HALVED, "deal.II step-20, degree 1: L2 of u",
     "0.127657 0.0319142 0.00797856 0.00199464 0.00049866 0.000124664 3.1166e-05", NULL},
    {3, HALVED, "deal.II step-20, degree 2: L2 of u",
     "5.10388e-14 9.04414e-15 1.23723e-14 1.86345e-07 2.72566e-07 3.57141e-07 4.46124e-07", NULL},
    {1, HALVED, "deal.II step-34, 2D: alpha", "5.000e-02 2.500e-02 1.250e-02 6.250e-03", NULL},
    {2, HALVED, "deal.II step-47, Q2, gamma = 6: L2", "8.780e-03 3.515e-03 1.103e-03 3.084e-04",
     NULL},
    {2, HALVED, "deal.II step-47, Q2, gamma = 6: H1", "7.095e-02 2.174e-02 6.106e-03 1.622e-03",
     NULL},
    {1, HALVED, "deal.II step-47, Q2, gamma = 6: H2", "1.645 8.121e-01 4.015e-01 1.993e-01", NULL},
    {4, HALVED, "deal.II step-47, Q3: L2", "2.045e-04 1.312e-05 8.239e-07 5.158e-08", NULL},
    {3, HALVED, "deal.II step-47, Q3: H1", "4.402e-03 5.537e-04 6.904e-05 8.621e-06", NULL},
    {2, HALVED, "deal.II step-47, Q3: H2", "1.641e-01 4.096e-02 1.023e-02 2.558e-03", NULL},
    {5, HALVED, "deal.II step-47, Q4: L2", "6.510e-06 2.679e-07 9.404e-09 7.943e-10", NULL},
    {4, HALVED, "deal.II step-47, Q4: H1", "2.215e-04 1.569e-05 1.040e-06 6.693e-08", NULL},
    {3, HALVED, "deal.II step-47, Q4: H2", "1.275e-02 1.496e-03 1.774e-04 2.150e-05", NULL},
    {2, HALVED, "deal.II step-47, Q2, gamma = 1: L2", "7.350e-02 6.798e-03 9.669e-04 1.755e-04",
     NULL},
    {1, HALVED, "deal.II step-47, Q2, gamma = 1: H1", "7.323e-01 1.716e-01 6.436e-02 2.831e-02",
     NULL},
    {2, HALVED, "deal.II step-47, Q2, gamma = 2: L2", "4.133e-02 6.500e-03 6.780e-04 1.622e-04",
     NULL},
    {2, HALVED, "deal.II step-47, Q2, gamma = 2: H1", "2.517e-01 5.916e-02 1.203e-02 2.448e-03",
     NULL},
    {1, HALVED, "deal.II step-47, Q2, gamma = 2: H2", "3.056 1.444 6.151e-01 2.618e-01", NULL},
    {2, SQUARES, "deal.II step-51, 2D, Q1: L2 of u",
     "1.804e+01 6.125e+00 9.785e-01 2.730e-01 1.493e-01 6.965e-02 4.018e-02 1.831e-02 1.043e-02 4.690e-03",
     NULL},
    {2, SQUARES, "deal.II step-51, 2D, Q1: L2 of gradient",
     "2.207e+01 9.472e+00 4.260e+00 1.866e+00 1.046e+00 4.846e-01 2.784e-01 1.264e-01 7.185e-02 3.228e-02",
     NULL},
    {3, SQUARES, "deal.II step-51, 2D, Q1: L2 of post-processed u",
     "1.798e+01 6.084e+00 7.102e-01 6.115e-02 2.880e-02 9.204e-03 4.027e-03 1.236e-03 5.306e-04 1.599e-04",
     NULL},
    {4, SQUARES, "deal.II step-51, 2D, Q3: L2 of u",
     "3.613e-01 6.411e-02 3.480e-02 8.297e-03 2.254e-03 4.558e-04 1.471e-04 2.956e-05 9.428e-06 1.876e-06",
     NULL},
    {4, SQUARES, "deal.II step-51, 2D, Q3: L2 of gradient",
     "1.891e+00 5.081e-01 2.533e-01 5.924e-02 1.636e-02 3.277e-03 1.052e-03 2.104e-04 6.697e-05 1.330e-05",
     NULL},
    {5, SQUARES, "deal.II step-51, 2D, Q3: L2 of post-processed u",
     "3.020e-01 3.238e-02 5.277e-03 6.330e-04 1.403e-04 1.844e-05 4.378e-06 5.750e-07 1.362e-07 1.788e-08",
     NULL},
    {2, CUBES, "deal.II step-51, 3D, Q1: L2 of u",
     "7.122e+00 5.491e+00 3.646e+00 1.595e+00 6.922e-01 2.915e-01 1.684e-01 7.972e-02 4.637e-02 2.133e-02",
     NULL},
    {2, CUBES, "deal.II step-51, 3D, Q1: L2 of gradient",
     "1.941e+01 2.184e+01 1.299e+01 8.550e+00 5.306e+00 2.490e+00 1.453e+00 6.861e-01 3.984e-01 1.830e-01",
     NULL},
    {3, CUBES, "deal.II step-51, 3D, Q1: L2 of post-processed u",
     "6.102e+00 4.448e+00 3.306e+00 1.441e+00 2.511e-01 8.588e-02 4.055e-02 1.335e-02 5.932e-03 1.851e-03",
     NULL},
    {4, CUBES, "deal.II step-51, 3D, Q3: L2 of u",
     "5.670e+00 1.048e+00 2.831e-01 7.883e-02 3.642e-02 8.546e-03 2.598e-03 5.314e-04 1.723e-04 3.482e-05",
     NULL},
    {4, CUBES, "deal.II step-51, 3D, Q3: L2 of gradient",
     "1.868e+01 6.988e+00 2.710e+00 7.721e-01 3.305e-01 7.581e-02 2.313e-02 4.697e-03 1.517e-03 3.055e-04",
     NULL},
    {5, CUBES, "deal.II step-51, 3D, Q3: L2 of post-processed u",
     "5.462e+00 8.011e-01 1.363e-01 2.158e-02 5.231e-03 7.640e-04 1.783e-04 2.355e-05 5.602e-06 7.374e-07",
     NULL},
    {1, HALVED, "deal.II step-61, degree 0: L2 of pressure",
     "1.587e-01 8.000e-02 4.006e-02 2.004e-02", NULL},
    {1, HALVED, "deal.II step-61, degree 0: L2 of velocity",
     "5.113e-01 2.529e-01 1.260e-01 6.297e-02", NULL},
    {1, HALVED, "deal.II step-61, degree 0: L2 of flux", "7.062e-01 3.554e-01 1.780e-01 8.902e-02",
     NULL},
    {2, HALVED, "deal.II step-61, degree 1: L2 of pressure",
     "1.613e-02 4.056e-03 1.015e-03 2.540e-04", NULL},
    {2, HALVED, "deal.II step-61, degree 1: L2 of velocity",
     "5.093e-02 1.276e-02 3.191e-03 7.979e-04", NULL},
    {2, HALVED, "deal.II step-61, degree 1: L2 of flux", "7.167e-02 1.802e-02 4.512e-03 1.128e-03",
     NULL},
    {3, HALVED, "deal.II step-61, degree 2: L2 of pressure",
     "1.072e-03 1.347e-04 1.685e-05 2.107e-06", NULL},
    {3, HALVED, "deal.II step-61, degree 2: L2 of velocity",
     "3.375e-03 4.233e-04 5.295e-05 6.620e-06", NULL},
    {3, HALVED, "deal.II step-61, degree 2: L2 of flux", "4.762e-03 5.982e-04 7.487e-05 9.362e-06",
     NULL},
    {2, HALVED, "deal.II step-78: L2",
     "1.667e-01 3.906e-02 9.679e-03 2.405e-03 5.967e-04 1.457e-04 3.307e-05 5.016e-06", NULL},
    {1, HALVED, "deal.II step-78: H1",
     "5.774e-01 2.889e-01 1.444e-01 7.218e-02 3.609e-02 1.804e-02 9.022e-03 4.511e-03", NULL},
    {1, HALVED, "deal.II step-82, degree 2: H2",
     "5.651e-02 3.095e-02 1.511e-02 7.353e-03 3.609e-03 1.785e-03", NULL},
    {2, HALVED, "deal.II step-82, degree 2: H1",
     "3.366e-03 1.284e-03 3.997e-04 1.129e-04 3.024e-05 7.850e-06", NULL},
    {2, HALVED, "deal.II step-82, degree 2: L2",
     "3.473e-04 1.369e-04 5.339e-05 1.691e-05 4.789e-06 1.277e-06", NULL},
    {2, HALVED, "deal.II step-82, degree 3: H2",
     "1.451e-02 3.565e-03 8.891e-04 2.223e-04 5.560e-05 1.390e-05", NULL},
    {3, HALVED, "deal.II step-82, degree 3: H1",
     "5.494e-04 6.870e-05 8.584e-06 1.073e-06 1.341e-07 1.676e-08", NULL},
    {4, HALVED, "deal.II step-82, degree 3: L2",
     "3.035e-05 2.091e-06 1.352e-07 8.594e-09 5.418e-10 3.245e-11", NULL},
    {2, HALVED, "deal.II step-85: L2", "8.0657e-02 1.8711e-02 4.1624e-03 9.3979e-04", NULL},
    {2, HALVED, "deal.II step-90: L2",
     "7.6322e-02 1.1950e-02 1.7306e-03 3.6276e-04 7.5910e-05 1.7279e-05 4.3891e-06", NULL},
    {1, HALVED, "deal.II step-90: H1",
     "3.6212e-01 1.4752e-01 7.4723e-02 3.9329e-02 1.9694e-02 9.8443e-03 4.9219e-03", NULL},
    {1, HALVED, "deal.II step-90: stabilisation",
     "2.2423e-01 1.1238e-01 6.1131e-02 3.0185e-02 1.4875e-02 7.4067e-03 3.7042e-03", NULL},
    {2, HALVED, "deal.II step-95, Q1: L2", "8.3792e-02 1.9073e-02 4.2112e-03 9.4586e-04", NULL},
    {3, HALVED, "deal.II step-95, Q2: L2", "1.2442e-04 9.6514e-06 8.3693e-07 7.4062e-08", NULL},
    {2, HALVED, "deal.II step-95, DG, Q1: L2", "7.8706e-02 1.8413e-02 4.0863e-03 9.3191e-04", NULL},
    {3, HALVED, "deal.II step-95, DG, Q2: L2", "1.5622e-04 1.0739e-05 1.0044e-06 7.9919e-08", NULL},
    {3, HALVED, "deal.II step-104: velocity", "4.5e-02 6.0e-03 7.6e-04 9.6e-05 1.2e-05 1.5e-06",
     NULL},
    {2, HALVED, "deal.II step-104: pressure", "1.5e-01 1.2e-02 1.2e-03 2.3e-04 5.6e-05 1.4e-05",
     NULL},
    {2, HALVED, "parallel_in_time: L2", "6.036e-03 1.735e-03 4.513e-04 1.140e-04 2.859e-05", NULL},
    {1, HALVED, "parallel_in_time: H1", "6.970e-02 3.414e-02 1.690e-02 8.426e-03 4.209e-03", NULL},
    {2, HALVED, "parallel_in_time: Linf", "7.557e-03 2.721e-03 7.410e-04 1.877e-04 4.715e-05",
     NULL},
    {4, HALVED, "Trixi: l2", "9.14e-06 5.69e-07 3.55e-08 2.22e-09", NULL},
    {4, HALVED, "Trixi: linf", "6.44e-05 4.11e-06 2.58e-07 1.62e-08", NULL},
    {1, HALVED, "mirgecom, N = 2: heat",
     "1.7834496275775333 0.6968572287595005 0.31670333794087324 0.15230421159162905 0.07483467000993342 0.03710968141446858",
     NULL},
    {2, HALVED, "mirgecom, N = 3: heat",
     "0.6610622776093845 0.16020897329634504 0.038383352453954044 0.009168145283721212 0.0022301145386689797 0.000549392786785",
     NULL},
    {2, HALVED, "Ferrite: L2", "0.202511 0.0510494 0.0128262 0.00321117 0.00080309 0.000200791",
     NULL},
    {1, HALVED, "Ferrite: H1", "1.00388 0.502255 0.251625 0.125888 0.0629537 0.0314781", NULL},
    {1, LISTED, "pycaputo, Caputo: L2 method",
     "6.659753e-02 3.341454e-02 1.690615e-02 8.552690e-03 4.318041e-03 2.175312e-03 1.455290e-03 1.093799e-03",
     "3.333e-02 1.613e-02 7.937e-03 3.937e-03 1.961e-03 9.785e-04 6.519e-04 4.888e-04"},
    {2, LISTED, "pycaputo, Riemann-Liouville: L2 method",
     "3.686930e-02 9.678625e-03 2.593723e-03 6.847805e-04 1.774681e-04 4.536133e-05 2.033538e-05 1.149314e-05",
     "3.333e-02 1.613e-02 7.937e-03 3.937e-03 1.961e-03 9.785e-04 6.519e-04 4.888e-04"},
    /* the later ones */
    {1, HALVED, "iFEM Maxwell ND0: L2 of u", "2.85095e-01 1.59317e-01 8.27814e-02 4.19067e-02",
     NULL},
    {2, HALVED, "iFEM Maxwell ND1: L2 of u", "2.41877e-02 6.28974e-03 1.59327e-03 4.00195e-04",
     NULL},
    {2, HALVED, "iFEM Maxwell ND2: L2 of u", "9.46920e-02 2.60741e-02 6.82809e-03 1.74533e-03",
     NULL},
    {2, HALVED, "iFEM P1, 3D: L2 of u", "7.70680e-02 2.35461e-02 6.27721e-03 1.59840e-03", NULL},
    {2, HALVED, "iFEM P1, 3D: H1 of u_I - u_h", "3.38890e-01 1.05354e-01 3.23192e-02 9.72436e-03",
     NULL},
    {3, HALVED, "iFEM P2, 3D: L2 of u", "4.33972e-03 5.63932e-04 7.20239e-05 9.12740e-06", NULL},
    {2.5, HALVED, "iFEM P2, 3D: H1 of u_I - u_h", "1.11359e-01 2.08121e-02 3.68308e-03 6.44578e-04",
     NULL},
    {2, HALVED, "iFEM P1: L2 of u", "1.29973e-03 3.25931e-04 8.15520e-05 2.03927e-05", NULL},
    {2, HALVED, "iFEM P1: H1 of u_I - u_h", "5.80361e-03 1.64867e-03 4.64515e-04 1.29765e-04",
     NULL},
    {3, HALVED, "iFEM P2: L2 of u", "4.45898e-04 5.64820e-05 7.10333e-06 8.90408e-07", NULL},
    {2.5, HALVED, "iFEM P2: H1 of u_I - u_h", "1.35282e-02 2.25947e-03 3.84722e-04 6.65670e-05",
     NULL},
    {4, HALVED, "iFEM P3: L2 of u", "4.29608e-04 2.60671e-05 1.60744e-06 9.99996e-08", NULL},
    {3, HALVED, "iFEM P3: H1 of u_I - u_h", "1.61466e-02 2.06194e-03 2.58554e-04 3.22882e-05",
     NULL},
    {2, HALVED, "iFEM CR: L2 of u", "5.18787e-03 1.30793e-03 3.27672e-04 8.19609e-05", NULL},
    {2, HALVED, "iFEM CR, 3D: L2 of u", "2.24448e-02 5.72292e-03 1.43932e-03 3.60390e-04", NULL},
    {2, HALVED, "iFEM WG: L2 of u", "1.76689e-02 4.83700e-03 1.28283e-03 3.30853e-04", NULL},
    {2, HALVED, "iFEM WG, 3D: L2 of u", "2.14311e-02 5.28526e-03 1.31642e-03 3.28925e-04", NULL},
    {1, HALVED, "iFEM RT0-P0: L2 of u", "1.35274e-01 6.55354e-02 3.27194e-02 1.63613e-02", NULL},
    {2, HALVED, "iFEM RT0-P0: L2 of u_I - u_h", "4.88517e-02 1.00318e-02 2.33376e-03 5.71884e-04",
     NULL},
    {1, HALVED, "iFEM BDM1-P0: L2 of u", "1.37562e-01 6.59922e-02 3.27830e-02 1.63694e-02", NULL},
    {2, HALVED, "iFEM BDM1-P0: L2 of u_I - u_h", "6.14647e-02 1.46240e-02 3.60849e-03 8.99021e-04",
     NULL},
    {2, HALVED, "iFEM Stokes CR-P0: L2 of u", "4.90098e-02 1.28301e-02 3.25995e-03 8.19377e-04",
     NULL},
    {1.5, HALVED, "iFEM Stokes CR-P0: L2 of p_I - p_h",
     "6.34277e-01 2.17142e-01 7.60130e-02 2.96038e-02", NULL},
    {1, HALVED, "iFEM Stokes CR-P0: L2 of p", "9.42925e-01 4.10772e-01 1.90168e-01 9.20441e-02",
     NULL},
    {1.5, HALVED, "iFEM Stokes P1b-P1: H1 of u_I - u_h",
     "1.80268e-01 6.32875e-02 2.21618e-02 7.77049e-03", NULL},
    {2, HALVED, "iFEM Stokes P1b-P1: L2 of u", "2.14012e-02 5.32944e-03 1.32998e-03 3.32204e-04",
     NULL},
    {1.5, HALVED, "iFEM Stokes P1b-P1: L2 of p", "7.11564e-01 2.20345e-01 7.02700e-02 2.31884e-02",
     NULL},
    {2, HALVED, "iFEM Stokes P2-P0: L2 of u", "1.21603e-02 3.17639e-03 8.10961e-04 2.04806e-04",
     NULL},
    {1, HALVED, "iFEM Stokes P2-P0: L2 of p", "7.05209e-01 3.50301e-01 1.74622e-01 8.72085e-02",
     NULL},
    {3, HALVED, "iFEM Stokes P2-P1: H1 of u_I - u_h",
     "1.43292e-03 1.80989e-04 2.27453e-05 2.91812e-06", NULL},
    {3, HALVED, "iFEM Stokes P2-P1: L2 of u", "2.40354e-04 2.99933e-05 3.74728e-06 4.68344e-07",
     NULL},
    {2, HALVED, "iFEM Stokes P2-P1: L2 of p", "1.65715e-02 4.08540e-03 1.01768e-03 2.54193e-04",
     NULL},
    {2, HALVED, "iFEM Stokes isoP2-P0: L2 of u", "1.17716e-02 3.05876e-03 7.78951e-04 1.96476e-04",
     NULL},
    {1, HALVED, "iFEM Stokes isoP2-P0: L2 of p", "7.56862e-01 3.76809e-01 1.88036e-01 9.39433e-02",
     NULL},
    {1.5, HALVED, "iFEM Stokes isoP2-P1: H1 of u_I - u_h",
     "6.44313e-02 2.02371e-02 6.56641e-03 2.19661e-03", NULL},
    {2, HALVED, "iFEM Stokes isoP2-P1: L2 of u", "3.76942e-03 9.25164e-04 2.29540e-04 5.71966e-05",
     NULL},
    {0.5, HALVED, "iFEM Stokes RT0-P0, bisected: L2 of p",
     "2.17524e+00 1.20769e+00 7.39582e-01 4.82431e-01", NULL},
    {0.5, HALVED, "iFEM Stokes RT0-P0, bisected: L2 of vorticity",
     "2.04257e+00 1.13439e+00 6.85950e-01 4.42065e-01", NULL},
    {1, HALVED, "iFEM Stokes RT0-P0, red: L2 of p_I - p_h",
     "1.29413e+00 5.01835e-01 1.99327e-01 8.63987e-02", NULL},
    {1, HALVED, "iFEM Stokes RT0-P0, red: L2 of vorticity",
     "2.21436e+00 1.08270e+00 5.35842e-01 2.67015e-01", NULL},
    {2, HALVED, "iFEM Stokes BDM1b-P0: L2 of u", "4.38331e-02 1.08772e-02 2.70990e-03 6.76340e-04",
     NULL},
    {1.5, HALVED, "iFEM Stokes BDM1b-P0: L2 of vorticity",
     "3.51241e-01 1.23521e-01 4.35171e-02 1.53552e-02", NULL},
    {1, HALVED, "iFEM Stokes BDM1b-P0: L2 of p", "1.39408e+00 6.97704e-01 3.48805e-01 1.74363e-01",
     NULL},
    {1.5, HALVED, "iFEM Stokes BDM1b-P0: L2 of p_I - p_h",
     "1.13398e-01 3.92539e-02 1.38100e-02 4.88052e-03", NULL},
    {1.5, HALVED, "iFEM Stokes BDM1b-P0: L2 of recovered p",
     "6.01561e-01 1.76040e-01 5.34677e-02 1.70432e-02", NULL},
    {1, LISTED, "iFEM VEM: H1 of u_I - u_h",
     "7.32287e-02 2.63733e-02 1.06655e-02 4.93804e-03 2.28291e-03",
     "0.087706 0.044108 0.022119 0.011065 0.0055341"},
    {2, LISTED, "iFEM VEM: max of u_I - u_h",
     "2.80832e-02 7.54620e-03 1.66407e-03 5.48253e-04 1.16791e-04",
     "0.087706 0.044108 0.022119 0.011065 0.0055341"},
    {1, LISTED, "decay-book: forward difference",
     "2.23E-01 1.86E-02 1.18E-03 7.40E-05 4.63E-06 2.89E-07 1.76E-08 6.64E-09 6.64E-09 1.42E-06 3.67E-05 8.91E-04 1.28E-02 1.07E-01 6.07E-01 6.07E-01",
     "1 0.0625 0.00390625 0.000244140625 1.525878906e-05 9.536743164e-07 5.960464478e-08 3.725290298e-09 2.328306437e-10 1.455191523e-11 9.094947018e-13 5.684341886e-14 3.552713679e-15 2.220446049e-16 1.387778781e-17 8.67361738e-19"},
    {1, LISTED, "decay-book: backward difference",
     "4.36E-01 1.94E-02 1.19E-03 7.40E-05 4.63E-06 2.89E-07 1.78E-08 6.64E-09 6.64E-09 1.42E-06 3.67E-05 8.91E-04 1.28E-02 1.07E-01 6.07E-01 6.07E-01",
     "1 0.0625 0.00390625 0.000244140625 1.525878906e-05 9.536743164e-07 5.960464478e-08 3.725290298e-09 2.328306437e-10 1.455191523e-11 9.094947018e-13 5.684341886e-14 3.552713679e-15 2.220446049e-16 1.387778781e-17 8.67361738e-19"},
    {2, LISTED, "decay-book: centered difference",
     "1.06E-01 3.95E-04 1.54E-06 6.03E-09 2.12E-11 3.01E-12 1.19E-10 6.64E-09 6.64E-09 1.42E-06 3.67E-05 8.91E-04 1.28E-02 1.07E-01 6.07E-01 6.07E-01",
     "1 0.0625 0.00390625 0.000244140625 1.525878906e-05 9.536743164e-07 5.960464478e-08 3.725290298e-09 2.328306437e-10 1.455191523e-11 9.094947018e-13 5.684341886e-14 3.552713679e-15 2.220446049e-16 1.387778781e-17 8.67361738e-19"},
    {2, LISTED, "decay-book: trapezoidal rule",
     "3.07E-01 2.04E-02 1.28E-03 7.99E-05 4.99E-06 3.12E-07 1.95E-08 1.22E-09 7.62E-11 4.74E-12 3.62E-13",
     "0.5 0.125 0.03125 0.0078125 0.001953125 0.00048828125 0.0001220703125 3.051757812e-05 7.629394531e-06 1.907348633e-06 4.768371582e-07"},
    {2, LISTED, "decay-book: midpoint rule",
     "1.46E-01 1.02E-02 6.39E-04 3.99E-05 2.50E-06 1.56E-07 9.75E-09 6.10E-10 3.81E-11 2.38E-12 2.33E-13",
     "0.5 0.125 0.03125 0.0078125 0.001953125 0.00048828125 0.0001220703125 3.051757812e-05 7.629394531e-06 1.907348633e-06 4.768371582e-07"},
    {5, HALVED, "EarthSci WENO5: Linf", "3.4137e-05 1.0656e-06 3.3254e-08 1.0377e-09", NULL},
    {3, HALVED, "EarthSci PPM: Linf", "2.9052e-03 2.2013e-04 2.1838e-05 2.6265e-06", NULL},
    {5, HALVED, "EarthSci WENO5, 2D: Linf", "1.0733e-03 3.4081e-05 1.0643e-06 3.3249e-08", NULL},
    {1, HALVED, "weno_singular WENO5, point source upwind: L1",
     "6.72e-02 3.35e-02 1.67e-02 8.35e-03 4.17e-03", NULL},
    {4, HALVED, "Castro SDC-4, diffusion: Linf",
     "8.639542243e-05 5.84073812e-06 3.725743019e-07 2.340631822e-08", NULL},
    {4, HALVED, "Castro SDC-4, hydrostatic: largest velocity",
     "0.018841266999 0.0011894966175 8.7006924189e-05 1.2416964741e-05", NULL},
    {2, HALVED, "Kirkup BEM, constant elements", "1.02e-2 2.26e-3 7.10e-4 1.93e-4 5.03e-5 1.28e-5",
     NULL},
    {0.5, LISTED, "Monte Carlo, z to 1.5", "0.087891 0.012235 0.008592 0.006104 0.000502",
     "1e-2 1e-3 1e-4 1e-5 1e-6"},
    {0.5, LISTED, "Monte Carlo, z to 125", "7.560841 0.285191 0.239708 0.235247",
     "1e-2 1e-4 1e-5 1e-6"},
    {2, HALVED, "Trixi FV, 1D: l2 of rho", "4.82e-04 1.17e-04 2.96e-05 7.38e-06", NULL},
    {2, HALVED, "Trixi FV, 1D: l2 of energy", "7.90e-04 1.92e-04 4.87e-05 1.22e-05", NULL},
    {2, HALVED, "Trixi FV, 1D: linf of rho", "1.45e-03 3.64e-04 9.48e-05 2.55e-05", NULL},
    {2, HALVED, "Trixi FV, 2D, structured: l2 of rho", "1.93e-03 4.86e-04 1.19e-04 2.87e-05", NULL},
    {2, HALVED, "Trixi FV, 2D, structured: l2 of energy", "4.70e-03 1.15e-03 2.79e-04 6.83e-05",
     NULL},
    {2, HALVED, "Trixi FV, 2D, structured: linf of rho", "5.67e-03 1.94e-03 6.14e-04 1.70e-04",
     NULL},
    {2, HALVED, "Trixi FV, 2D, structured: linf of energy", "1.44e-02 4.00e-03 1.04e-03 2.75e-04",
     NULL},
    {2, HALVED, "Trixi FV, 2D, tree: l2 of rho", "2.50e-03 6.56e-04 1.60e-04 3.91e-05", NULL},
    {2, HALVED, "Trixi FV, 2D, tree: l2 of energy", "5.33e-03 1.32e-03 3.17e-04 7.79e-05", NULL},
    {2, HALVED, "Trixi FV, 2D, tree: linf of rho", "5.80e-03 1.93e-03 5.85e-04 1.62e-04", NULL},
    {2, HALVED, "Trixi FV, 2D, tree: linf of energy", "1.49e-02 3.94e-03 1.07e-03 2.87e-04", NULL},
    {2, HALVED, "Trixi FV, 3D, tree: l2", "2.34e-02 4.89e-03 1.15e-03 2.72e-04", NULL},
    {2, HALVED, "Trixi FV, 3D, tree: linf", "7.14e-02 1.87e-02 5.17e-03 1.46e-03", NULL},
    {4, HALVED, "Trixi sphere, degree 3: l2 of rho", "8.45e-03 8.47e-04 2.30e-05 1.06e-06", NULL},
    {4, HALVED, "Trixi sphere, degree 3: l2 of rho v1", "8.23e-03 8.17e-04 2.26e-05 9.43e-07",
     NULL},
    {4, HALVED, "Trixi sphere, degree 3: l2 of rho v3", "1.84e-03 2.04e-04 4.08e-06 3.73e-07",
     NULL},
    {1, LISTED, "mirgecom vortex, degree 1",
     "1.7441922831117675 1.2752916875582745 0.7730956445395745 0.1999643584725899 0.10002099667222199",
     "0.6666666666666666 0.3225806451612903 0.15873015873015872 0.0392156862745098 0.019569471624266144"},
    {2, LISTED, "mirgecom vortex, degree 2",
     "1.5100385589115102 0.6358166704048114 0.18214371452252343 0.011578972118560385 0.002890081385315724",
     "0.6666666666666666 0.3225806451612903 0.15873015873015872 0.0392156862745098 0.019569471624266144"},
    {1, HALVED, "gFlex 1D, clamped ends, first version: Linf",
     "4.34e-2 2.75e-2 1.54e-2 8.11e-3 4.16e-3 2.11e-3", NULL},
    {2, HALVED, "gFlex 1D, clamped ends: Linf", "1.84e-3 4.55e-4 1.14e-4 2.85e-5 7.12e-6 1.78e-6",
     NULL},
    {1, HALVED, "gFlex 1D, free ends, first version: Linf",
     "9.00e-2 6.97e-2 3.90e-2 2.02e-2 1.02e-2 5.14e-3", NULL},
    {2, HALVED, "gFlex 1D, free ends: Linf", "1.72e-2 4.40e-3 1.11e-3 2.77e-4 6.93e-5 1.73e-5",
     NULL},
    {2, LISTED, "OpenPFC heat, order 2: L2",
     "2.2973362182e-02 1.0334048779e-02 5.8366153945e-03 2.6014854303e-03 1.4647885583e-03",
     "0.3926990817 0.2617993878 0.19634954085 0.1308996939 0.098174770425"},
    {4, LISTED, "OpenPFC heat, order 4: L2",
     "3.8542332570e-03 8.1261437507e-04 2.6321391811e-04 5.2882208886e-05 1.6832636452e-05",
     "0.3926990817 0.2617993878 0.19634954085 0.1308996939 0.098174770425"},
    {8, LISTED, "OpenPFC heat, order 8: L2",
     "1.7448773470e-04 8.1066386336e-06 8.6284145397e-07 3.5173506204e-08 3.5757795961e-09",
     "0.3926990817 0.2617993878 0.19634954085 0.1308996939 0.098174770425"},
    {12, LISTED, "OpenPFC heat, order 12: L2",
     "1.0191814580e-05 1.0521021754e-07 3.6916810755e-09 3.0577867297e-11 1.0129478185e-12",
     "0.3926990817 0.2617993878 0.19634954085 0.1308996939 0.098174770425"},
    {2, HALVED, "DispersiveShallowWater BBM-BBM, walls: l2 of eta",
     "1.18e-01 2.68e-02 6.43e-03 1.58e-03", NULL},
    {2, HALVED, "DispersiveShallowWater BBM-BBM, walls: l2 of v",
     "1.01e-01 2.26e-02 5.43e-03 1.33e-03", NULL},
    {2, HALVED, "DispersiveShallowWater hyperbolic SGN, walls: l2 of v",
     "6.18e-03 1.47e-03 3.59e-04 8.89e-05 2.21e-05", NULL},
    {2, HALVED, "IPPL Poisson, periodic: relative error",
     "0.06610999025353671 0.01511692691447935 0.003724276265077857 0.000927748509094244 0.0002317313213524396 5.791999424903597e-05",
     NULL},
    {1, HALVED, "libMesh RT0, hybridized: L2 of u", "0.972572 0.500032 0.251364 0.125855", NULL},
    {1, HALVED, "libMesh RT0, hybridized: L2 of div u", "2.43859 1.27137 0.643384 0.322662", NULL},
    {1, LISTED, "FNC forward difference",
     "0.5316698672980729 0.16675169931001355 0.04278399066110605 0.010751437812063891 0.002691131271080671 0.0006729843309356554 0.00016825863274316788 4.2065436150373614e-05",
     "0.25 0.0625 0.015625 0.00390625 0.0009765625 0.000244140625 6.103515625e-05 1.52587890625e-05"},
    {2, LISTED, "FNC centered difference",
     "0.08589720009317459 0.004443830592427034 0.00027402935583697996 1.711231996370799e-5 1.0694634058339147e-6 6.684110775978525e-8 4.176695433955047e-9 2.7268942659475215e-10",
     "0.25 0.0625 0.015625 0.00390625 0.0009765625 0.000244140625 6.103515625e-05 1.52587890625e-05"},
    {2, HALVED, "FNC trapezoid formula",
     "0.0009168471592517768 0.00023006461762786756 5.7567555966198114e-5 1.4395072795103658e-5 3.598966740625542e-6 8.997540876798382e-7",
     NULL},
    {4, HALVED, "Olson RK4, 10 to 5120 steps",
     "1.025448593046163e-03 4.670956141906470e-05 2.528044066861176e-06 1.437479595469207e-07 8.504710330946297e-09 5.161617687085562e-10 3.177485878580466e-11 1.970613776325347e-12 1.228739332503892e-13 7.575537419590717e-15",
     NULL},
    {2, HALVED, "Euler's method of sin x from 0 to pi", "0.01648 0.00411 0.00103 0.00026", NULL},
    {3, HALVED, "CADET radial, WENO 2",
     "4.37e-07 5.87e-08 7.56e-09 9.66e-10 1.22e-10 1.55e-11 1.95e-12 2.45e-13", NULL},
    {2, HALVED, "CADET radial, Koren, unequal cells",
     "1.16e-05 4.31e-06 1.28e-06 3.47e-07 9.05e-08 2.31e-08 5.83e-09 1.46e-09", NULL},
    {5, HALVED, "CADET radial, WENO 3", "2.32e-10 1.32e-11 4.77e-13 1.11e-14", NULL},
    {2, HALVED, "CADET frustum, WENO 3 of second order: Linf",
     "4.686183477280612e-01 3.2001568531397706e-01 1.3927644092822522e-01 3.653081885155163e-02 7.310039555163295e-03 1.2200205897086036e-03 1.9713005811072826e-04 3.021944192715953e-05 4.266123197038674e-06 6.269278461923378e-07 1.1262657717558966e-07 2.480393157533456e-08 5.841918171434202e-09",
     NULL},
    {2, HALVED, "MFMFE, k = 2: L2 of u", "1.24E-01 3.16E-02 7.87E-03 1.96E-03 4.89E-04 1.22E-04",
     NULL},
    {2, HALVED, "MFMFE, k = 2: L2 of div u",
     "8.77E-01 2.21E-01 5.55E-02 1.39E-02 3.47E-03 8.68E-04", NULL},
    {2, HALVED, "MFMFE, k = 2: L2 of p", "9.04E-03 2.24E-03 5.59E-04 1.40E-04 3.49E-05 8.73E-06",
     NULL},
    {3, HALVED, "MFMFE, k = 2: p at Gaussian points",
     "7.95E-04 1.07E-04 1.43E-05 1.87E-06 2.38E-07 3.01E-08", NULL},
    {3, HALVED, "Lethe Taylor-Couette, Q2-Q1: velocity",
     "9.623524e-05 1.270925e-05 1.613718e-06 2.025381e-07", NULL},
    {2, HALVED, "Lethe Taylor-Couette, Q2-Q1: pressure",
     "2.595531e-04 6.696872e-05 1.675237e-05 4.181523e-06", NULL},
    {2, HALVED, "Burkardt fem1d_bvp_linear 06: L2", "0.005798 0.001453 0.000363 0.000091 0.000023",
     NULL},
    {1, HALVED, "Burkardt fem1d_bvp_linear 06: H1", "0.201186 0.100697 0.050361 0.025182 0.012591",
     NULL},
    {2, HALVED, "Burkardt fem1d_bvp_linear 07: L2", "0.054894 0.015170 0.004950 0.001267 0.000317",
     NULL},
    {1, HALVED, "Burkardt fem1d_bvp_linear 07: H1", "2.119623 1.069906 0.685573 0.350963 0.176055",
     NULL},
    {2, HALVED, "BenchPhaseFlow 1D Poisson: L2",
     "0.0167693 0.00342658 0.00078618 0.000188837 4.63044e-05 1.14664e-05", NULL},
    {2, HALVED, "BenchPhaseFlow Johansen-Colella 1: L1",
     "3.46055e-05 1.04216e-05 2.95771e-06 7.82001e-07 2.20462e-07", NULL},
    {1, HALVED, "BenchPhaseFlow heat, Robin, backward Euler: L2",
     "0.215184 0.15327 0.0709314 0.0239428 0.0253672 0.00611887 0.00307128", NULL},
    {4, HALVED, "Trixi polytropic, degree 3: l2 of rho",
     "1.67e-03 1.32e-04 1.02e-05 6.56e-07 3.58e-08", NULL},
    {4, HALVED, "Trixi polytropic, degree 3: l2 of rho v1",
     "2.59e-03 1.34e-04 8.57e-06 5.26e-07 3.09e-08", NULL},
    {4, HALVED, "Trixi polytropic, degree 3: l2 of rho v2",
     "3.28e-03 2.06e-04 1.24e-05 7.26e-07 4.52e-08", NULL},
    {4, HALVED, "Trixi flux comparison, degree 3: l2 of rho", "6.23e-06 4.42e-07 2.03e-08 5.29e-10",
     NULL},
};
enum {
    BR_PUBLISHED = sizeof br_published / sizeof *br_published,
    BR_PUBLISHED_FIRST = 85, /* the later ones follow */
    BR_PUBLISHED_LAST = 164, /* and after them the last ones */
};

static inline struct br_error_line br_published_line(const struct br_published *p)
{
    static const double edge[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96};
    struct br_error_line line = {.truth = p->order};
    const char *sizes = p->sizes;
    char *end = (char *)p->errors;
    for (size_t i = 0; *end && i < BR_MOST_ERRORS; i++, line.rows++) {
        line.e[i] = strtod(end, &end);
        char *next;
        const double size = sizes ? strtod(sizes, &next) : 0;
        sizes = sizes ? next : NULL;
        line.h[i] = p->mesh_sequence == HALVED     ? pow(0.5, (double)i)
                    : p->mesh_sequence == SQUARES  ? 1 / edge[i + 2]
                    : p->mesh_sequence == CUBES    ? 1 / edge[i]
                    : p->mesh_sequence == UNKNOWNS ? 1 / sqrt(size)
                                                   : size;
    }
    return line;
}

#endif
