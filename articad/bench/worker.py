"""A worker of a local batch: reads an item a line, makes it, answers with its record; ends when there are no more lines.

python -m articad.bench.worker OUT MEMORY_GB
"""

from __future__ import annotations

import json
import os
import resource
import sys

from articad.bench.items import Item, make


def main() -> int:
    """Serve; return the exit code."""
    out, memory = sys.argv[1], float(sys.argv[2])
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever else is printed goes to the terminal, not between the answers
    resource.setrlimit(resource.RLIMIT_DATA, (int(memory * 2**30), resource.RLIM_INFINITY))
    for line in sys.stdin:
        answers.write(json.dumps(make(Item.from_json(json.loads(line)), out)) + "\n")
        answers.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
