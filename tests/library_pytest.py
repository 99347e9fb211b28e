# SPDX-License-Identifier: GPL-3.0-or-later
"""The plugin of pytest, in runs of pytest on made errors. usage: library_pytest.py [OPTION OF PYTEST...]"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

TEST = """
import os
def test_orders(orders):
    n = [8, 16, 32, 64, 128]
    factor, order = float(os.environ["FACTOR"]), float(os.environ["ORDER"])
    orders.check({"n": n, "l2": [factor * i ** -order for i in n], "h1": [1 / i for i in n]}, l2=2, h1=(1, 0.2))
def test_grid(orders):
    grid = [(h, k) for h in (1, .5, .25, .125) for k in (1, .5, .25, .125)]
    orders.check({"h": [h for h, _ in grid], "k": [k for _, k in grid],
                  "L2 error": [h ** 2 + k for h, k in grid]}, {"L2 error": {"h": 2, "k": 1}})
def test_two(orders):
    for order in (2, float(os.environ["ORDER"])):
        orders.check({"n": [8, 16, 32, 64, 128], f"e{order}": [i ** -order for i in (8, 16, 32, 64, 128)]},
                     {f"e{order}": 2})
"""
os.chdir(tempfile.mkdtemp())
Path("test_made.py").write_text(TEST)
baseline = Path("orders-baseline.json")


def run(code, *said, factor=1, order=2, options=()):
    ended = subprocess.run([sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *sys.argv[1:], *options],
                           env=os.environ | {"FACTOR": str(factor), "ORDER": str(order)}, capture_output=True,
                           text=True)
    assert ended.returncode == code, (ended.returncode, code, ended.stdout, ended.stderr)
    for text in said:
        assert text in ended.stdout, (text, ended.stdout)


run(0, "3 passed")
assert not baseline.exists()
run(1, "2 failed, 1 passed", order=1.5, options=["--update-baseline"])
run(1, "Failed: l2: order 1.50", "], expected 2 +- 0.1: FAIL: the order,", order=1.5)
assert list(json.loads(baseline.read_text())["tests"]) == ["test_made.py::test_grid"]  # what passes alone
run(0, options=["--update-baseline"])
made = json.loads(baseline.read_text())["tests"]
assert made["test_made.py::test_orders"]["l2, space"]["order"] - 2 < 1e-6, made
assert sorted(made["test_made.py::test_grid"]) == ["L2 error, space", "L2 error, time"], made
run(0, factor=1.9)
run(1, "Failed: l2: order 2.00", "], expected 2 +- 0.1: the constant is 2.1 times the baseline's", factor=2.1)
run(1, "the constant is 0.48 times the baseline's", factor=0.48)
run(0, factor=2.1, options=["--update-baseline"])
run(0, factor=2.1)
made = json.loads(baseline.read_text())
made["tests"]["test_made.py::test_orders"]["h1, space"]["order"] = 0.85
baseline.write_text(json.dumps(made))
run(0, factor=2.1)  # within 0.2
made["tests"]["test_made.py::test_orders"]["h1, space"]["order"] = 1.21
baseline.write_text(json.dumps(made))
run(1, "Failed: h1: order 1.00", "], expected 1 +- 0.2: the baseline's order is 1.21", factor=2.1)
for damaged in ("{", "{}", '{"format": "beamrate check", "version": 2, "tests": {}}'):
    baseline.write_text(damaged)
    run(1, "expected a baseline, as pytest --update-baseline writes it", options=["--update-baseline"])
    assert baseline.read_text() == damaged
print("ok")
