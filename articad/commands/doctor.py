"""What this machine has of what articad needs, and the command that installs the rest.

The probe for shared libraries runs before anything that is linked against them: without libGL the B-rep kernel, and without libgomp
Pinocchio, fail with an unhelpful ImportError, and some renderers with a segmentation fault.
"""

from __future__ import annotations

import ctypes
import importlib.util
import io
import json
import os
import platform
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from articad.errors import KernelUnavailableError, TransportError
from articad.findings import Finding
from articad.kernels.cache import default_root
from articad.kernels.libraries import PACKAGES
from articad.processes import launcher

if TYPE_CHECKING:
    from articad.agents.llm import LLM

Status = Literal["ok", "missing", "optional"]
Loader = Callable[[str], object]


class Library(NamedTuple):
    """A shared library of the system: the name for the loader, the Debian package, and what needs it."""

    soname: str
    package: str
    needed_by: str


_NEEDED_BY = {"libgomp.so.1": "Pinocchio"}  # the B-rep kernel needs the others
LIBRARIES = tuple(Library(soname, package, _NEEDED_BY.get(soname, "the B-rep kernel")) for soname, package in PACKAGES.items())

# Distribution -> its purpose in articad. Reported with versions; all of them come with `pip install articad`.
_PACKAGES = {
    "numpy": "everything",
    "scipy": "pieces of meshes",
    "pin": "kinematics",
    "yourdfpy": "URDF read back",
    "trimesh": "foreign meshes",
    "python-fcl": "interference: candidates, distances",
    "manifold3d": "interference: volumes, depths",
    "pydantic": "plans, typed replies",
    "litellm": "models",
    "build123d": "part scripts",
    "mujoco": "simulation",
    "lxml": "URDF, MJCF",
}
_COMPROMISED = {("litellm", "1.82.7"), ("litellm", "1.82.8")}  # releases that stole credentials (MAL-2026-2144)
_KEYS = ("OPENAI_API_KEY", "ANTHROPIC_API_KEY", "GEMINI_API_KEY", "OPENROUTER_API_KEY", "MISTRAL_API_KEY", "AZURE_API_KEY")
_KERNEL_SECONDS = 120  # a cold disk needs 5 s for the kernel's 400 MB; beyond this something hangs
_GIB = 2**30


@dataclass(frozen=True)
class Probe:
    """One line of the report: the item, whether it exists, and what to do if it does not."""

    name: str
    status: Status
    detail: str
    remedy: str = ""

    def to_json(self) -> dict[str, str]:
        """Return the JSON object of the report."""
        return {"name": self.name, "status": self.status, "detail": self.detail, "remedy": self.remedy}


def _load_lazily(soname: str) -> object:
    return ctypes.CDLL(soname, mode=os.RTLD_LAZY)


def missing_libraries(load: Loader = _load_lazily) -> tuple[Library, ...]:
    """Return the shared libraries that the dynamic loader does not find; none on systems other than Linux.

    Args:
        load: Opens a library by its name or raises OSError.
    """
    if sys.platform != "linux":
        return ()
    missing = []
    for library in LIBRARIES:
        try:
            load(library.soname)
        except OSError:
            missing.append(library)
    return tuple(missing)


def install_line(missing: Iterable[Library]) -> str:
    """Return the command that installs these libraries on Debian and Ubuntu."""
    packages = sorted({library.package for library in missing})
    return f"apt-get update && apt-get install --no-install-recommends {' '.join(packages)}"


def unavailable(missing: Iterable[Library]) -> KernelUnavailableError:
    """Return the error that names each missing library, who needs it, and the line that installs them."""
    missing = tuple(missing)
    names = ", ".join(f"{library.soname} (for {library.needed_by})" for library in missing)
    line = install_line(missing)
    finding = Finding(code="E_KERNEL_UNAVAILABLE", where="system", message=f"Missing: {names}.", hint=f"As root: {line}")
    return KernelUnavailableError(
        f"This machine lacks shared libraries that articad needs: {', '.join(library.soname for library in missing)}.",
        findings=[finding],
        looked_in=["the dynamic loader's paths"],
        how_to_get=line,
    )


def require_libraries(load: Loader = _load_lazily) -> None:
    """Raise if a shared library is missing that later imports are linked against.

    Raises:
        KernelUnavailableError: If there is one that the dynamic loader does not find.
    """
    if missing := missing_libraries(load):
        raise unavailable(missing)


def examine(load: Loader = _load_lazily) -> tuple[Probe, ...]:
    """Check everything that articad needs or can use on this machine. Takes some seconds: it starts the B-rep kernel."""
    libraries = missing_libraries(load)
    return (
        Probe("articad", "ok", metadata.version("articad")),
        Probe("python", "ok", f"{platform.python_version()} at {sys.executable}"),
        Probe("machine", "ok", f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors, {_disk_free()} free here"),
        *_libraries(libraries),
        *_packages(),
        _kernel() if not libraries else Probe("build123d starts", "missing", "not tried: shared libraries are missing"),
        _freecad(),
        _sandbox(),
        _renderer(),
        _cache(),
        _keys(),
    )


def examine_model(name: str, *, api_base: str | None = None) -> tuple[Probe, ...]:
    """Check whether a model's key exists and works, whether the model keeps to forms and accepts images, and what that costs."""
    from articad.agents.live import LiteLLM

    try:
        return ask_once(LiteLLM(name, api_base=api_base, tries=2))
    except TransportError as error:
        (finding,) = error.findings
        return (Probe(f"model {name}", "missing", finding.message, finding.hint),)


def ask_once(llm: LLM) -> tuple[Probe, ...]:
    """Ask a model one tiny question, with a picture and a form for the answer.

    Raises:
        TransportError: If it cannot be asked.
    """
    from articad.agents.llm import Image, Request, system, user

    schema = {"type": "object", "properties": {"color": {"type": "string"}}, "required": ["color"], "additionalProperties": False}
    messages = (system("Answer with one JSON object."), user("Which colour is this square? One English word.", Image(_red_square())))
    reply = llm.complete(Request(role="doctor", step="doctor", messages=messages, response_schema=schema))
    answers = Probe(
        f"model {reply.model}", "ok", f"replies; {reply.usage.total} tokens{f', {reply.fingerprint}' if reply.fingerprint else ''}"
    )
    known = (
        "price unknown: limit calls or tokens, because --max-cost cannot be enforced"
        if reply.cost is None
        else f"${reply.cost:.6f} for this question"
    )
    price = Probe("model's price", "optional" if reply.cost is None else "ok", known)
    try:
        color = str(json.loads(reply.text)["color"])
    except (ValueError, KeyError, TypeError, RecursionError):
        return (answers, Probe("model's forms", "missing", f"not in the requested form: {reply.text[:80]!r}", "Try another model."), price)
    by_provider = getattr(llm, "takes_schemas", None)
    held = "" if by_provider is None else ", enforced by its provider" if by_provider() else ", requested in the prompt"
    forms = Probe("model's forms", "ok", f"returns the requested form{held}")
    if "red" in color.lower():
        return (answers, forms, Probe("model's sight", "ok", "sees"), price)
    blind = f"does not see well: it called a red square {color!r}"
    return (answers, forms, Probe("model's sight", "optional", blind, "Use --vision-model, or --no-look --no-inspection."), price)


def report(items: Iterable[Probe]) -> dict[str, Any]:
    """Return the report `articad.doctor/1`."""
    rows = tuple(items)
    return {
        "schema": "articad.doctor/1",
        "ok": all(item.status != "missing" for item in rows),
        "items": [item.to_json() for item in rows],
        "findings": [],
    }


def _libraries(missing: tuple[Library, ...]) -> Iterator[Probe]:
    if sys.platform != "linux":
        return
    for library in LIBRARIES:
        if library in missing:
            yield Probe(library.soname, "missing", f"needed by {library.needed_by}", install_line([library]))
        else:
            yield Probe(library.soname, "ok", f"for {library.needed_by}")


def _packages() -> Iterator[Probe]:
    for name, purpose in _PACKAGES.items():
        try:
            version = metadata.version(name)
        except metadata.PackageNotFoundError:
            yield Probe(name, "missing", f"for {purpose}", f"pip install {name}")
            continue
        if (name, version) in _COMPROMISED:
            yield Probe(name, "missing", f"{version} is a compromised release", f"pip install --upgrade {name}, and change your keys")
        else:
            yield Probe(name, "ok", f"{version}, for {purpose}")


def _kernel() -> Probe:
    """Start the B-rep kernel in a process of its own, so that a crash is only a line of the report."""
    name = "build123d starts"
    ended = launcher.run([], module="articad.kernels.trial_start", limits=launcher.Limits(seconds=_KERNEL_SECONDS))
    if ended.late:
        return Probe(name, "missing", f"no answer in {_KERNEL_SECONDS} s", "Check the machine's load and disk.")
    if ended.code == 0:
        return Probe(name, "ok", "a box has the correct volume; Pinocchio imports alongside it")
    return Probe(name, "missing", ended.last_line, "Run ./scripts/setup, or pip install --force-reinstall build123d pin")


def _freecad() -> Probe:
    from articad.kernels import freecad_install

    try:
        freecad = freecad_install.find()
    except KernelUnavailableError as error:
        return Probe("FreeCAD", "optional", f"{error.findings[0].message} Only needed for FreeCAD's own feature trees.", error.how_to_get)
    return Probe("FreeCAD", "ok", f"{freecad.version_text} at {freecad.where}")


def _sandbox() -> Probe:
    from articad.kernels import sandbox

    level, problems = sandbox.level(), "; ".join(sandbox.missing())
    if level == sandbox.WEAK:
        remedy = "apt-get install --no-install-recommends bubblewrap, or a kernel with Landlock; else --sandbox weak"
        return Probe("sandbox", "missing", f"part scripts are refused here: {problems}", remedy)
    return Probe("sandbox", "ok", f"{level} ({problems})" if problems else level)


def _renderer() -> Probe:
    if not _installed("embreex"):
        return Probe("renderer", "missing", "embreex, which casts the rays, is not installed", "pip install embreex")
    nicer = "VTK is installed too" if _installed("pyvista") else "pip install 'articad[render]' for the VTK renderer"
    return Probe("renderer", "ok", f"articad's own, on embreex {metadata.version('embreex')}; {nicer}")


def _installed(name: str) -> bool:
    return importlib.util.find_spec(name) is not None


def _cache() -> Probe:
    folder = default_root()
    existing = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if os.access(existing, os.W_OK):
        return Probe("cache", "ok", str(folder))
    return Probe("cache", "missing", f"{folder} cannot be written", "Set ARTICAD_CACHE to a folder that you can write to.")


def _keys() -> Probe:
    present = [name for name in _KEYS if os.environ.get(name)]
    if present:
        return Probe("model keys", "ok", ", ".join(f"{name} is set" for name in present))
    return Probe(
        "model keys", "optional", "none set; only generate and edit need one", "Set your provider's variable, such as GEMINI_API_KEY."
    )


def _red_square() -> bytes:
    """Return a PNG of 32 x 32 red pixels."""
    from PIL import Image as Picture

    stream = io.BytesIO()
    Picture.new("RGB", (32, 32), (220, 20, 20)).save(stream, "PNG")
    return stream.getvalue()


def _disk_free() -> str:
    return f"{shutil.disk_usage(Path.cwd()).free / _GIB:.0f} GiB"
