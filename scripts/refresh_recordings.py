"""Makes the files of the recorded examples again after the kernel or a writer has changed; what models answered stays as it is.

    .venv/bin/python scripts/refresh_recordings.py

Every recording is replayed strictly: where a prompt has changed, it is refused and must be recorded anew.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from articad.agents.pipeline import replay

ROOT = Path(__file__).resolve().parents[1]
ANSWERED = {"llm", "request.json", "README.md", "trace.jsonl", "images"}


def main() -> int:
    """Refresh all recordings; return how many replies would have changed, which must be none."""
    changed = 0
    for recording in sorted(path.parent for path in (ROOT / "examples").glob("*/recording/request.json")):
        with tempfile.TemporaryDirectory() as folder:
            again = replay(recording, out=Path(folder) / "run", strict=True)
            answered = [name for name in again.differences if name.split("/")[0] in ANSWERED - {"README.md"}]
            changed += len(answered)
            for entry in again.run.path.iterdir():
                if entry.name in ANSWERED or answered:
                    continue
                target = recording / entry.name
                shutil.rmtree(target) if target.is_dir() else target.unlink(missing_ok=True)
                shutil.move(entry, target)
            print(f"{recording.relative_to(ROOT)}: {len(again.differences)} files differed, {len(answered)} of them answers")
    return min(changed, 1)


if __name__ == "__main__":
    sys.exit(main())
