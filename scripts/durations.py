"""Writes tests/slow.txt, which `./scripts/test fast` leaves out, from the report of a whole run.

ARTICAD_TEST_REPORT=report.xml ./scripts/test tests && .venv/bin/python scripts/durations.py report.xml
"""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FAST_SECONDS = 0.5  # of a test function, all of its parameters together


def main(report: str) -> None:
    """Read a JUnit report and write the list, slowest first."""
    seconds: Counter[str] = Counter()
    for case in ET.parse(report).getroot().iter("testcase"):  # noqa: S314 - our own pytest wrote it
        file = case.get("classname", "").replace(".", "/") + ".py"
        seconds[f"{file}::{case.get('name', '').partition('[')[0]}"] += float(case.get("time", "0"))
    rows = [f"{spent:8.1f} {name}" for name, spent in seconds.most_common() if spent > FAST_SECONDS]
    head = f"# seconds and name of each test function above {FAST_SECONDS} s; written by scripts/durations.py"
    (ROOT / "tests" / "slow.txt").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    fast = sum(spent for spent in seconds.values() if spent <= FAST_SECONDS)
    print(f"{len(rows)} slow functions take {sum(seconds.values()) - fast:.0f} s, {len(seconds) - len(rows)} fast ones {fast:.0f} s")


if __name__ == "__main__":
    main(sys.argv[1])
