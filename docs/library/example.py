# SPDX-License-Identifier: GPL-3.0-or-later
# %% [markdown]
# beamrate in Python, cell by cell. In front of it:
# `export PYTHONPATH=PREFIX/share/beamrate/python`, with the prefix of `meson install`.

# %% The orders of a table. A notebook shows the last line as a table.
import numpy as np

import beamrate

n = np.array([10, 20, 40, 80])
found = beamrate.orders({"n": n, "l2": 3.0 / n**2, "h1": 2.0 / n})
print(found)
found

# %% An order is a number with its interval
order = found["l2"].order
print(f"l2 converges with order {order:.2f}, between {order.low:.2f} and {order.high:.2f}")
assert 1.9 < order < 2.1 and np.isclose(order, 2)

# %% Errors over h, and a verdict
found = beamrate.orders([1.01e-2, 2.52e-3, 6.3e-4, 1.57e-4], h=[0.1, 0.05, 0.025, 0.0125])
order = found.order
print(f"order {order.value!r} {order.low!r} {order.high!r}")
case = found.check((beamrate.SPACE, 2, 0.1)).cases[0]
print(f"verdict {case.verdict}")

# %% Values on three grids: their limit, the observed order, the grid convergence index
found = beamrate.orders([0.2310, 0.2252, 0.2238], n=[20, 40, 80], values=True)
print(f"limit {found.limit:.4f}, p = {found.p:.2f}, GCI = {100 * found.gci:.2f} %")

# %% What is wrong is an exception
try:
    beamrate.orders({"n": n, "l2": -1.0 / n}, errors="l2")
except beamrate.BadInput as error:
    print(error)
