#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""-div grad u = f on the unit square, u = exp(x + 2 y) sin(pi x) sin(pi y), by the five-point formula
(order 2) or the compact nine-point one (order 4), with SciPy's sparse solver.
usage: sparse.py N ORDER; prints the error in l2, the root mean square over the nodes."""
import sys

import numpy as np
from scipy.sparse import diags, eye, kron
from scipy.sparse.linalg import spsolve

n, order = int(sys.argv[1]), int(sys.argv[2])
h, pi = 1 / n, np.pi
at = np.linspace(0, 1, n + 1)


def a(x, c):
    return np.exp(c * x) * np.sin(pi * x)


def a2(x, c):
    return np.exp(c * x) * ((c**2 - pi**2) * np.sin(pi * x) + 2 * c * pi * np.cos(pi * x))


u = np.outer(a(at, 1), a(at, 2))
f = -np.outer(a2(at, 1), a(at, 2)) - np.outer(a(at, 1), a2(at, 2))
second = diags([1, -2, 1], [-1, 0, 1], shape=(n - 1, n - 1))
one = eye(n - 1)
matrix = -kron(second, one) - kron(one, second)
right = h**2 * f[1:-1, 1:-1]
if order == 4:
    matrix = matrix - kron(second, second) / 6
    right = right + h**2 / 12 * (f[2:, 1:-1] + f[:-2, 1:-1] + f[1:-1, 2:] + f[1:-1, :-2] - 4 * f[1:-1, 1:-1])
found = spsolve(matrix.tocsc(), right.ravel())
print(f"l2 {h * np.linalg.norm(found - u[1:-1, 1:-1].ravel()):.6e}")
