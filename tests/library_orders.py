# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders of arrays and frames in Python, against made numbers whose orders are known.

usage: library_orders.py [pandas | matplotlib]: with these instead of what stands in for them.
"""
import copy
import json
import math
import pickle
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import beamrate as br

N = np.array([10, 20, 40, 80, 160])


class Frame(dict):
    """What is used of a DataFrame: columns by name, and an index that may have a name."""

    def __init__(self, columns, index=None):
        super().__init__(columns)
        self.columns = list(columns)
        self.index = SimpleNamespace(names=[index])
        self.at_index = index

    def set_index(self, name):
        return Frame(dict(self), name)

    def reset_index(self):
        return Frame({key: self[key] for key in self.columns})

    def __iter__(self):
        return iter(key for key in self.columns if key != self.at_index)

    keys = __iter__


class Axes:
    """What is used of matplotlib's axes; it keeps what is drawn."""

    def __init__(self):
        self.drawn, self.bands, self.bars, self.labels = [], [], [], []

    def plot(self, x, y, *_, fillstyle="line", label=None, **__):
        self.drawn.append((fillstyle, list(x), list(y)))
        self.labels.append(label)

    def fill_between(self, x, low, high, **_):
        self.bands.append((list(x), list(low), list(high)))

    def errorbar(self, x, y, yerr, **_):
        self.bars.append((list(x)[0], list(y)[0], np.ravel(yerr).tolist()))

    def set(self, **texts):
        self.title = texts.get("title", getattr(self, "title", None))

    def legend(self):
        pass

    minorticks_off = legend


def close(found, expected, tolerance=1e-9):
    if not abs(found - expected) <= tolerance:
        raise AssertionError(f"found {found}, expected {expected}")


statuses = set()  # of the calls that failed


def refused(text, call, kind=(br.BadInput, TypeError, KeyError)):
    try:
        call()
    except kind as error:
        assert text in str(error), (text, str(error))
        if isinstance(error, br.Error) and error.status is not None:
            statuses.add((type(error), error.status))
    else:
        raise AssertionError(f"not refused: {text}")


def check_frame(frame):
    found = br.orders(frame)
    assert [q.name for q in found.quantities] == ["L2", "H1"], found.quantities
    assert repr(found).startswith("L2: order 2.000"), repr(found)
    assert "left aside: rate" in repr(found)
    close(found["L2"].order.value, 2, 1e-4)
    close(found["H1"].h.value, 1, 1e-4)  # numbers of few digits
    assert found["L2"].k is None and found["L2"].h.open == ""
    close(found["L2"].rates[1], 2)
    assert math.isnan(found["L2"].rates[0])
    assert [row["error"] for row in found["L2"].rows] == list(3.0 / N ** 2)  # to the last bit
    again = br.orders(frame.set_index("N"))  # a name of the index is a heading
    assert repr(again) == repr(found)
    found.assert_order(2, quantity="L2")
    for text in ("H1: order 1.00", "], expected 2 +- 0.1: FAIL: the order, 1.00"):
        refused(text, lambda: found.assert_order(2), AssertionError)
    found.assert_order("l2: h 2 +- 0.1; h1 >= 0.9")
    found.assert_order(0.9, tolerance=0)
    refused("H1: order 1.00", lambda: found.assert_order("L2=2, H1 >= 1.1"), AssertionError)
    refused("at least 1.1", lambda: found.assert_order(1.1, tolerance=0), AssertionError)
    refused("2 columns may be meant", lambda: found.check("2"))
    assert [case.measure for case in found.check("h1 = 1", "L2 >= 1.9").cases] == ["H1", "L2"]
    refused("expected one of ['L2', 'H1']", lambda: found["l2"])
    refused("expected columns of", lambda: br.orders(frame, h="dx"))


def check_arrays():
    error = 2 * (1 / N) ** 1.5
    for sizes in ({"n": N}, {"h": 1 / N}, {"k": 1 / N}, {"dt": list(1 / N)}, {"steps": N}, {"level": range(5)},
                  {"dofs": N ** 3, "dimension": 3}, {"dofs": N, "dimension": 1}):
        found = br.orders(error, **sizes)
        found.assert_order(1.5)
        close(found["error"].order.value, 1.5)
        assert (found["error"].h is None) == (not {"k", "dt", "steps"}.isdisjoint(sizes)), sizes
    close(br.orders(error, cells=N ** 3, dimension=3)["error"].order.value, 1.5)
    assumed = br.orders(error, dofs=N ** 2)
    assert "2-D assumed; --dimension 1 gives 0.75, 3 gives 2.25" in repr(assumed), assumed
    refused("state the dimension of the mesh", lambda: assumed.assert_order(1.5))
    assert "dimension" in assumed.order.open and repr(assumed.order).endswith(" (not settled)"), assumed.order
    frame = {"edge": 1 / N, "e": error, "more": 2 * error}
    assert [q.name for q in br.orders(frame, h="edge").quantities] == ["e", "more"]
    close(br.orders(frame, h="edge", errors="e")["e"].order.value, 1.5)
    close(br.orders(frame, h="edge", errors=["e"])["e"].order.value, 1.5)
    commas = {"n": N, "L2, u": 1 / N, "v": 1 / N**2}
    assert [q.name for q in br.orders(commas, errors=["L2, u"]).quantities] == ["L2, u"]
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write("n,e\n" + "".join(f"{n},{e!r}\n" for n, e in zip(N, error.tolist())))
        file.flush()
        close(br.orders(file.name)["e"].order.value, 1.5)
        refused(f"{file.name}: --error: there is no column 'q'", lambda: br.orders(file.name, errors="q"))
        refused("names of columns beside a file", lambda: br.orders(file.name, n=N))
        close(br.orders(file.name, h="n")["e"].order.value, -1.5)
        refused("no column 'dx'", lambda: br.orders(file.name, h="dx"))


def check_meaning():
    """Two sizes, cases, and types of columns: what a frame knows and a text does not."""
    both = {"h": 1 / N, "edge": 1 / N ** 1.5, "e": 1 / N}
    close(br.orders(both, h="h")["e"].order.value, 1, 1e-4)
    found = br.orders(both, h="edge")
    close(found["e"].order.value, 2 / 3, 1e-4)
    assert "left aside: h (another size)" in repr(found), found
    tidy = {"method": ["P1"] * 5 + ["P2"] * 5, "n": [*N, *N], "e": [*(1 / N ** 2), *(1 / N ** 3)]}
    found = br.orders(tidy)
    assert [q.name for q in found.quantities] == ["e [method = P1]", "e [method = P2]"], found
    close(found["e [method = P2]"].order.value, 3)
    close(br.orders(tidy, where={"method": "P1"})["e"].order.value, 2)
    refused("no row has method = 'P3'", lambda: br.orders(tidy, where={"method": "P3"}))
    refused("names without a comma", lambda: br.orders(tidy, where={"method": "P1,P2"}))
    days = np.datetime64("2026-05") + np.arange(5)
    found = br.orders({"n": N, "e": 1 / N ** 2, "day": days, "t": days - days[0], "ok": N > 0, "seed": N % 3})
    assert [q.name for q in found.quantities] == ["e"], found
    assert "day, t, ok (words)" in repr(found), found
    close(br.orders({"n": N, "e": 1 / N ** 2, "x": 1 / N}, columns={"x": "aside"})["e"].order.value, 2)
    refused("columns of", lambda: br.orders(both, columns={"x": "aside"}))


def check_grid():
    h, k = np.repeat(1 / N, 5), np.tile(0.1 / N, 5)
    found = br.orders({"h": h, "k": k, "e": h ** 2 + k})["e"]
    close(found.h.value, 2, 1e-6)
    close(found.k.value, 1, 1e-6)
    refused("refined in h and in k", lambda: found.order)
    both = br.orders({"h": h, "k": k, "e": h ** 2 + k})
    both.assert_order(2, axis="h")
    both.assert_order(1, axis="k")
    refused("e: order in h 2.00", lambda: both.assert_order(1, axis="h"), AssertionError)
    value = br.orders({"h": h, "k": k, "v": 7 + h ** 2 + k}, values="v")["v"]
    assert [row["in"] for row in value.limits][-2:] == ["k", "h and k"], value.limits
    close(value.limit, value.limits[-1]["limit"])
    close(value.gci, value.limits[-2]["gci_fine"])
    close(value.limit, 7, 1e-6)
    refused("axis: found 'x', expected 'h' or 'k'", lambda: both.assert_order(1, axis="x"))


def check_values():
    found = br.orders(7 + 3 / N ** 2, n=N, values=True)["value"]
    close(found.limit, 7)
    assert found.limit.low <= 7 <= found.limit.high
    close(found.p, 2)
    finest, before = 7 + 3 / 160 ** 2, 7 + 3 / 80 ** 2
    close(found.gci, 1.25 * (before - finest) / finest / 3, 1e-12)  # Celik et al., (7)
    both = br.orders({"n": N, "e": 1 / N, "cd": 7 + 3 / N ** 2}, values="cd", errors="e")
    assert [q.is_value for q in both.quantities] == [False, True]
    assert both["e"].limit is both["e"].p is both["e"].gci is None
    close(both["cd"].limit, 7)


def check_numbers():
    """Orders and limits are numbers, wherever one is wanted."""
    found = br.orders(3 / N ** 1.5, n=N)
    order = found.order
    assert type(order) is br.Number and isinstance(order, float)
    assert float(order) == order.value == found["error"].order == found["error"].h
    assert 1.4 < order < 1.6 and order != 2 and order <= 1.5 + 1e-9 and not order > 1.6
    assert order.low <= order <= order.high and order.open == ""
    close(2 * order - 1, 2)
    close(np.array([order, 2.5]).mean(), 2)
    assert np.isclose(order, 1.5) and np.float64(1) < order and max(order, 1) is order
    assert f"{order:.2f}" == "1.50" and json.loads(json.dumps(order)) == order
    assert repr(br.Number(2, 1.5, 2.5)) == str(br.Number(2, 1.5, 2.5)) == "2 [1.5, 2.5]"
    assert repr(br.Number(2, 1.9999999, 2.5)) == "2 [1.9999999, 2.5]"  # rounding hides no end
    assert repr(br.Number(4.0002, 3.996, 4.006)) == "4.0002 [3.996, 4.006]"
    for other in (copy.copy(order), pickle.loads(pickle.dumps(order))):
        assert (other, other.low, other.high, other.open) == (order, order.low, order.high, order.open)
    case = found.check((br.SPACE, 1.5, 0.1)).cases[0]
    assert case.order == order and case.order.low == order.low, case
    none = br.orders([4, 2, 1, 1], n=[1, 2, 4, 8], values=True)  # the last two differ by nothing
    assert all(map(math.isnan, (none.order, none.limit, none.p, none.gci))), none.quantities
    assert repr(none.order) == "nan" and not none.order > 0 and none.order != none.order
    refused("found 2 columns, expected one of ['e', 'f'] by name",
            lambda: br.orders({"n": N, "e": 1 / N, "f": 1 / N}).order)


def check_notebook():
    """The table of a notebook: sizes, then numbers and rates of each column."""
    error = 3.0 / N ** 2
    error[2] = np.nan
    text = br.orders({"n": N, "<l2>": error, "cd": 7 + 1 / N}, errors="<l2>", values="cd")._repr_html_()
    root = xml.etree.ElementTree.fromstring(f"<div>{text}</div>".replace("<br>", "<br/>"))
    rows = [["".join(cell.itertext()) for cell in row] for row in root.iter("tr")]
    assert rows[0] == ["n", "<l2>", "rate", "cd", "rate"], rows
    assert rows[1] == ["10", "3.000e-02", "", "7.1", ""], rows
    assert rows[2] == ["20", "7.500e-03", "2.00", "7.05", "1.00"], rows
    assert rows[3][:2] == ["40", "failed"] and len(rows) == 6, rows
    assert "".join(root[0].itertext()).startswith("<l2>: order 2.0"), text
    h, k = np.repeat(1 / N, 5), np.tile(0.1 / N, 5)
    text = br.orders({"h": h, "k": k, "e": h ** 2 + k})._repr_html_()
    assert "<th>h</th><th>k</th><th>e</th><th>rate in h</th><th>rate in k</th>" in text, text


def check_left_out():
    error = 3.0 / N ** 2
    error[0] = 5
    found = br.orders(error, n=N)["error"]
    assert [p.left_out for p in found.left_out] == ["not asymptotic"], found.left_out
    close(found.left_out[0].size, 0.1)
    error[2] = np.nan
    assert [p.left_out for p in br.orders(error, n=N)["error"].left_out][-1] == "failed"
    for missing in (np.nan, np.inf):  # at the finest size
        lost = br.orders([*(3.0 / N ** 2), missing], n=[*N, 320])
        refused("the finest row, n = 320, has no number; without it", lambda: lost.assert_order(2), AssertionError)
        refused("INCONCLUSIVE", lambda: lost.assert_order(2), AssertionError)
        br.orders([*(3.0 / N ** 2), missing], n=[*N, 320], without=320).assert_order(2)
    refused("INCONCLUSIVE", lambda: br.orders([4, 2, 1], h=[4, 2, 1]).assert_order(1), AssertionError)
    nothing = br.Orders([16 / 3, 4 / 3, 1 / 3, 1 / 12], h=[8, 4, 2, 1]).line(br.SPACE)
    close(nothing.constant, 1 / 12, 1e-6)  # of all digits: rounded numbers leave the order open by 3e-5


def check_window():
    error = [9, 5, 1, 1 / 4, 1 / 16]
    alone = br.orders(error[2:], n=N[2:])
    for window in ({"finest": 3}, {"without": [10, 20]}, {"without": ["n=10", 20.0]}, {"finest": 3, "without": 10}):
        found = br.orders(error, n=N, **window)
        assert found.order == alone.order and found.order.low == alone.order.low, window
        assert [row["left_out"] for row in found["error"].rows] == ["by hand"] * 2 + [""] * 3, window
        assert len(found["error"].points) == 3
    for none in ({"without": []}, {"without": None}, {"finest": 0}, {"where": {}}, {"columns": {}}):
        every = br.orders({"n": N, "e": 1 / N ** 2}, values=[], **none)
        assert [p.left_out for p in every["e"].points] == [""] * 5, (none, every)
    refused("--error", lambda: br.orders({"n": N, "e": 1 / N}, errors=[]))
    assert "rows by hand: the 3 finest of 5." in repr(br.orders(error, n=N, finest=3))
    axes = Axes()
    br.orders(error, n=N, finest=3).plot(axes)
    assert ("none", [0.1, 0.05], [9, 5]) in axes.drawn, axes.drawn
    axes = Axes()
    br.orders(error, n=N, values=True, without=20).plot(axes)
    assert ("none", [0.05], [5]) in axes.drawn, axes.drawn
    refused("finest: found 2", lambda: br.orders(error, n=N, finest=2))
    refused("finest: found 3.5", lambda: br.orders(error, n=N, finest=3.5))
    refused("--without: found 8, which is no size there", lambda: br.orders(error, n=N, without=8))


def check_plot(make):
    error = 3.0 / N ** 2
    error[0] = 5
    found = br.orders({"n": N, "e": error, "v": 7 + 1 / N}, errors="e", values="v")
    refused("axes: found 1, expected a list of 2", lambda: found.plot(Axes()))
    both = found.plot([make(), make()] if make else None)
    if not make:
        assert [len(axes.lines) for axes in both] == [3, 8], [axes.lines for axes in both]
        assert all(axes.get_legend() for axes in both)
        return
    axes, of_value = both
    (_, x, y), (hollow, x_out, y_out), (_, x_fit, fit) = axes.drawn
    assert x == [1 / n for n in N[1:]] and y == error[1:].tolist(), (x, y)
    assert (hollow, x_out, y_out) == ("none", [0.1], [5])
    assert len(x_fit) == 5 and len(axes.bands) == 1
    for at, low, middle, high in zip(x_fit, axes.bands[0][1], fit, axes.bands[0][2]):
        close(middle / (3 * at ** 2), 1, 1e-6)
        assert low <= middle <= high
    assert "e: order in h 2.000 [1.999, 2.001]" in axes.labels, axes.labels
    (_, x, y), (_, x_fit, fit) = of_value.drawn
    assert x == [1 / n for n in N] and y == (7 + 1 / N).tolist(), (x, y)
    assert x_fit[0] == 0
    for at, value in zip(x_fit, fit):
        close(value, 7 + at, 1e-8)
    (h, finest, half), (zero, limit, around) = of_value.bars
    assert (h, finest, zero) == (1 / 160, 7 + 1 / 160, 0)
    close(half[0], 1.25 / 160, 1e-9)  # 1.25 |difference| / (r^p - 1)
    assert abs(limit - 7) <= min(around) + 1e-9 and "p = 1.00, GCI 0.11 %\nlimit 7" in of_value.title


def check_trade(make):
    sizes = np.array([8, 16, 32, 64])
    low = {"n": sizes, "l2": 1.0 / sizes ** 2, "seconds": 1e-3 * sizes ** 2}
    high = {"n": sizes, "l2": 1.0 / sizes ** 4, "seconds": 1e-2 * sizes ** 3}
    found = br.trade({"low": low, "high": high})
    assert repr(found).startswith("Cheapest to 1e-3: low, n = 32, 1.02 s; next: high, 5.12 s."), found
    assert [(row["program"], row["to_error"]) for row in found.cheapest][-1] == ("high", 1e-7)
    for row, growth, tenth in zip(found.growth, (2, 3), (10, 10 ** 0.75)):
        close(row["growth"], growth, 1e-6)
        close(row["tenth"], tenth, 1e-6)
    close(found.growth[0]["needed"], 1e3, 1e-6)  # n = 1000
    axes = found.plot(make())
    assert axes.labels[0] == "front of all" and {"low", "high"} <= set(axes.labels), axes.labels
    assert axes.drawn[0][1] == sorted(axes.drawn[0][1])
    refused("table 1: found no column of a cost", lambda: br.trade([{"n": sizes, "l2": 1.0 / sizes}]))
    refused("low measures l2; other measures h1", lambda: br.trade(
        {"low": low, "other": {"n": sizes, "h1": 1.0 / sizes, "seconds": sizes ** 2}}))
    refused("falls from", lambda: br.trade([low | {"seconds": 1.5 / sizes}]))
    refused("axes: found 1, expected a list of 2", lambda: br.trade([low | {"h1": 2.0 / sizes}]).plot(make()))
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.yaml"
        study.write_text("run: /bin/sh -c 'echo l2 $((10000 / {n} / {n}))e-4'\nn: 10, 20, 40\n"
                         "read: {l2: 'l2 (.+)'}\n")
        refused("give trust=True", lambda: br.trade([study]))
        assert [row["error"] for row in br.trade([study], trust=True).runs] == [100e-4, 25e-4, 6e-4]
        Path(folder, "zero.csv").write_bytes(b"n\0")
        refused("found a zero byte", lambda: br.trade([Path(folder) / "zero.csv"]))


def check_refusals():
    refused("found no column of a resolution among", lambda: br.orders([3, 2, 1]))
    refused("--value", lambda: br.orders({"n": [1, 2, 3], "e": [1, -2, 3]}))
    refused("found columns of [2, 3]", lambda: br.orders([1, 2, 3], n=[1, 2]))
    refused("sizes: found ['m']", lambda: br.orders([1, 2, 3], m=[1, 2, 3]))
    refused("n: found 'it twice'", lambda: br.orders({"n": N, "e": N}, n=N))
    refused("e: found array", lambda: br.orders({"n": N, "e": 1j * N}))
    refused("e: found masked_array", lambda: br.orders({"n": N, "e": np.ma.array(N, mask=N > 20)}))
    refused("column: found 'e\\x00x'", lambda: br.orders({"n": N, "e\0x": N}))
    refused("column: found 'e\\ud800'", lambda: br.orders({"n": N, "e\ud800": N}))
    refused("values: found 'e\\ud800'", lambda: br.orders({"n": N, "e": N}, values="e\ud800"))
    small = np.array([4, 2, 1], np.longdouble) * np.longdouble("1e-4000")
    if small[0] != 0:  # where it has more exponents than a double
        refused("number: found array", lambda: br.Orders(small, h=[4, 2, 1]))
        refused("number: found array", lambda: br.Orders(1 / small, h=[4, 2, 1]))
        refused("found no column of errors", lambda: br.orders({"h": [4, 2, 1], "e": small}))
    refused("values: found True", lambda: br.orders({"n": N, "e": N}, values=True))
    for wrong in (-1, math.nan, math.inf, "2"):
        refused("dimension, formal: found", lambda: br.orders({"n": N, "e": N}, dimension=wrong))
        refused("dimension, formal: found", lambda: br.orders({"n": N, "e": N}, formal=wrong))
    refused("a text without NUL", lambda: br.orders({"n": N, "e": N}, errors="e\0"))


COLUMNS = {"N": N, "L2": 3.0 / N ** 2, "H1": 2.0 / N, "rate": np.full(5, np.nan)}
if "pandas" in sys.argv:
    import pandas
    check_frame(pandas.DataFrame(COLUMNS))
    close(br.orders(pandas.Series(1.0 / N, name="e"), n=N)["e"].order.value, 1, 1e-4)
elif "matplotlib" in sys.argv:
    import matplotlib
    matplotlib.use("Agg")
    check_plot(None)
else:
    check_frame(Frame(COLUMNS))
    check_arrays()
    check_meaning()
    check_grid()
    check_values()
    check_numbers()
    check_notebook()
    check_left_out()
    check_window()
    check_plot(Axes)
    check_trade(Axes)
    check_refusals()
    assert statuses == {(br.BadInput, 1)}, statuses  # as beamrate.h has it, and no other number
