"""Run one part script: untrusted code, in a confined process of its own that does nothing else afterwards.

The result is a report, a JSON object, and the shape. Whoever reads them must not trust them.
"""

from __future__ import annotations

import copy
import traceback
from collections.abc import Callable, Iterator, Mapping
from types import FrameType, FunctionType, SimpleNamespace
from typing import Any

from build123d import Shape
from OCP.BRepCheck import BRepCheck_Analyzer

from articad.errors import did_you_mean
from articad.kernels import measure, timers
from articad.kernels.made import made
from articad.kernels.tessellation import Same
from articad.plan.signatures import names_for

FILE = "part.py"  # the file name of a script's code: tracebacks are cut down to it
PARTIAL_SOLIDS = 32  # solids of a failed script that are kept
_TEXT = 2000  # characters of a message that are kept

Write = Callable[[dict[str, Any]], None]
Json = dict[str, Any]


class Dimensions(dict[str, Any]):
    """Dimensions by name: `d["width"]`, or `d.width`; a dimension `clear` or `values` hides the method of that name."""

    def __getattribute__(self, name: str) -> Any:
        return self[name] if dict.__contains__(self, name) else super().__getattribute__(name)

    def __getattr__(self, name: str) -> Any:
        if name not in self:
            raise AttributeError(self._missed(name))
        return self[name]

    def __missing__(self, name: str) -> Any:
        raise KeyError(self._missed(name))

    def _missed(self, name: str) -> str:
        return f"The part has no dimension {name!r}.{did_you_mean(str(name), self)} It has {', '.join(self) or 'none'}."


class NotAPart(Exception):  # noqa: N818 - not an error in the script's code, but a message to its author
    """The script has no `build(part)`, or what that returns is not `(shape, connectors)`; `problems` lists the faults."""

    def __init__(self, *problems: str, shape: Any = None) -> None:
        super().__init__(*problems)
        self.problems, self.shape = problems, shape


def run(script: str, part: Json, *, seconds: float, report: Write, shape: Callable[[bytes], None]) -> None:
    """Run a script, deliver its shape and its report.

    Args:
        script: The source.
        part: The brief of the part.
        seconds: Processor time for the script; see `timers.allow`.
        report: Receives the report.
        shape: Receives the shape, in the form that `measure.read_shape("bin", …)` reads.
    """
    timers.allow(seconds)
    namespace: Json = {"__name__": "part", "__builtins__": __builtins__}
    try:
        exec(compile(script, FILE, "exec"), namespace)  # noqa: S102 - this is what the sandbox is for
        solid, connectors = built(namespace, part)
    except NotAPart as wrong:
        if wrong.shape is not None:
            shape(measure.binary(wrong.shape))
        report({"ok": False, "problems": list(wrong.problems), "partial": wrong.shape is not None})
        return
    except BaseException as error:  # noqa: BLE001 - a script may raise anything
        held = _last_solids(error)
        if held:
            shape(measure.binary(measure.compound(held)))
        report({"ok": False, "error": described(error), "partial": bool(held)})
        return
    shape(measure.binary(solid))
    report({"ok": True, "connectors": connectors})
    timers.unlimited()


def described(error: BaseException) -> Json:
    """Return an exception as data: type, message, and the frames of the script only, outermost first."""
    frames = [(line, frame.f_code.co_name) for frame, line in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == FILE]
    line = frames[-1][0] if frames else None
    if isinstance(error, SyntaxError) and error.filename == FILE:
        line = error.lineno
    own = error.__traceback__ is not None and _innermost(error).f_code.co_filename == FILE
    return {
        "type": type(error).__name__[:100],
        "message": str(error)[:_TEXT],
        "line": line,
        "frames": frames[-20:],
        # a script may not use the operating system: whatever failed there was forbidden; build123d's exporters hide the cause
        "denied": isinstance(error, OSError) or str(error).startswith("Failed to write"),
        "module": error.name if isinstance(error, ImportError) else None,
        "refused": own and isinstance(error, (ValueError, AssertionError)),
    }


def _innermost(error: BaseException) -> FrameType:
    return [frame for frame, _ in traceback.walk_tb(error.__traceback__)][-1]


def built(namespace: Json, part: Json) -> tuple[Any, dict[str, Json]]:
    """Call the function that builds a part, and return the kernel's shape and plain connectors."""
    result = called(namespace, as_object(part))
    if not (isinstance(result, (tuple, list)) and len(result) == 2):
        raise NotAPart(f"The function build(part) returned {_kind(result)}, not (shape, connectors)")
    problems: list[str] = []
    shape = _kernel_shape(result[0], problems)
    connectors = plain_connectors(result[1], problems)
    if problems:
        raise NotAPart(*problems, shape=shape)
    return shape, connectors


def called(namespace: Json, part: SimpleNamespace) -> Any:
    """Call `build(part)`, or the function with the part's name, whose arguments are its dimensions; return what it returns.

    A function with the part's name may return the shape alone: the features of the part's joints are added to it.
    """
    build = namespace.get("build")
    if callable(build):
        return build(part)
    named = (namespace.get(name) for name in names_for(part.name))
    function = next((one for one in named if isinstance(one, FunctionType) and one.__module__ == namespace["__name__"]), None)
    if function is None:
        raise NotAPart(f"The script defines no function build(part), and none called {' or '.join(names_for(part.name))}")
    given: Json = {"part": part, **part.dimensions}
    code = function.__code__
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    required = names[: code.co_argcount - len(function.__defaults__ or ())]
    if missing := [name for name in required if name not in given]:
        raise NotAPart(f"The function {function.__name__} takes {', '.join(missing)}, which the part has no dimension for")
    returned = function(**{name: given[name] for name in names if name in given})
    return returned if isinstance(returned, tuple) else made(returned, part)


def as_object(part: Json) -> SimpleNamespace:
    """Return the brief as the object that scripts get, newly made for each call."""
    fields = copy.deepcopy({key: part[key] for key in ("name", "description", "material", "dimensions")})
    connectors = {
        name: SimpleNamespace(
            o=tuple(frame["o"]), z=tuple(frame["z"]), x=tuple(frame["x"]), label=frame["label"], joints=copy.deepcopy(frame["joints"])
        )
        for name, frame in part["connectors"].items()
    }
    given = SimpleNamespace(**fields | {"dimensions": Dimensions(fields["dimensions"])}, connectors=connectors)
    given.made = lambda shape: made(shape, given)
    return given


def _kernel_shape(value: Any, problems: list[str]) -> Any:
    shapes = list(value) if isinstance(value, (list, tuple)) else [value]
    if not all(isinstance(shape, Shape) for shape in shapes):
        hint = "; return its .part" if hasattr(value, "part") else ""
        problems.append(f"The shape is {_kind(value)}, not a build123d Part, Solid or Compound{hint}")
        return None
    wrapped = [shape.wrapped for shape in shapes if not shape.is_null]
    return wrapped[0] if len(wrapped) == 1 else measure.compound(wrapped)


def plain_connectors(value: Any, problems: list[str]) -> dict[str, Json]:
    """Return the connectors that a script returned as plain numbers; append what is wrong with them to `problems`."""
    if not isinstance(value, Mapping):
        problems.append(f"The connectors are {_kind(value)}, not a dict of name to {{'o', 'z', 'x'}}")
        return {}
    connectors: dict[str, Json] = {}
    for name, returned in value.items():
        planned = isinstance(returned, SimpleNamespace) and hasattr(returned, "o") and hasattr(returned, "z")
        entry = {axis: getattr(returned, axis, None) for axis in ("o", "z", "x")} if planned else returned  # an entry of part.connectors
        if not isinstance(entry, Mapping) or not {"o", "z"} <= set(entry) <= {"o", "z", "x"}:
            found = f"a dict with {', '.join(map(repr, entry)) or 'nothing'}"[:200] if isinstance(entry, Mapping) else _kind(entry)
            problems.append(f"Connector {str(name)[:60]!r} is {found}; it must be a dict with 'o', 'z' and perhaps 'x'")
            continue
        vectors = {axis: _vector(entry[axis]) for axis in ("o", "z", "x") if entry.get(axis) is not None}
        wrong = [axis for axis, vector in vectors.items() if vector is None]
        problems += [f"In connector {str(name)[:60]!r}, {axis} is not three finite numbers" for axis in wrong]
        connectors[str(name)[:60]] = {"o": vectors.get("o"), "z": vectors.get("z"), "x": vectors.get("x")}
    return connectors


def _vector(value: Any) -> list[float] | None:
    try:
        numbers = [float(number) for number in value]
    except (TypeError, ValueError):
        return None
    return numbers if len(numbers) == 3 and all(abs(number) < 1e9 for number in numbers) else None


def _kind(value: Any) -> str:
    return "None" if value is None else f"a {type(value).__name__[:60]}"


# ---------------------------------------------------------------------- what a failed script held


def _last_solids(error: BaseException) -> list[Any]:
    """Return the valid solids in the local variables of the script's innermost frame that has any."""
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == FILE]
    for frame in reversed(frames):
        try:
            solids = list(_solids_in(list(frame.f_locals.values())))
        except Exception:  # noqa: BLE001, S112 - shapes of a failed script may be in any state, and nobody would read a log
            continue
        if solids:
            return solids
    return []


def _solids_in(values: list[Any]) -> Iterator[Any]:
    seen: set[Same] = set()
    for value in values:
        held = getattr(value, "part", value)  # a builder's part so far
        for shape in held if isinstance(held, (list, tuple)) else [held]:
            if not isinstance(shape, Shape) or shape.is_null:
                continue
            for solid in measure.solids_of(shape.wrapped):
                if len(seen) < PARTIAL_SOLIDS and Same(solid) not in seen and BRepCheck_Analyzer(solid).IsValid():
                    seen.add(Same(solid))
                    yield solid
