# SPDX-License-Identifier: GPL-3.0-or-later
"""A plugin of pytest: the fixture `orders`, and --update-baseline.

    def test_order(orders):
        orders.check({"n": [8, 16, 32, 64], "l2": errors}, l2=2)

`check` fails unless each order passes, as `beamrate orders --expect` does, or where it has moved from
orders-baseline.json, beside the file of the test, by its tolerance, or a constant by a factor of 2.
pytest --update-baseline writes that file.
"""
import fcntl
import json
import math
import os

import pytest

BASELINE = "orders-baseline.json"
KEY = pytest.StashKey()  # of a test's Orders
FORMAT = {"format": "beamrate pytest", "version": 1}
MOST = 2  # a constant may change by such a factor
TOLERANCE = 0.1  # usual, and of orders that are at least so high


def pytest_addoption(parser):
    parser.getgroup("beamrate").addoption(
        "--update-baseline", action="store_true",
        help=f"write the orders that pass into {BASELINE}, beside the test")


@pytest.fixture
def orders(request):
    """Orders.check(frame, l2=2, h1=1): verdicts on orders of convergence."""
    made = request.node.stash[KEY] = Orders(request)
    return made


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_call(item):
    """Writes what a test has checked, once all of it has passed."""
    ended = yield
    made = item.stash.get(KEY, None)
    if made and made.update and made.cases and not ended.excinfo:
        _write(made.path, made.key, made.cases)


def _read(path):
    if not path.exists():
        return {}
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if {key: found[key] for key in FORMAT} == FORMAT:
            return found["tests"]
    except (ValueError, KeyError, TypeError):
        pass
    raise ValueError(f"{path}: expected a baseline, as pytest --update-baseline writes it into a new file")


def _write(path, key, cases):
    """Replaces the cases of one test; those of others, which may run beside this one, stay."""
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        tests = _read(path) | {key: cases}
        new = path.with_name(f"{path.name}.{os.getpid()}")
        new.write_text(json.dumps(FORMAT | {"tests": tests}, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        new.replace(path)
    finally:
        os.close(folder)


def _differences(case, before):
    """What is serious, as `beamrate check --compare` calls it."""
    order, was = case["order"], before["order"]  # None: there is none, as of exponential convergence
    if (order is None) != (was is None) or (order and not abs(order - was) < (before["tolerance"] or TOLERANCE)):
        yield f"the baseline's order is {was if was is None else format(was, '.2f')}"
    now, then = case["constant"], before["constant"]  # None: there is none
    if now and then and not 1 / MOST < now / then < MOST:
        yield f"the constant is {now / then:.3g} times the baseline's"
    elif bool(now) != bool(then):
        yield f"the constant is {now}, the baseline's {then}"


def _expected(columns, tolerance):
    """Of each column: axis (None: the only one), order and tolerance."""
    for name, expected in columns.items():
        axes = expected.items() if isinstance(expected, dict) else [(None, expected)]
        for axis, order in axes:
            yield (name, axis, *(order if isinstance(order, tuple) else (order, tolerance)))


class Orders:
    """See the fixture `orders`."""

    def __init__(self, request):
        self.path = request.node.path.parent / BASELINE
        self.key = f"{request.node.path.name}::{request.node.nodeid.partition('::')[2]}"
        self.update = request.config.getoption("--update-baseline")
        self.cases = {}

    def check(self, data, expect=None, *, tolerance=TOLERANCE, down_to=0, **columns):
        """data: all that beamrate.orders takes with its sizes in it, or what it returns. l2=2: the order of
        the column l2, within 0.1; l2=(2, 0.2): within 0.2; l2=(2, 0): at least 2; l2={"h": 2, "k": 1}: of a
        grid. expect: the same as a mapping, for names that are no words of Python: {"L2 error": 2}. Returns
        the orders."""
        __tracebackhide__ = True
        import beamrate  # not before it is needed: each start of pytest reads this file
        wanted = (expect or {}) | columns
        if not wanted:
            raise beamrate.BadInput("nothing is expected: name a column and its order, as l2=2")
        if not isinstance(data, beamrate.Orders):
            data = beamrate.orders(data, errors=list(wanted))
        failures, before = [], _read(self.path).get(self.key, {})
        for name, axis, order, within in _expected(wanted, tolerance):
            quantity = data[name]
            case = data.check((quantity._axis(axis), order, within, down_to), quantity=name).cases[0]
            key = f"{name}, {case.study}"
            if key in self.cases:
                raise beamrate.BadInput(f"{key}: is checked twice in one test, expected once")
            now = {"order": float(case.order) if math.isfinite(case.order) else None, "tolerance": within,
                   "constant": case.constant if math.isfinite(case.constant) else None}
            bad = [] if case.verdict == "PASS" else [f"{case.verdict}: {case.reason}"]
            if not bad and not self.update and key in before:
                bad = list(_differences(now, before[key]))
            failures += [f"{beamrate.said(quantity, case)}: {'; '.join(bad)}"] if bad else []
            self.cases[key] = now
        if failures:
            pytest.fail("\n".join(failures))
        return data
