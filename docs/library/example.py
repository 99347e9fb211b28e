# SPDX-License-Identifier: GPL-3.0-or-later
# %% [markdown]
# beamrate in Python, cell by cell. In front of it:
# `export PYTHONPATH=PREFIX/share/beamrate/python`, with the prefix of `meson install`.

# %% A scene, and what to expect of a march of it
import numpy as np

import beamrate as br

scene = br.Scene("example2")
forecast = scene.foresee(n=20, steps=40)
print(f"{scene.info.title}: L = {scene.info.length} m, T = {scene.info.duration} s")
print(f"expected error of w: {forecast.error[br.BENDING].value:.2g} of the largest")
for warning in forecast.warnings:
    print(f"warning: {warning.text}")

# %% A march, step by step, and its fields
march = br.March(scene, n=20, steps=40)
w = np.empty((41, 21, 2))  # every time level; the columns are w and h w_x
velocity = np.empty((21, 2))
march.get(br.BENDING, w[0], velocity)
for level in range(1, 41):
    march.step()
    march.get(br.BENDING, w[level], velocity)
tip = march.tip()
print(f"tip.axial {tip.displacement[br.AXIAL]!r}")
print(f"tip.bending {tip.displacement[br.BENDING]!r}")
print(f"contact_force {tip.contact_force!r}")
print(f"friction_force {tip.friction_force!r}")
assert w[40, -1, 0] == tip.displacement[br.BENDING]

# %% The errors of a grid against the exact solution, and their order
study = br.Study(scene, n=[10, 20, 40], steps=[20, 40, 80])
for i, n in enumerate(study.n):
    for j, steps in enumerate(study.steps):
        print(f"error {n} {steps} {float(study.error[br.TOTAL, i, j])!r}")
q = study.fit().q
print(f"q {q.value!r} {q.low!r} {q.high!r}")

# %% The order of numbers of another program, and a verdict
h = np.array([0.1, 0.05, 0.025, 0.0125])
orders = br.Orders(np.array([1.01e-2, 2.52e-3, 6.3e-4, 1.57e-4]), h=h)
case = orders.check((br.SPACE, 2, 0.1)).cases[0]
print(f"order {case.order.value!r} {case.order.low!r} {case.order.high!r}")
print(f"verdict {case.verdict}")

# %% What is wrong is an exception
try:
    br.March(scene, 20, 40, scheme="eulr")
except br.BadInput as error:
    print(error)
