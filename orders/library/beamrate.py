# SPDX-License-Identifier: GPL-3.0-or-later
"""beamrate in Python: orders of convergence of any numbers, limits of values, and verdicts.

    import beamrate
    found = beamrate.orders(frame)  # of pandas, or {"n": [10, 20, 40, 80], "l2": [...]}
    print(found)                    # the answer
    found.assert_order(2)           # in a test

An order is a Number: a float with its 95 % interval. beamrate.h describes each member of the other
results. An error raises Error, or BadInput, with the library's message.

$BEAMRATE_LIBRARY names the shared library where it is not installed with this file.
"""
import ctypes
import html
import json
import math
import operator
import os
import weakref
from ctypes import byref, c_char, c_char_p, c_double, c_int, c_size_t, c_void_p
from pathlib import Path
from types import SimpleNamespace

import numpy as np

SPACE, TIME = 0, 1  # what is refined
VERDICTS = ("PASS", "FAIL", "INCONCLUSIVE")


class Error(Exception):
    """A call failed; status: as in beamrate.h, None where the library was not called."""
    status = None


class BadInput(Error, ValueError):
    """The input is refused; the message states what was found and what was expected."""


class Number(float):
    """A number with its 95 % interval, low to high; open: why it is not settled, or ""."""

    def __new__(cls, value, low=math.nan, high=math.nan, open=""):
        self = super().__new__(cls, value)
        self.low, self.high, self.open = low, high, open
        return self

    value = property(float)

    def __repr__(self):
        digits = 6
        while digits < 17 and any(end != self and f"{end:.{digits}g}" == f"{self:.{digits}g}"
                                  for end in (self.low, self.high)):
            digits += 1
        interval = "" if math.isnan(self.low) else f" [{self.low:.{digits}g}, {self.high:.{digits}g}]"
        return f"{self:.{digits}g}{interval}{' (not settled)' if self.open else ''}"


# ---- the structs of beamrate.h: each member in its order, TYPE:NAME, or TYPE:NAME:COUNT ----

def _struct(members, **types):
    types = {"i": c_int, "d": c_double, "z": c_size_t, "s": c_char_p, "c": c_char, "p": c_void_p} | types
    fields = []
    for code, name, *count in (member.split(":") for member in members.split()):
        fields.append((name, types[code] * int(count[0]) if count else types[code]))
    return type("struct", (ctypes.Structure,), {"_fields_": fields})


_Error = _struct("i:status c:message:1024")
_Estimate = _struct("d:value d:low d:high")
_Case = _struct("s:study s:measure d:expected d:tolerance e:order d:constant d:margin z:points "
                "z:used i:verdict s:reason s:note", e=_Estimate)
_Fit = _struct("i:describes e:p e:c_h e:q e:c_k e:r d:misfit z:points", e=_Estimate)
_Numbers = _struct("p:h p:k p:number z:count i:values d:formal")
_Order = _struct("e:order d:constant z:points z:used e:limit", e=_Estimate)
_Table = _struct("s:name s:text s:errors s:values d:dimension d:formal s:columns s:where "
                 "z:finest s:without")
_Answer = _struct("s:quantity i:values i:refined e:order s:open", e=_Estimate)
_OrderPoint = _struct("d:size d:error d:rate e:fit s:left_out", e=_Estimate)
_Expectation = _struct("i:axis d:order d:tolerance d:down_to")


def _plain(value):
    """A struct as Python's own objects, which outlive its handle."""
    if isinstance(value, _Estimate):
        return Number(value.value, value.low, value.high)
    if isinstance(value, ctypes.Structure):
        return SimpleNamespace(**{name: _plain(getattr(value, name)) for name, _ in value._fields_})
    return value.decode(errors="replace") if isinstance(value, bytes) else value


# ---- the library ----

def _load():
    here = Path(__file__).resolve()
    found = [*here.parent.glob("libbeamrate.so")]
    for prefix in list(here.parents)[3:4]:  # of PREFIX/share/beamrate/python
        found += [*prefix.glob("lib*/libbeamrate.so.1"), *prefix.glob("lib/*/libbeamrate.so.1")]
    return ctypes.CDLL(os.environ.get("BEAMRATE_LIBRARY") or str((found or ["libbeamrate.so.1"])[0]))


_lib = _load()
_lib.beamrate_version.restype = c_char_p
_lib.beamrate_check_count.restype = c_size_t
__version__ = _lib.beamrate_version().decode()


def _call(name, *arguments):
    err = _Error()
    if getattr(_lib, "beamrate_" + name)(*arguments, byref(err)) != 0:
        error = (BadInput if err.status == 1 else Error)(err.message.decode(errors="replace"))
        error.status = err.status
        raise error


# ---- arguments: what C would misread is refused, by the argument's name ----

def _refuse(error, name, value, expected):
    raise error(f"{name}: found {value!r:.200}, expected {expected}")


def _text(name, value, kinds=(str, os.PathLike)):
    if not isinstance(value, kinds):
        _refuse(TypeError, name, value, "a text")
    if "\0" in (text := str(value)):
        _refuse(BadInput, name, value, "a text without NUL")
    try:
        return text.encode()
    except UnicodeEncodeError:  # half of a character: a lone surrogate
        _refuse(BadInput, name, value, "text in UTF-8")


def _axis(value):
    try:
        value = operator.index(value)
    except TypeError:
        _refuse(TypeError, "axis", value, "a whole number (an integer)")
    return value if value in (SPACE, TIME) else _refuse(BadInput, "axis", value, "SPACE (0) or TIME (1)")


def _numbers(name, values):
    if isinstance(values, np.ma.MaskedArray):
        _refuse(TypeError, name, values, "an array without a mask; NaN is a missing number")
    values = np.asarray(values)
    if values.dtype.kind not in "iuf" or values.ndim != 1:
        _refuse(TypeError, name, values, "a list of real numbers")
    with np.errstate(all="ignore"):
        doubles = np.ascontiguousarray(values, np.float64)
    if ((doubles != values) & ((doubles == 0) | np.isinf(doubles))).any():
        _refuse(BadInput, name, values, "numbers within the range of a double")
    return doubles


class _Handle:
    """Owns a handle of the library: self.handle, which ctypes passes."""

    _kind = None
    _as_parameter_ = c_void_p()  # until there is one, which the library refuses

    def __init__(self):
        self.handle = self._as_parameter_ = c_void_p()
        free = getattr(_lib, f"beamrate_{self._kind}_free")
        weakref.finalize(self, free, self.handle).atexit = False

    def _get(self, name, struct, *arguments, found=0):
        out = struct()
        if getattr(_lib, "beamrate_" + name)(self, *arguments, byref(out)) != found:
            raise BadInput(f"{name}: the library refuses this {self._kind} or index")
        return _plain(out)

    def __reduce_ex__(self, protocol):
        raise TypeError(f"a {type(self).__name__} is not copied or pickled: it owns memory of the library")


class Check(_Handle):
    """Verdicts on orders, by Orders.check. cases: a list; passed: all of them."""
    _kind = "check"

    def __init__(self, orders, quantity, expected):
        super().__init__()
        if expected and all(isinstance(one, str) for one in expected):
            _call("orders_expect", byref(self.handle), orders, _text("expected", "; ".join(expected)))
        else:
            structs = (_Expectation * len(expected))(*(
                _Expectation(_axis(axis), *numbers) for axis, *numbers in expected))
            _call("orders_check_quantity", byref(self.handle), orders, c_size_t(quantity), structs,
                  c_size_t(len(structs)))
        self.cases = [self._get("check_case", _Case, c_size_t(i))
                      for i in range(_lib.beamrate_check_count(self))]
        for case in self.cases:
            case.verdict = VERDICTS[case.verdict]
        self.passed = all(case.verdict == "PASS" for case in self.cases)


def _floats(row, *keys):
    """Numbers of a row of the report, where null is NaN."""
    return [math.nan if row[key] is None else row[key] for key in keys]


def _shown(number, digits):
    return "" if number is None else format(number, digits)


class Quantity:
    """What is known of one column of numbers.

    h, k: the order in each, a Number; None where it is not refined. order: the only one. Of values:
    limit, a Number; p and gci, the observed order and the grid convergence index at the finest sizes,
    numbers; else None. limits: the rows of the report's table of that name. rows: every row of the
    report. points: of the finest line, from coarse to fine: size, error, rate, fit, left_out.
    """

    def __init__(self, orders, index):
        first, second = (orders._get("orders_answer", _Answer, c_size_t(index), c_int(axis), found=1)
                         for axis in (SPACE, TIME))
        self.name, self.is_value = first.quantity, bool(first.values)
        self.h, self.k = (Number(a.order, a.order.low, a.order.high, a.open) if a.refined else None
                          for a in (first, second))
        self._axes = [axis for axis, a in ((SPACE, first), (TIME, second)) if a.refined]
        tables = orders.report["tables"]
        self.rows = tables[f"rows-{index + 1}"]
        self.limits = [row for row in tables["limits"] if row["quantity"] == self.name]
        lines = [row for row in self.limits if row["in"] in ("h", "k")]
        self.limit = Number(*_floats(self.limits[-1], "limit", "low", "high")) if self.limits else None
        self.p, self.gci = _floats(lines[-1], "p", "gci_fine") if lines else (None, None)
        self.points = self._points(orders, index, self._axes[0]) if self._axes else []

    @staticmethod
    def _points(orders, index, axis):
        points = []
        while True:
            point = _OrderPoint()
            if not _lib.beamrate_orders_point(orders, c_size_t(index), c_int(axis),
                                              c_size_t(len(points)), byref(point)):
                return points
            points.append(_plain(point))

    def _axis(self, axis=None):
        if axis not in (None, "h", "k", SPACE, TIME):
            _refuse(BadInput, "axis", axis, "'h' or 'k'")
        axes = self._axes if axis is None else [("h", "k").index(axis) if axis in ("h", "k") else axis]
        if len(axes) != 1:
            raise BadInput(f"{self.name}: " + ("refined in h and in k, expected axis='h' or axis='k'"
                                               if axes else "no three sizes of one line"))
        return axes[0]

    @property
    def order(self):
        return (self.h, self.k)[self._axis()]

    @property
    def rates(self):
        return [point.rate for point in self.points]

    @property
    def left_out(self):
        """The points that the order does not rest on; each says why, in left_out."""
        return [point for point in self.points if point.left_out]

    def __repr__(self):
        orders = [f"no order in {axis}" if math.isnan(o) else
                  f"order in {axis} {_order_text(o)}"
                  for axis, o in (("h", self.h), ("k", self.k)) if o is not None]
        return f"{self.name}: " + (", ".join(orders) or "no order")


def _order_text(o):
    """1.00 [0.99, 1.01], with digits that tell the ends from the order, as in a report."""
    half = (o.high - o.low) / 2
    digits = 4 if half < 5e-4 else 3 if half < 5e-3 else 2
    while digits < 4 and any(end != o and round(end, digits) == round(o, digits) for end in (o.low, o.high)):
        digits += 1
    unit, value, empty = 10 ** -digits, round(o, digits), o.low == o.high
    low = min(round(o.low, digits), value - unit * (empty or o.low < o))
    high = max(round(o.high, digits), value + unit * (empty or o.high > o))
    return f"{o:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"


def said(quantity, case):
    """"l2: order 1.00 [0.99, 1.01], expected 2 +- 0.1"."""
    o, letter = case.order, {"space": " in h", "time": " in k"}[case.study] if len(quantity._axes) > 1 else ""
    found = "no order" if math.isnan(o.high - o.low) else f"order{letter} {_order_text(o)}"
    band = f"{case.expected:g} +- {case.tolerance:g}" if case.tolerance > 0 else f"at least {case.expected:g}"
    return f"{quantity.name}: {found}, expected {band}"


def _axes(axes, count):
    """As many axes to draw on as there are pictures: those that are given, or new ones."""
    if axes is None:
        import matplotlib.pyplot
        axes = matplotlib.pyplot.subplots(1, count, squeeze=False, figsize=(6.4 * count, 4.8))[1]
    axes = list(axes.flat) if isinstance(axes, np.ndarray) else axes if isinstance(axes, list) else [axes]
    if len(axes) < count:
        raise BadInput(f"axes: found {len(axes)}, expected a list of {count}")
    return axes


class Orders(_Handle):
    """Orders of numbers of any program: errors, or values whose limit is not known. See orders().

    order, limit, p, gci: those of the only column.
    """
    _kind = "orders"

    def __init__(self, number, h=None, k=None, values=False, formal=0, _table=None):
        super().__init__()
        if _table is None:
            arrays = [None if a is None else _numbers(name, a)
                      for name, a in (("h", h), ("k", k), ("number", [] if number is None else number))]
            if any(a is not None and a.shape != arrays[2].shape for a in arrays):
                raise BadInput("h, k and the numbers differ in length, expected as many of each")
            data = [None if a is None else a.ctypes.data for a in arrays]
            numbers = _Numbers(*data, len(arrays[2]), bool(values), formal)
            _call("orders_find", byref(self.handle), byref(numbers))
        else:
            _call("orders_read", byref(self.handle), byref(_table))
        text = c_char_p()
        _call("orders_report", self, byref(text))
        self.report = json.loads(text.value)
        count = sum(key.startswith("rows-") for key in self.report["tables"])
        self.quantities = [Quantity(self, i) for i in range(count)]

    def __repr__(self):
        return "\n".join(self.report["answer"])

    def __getitem__(self, name):
        """The Quantity of that name."""
        for quantity in self.quantities:
            if quantity.name == name:
                return quantity
        raise KeyError(f"{name}: expected one of {[q.name for q in self.quantities]}")

    def _only(self):
        if len(self.quantities) != 1:
            raise BadInput(f"found {len(self.quantities)} columns, expected one of "
                           f"{[q.name for q in self.quantities]} by name")
        return self.quantities[0]

    order = property(lambda self: self._only().order)
    limit = property(lambda self: self._only().limit)
    p = property(lambda self: self._only().p)
    gci = property(lambda self: self._only().gci)

    def _columns(self):
        """The headings and texts of one table: sizes, then numbers and rates of each quantity."""
        rows = self.quantities[0].rows
        keys = list(rows[0])
        sizes = keys[1:keys.index("value" if self.quantities[0].is_value else "error")]
        columns = [(key, [_shown(row[key], ".10g") for row in rows]) for key in sizes]
        axes = [key for key in ("rate_h", "rate_k") if key in keys]
        for q in self.quantities:
            number, digits = ("value", ".9g") if q.is_value else ("error", ".3e")
            columns.append((q.name, [f"{_shown(row[number], digits)} {row['left_out']}" for row in q.rows]))
            columns += [("rate" if len(axes) == 1 else key.replace("_", " in "),
                         [_shown(row[key], ".2f") for row in q.rows]) for key in axes]
        return columns

    def _repr_html_(self):
        """In a notebook: the answer, and the table."""
        heads, texts = zip(*self._columns())
        lines = "".join("<tr>" + "".join(f"<{tag}>{html.escape(word.strip())}</{tag}>" for word in line)
                        + "</tr>" for tag, line in [("th", heads), *(("td", t) for t in zip(*texts))])
        answer = "<br>".join(map(html.escape, self.report["answer"]))
        return f"<p>{answer}</p><table>{lines}</table>"

    def line(self, axis):
        """The order of the first column along an axis, at the finest size of the other one; None: there
        is no line."""
        out = _Order()
        found = _lib.beamrate_orders_line(self, c_int(_axis(axis)), byref(out))
        return _plain(out) if found else None

    def fit(self):
        """Both orders of the first column together, of errors on a grid."""
        return self._get("orders_fit", _Fit)

    def check(self, *expected, quantity=None):
        """Verdicts on expectations: (axis, order, tolerance) or (axis, order, tolerance, down_to), where
        tolerance 0 expects at least that order; of the quantity of that name, else of the first. Or on
        texts as of --expect: "L2: h 2 +- 0.1", "H1 >= 0.9"."""
        index = 0 if quantity is None else self.quantities.index(self[quantity])
        return Check(self, index, expected)

    def assert_order(self, order, tolerance=0.1, quantity=None, axis=None, down_to=0):
        """For tests: AssertionError with the reason unless the verdict is PASS, which needs the whole
        95 % interval within order -+ tolerance; tolerance 0: above order. Of all quantities, or of one;
        axis: "h" or "k". Or a text, as of check: ">= 1.8", "L2: h 2; H1 >= 0.9"."""
        __tracebackhide__ = True  # of pytest
        if isinstance(order, str):
            checks = [self.check(order)]
        else:
            checks = [self.check((q._axis(axis), order, tolerance, down_to), quantity=q.name)
                      for q in (self.quantities if quantity is None else [self[quantity]])]
        failures = [f"{said(self[case.measure], case)}: {case.verdict}: {case.reason}" for check in checks
                    for case in check.cases if case.verdict != "PASS"]
        if failures:
            raise AssertionError("\n".join(failures))

    def plot(self, axes=None):
        """Draws the errors over the size, with the line of each order and its band; hollow: left out. And
        each column of values over the size, with its limit and grid convergence index. Needs matplotlib.
        axes: as many as that takes. Returns them: one, or a list."""
        drawn = [q for q in self.quantities if q.points]
        errors = [q for q in drawn if not q.is_value]
        groups = ([errors] if errors else []) + [[q] for q in drawn if q.is_value]
        if not groups:
            raise BadInput("there are no three sizes of one line")
        axes = _axes(axes, len(groups))
        for one, group in zip(axes, groups):
            (self._plot_value if group[0].is_value else self._plot_errors)(one, group)
            one.legend()
        return axes[0] if len(axes) == 1 else axes

    @staticmethod
    def _by_hand(q, letter, number):
        """Sizes and numbers of the rows that finest= and without= leave out, at the finest other size."""
        other = "size_" + ("k" if letter == "h" else "h")
        finest = min((row[other] for row in q.rows if row.get(other)), default=None)
        return [(row["size_" + letter], row[number]) for row in q.rows if row["left_out"] == "by hand" and
                (len(q._axes) == 1 or row[other] == finest)]

    def _plot_errors(self, axes, group):
        for i, q in enumerate(group):
            size = [p.size for p in q.points]
            for hollow in (False, True):
                drawn = [(p.size, p.error) for p in q.points if bool(p.left_out) == hollow]
                drawn += self._by_hand(q, "hk"[q._axes[0]], "error") if hollow else []
                axes.plot([p[0] for p in drawn], [p[1] for p in drawn], "os^Dv"[i % 5], color=f"C{i}",
                          fillstyle="none" if hollow else "full", label=None if hollow else repr(q))
            axes.plot(size, [p.fit.value for p in q.points], color=f"C{i}")
            axes.fill_between(size, [p.fit.low for p in q.points], [p.fit.high for p in q.points],
                              color=f"C{i}", alpha=0.2)
        axes.set(xscale="log", yscale="log", xlabel="size", ylabel="error", title="\n".join(map(repr, group[:2])))
        if len(size) <= 8:
            axes.set(xticks=size, xticklabels=[f"{s:.3g}" for s in size])
            axes.minorticks_off()

    def _plot_value(self, axes, group):
        letter = "hk"[group[0]._axes[0]]
        rows = [row for row in group[0].rows if row["value"] is not None and row["left_out"] != "by hand"]
        if len(group[0]._axes) == 2:  # the line at the finest time step
            rows = [row for row in rows if row["size_k"] == min(r["size_k"] for r in rows)]
        size, value = [row["size_" + letter] for row in rows], [row["value"] for row in rows]
        row = [r for r in self.report["tables"]["limits"] if r["quantity"] == group[0].name and r["in"] == letter][-1]
        title, end = [], row["phi_ext"]
        axes.plot(size, value, "o", color="C0", label=group[0].name)
        if by_hand := self._by_hand(group[0], letter, "value"):
            axes.plot(*zip(*by_hand), "o", color="C0", fillstyle="none")
        if row["gci_fine"] is not None:
            title.append(f"p = {row['p']:.2f}, GCI {100 * row['gci_fine']:.2g} %")
            axes.errorbar(size[-1:], value[-1:], yerr=abs(row["gci_fine"] * value[-1]), color="0.2", capsize=5,
                          label="GCI of the finest value")
        if row["low"] is None:
            title.append(f"no limit: {row['sequence']}")
        else:
            title.append(f"limit {row['limit']:.6g} [{row['low']:.6g}, {row['high']:.6g}]")
            axes.errorbar([0], [row["limit"]], yerr=[[row["limit"] - row["low"]], [row["high"] - row["limit"]]],
                          fmt="o", color="0.2", fillstyle="none", capsize=5, label="limit, with its 95 % interval")
        if row["low"] is not None and end is not None and row["of_three"] == "monotone convergence":
            at = max(size) * np.linspace(0, 1, 61) ** max(1, 1 / row["p"])
            axes.plot(at, end + (value[-1] - end) * (at / size[-1]) ** row["p"], color="C0")
        axes.set(xlabel=f"size {letter}", ylabel=group[0].name, title=f"{group[0].name}: " + "\n".join(title))


class Trade(_Handle):
    """What a digit costs in several programs. See trade().

    cheapest, growth, runs: rows of the report's tables of these names.
    """
    _kind = "trade"

    def __init__(self, tables, cost):
        super().__init__()
        _call("trade_read", byref(self.handle), (_Table * len(tables))(*tables), c_size_t(len(tables)), cost)
        text = c_char_p()
        _call("trade_report", self, byref(text))
        self.report = json.loads(text.value)
        self.cheapest, self.growth, self.runs = (self.report["tables"][key]
                                                 for key in ("cheapest", "growth", "runs"))

    def __repr__(self):
        return "\n".join(self.report["answer"])

    def plot(self, axes=None):
        """Draws the errors over the costs: the stairs of each program's own best; dots: dearer and no
        better; hollow: mostly the start of the program; grey: the front of all. Needs matplotlib. axes:
        one for each quantity. Returns them: one, or a list."""
        names = list(dict.fromkeys(row["quantity"] for row in self.runs))
        axes = _axes(axes, len(names))
        for one, name in zip(axes, names):
            self._plot(one, [row for row in self.runs if row["quantity"] == name])
            one.set(xscale="log", yscale="log", xlabel=", ".join(filter(None, (self.report["cost"], self.report["cost_unit"]))), ylabel=f"error {name}")
            one.legend()
        return axes[0] if len(axes) == 1 else axes

    @staticmethod
    def _plot(axes, runs):
        def draw(rows, *style, **more):
            rows = sorted(rows, key=lambda row: row["cost"])
            axes.plot([row["cost"] for row in rows], [row["error"] for row in rows], *style, **more)

        draw([r for r in runs if r["front"]], color="0.85", linewidth=6, drawstyle="steps-post", label="front of all")
        for i, program in enumerate(dict.fromkeys(row["program"] for row in runs)):
            own = [r for r in runs if r["program"] == program and r["own_front"]]
            draw(own, color=f"C{i}", linestyle=("-", "--", ":", "-.")[i % 4], drawstyle="steps-post")
            for start in (False, True):
                draw([r for r in own if bool(r["remark"]) == start], "os^Dv"[i % 5], color=f"C{i}",
                     fillstyle="none" if start else "full", label=None if start else program)
        draw([r for r in runs if not r["own_front"]], ".", color="0.6")


# ---- orders of a table ----

def _read(path):
    text = Path(path).read_bytes()
    if b"\0" in text:
        raise BadInput(f"{path}: found a zero byte, expected text")
    return text


def _column(name, values):
    """The type of a column in a Table Schema (specs.frictionlessdata.io), and its fields: a number keeps
    all its digits, a missing one is None. Dates, times and categories are words."""
    if isinstance(values, np.ma.MaskedArray):
        _refuse(TypeError, name, values, "an array without a mask; NaN is a missing number")
    words = getattr(getattr(values, "dtype", None), "name", "") == "category"
    values = np.asarray(values)
    if values.ndim != 1 or values.dtype.kind == "c":
        _refuse(TypeError, name, values, "a list of real numbers")
    words = words or values.dtype.kind in "mMb"
    fields = values.astype(str) if values.dtype.kind in "mM" else values
    return "any" if words else "number", [_field(v, words) for v in fields.tolist()]


def _field(value, is_word):
    if isinstance(value, float) and not is_word:
        return None if math.isnan(value) else repr(value)
    return " ".join(str(value).split())


def _names(name, value):
    """Options' "l2,h1": one text, or a list of names, which may have commas."""
    if value is not None:
        value = [value] if isinstance(value, str) else [f'"{v}"' if "," in str(v) else str(v) for v in value]
    none = value is None or (value == [] and name != "errors")  # without errors=, all numbers are errors
    return None if none else _text(name, ",".join(value))


_SIZES = ("h", "n", "level", "dofs", "cells", "points", "interior", "degree", "k", "dt", "steps")


def orders(data, *, values=None, errors=None, dimension=0, formal=0, columns=None, where=None, finest=0,
           without=None, **sizes):
    """The orders of convergence of a table: Orders, whose repr is the answer.

    data: a pandas DataFrame, a mapping of names to lists of numbers, the path of a file, or one list
    of numbers. The headings and the numbers tell the mesh and the time step, as those of a file do;
    else name them: h=, n=, level=, points=, interior=, dofs= or cells= with dimension=, k=, dt=, steps=:
    a list of numbers, or the name of a column, which then counts: h="h" decides between two sizes.
    values, errors: names of columns, "cd" or ["cd", "cl"]: values have no known limit; default: all
    numbers are errors. Of one list, values=True makes it values. formal: the order of theory for
    values (2). columns={"time": "aside"}: what other columns are, as --column has it.
    where={"method": "P1"}: one case of several; else each is answered. finest=3: the finest three sizes
    alone; without=[8]: all sizes but these. NaN is a missing number. The answer says what was taken for
    what, and what was left aside.
    """
    if wrong := sorted(set(sizes) - set(_SIZES)):
        _refuse(TypeError, "sizes", wrong, f"some of {', '.join(_SIZES)}")
    roles = dict(columns or {}) | {size: key for key, size in sizes.items() if isinstance(size, str)}
    if isinstance(data, (str, os.PathLike)):
        name, text = _text("data", data), _read(data)
        if lists := sorted(key for key in sizes if sizes[key] is not None and key not in roles.values()):
            _refuse(TypeError, "sizes", lists, "names of columns beside a file")
    else:
        name, text, values = b"table", *_as_json(data, values, sizes, roles)
    watch = (dimension, formal)
    if not all(isinstance(v, (int, float, np.number)) and math.isfinite(v) and v >= 0 for v in watch):
        _refuse(BadInput, "dimension, formal", watch, "numbers above 0")
    return Orders(None, _table=_Table(name, text, _names("errors", errors), _names("values", values),
                                      dimension, formal, _pairs("columns", roles),
                                      _pairs("where", dict(where or {})), _finest(finest),
                                      _names("without", [without] if isinstance(without, (int, float, np.number))
                                             else without)))


def _finest(value):
    try:
        value = operator.index(value or 0)
    except TypeError:
        _refuse(TypeError, "finest", value, "a whole number (an integer)")
    return value if value == 0 or 3 <= value <= 1000 else _refuse(BadInput, "finest", value, "3 to 1000 sizes")


def trade(sources, *, cost=None, trust=False):
    """What a digit costs: errors over costs of several programs. A Trade, whose repr is the answer.

    sources: a list, or a mapping of names to them: paths of tables and of study files (.yaml), pandas
    DataFrames, mappings of names to lists of numbers. Each has a column of a cost, seconds, cpu, wall,
    dofs, iterations or memory, or one that cost= names, and an error of a name that all have. Study
    files run their commands, one at a time, until the times are known: read them, then trust=True.
    """
    named = sources.items() if hasattr(sources, "items") else [(None, data) for data in sources]
    tables = []
    for i, (name, data) in enumerate(named):
        if isinstance(data, (str, os.PathLike)):
            text = _read(data)
            study = Path(data).suffix in (".yaml", ".yml")
            if study and not trust:
                raise BadInput(f"{data}: it may run commands: read it, then give trust=True")
            name = data if study or name is None else name
        else:
            text, name = _as_json(data, None, {}, {})[0], f"table {i + 1}" if name is None else name
        tables.append(_Table(_text("name", str(name)), text, None, None, 0, 0, None, None))
    return Trade(tables, None if cost is None else _text("cost", cost))


def _pairs(name, pairs):
    """Options' "a=b, c=d"."""
    for pair in pairs.items():
        if any("," in str(word) for word in pair):
            _refuse(BadInput, name, pair, "names without a comma")
    return _text(name, ", ".join(f"{key}={value}" for key, value in pairs.items())) if pairs else None


def _as_json(data, values, sizes, roles):
    """The table of what Python has, as pandas' to_json(orient="table") writes it; and `values`."""
    if hasattr(data, "to_frame") and not hasattr(data, "columns"):  # a Series of pandas
        data = data.to_frame()
    if any(name is not None for name in getattr(getattr(data, "index", None), "names", [])):
        data = data.reset_index()  # pandas: an index with a name is a column
    if not hasattr(data, "keys"):
        data = {"value" if values else "error": data}
        values = "value" if values else None
    elif isinstance(values, bool):
        _refuse(TypeError, "values", values, "names of columns")
    names = [str(key) for key in data.keys()]
    if missing := sorted(set(map(str, roles)) - set(names)):
        _refuse(BadInput, "sizes, columns", missing, f"columns of {names}")
    made = {key: _column(key, size) for key, size in sizes.items()
            if size is not None and not isinstance(size, str)}
    if twice := sorted({name for name in [*made, *names] if [*made, *names].count(name) > 1}):
        _refuse(BadInput, twice[0], "it twice", "a column or an argument of that name")
    roles |= {key: key for key in made}
    made |= {str(key): _column(str(key), data[key]) for key in data.keys()}
    if len(lengths := {len(fields) for _, fields in made.values()}) != 1:
        raise BadInput(f"found columns of {sorted(lengths)} numbers, expected as many in each")
    for name in made:
        _text("column", name)
    rows = zip(*(fields for _, fields in made.values()))
    table = {"schema": {"fields": [{"name": name, "type": kind} for name, (kind, _) in made.items()]},
             "data": [dict(zip(made, row)) for row in rows]}
    return _text("table", json.dumps(table)), values
