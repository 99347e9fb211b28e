# SPDX-License-Identifier: GPL-3.0-or-later
"""beamrate in Python: scenes, marches, studies, verdicts, and orders of convergence, over libbeamrate.

Arrays are numpy's; the library writes into them and reads from them without copies. All quantities
are in SI units; beamrate.h describes each member of the results. A method is given by keywords:
scheme="bdf2", axial_degree=2. An error raises Error, or BadInput, with the library's message.

$BEAMRATE_LIBRARY names the shared library where it is not installed beside this file.
"""
import ctypes
import operator
import os
import threading
import weakref
from ctypes import byref, c_char, c_char_p, c_double, c_int, c_size_t, c_void_p
from pathlib import Path
from types import SimpleNamespace

import numpy as np

AXIAL, BENDING = 0, 1  # fields
TOTAL, OF_AXIAL, OF_BENDING = 0, 1, 2  # components of an error
SPACE, TIME = 0, 1  # what is refined
VERDICTS = ("PASS", "FAIL", "INCONCLUSIVE")


class Error(Exception):
    """A call failed; status as in beamrate.h."""


class BadInput(Error, ValueError):
    """The input is refused; the message states what was found and what was expected."""


# ---- the structs of beamrate.h: each member in its order, TYPE:NAME, or TYPE:NAME:COUNT ----

def _struct(members, **types):
    types = {"i": c_int, "d": c_double, "z": c_size_t, "s": c_char_p, "c": c_char, "p": c_void_p} | types
    fields = []
    for code, name, *count in (member.split(":") for member in members.split()):
        fields.append((name, types[code] * int(count[0]) if count else types[code]))
    return type("struct", (ctypes.Structure,), {"_fields_": fields})


_Error = _struct("i:status c:message:1024")
_Estimate = _struct("d:value d:low d:high")
_Observer = _struct("f:progress p:self", f=ctypes.CFUNCTYPE(c_int, c_void_p, c_double))
_SceneInfo = _struct("s:name s:title d:length d:duration d:density i:modelled:2 i:contact i:friction")
_Warning = _struct("c:kind:24 c:text:400 c:remedy:400")
_Forecast = _struct("i:known c:why:200 e:error:2 d:round_off z:warnings w:warning:16",
                    e=_Estimate, w=_Warning)
_Tip = _struct("z:step d:time d:displacement:2 d:velocity:2 d:contact_force d:friction_force "
               "d:friction_bound")
_MarchReport = _struct("z:n z:steps z:done z:accepted z:rejected z:stages d:round_off i:unstable")
_StudyRequest = _struct("p:n z:n_count p:steps z:steps_count p:method s:reference z:reference_n "
                        "z:reference_steps s:norm i:threads p:observer")
_Cell = _struct("z:n z:steps d:error:3 s:flag:3 d:tip:2 d:seconds s:failure")
_Fit = _struct("i:describes e:p e:c_h e:q e:c_k e:r d:misfit z:points", e=_Estimate)
_Reference = _struct("s:name z:n z:steps d:own_error:3 d:size d:tip:2")
_Case = _struct("s:study s:measure s:part d:expected d:tolerance e:order d:constant d:margin z:points "
                "z:used i:verdict s:reason s:note", e=_Estimate)
_Numbers = _struct("p:h p:k p:number z:count i:values d:formal")
_Order = _struct("e:order d:constant z:points z:used e:limit", e=_Estimate)
_Expectation = _struct("i:axis d:order d:tolerance d:down_to")


def _plain(value):
    """A struct as Python's own objects, which outlive its handle."""
    if isinstance(value, ctypes.Structure):
        return SimpleNamespace(**{name: _plain(getattr(value, name)) for name, _ in value._fields_})
    if isinstance(value, ctypes.Array):
        return [_plain(item) for item in value]
    return value.decode(errors="replace") if isinstance(value, bytes) else value


# ---- the library ----

def _load():
    prefix = Path(__file__).resolve().parents[3]  # of PREFIX/share/beamrate/python
    found = [*prefix.glob("lib*/libbeamrate.so.0"), *prefix.glob("lib/*/libbeamrate.so.0")]
    return ctypes.CDLL(os.environ.get("BEAMRATE_LIBRARY") or str((found or ["libbeamrate.so.0"])[0]))


_lib = _load()
_lib.beamrate_version.restype = c_char_p
_lib.beamrate_march_columns.restype = _lib.beamrate_check_count.restype = c_size_t
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
    return text.encode()


def _whole(name, value, most):
    """A whole number from 0 to most: never one that is rounded, or wraps."""
    try:
        value = operator.index(value)
    except TypeError:
        _refuse(TypeError, name, value, "a whole number (an integer)")
    if value < 0:
        _refuse(BadInput, name, value, "a number of at least 0")
    if value > most:
        _refuse(OverflowError, name, value, f"at most {most}")
    return value


def _count(name, value):
    return c_size_t(_whole(name, value, c_size_t(-1).value))


def _counts(name, values):
    try:
        values = list(values)
    except TypeError:
        _refuse(TypeError, name, values, "a list of whole numbers")
    return (c_size_t * len(values))(*(_count(name, value) for value in values))


def _threads(value):
    return c_int(_whole("threads", value, 1024))


def _choice(name, value, count):
    try:
        return c_int(_whole(name, value, count - 1))
    except OverflowError as error:
        raise BadInput(*error.args) from None


def _method(options):
    words = [word for name, value in options.items()
             for word in (_text("method", name), _text(name, value, (str, int, float, np.number)))]
    return (c_char_p * (len(words) + 1))(*words, None)


def _scene(value):
    return value if isinstance(value, Scene) else _refuse(TypeError, "scene", value, "a Scene")


def _numbers(name, values):
    if isinstance(values, np.ma.MaskedArray):
        _refuse(TypeError, name, values, "an array without a mask; NaN is a missing number")
    values = np.asarray(values)
    if values.dtype.kind not in "iuf" or values.ndim != 1:
        _refuse(TypeError, name, values, "a list of real numbers")
    return np.ascontiguousarray(values, np.float64)


class _Watch:
    """A caller's progress(share). Its exceptions, and Ctrl-C, end the call and are raised then."""

    def __init__(self, progress):
        if progress is not None and not callable(progress):
            _refuse(TypeError, "progress", progress, "a function")
        self.progress, self.raised = progress, None
        self.observer = _Observer(_Observer._fields_[0][1](self._called), None)

    def _called(self, _, share):
        try:
            return bool(self.raised or self.progress and self.progress(share))
        except BaseException as error:
            self.raised = error
            return True

    def _run(self, arguments, done, failures):
        try:
            _call(*arguments)
        except BaseException as error:
            failures.append(error)
        finally:
            done.set()

    def call(self, *arguments):
        """The call runs in a thread of its own: the caller's waits, and so Ctrl-C reaches it at once."""
        done, failures = threading.Event(), []
        threading.Thread(target=self._run, args=(arguments, done, failures), daemon=True).start()
        while not done.is_set():
            try:
                done.wait()
            except BaseException as error:
                self.raised = error
        if self.raised is not None:
            raise self.raised
        if failures:
            raise failures[0]


class _Handle:
    """Owns a handle of the library: self.handle, which ctypes passes."""

    _kind = None
    _as_parameter_ = c_void_p()  # until there is one, which the library refuses

    def __init__(self):
        self.handle = self._as_parameter_ = c_void_p()
        free = getattr(_lib, f"beamrate_{self._kind}_free")
        weakref.finalize(self, free, self.handle).atexit = False

    def _get(self, name, struct, *arguments):
        out = struct()
        if getattr(_lib, "beamrate_" + name)(self, *arguments, byref(out)) != 0:
            raise BadInput(f"{name}: the library refuses this {self._kind} or index")
        return _plain(out)

    def __reduce_ex__(self, protocol):
        raise TypeError(f"a {type(self).__name__} is not copied or pickled: it owns memory of the library")


class Scene(_Handle):
    """A scene: Scene("file.yaml"), Scene("example2"), or of a text, Scene("its name", text)."""
    _kind = "scene"

    def __init__(self, name, text=None):
        super().__init__()
        given = [_text("name", name)] if text is None else [_text("name", name), _text("text", text)]
        _call("scene_open" if text is None else "scene_parse", byref(self.handle), *given)
        self.info = self._get("scene_info", _SceneInfo)

    def foresee(self, n, steps, **method):
        """The expected errors of a march, and its warnings."""
        out = _Forecast()
        _call("foresee", self, _count("n", n), _count("steps", steps), _method(method), byref(out))
        plain = _plain(out)
        plain.warnings = plain.warning[:plain.warnings]
        del plain.warning
        return plain


class March(_Handle):
    """The fully discrete problem, (16) and (17), on n elements and `steps` steps. x: its nodes."""
    _kind = "march"

    def __init__(self, scene, n, steps, **method):
        super().__init__()
        self.scene = _scene(scene)
        _call("march_create", byref(self.handle), scene, _count("n", n), _count("steps", steps),
              _method(method))
        self.x = np.linspace(0, scene.info.length, n + 1)

    def step(self, count=1):
        """Takes steps; other threads of Python run meanwhile."""
        _call("march_step", self, _count("count", count))

    def tip(self):
        return self._get("march_tip", _Tip)

    def report(self):
        return self._get("march_report", _MarchReport)

    def get(self, field, displacement=None, velocity=None):
        """Displacement and velocity at the nodes, (n + 1, columns) each; written into given arrays."""
        field = _choice("field", field, 2)
        shape = (len(self.x), _lib.beamrate_march_columns(self, field))
        arrays = [np.empty(shape) if a is None else a for a in (displacement, velocity)]
        for a in arrays:
            if not isinstance(a, np.ndarray) or isinstance(a, np.ma.MaskedArray):
                _refuse(TypeError, "displacement or velocity", a, "an array without a mask")
            if a.shape != shape or a.dtype != np.float64 or not a.flags.carray:
                raise BadInput(f"found {a.dtype} {a.shape}, expected a contiguous float64 {shape}")
        if _lib.beamrate_march_get(self, field, *(c_void_p(a.ctypes.data) for a in arrays)) != 0:
            raise BadInput("march_get: the library refuses this march")
        return tuple(arrays)


class Study(_Handle):
    """The errors of a grid against a reference: error[part, i, j] of n[i] and steps[j], cell[i][j]."""
    _kind = "study"

    def __init__(self, scene, n, steps, reference=None, fine=(0, 0), norm=None, threads=0,
                 progress=None, **method):
        super().__init__()
        watch, words, meshes, times = (_Watch(progress), _method(method), _counts("n", n),
                                       _counts("steps", steps))
        if (finest := _counts("fine", fine))._length_ != 2:
            _refuse(BadInput, "fine", fine, "two numbers: n and steps")
        request = _StudyRequest(
            ctypes.addressof(meshes), len(meshes), ctypes.addressof(times), len(times),
            ctypes.addressof(words), None if reference is None else _text("reference", reference),
            *finest, None if norm is None else _text("norm", norm), _threads(threads),
            ctypes.addressof(watch.observer))
        watch.call("study_run", byref(self.handle), _scene(scene), byref(request))
        self.n, self.steps = np.array(meshes), np.array(times)
        self.h, self.k = scene.info.length / self.n, scene.info.duration / self.steps
        self.cell = [[self._get("study_cell", _Cell, c_size_t(i), c_size_t(j))
                      for j in range(len(times))] for i in range(len(meshes))]
        self.error = np.array([[c.error for c in row] for row in self.cell]).transpose(2, 0, 1)
        self.reference = self._get("study_reference", _Reference)

    def fit(self, part=TOTAL):
        """Both orders together, from all cells."""
        return self._get("study_fit", _Fit, _choice("part", part, 3))


class Check(_Handle):
    """Verdicts on a scene's orders; on those of numbers: Orders.check. cases: a list; passed: all."""
    _kind = "check"

    def __init__(self, scene, threads=0, progress=None, _orders=None, _expected=()):
        super().__init__()
        watch, out = _Watch(progress), byref(self.handle)
        if _orders is None:
            watch.call("check_run", out, _scene(scene), _threads(threads), byref(watch.observer))
        else:
            expected = (_Expectation * len(_expected))(*(
                _Expectation(_choice("axis", axis, 2), *numbers) for axis, *numbers in _expected))
            _call("orders_check", out, _orders, expected, c_size_t(len(expected)))
        self.cases = [self._get("check_case", _Case, c_size_t(i))
                      for i in range(_lib.beamrate_check_count(self))]
        for case in self.cases:
            case.verdict = VERDICTS[case.verdict]
        self.passed = all(case.verdict == "PASS" for case in self.cases)


class Orders(_Handle):
    """Orders of numbers of any program: errors, or values whose limit is not known."""
    _kind = "orders"

    def __init__(self, number, h=None, k=None, values=False, formal=0):
        super().__init__()
        arrays = [None if a is None else _numbers(name, a)
                  for name, a in (("h", h), ("k", k), ("number", [] if number is None else number))]
        if any(a is not None and a.shape != arrays[2].shape for a in arrays):
            raise BadInput("h, k and the numbers differ in length, expected as many of each")
        data = [None if a is None else a.ctypes.data for a in arrays]
        _call("orders_find", byref(self.handle), byref(_Numbers(*data, len(arrays[2]), bool(values), formal)))

    def line(self, axis):
        """The order along an axis at the finest size of the other one; None: there is no line."""
        out = _Order()
        found = _lib.beamrate_orders_line(self, _choice("axis", axis, 2), byref(out))
        return _plain(out) if found else None

    def fit(self):
        """Both orders together, of errors on a grid."""
        return self._get("orders_fit", _Fit)

    def check(self, *expected):
        """Verdicts on expectations: (axis, order, tolerance) or (axis, order, tolerance, down_to)."""
        return Check(None, _orders=self, _expected=expected)
