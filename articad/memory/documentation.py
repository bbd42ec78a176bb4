"""The kernels' own documentation, looked up by name or by purpose.

Extracted from the installed packages: names, signatures and texts come from the packages themselves, once for each version, and are
stored beside the cache of parts. Worked snippets are articad's own; each is a whole part script that tests build.
"""

from __future__ import annotations

import ast
import hashlib
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib import metadata
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from articad.errors import KernelUnavailableError, ReadError
from articad.findings import Finding
from articad.kernels import freecad_install
from articad.kernels.cache import default_root
from articad.memory.embedding import Embedder, FloatArray, WordLlamaEmbedder
from articad.processes import launcher, scratch
from articad.runs.run import write_atomically

Dialect = Literal["build123d", "freecad"]

_HERE: Final = Path(__file__).parent
_HELPERS: Final = Path(freecad_install.__file__).parent / "inside_freecad" / "part.py"
_SECONDS: Final = 120.0  # to extract a catalogue; it takes 4
_OF_SNIPPETS: Final = 0.9  # a snippet's title counts for the names that it shows, a little less than their own words do
_LETTERS: Final = 0.3  # weight of common words in addition to similarity of meaning: vectors represent names badly
_METHODS: Final = 0.1  # methods that query a shape are needed less often than functions that make one
_STOP: Final = frozenset(
    re.findall(r"\w+", "a an and as at by for from in into is it of on or so such that the this to with which where whose")
)


@dataclass(frozen=True)
class Entry:
    """A name that part scripts may use.

    Attributes:
        name: As written in scripts: "fillet", "Shape.bounding_box", "part.pad", "PartDesign::Hole".
        signature: Its signature.
        summary: What it does, in a sentence or two.
        text: Its complete documentation.
    """

    name: str
    signature: str
    summary: str
    text: str = ""

    def __str__(self) -> str:
        return f"{self.signature}\n    {self.summary}"


@dataclass(frozen=True)
class Snippet:
    """A worked part script.

    Attributes:
        title: What it demonstrates.
        shows: Names that it demonstrates.
        dimensions: Content of its `part.dimensions`.
        script: The script.
    """

    title: str
    shows: tuple[str, ...]
    dimensions: dict[str, float]
    script: str


class DocumentationStore:
    """Entries and snippets of one dialect.

    Args:
        dialect: "build123d" or "freecad". Without FreeCAD on this machine, the latter has only articad's own helpers and snippets.
        folder: Folder of catalogues; beside the cache of parts by default.
        embedder: Measures similarity.
    """

    def __init__(self, dialect: Dialect, folder: Path | None = None, embedder: Embedder | None = None) -> None:
        self.dialect = dialect
        self.folder = default_root().parent / "docs" if folder is None else folder
        self.embedder = embedder or WordLlamaEmbedder()

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """All names, helpers first.

        Raises:
            ReadError: If the catalogue cannot be made.
        """
        if self.dialect == "build123d":
            return self._catalogue(metadata.version("build123d"), _HERE / "catalogue_build123d.py")
        try:
            freecad = freecad_install.find()
        except KernelUnavailableError:
            return tuple(_helpers())
        return (*_helpers(), *self._catalogue(freecad.version_text, _HERE / "inside_freecad" / "catalogue.py"))

    @cached_property
    def snippets(self) -> tuple[Snippet, ...]:
        """The worked examples."""
        return tuple(_snippet(file) for file in sorted((_HERE / "snippets" / self.dialect).glob("*.py")))

    def named(self, names: Sequence[str], limit: int = 12) -> tuple[Entry, ...]:
        """Return the entries for names that a model believes to exist, in that order; for a near miss the nearest one.

        A name may be qualified or not, in any case: `Fillet`, `bd.fillet` and `fillet` find `fillet`.
        """
        known = {entry.name.lower(): entry for entry in self.entries}
        short = {_last(entry.name): entry for entry in reversed(self.entries)}
        found: dict[str, Entry] = {}
        for name in names:
            entry = known.get(name.lower()) or short.get(_last(name))
            entry = entry or next(iter(self.find(re.sub(r"(?<=[a-z])(?=[A-Z])|[_.:]", " ", name), 1)), None)
            if entry is not None:
                found.setdefault(entry.name, entry)
        return tuple(found.values())[:limit]

    def find(self, intent: str, limit: int = 5) -> tuple[Entry, ...]:
        """Return the entries that serve an intent best, such as "round the vertical edges", the best first."""
        query = self.embedder.embed([intent])[0]
        methods = np.array(["." in entry.name and not entry.name.startswith("part.") for entry in self.entries])
        scores = (
            self._vectors @ query - _METHODS * methods + _LETTERS * np.array([_common(intent, self._said(entry)) for entry in self.entries])
        )
        shown = {entry.name: index for index, entry in enumerate(self.entries)}
        for snippet, likeness in zip(self.snippets, self._snippet_vectors @ query, strict=True):
            score = _OF_SNIPPETS * (float(likeness) + _LETTERS * _common(intent, snippet.title))
            for name in snippet.shows:
                if (index := shown.get(name)) is not None:
                    scores[index] = max(scores[index], score)
        order = np.lexsort((np.arange(len(scores)), -scores))
        return tuple(self.entries[index] for index in order[:limit])

    def example(self, intent: str) -> Snippet:
        """Return the snippet that shows what is nearest to an intent."""
        likeness = self._snippet_vectors @ self.embedder.embed([intent])[0]
        return self.snippets[int(np.argmax(likeness))]

    # ------------------------------------------------------------------ internals

    @cached_property
    def _vectors(self) -> FloatArray:
        return self.embedder.embed([self._said(entry) for entry in self.entries])

    @cached_property
    def _snippet_vectors(self) -> FloatArray:
        return self.embedder.embed([snippet.title for snippet in self.snippets])

    @staticmethod
    def _said(entry: Entry) -> str:
        name = re.sub(r"(?<=[a-z])(?=[A-Z])|[_.]|::|\bPart(Design)?\b|\bpart\.", " ", entry.name)
        return f"{name}: {entry.summary}"

    def _catalogue(self, version: str, program: Path) -> tuple[Entry, ...]:
        mark = hashlib.sha256(program.read_bytes()).hexdigest()[:8]
        file = self.folder / f"{self.dialect}-{version}-{mark}.json"
        try:
            stored = json.loads(file.read_bytes())
        except (OSError, ValueError):  # missing or incomplete
            stored = self._written_down(program)
            write_atomically(file, json.dumps(stored, indent=1).encode())
        return tuple(Entry(**entry) for entry in stored["entries"])

    def _written_down(self, program: Path) -> dict[str, Any]:
        """Run a program that writes a catalogue, in a process that can import the package."""
        with scratch.folder("docs") as name:
            folder = Path(name)
            if self.dialect == "freecad":
                folder.chmod(0o777)  # FreeCAD runs as nobody in there
                ended = freecad_install.find().run(program, folder=folder, limits=freecad_install.FreeCADLimits(seconds=_SECONDS))
                said, content = ended.said, (folder / "catalogue.json")
                text = content.read_text(encoding="utf-8") if content.is_file() else ""
            else:
                limits = launcher.Limits(seconds=_SECONDS)
                done = launcher.run([], module="articad.memory.catalogue_build123d", limits=limits)
                said, text = done.err.decode(errors="replace"), done.out.decode(errors="replace")
        try:
            return dict(json.loads(text))
        except ValueError as error:
            message = f"The documentation of {self.dialect} could not be extracted: {said.strip()[-500:]}"
            finding = Finding(code="E_READ", where=self.dialect, message=message, hint="Run `articad doctor`.")
            raise ReadError(message, path=self.dialect, findings=[finding]) from error


def _helpers() -> Iterator[Entry]:
    """Yield articad's own helpers for FreeCAD scripts, read from their source: they can be imported in FreeCAD only."""
    tree = ast.parse(_HELPERS.read_text(encoding="utf-8"))
    authoring = next(node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Authoring")
    for node in authoring.body:
        if not isinstance(node, ast.FunctionDef) or node.name.startswith("_"):
            continue
        text = ast.get_docstring(node) or ""
        for argument in (*node.args.args, *node.args.kwonlyargs):
            argument.annotation = None
        node.args.args = node.args.args[1:]
        is_property = any(isinstance(item, ast.Name) and item.id == "property" for item in node.decorator_list)
        signature = f"part.{node.name}" + ("" if is_property else f"({ast.unparse(node.args)})")
        yield Entry(f"part.{node.name}", signature, " ".join(text.split("\n\n")[0].split()), text)


def _snippet(file: Path) -> Snippet:
    script = file.read_text(encoding="utf-8")
    title, *lines = (ast.get_docstring(ast.parse(script)) or "").split("\n")
    told = dict(line.split(": ", 1) for line in lines if ": " in line)
    return Snippet(title, tuple(told["Shows"].split(", ")), json.loads(told["Dimensions"]), script)


def _last(name: str) -> str:
    return re.split(r"[.:]", name)[-1].lower()


def _common(intent: str, text: str) -> float:
    """Return the share of an intent's words that a text has, by their first five letters."""
    words = _stems(intent)
    return len(words & _stems(text)) / max(len(words), 1)


def _stems(text: str) -> set[str]:
    return {word[:5] for word in re.findall(r"[a-z]+", text.lower()) if word not in _STOP}
