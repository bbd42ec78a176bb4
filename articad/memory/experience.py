"""The experience store: cases of earlier runs, retrieved by similarity. SQLite holds the data; indices can be rebuilt.

Several processes may write at once, and a killed one loses nothing that was committed: each case is one transaction in a write-ahead
log. The store is outside runs, in one folder, and is empty at first.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import sqlite3
import stat
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np

from articad.arrays import IntArray
from articad.errors import ReadError, WriteError
from articad.files import user_folder
from articad.findings import Finding
from articad.memory import faiss_index
from articad.memory.case import Case, Kind
from articad.memory.embedding import Embedder, FloatArray, WordLlamaEmbedder

VERSION: Final = 1
FILE: Final = "experience.sqlite3"
_BESIDE: Final = ("-wal", "-shm", "-journal")  # what SQLite keeps beside the file, by the endings of the names
_PATIENCE_S: Final = 30.0  # for other writers; a transaction takes milliseconds
_SCHEMA: Final = """
create table cases (id text primary key, kind text not null, added real not null, content text not null);
create table texts (
  number integer primary key, case_id text not null references cases (id) on delete cascade,
  kind text not null, topic text not null, item text not null, text text not null
);
create table vectors (
  text integer not null references texts (number) on delete cascade, space text not null, vector blob not null,
  primary key (text, space)
);
create index texts_of_topic on texts (topic, kind);
"""
_TEXTS_OF_A_CASE: Final = 50  # of one topic, for FAISS: it must retrieve more texts than the wanted cases
# The topic of a text is what it is retrieved as: a whole request, or the specification of a part for one kernel.
_REQUEST: Final = "request"


def default_folder() -> Path:
    """Return `$ARTICAD_MEMORY`, or `articad/memory` in the user's data folder."""
    if named := os.environ.get("ARTICAD_MEMORY"):
        return Path(named)
    return user_folder("XDG_DATA_HOME", ".local/share") / "articad" / "memory"


@dataclass(frozen=True)
class Hit:
    """A case that was found.

    Attributes:
        case: The case.
        likeness: Cosine of the angle between the texts' vectors, at most 1.
        item: Name of the part with the similar specification; empty for a search by request.
    """

    case: Case
    likeness: float
    item: str = ""


class ExperienceStore:
    """Cases in a folder; the folder is made when the first case is added.

    Args:
        folder: The folder; `default_folder()` by default.
        embedder: Measures similarity. New texts are embedded at the next search.
        index: "exact" compares with every text, a millisecond for 2000; "faiss" keeps an index (extra `faiss`).
    """

    def __init__(
        self, folder: str | Path | None = None, embedder: Embedder | None = None, *, index: Literal["exact", "faiss"] = "exact"
    ) -> None:
        self.folder = default_folder() if folder is None else Path(folder)
        self.embedder = embedder or WordLlamaEmbedder()
        self.index = index

    # ------------------------------------------------------------------ writing

    def add(self, *cases: Case) -> int:
        """Store cases, all or none; return how many of them were new.

        Raises:
            WriteError: If the folder cannot be written, or is another version's.
        """
        with self._connection(writing=True) as database:
            return sum(self._insert(database, case) for case in cases)

    def remove(self, *ids: str) -> int:
        """Remove cases; return how many existed."""
        with self._connection(writing=True) as database:
            return sum(database.execute("delete from cases where id = ?", (name,)).rowcount for name in ids)

    def prune(self, keep: int) -> int:
        """Remove all but the newest cases of each kind; return how many were removed."""
        ranked = "select id, row_number() over (partition by kind order by added desc, id) as rank from cases"
        with self._connection(writing=True) as database:
            return database.execute(f"delete from cases where id in (select id from ({ranked}) where rank > ?)", (keep,)).rowcount  # noqa: S608

    # ------------------------------------------------------------------ reading

    def cases(self) -> tuple[Case, ...]:
        """Return all cases, the oldest first."""
        with self._connection() as database:
            rows = database.execute("select content from cases order by added, id").fetchall()
        return tuple(Case.from_json(json.loads(content)) for (content,) in rows)

    def case(self, name: str) -> Case:
        """Return one case by its id, or by a unique prefix of it.

        Raises:
            ReadError: If there is none, or more than one.
        """
        with self._connection() as database:
            rows = database.execute("select content from cases where substr(id, 1, ?) = ?", (len(name), name)).fetchall()
        if len(rows) != 1 or not name:
            message = f"{len(rows) if name else 'No'} cases of {self.folder} begin with {name!r}."
            raise _unreadable(self.folder, message, "List them with `articad memory list`.")
        return Case.from_json(json.loads(rows[0][0]))

    def like_request(self, text: str, kind: Kind, limit: int = 3, least: float = -1.0) -> tuple[Hit, ...]:
        """Return the cases of one kind whose request is most similar to a text, the nearest first.

        Args:
            text: A request.
            kind: "good" or "issue".
            limit: Largest number of cases.
            least: Similarity below which nothing is returned.
        """
        return self._search(text, _REQUEST, kind, limit, least)

    def like_part(self, specification: str, kernel: str, limit: int = 2, least: float = -1.0) -> tuple[Hit, ...]:
        """Return good cases with a part whose specification is most similar, in the kernel's dialect."""
        return self._search(specification, _topic_of_parts(kernel), "good", limit, least)

    def __len__(self) -> int:
        """Number of cases."""
        with self._connection() as database:
            return int(database.execute("select count(*) from cases").fetchone()[0])

    # ------------------------------------------------------------------ import and export

    def export(self) -> Iterator[str]:
        """Yield each case as a line of JSON."""
        for case in self.cases():
            yield json.dumps(case.to_json(), ensure_ascii=False, sort_keys=True)

    def import_lines(self, lines: Iterable[str]) -> int:
        """Add cases from lines of JSON, all or none; return how many were new.

        Raises:
            ReadError: If a line is not a case.
        """
        cases = []
        for number, line in enumerate(lines, 1):
            try:
                cases.append(Case.from_json(json.loads(line)))
            except (ValueError, RecursionError, ReadError) as error:
                raise _unreadable(Path(f"line {number}"), f"Line {number} is not a case: {error}", "Nothing was added.") from error
        return self.add(*cases)

    # ------------------------------------------------------------------ internals

    @staticmethod
    def _insert(database: sqlite3.Connection, case: Case) -> int:
        content = json.dumps(case.to_json(), ensure_ascii=False, sort_keys=True)
        row = (case.id, case.kind, time.time(), content)
        if not database.execute("insert or ignore into cases values (?, ?, ?, ?)", row).rowcount:
            return 0
        texts = [(_REQUEST, "", case.request)]
        texts += [(_topic_of_parts(part.kernel), part.name, part.specification) for part in case.parts]
        insert = "insert into texts (case_id, kind, topic, item, text) values (?, ?, ?, ?, ?)"
        database.executemany(insert, [(case.id, case.kind, *text) for text in texts])
        return 1

    def _search(self, text: str, topic: str, kind: Kind, limit: int, least: float) -> tuple[Hit, ...]:
        found: dict[str, tuple[float, str, str]] = {}
        with self._connection() as database:
            for number, likeness in self._nearest(database, text, topic, kind, limit):
                if len(found) == limit or likeness < least:
                    break
                query = "select cases.id, item, content from texts join cases on cases.id = case_id where number = ?"
                name, item, content = database.execute(query, (number,)).fetchone()
                found.setdefault(name, (likeness, item, content))  # the nearest text of each case
        return tuple(Hit(Case.from_json(json.loads(content)), value, item) for value, item, content in found.values())

    def _nearest(self, database: sqlite3.Connection, text: str, topic: str, kind: Kind, limit: int) -> Iterator[tuple[int, float]]:
        """Yield texts' numbers and their similarity to a text, the nearest first."""
        query = self.embedder.embed([text])[0]
        if self.index == "exact":
            numbers, vectors = self._vectors(database, topic, kind, len(query))
            likeness = vectors @ query if len(numbers) else np.zeros(0, np.float32)
        else:
            count, stamp = database.execute(
                "select count(*), count(*) || ' ' || total(number) || ' ' || total(number * number) from texts where topic = ? and kind = ?",
                (topic, kind),
            ).fetchone()
            if not count:
                return
            label = f"{self.embedder.name} {topic} {kind}"
            index = faiss_index.load(self.folder, label, stamp)
            if index is None or index.d != len(query):
                index = faiss_index.build(self.folder, label, stamp, *self._vectors(database, topic, kind, len(query)))
            (likeness,), (numbers,) = index.search(query[None], min(count, limit * _TEXTS_OF_A_CASE))
        for place in np.lexsort((numbers, -likeness)):
            yield int(numbers[place]), float(likeness[place])

    def _vectors(self, database: sqlite3.Connection, topic: str, kind: Kind, size: int) -> tuple[IntArray, FloatArray]:
        """Return the numbers and vectors of all texts of a topic; missing vectors of this space are computed and stored.

        So are those of another size: a provider may give another model the same name.
        """
        joined = "texts left join vectors on vectors.text = number and space = ? where topic = ? and kind = ?"
        query = f"select number, texts.text, vector from {joined} order by number"  # noqa: S608 - the text is articad's own
        rows = database.execute(query, (self.embedder.name, topic, kind)).fetchall()
        if not rows:
            return np.zeros(0, np.int64), np.zeros((0, 1), np.float32)
        missing = {number: text for number, text, vector in rows if vector is None or len(vector) != size * np.float32().nbytes}
        fresh = dict(zip(missing, self.embedder.embed(list(missing.values())), strict=True))
        if fresh:
            self._keep([(number, self.embedder.name, vector.tobytes()) for number, vector in fresh.items()])
        vectors = [fresh[number] if number in fresh else np.frombuffer(vector, np.float32) for number, _, vector in rows]
        return np.array([number for number, _, _ in rows]), np.stack(vectors)

    def _keep(self, rows: Sequence[tuple[int, str, bytes]]) -> None:
        """Store vectors, so that they need not be computed again; ignored if the store is read-only."""
        with contextlib.suppress(WriteError), self._connection(writing=True) as database:
            database.executemany("insert or replace into vectors values (?, ?, ?)", rows)

    @contextlib.contextmanager
    def _connection(self, *, writing: bool = False) -> Iterator[sqlite3.Connection]:
        """Open the database for one transaction. A store that does not exist reads as an empty one."""
        path = self.folder / FILE
        try:
            if writing:
                self.folder.mkdir(parents=True, exist_ok=True)
            _require_regular(path)
            exists = path.is_file()
            address = path if writing or exists else ":memory:"
            database = sqlite3.connect(address, timeout=_PATIENCE_S, isolation_level=None)
        except (OSError, sqlite3.Error) as error:
            raise _refused(path, error, writing=writing) from error
        try:
            with contextlib.closing(database):
                _prepare(database, path, writing=writing or not exists)
                database.execute("begin immediate" if writing else "begin")
                yield database
                database.execute("commit")
        except sqlite3.Error as error:
            raise _refused(path, error, writing=writing) from error


def _prepare(database: sqlite3.Connection, path: Path, *, writing: bool) -> None:
    """Set up a connection; make the tables if there are none yet.

    Raises:
        ReadError: If the file was written by a later version.
    """
    database.execute("pragma foreign_keys = on")
    version = int(database.execute("pragma user_version").fetchone()[0])
    if version > VERSION:
        hint = "Use that version, or another folder with --memory."
        raise _unreadable(
            path, f"{path} was written by a later version of articad (store version {version}, this one knows {VERSION}).", hint
        )
    if not writing or version == VERSION:
        return
    if str(database.execute("pragma database_list").fetchone()[2]):
        database.execute("pragma journal_mode = wal")
    database.execute("begin immediate")
    if int(database.execute("pragma user_version").fetchone()[0]) == 0:  # otherwise another process was first
        for statement in _SCHEMA.split(";"):
            database.execute(statement)
        database.execute(f"pragma user_version = {VERSION}")
    database.execute("commit")


def _require_regular(path: Path) -> None:
    """Check that the database and what SQLite keeps beside it are regular files or missing: SQLite follows links.

    Raises:
        OSError: If one is a link, a folder, a pipe, a socket or a device.
    """
    for place in (path, *(path.with_name(path.name + ending) for ending in _BESIDE)):
        with contextlib.suppress(FileNotFoundError, NotADirectoryError):
            if not stat.S_ISREG(place.lstat().st_mode):
                raise OSError(errno.EPERM, "it is a link, a folder, a pipe, a socket or a device, not a file", str(place))


def _topic_of_parts(kernel: str) -> str:
    return f"part {kernel}"


def _refused(path: Path, error: Exception, *, writing: bool) -> ReadError | WriteError:
    doing = "write" if writing else "read"
    message = f"Cannot {doing} the experience store {path}: {error}."
    hint = "Name another folder with --memory; if the file is damaged, move it away and import an export of it."
    finding = Finding(code="E_WRITE" if writing else "E_READ", where=str(path), message=message, hint=hint)
    kind = WriteError if writing else ReadError
    return kind(f"{message} {hint}", path=str(path), findings=[finding])


def _unreadable(path: Path, message: str, hint: str) -> ReadError:
    return ReadError(f"{message} {hint}", path=str(path), findings=[Finding(code="E_READ", where=str(path), message=message, hint=hint)])
