"""Run inside FreeCAD: build a body from each example of the kernel's functions, and measure it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import FreeCAD as App


def main() -> None:
    """Read the job, build, report the volume of each example's body [mm³] and what is invalid in its document."""
    job = json.loads(Path("job.json").read_text())
    kernel: dict[str, Any] = {"__name__": "part"}
    exec(compile(job["kernel"], "part.py", "exec"), kernel)
    report = {}
    for name, example in job["examples"].items():
        document = App.newDocument(name)
        values = document.addObject("App::VarSet", "Dimensions")
        for dimension, value in job["dimensions"].items():
            values.addProperty("App::PropertyFloat", f"d_{dimension}", "Dimensions")
            setattr(values, f"d_{dimension}", value)
        brief = {"name": name, "description": "", "material": None, "dimensions": job["dimensions"], "connectors": {}}
        part = kernel["Authoring"](brief, document)
        exec(compile(example, name, "exec"), {"part": part})
        document.recompute()
        shape = part.body.Shape
        report[name] = {
            "volume": shape.Volume,
            "solids": len(shape.Solids),
            "valid": shape.isValid(),
            "invalid": [item.Name for item in document.Objects if "Invalid" in item.State],
        }
    Path("report.json").write_text(json.dumps(report))


main()
