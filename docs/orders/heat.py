#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""u_t = u_xx on (0, 1), u = 0 at both ends, u = sin(pi x) exp(-pi^2 t), to t = 0.1.

Central differences and implicit Euler. usage: heat.py N K; prints the error in l2 as JSON."""
import json
import math
import sys


def solve(diagonal, side, right):
    """Thomas' algorithm; side stands above and below the diagonal."""
    pivot = [diagonal]
    u = right[:]
    for i in range(1, len(u)):
        factor = side / pivot[i - 1]
        pivot.append(diagonal - factor * side)
        u[i] -= factor * u[i - 1]
    u[-1] /= pivot[-1]
    for i in range(len(u) - 2, -1, -1):
        u[i] = (u[i] - side * u[i + 1]) / pivot[i]
    return u


n, k = int(sys.argv[1]), float(sys.argv[2])
end = 0.1
steps = round(end / k)
if abs(steps * k - end) > 1e-9 * end:
    sys.exit(f"K = {k} does not divide {end}")
h = 1 / n
mode = [math.sin(math.pi * i * h) for i in range(1, n)]
u = mode
for _ in range(steps):
    u = solve(1 + 2 * k / h**2, -k / h**2, u)
decay = math.exp(-(math.pi**2) * end)
error = math.sqrt(h * sum((a - decay * b) ** 2 for a, b in zip(u, mode)))
json.dump({"n": n, "k": k, "errors": {"l2": error}}, sys.stdout)
