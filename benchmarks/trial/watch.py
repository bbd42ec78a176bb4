"""Watch what an agent writes into a folder: characters added to scripts and plans, and when.

    python benchmarks/trial/watch.py FOLDER [--ends .py,.json,.txt] &

Each half second, every file that was written by hand (its name ends as stated, and it is in no folder that a tool makes: one with a name
such as `export`, or a run of articad, which holds `request.json`) is compared with its last version: inserted and replaced characters count, also when they replace what was written before. A copy of a file that is there already
counts nothing. The sums go to FOLDER/written.json: `seconds` since the watch began until the last change, `characters` in all, `final`
characters in the last versions.
The watch ends when FOLDER/done is there.
"""

from __future__ import annotations

import argparse
import difflib
import json
import time
from pathlib import Path
from typing import Final

RUN: Final = "request.json"
MADE: Final = frozenset({"run", "out", "export", "meshes", "__pycache__"})
PERIOD: Final = 0.5  # s


def written(before: str, after: str) -> int:
    """Return how many characters of `after` are not kept from `before`, line by line and within changed lines."""
    old, new = before.splitlines(keepends=True), after.splitlines(keepends=True)
    added = 0
    for tag, a, b, c, d in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if tag == "insert":
            added += sum(map(len, new[c:d]))
        elif tag == "replace":
            inner = difflib.SequenceMatcher(None, "".join(old[a:b]), "".join(new[c:d]), autojunk=False)
            added += sum(j - i for kind, _, _, i, j in inner.get_opcodes() if kind in ("insert", "replace"))
    return added


def is_made(file: Path, folder: Path) -> bool:
    """Return whether a file is in a folder that a tool made."""
    inner = file.relative_to(folder)
    named = any(MADE & {part, part.rstrip("0123456789_")} for part in inner.parts)
    return named or any((folder / place / RUN).exists() for place in inner.parents if place != Path())


def main() -> None:
    """Watch until the folder holds a file `done`."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("folder", type=Path)
    reader.add_argument("--ends", default=".py,.json,.txt")
    arguments = reader.parse_args()
    folder, ends = arguments.folder, tuple(arguments.ends.split(","))
    known: dict[Path, str] = {}
    characters, began, changed = 0, time.time(), time.time()
    ended = False
    while not ended:
        ended = (folder / "done").exists()
        for file in sorted(folder.rglob("*")):
            if not file.name.endswith(ends) or file.name == "written.json" or is_made(file, folder) or not file.is_file():
                continue
            text = file.read_text(errors="replace")
            if text != known.get(file):
                if text not in known.values():
                    characters += written(known.get(file, ""), text)
                known[file], changed = text, time.time()
        report = {"seconds": round(changed - began, 1), "characters": characters, "final": sum(map(len, set(known.values())))}
        if ended:
            report["done_after_s"] = round((folder / "done").stat().st_mtime - began, 1)
        (folder / "written.json").write_text(json.dumps(report) + "\n")
        time.sleep(PERIOD)


if __name__ == "__main__":
    main()
