"""Record: writes an assembly into a run directory, and restores it from there."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from articad import formats
from articad.aliases import Progress
from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.bounds import values_in
from articad.certificates.certificate import Certificate, mechanism_json
from articad.certificates.verifier import verify_file
from articad.certificates.verifier_files import BYTES, ROOM, TEXT, VALUES, arrays_in, room
from articad.connectors.connector import Connector
from articad.errors import ReadError
from articad.findings import Finding, Findings
from articad.geometry.mesh_files import write_stl
from articad.geometry.part import Solid
from articad.interference.check import Checks
from articad.kernels.choice import Sandbox, kernel_named
from articad.kernels.kernel import BuildCache
from articad.kernels.parts import RealisedPart
from articad.plan.brief import brief
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.processes import scratch
from articad.report import Documents, report_page
from articad.runs.forms import FINDING, misfit
from articad.runs.run import Run

Report = dict[str, Any]

HURRIED: Final = {"W_BUILD_UNCHECKED"}  # findings of a machine that was too slow: only in the trace, or no replay would be equal
_KERNEL_FILES: Final = ("part.npz", "part.brep", "part.step", "part.FCStd", "seat.json")
_SAME_MM: Final = 1e-6  # between corners of two meshes that processors may round otherwise


def record_assembly(run: Run, assembly: Assembly) -> None:
    """Save every part with its script, files and measurements, and the assembly's report."""
    for name, realised in assembly.realised.items():
        _record_part(run, assembly, name, realised)
    for stranger in sorted(set(run.part_names()) - set(assembly.parts)):
        run.remove_part(stranger)
    for finding in assembly.findings.of(*HURRIED):
        run.trace_finding(finding)
    run.save_assembly(assembly_report(assembly))


def assembly_report(assembly: Assembly) -> Report:
    """Return the report `articad.assembly/1`: parts, joints, freedoms, drivers and mass at rest, numbers in mm, rad and kg."""
    rest = assembly.at()
    parts = {
        name: {
            "material": part.material,
            "volume_mm3": None if part.solid is None else part.solid.volume,
            "mass_kg": None if part.mass is None else part.mass.mass,
            "rest": rest[name].data.tolist(),
            "derived_from": assembly.realised[name].derived_from if name in assembly.realised else None,
        }
        for name, part in assembly.parts.items()
    }
    drivers = [
        {"name": driver.name, "unit": driver.unit, "lower": _finite(driver.lower), "upper": _finite(driver.upper), "rest": driver.rest}
        for driver in assembly.drivers
    ]
    return {
        "schema": "articad.assembly/1",
        "ok": assembly.findings.ok,
        "name": assembly.name,
        "ground": assembly.ground,
        "freedoms": assembly.mechanism.mobility,
        "mass_kg": sum(part.mass.mass for part in assembly.parts.values() if part.mass is not None),
        "parts": parts,
        "joints": {joint.name: {"type": str(joint.type), "parent": joint.parent, "child": joint.child} for joint in assembly.joints},
        "drivers": drivers,
        "findings": [finding.to_json() for finding in assembly.findings if finding.code not in HURRIED],
    }


def record_checks(run: Run, checks: Checks) -> None:
    """Save the checks, and write each finding into the trace."""
    run.save_checks(checks.to_json())
    for finding in checks.findings:
        run.trace_finding(finding)


def documents_of(run: Run) -> Documents:
    """Return a run's documents other than its assembly, for its page; paths are relative to the run."""
    exports = {name: report | {"main": Path(report["main"]).relative_to(run.path).as_posix()} for name, report in run.exports().items()}
    return Documents(
        prompt=run.prompt if run.request.options.get("task") != "build" else "",
        checks=run.checks(),
        certificate=run.certificate(),
        verdict=run.verdict(),
        exports=exports,
        replies=run.talks(),
        plan=run.plan_text(),
        files=run.results(),
    )


def record_page(run: Run, assembly: Assembly, *, repeated: bool = False) -> Path:
    """Save the HTML page of a run; return its file. `repeated`: whether anybody may have written what the run states."""
    return run.save_page(report_page(assembly, replace(documents_of(run), repeated=repeated)))


def record_certificate(run: Run, certificate: Certificate) -> Report:
    """Save a certificate and its meshes; return its report. With a file that the independent checker does not read, it is not ok."""
    report, meshes = certificate.to_json(), certificate.mesh_files()
    if certificate.ok and (reason := _unread(certificate, json.dumps(report).encode(), meshes)):
        certificate = _not_checked(certificate, reason)
        report = certificate.to_json()
    _save_certificate(run, certificate, report, meshes)
    return report


def departures(run: Run, certificate: Report, meshes: Path) -> list[str]:
    """Return how a certificate is about another product than the plan and the parts that a run records; nothing is built for that.

    Args:
        run: The run.
        certificate: A certificate that its checker accepts.
        meshes: The folder of its meshes.

    Raises:
        ReadError: If the run has no plan.
        PlanError: If its plan cannot be resolved.
    """
    parameters: Mapping[str, float] = run.request.options.get("parameters") or {}
    resolved = resolve(_plan_of(run), **parameters)
    made = {name: (run.part(name) or {}).get("shape", {}).get("mesh_sha256") for name in run.part_names()}
    proven = {name: mesh["sha256"] for name, mesh in certificate["meshes"].items()}
    derived = {name: part.derivation for name, part in resolved.parts.items() if part.derivation is not None}
    images = {name: (how.source, how.S) for name, how in derived.items() if how.S is not None}
    strange = {name for name in made.keys() | proven.keys() if made.get(name) != proven.get(name)} - images.keys()
    strange |= {name for name, image in images.items() if not _is_image(name, *image, proven, meshes)}
    found = [f"it is about other parts than the run's: {_some(sorted(strange))}"] if strange else []
    if json.loads(json.dumps(mechanism_json(resolved.mechanism))) != certificate["mechanism"]:
        found.append("it is about other joints than the run's: their frames, limits or couplings differ")
    return found


def _is_image(name: str, source: str, S: FloatArray, proven: Collection[str], meshes: Path) -> bool:
    """Return whether one mesh of a certificate is the mirror image of another one: a record of it would state the kernel's own image."""
    if name not in proven or source not in proven:
        return name not in proven and source not in proven
    arrays = arrays_in(meshes, [name, source])
    expected = arrays[source]["vertices"] @ S[:3, :3].T + S[:3, 3]
    vertices = arrays[name]["vertices"]
    return bool(vertices.shape == expected.shape and np.abs(vertices - expected).max(initial=0.0) <= _SAME_MM)


def _some(names: Sequence[str], most: int = 5) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def _plan_of(run: Run) -> AssemblyPlan:
    text = run.plan_text()
    if text is None:
        raise ReadError(f"{run.path} has no plan yet.", path=str(run.path), where="plan.json")
    return AssemblyPlan.loads(text)


def _save_certificate(run: Run, certificate: Certificate, report: Report, meshes: Mapping[str, bytes]) -> None:
    run.save_certificate(report, meshes)
    for finding in certificate.findings:
        run.trace_finding(finding)


def record_checked(run: Run, certificate: Certificate) -> Report:
    """Have the independent checker read the files of a certificate, then save it; return whether it is accepted, and why not.

    A refuted certificate is saved with the error `E_CERTIFICATE_REFUTED`, one with a file that the checker does not read with `E_NOT_CHECKED`.

    Returns:
        `ok`; `checked`, whether the checker reads files of this size; `faults`, why it is not accepted.
    """
    report, meshes = certificate.to_json(), certificate.mesh_files()
    text = json.dumps(report).encode()
    unread = _unread(certificate, text, meshes)
    faults = [unread] if unread else _faults(text, meshes)
    if faults and certificate.ok:
        certificate = _not_checked(certificate, unread) if unread else certificate.refuted(faults[0])
        report = certificate.to_json()
    _save_certificate(run, certificate, report, meshes)
    return {"ok": not faults, "checked": not unread, "faults": faults}


def _unread(certificate: Certificate, report: bytes, files: Mapping[str, bytes]) -> str:
    """Return which file of a certificate is larger than its checker reads; empty if none is."""
    size, name = max((len(content), name) for name, content in files.items())
    if size > BYTES:
        return f"{name} has {size} bytes, more than the {BYTES} that it reads"
    if len(report) > TEXT:
        return f"certificate.json has {len(report)} bytes, more than the {TEXT} that it reads"
    if (values := values_in(report)) > VALUES:
        return f"certificate.json has {values} values, more than the {VALUES} that it reads"
    size = sum(
        map(room, [*certificate.proof.values(), *(of for mesh in certificate.meshes.values() for of in (mesh.vertices, mesh.triangles))])
    )
    return f"the proof has {size} bytes of numbers, more than the {ROOM} that it reads" if size > ROOM else ""


def _not_checked(certificate: Certificate, reason: str) -> Certificate:
    """Return a certificate with the error that its checker does not read it."""
    message = f"The certificate checker does not read the proof: {reason}."
    hint = "Prove some joints at a time: `articad certify RUN --joints A,B`; or each joint alone: `articad certify RUN --no-pairs`."
    finding = Finding(code="E_NOT_CHECKED", where="certificate", message=message, hint=hint)
    return replace(certificate, findings=Findings([*certificate.findings, finding]))


def _faults(certificate: bytes, meshes: Mapping[str, bytes]) -> list[str]:
    """Return why the independent checker refutes the files of a certificate."""
    with scratch.folder("certificate") as name:
        folder = Path(name)
        (folder / "certificate.json").write_bytes(certificate)
        (folder / "meshes").mkdir()
        for file, content in meshes.items():
            (folder / "meshes" / file).write_bytes(content)
        return verify_file(folder / "certificate.json", folder / "meshes")


def _hurried(run: Run) -> list[Report]:
    """Return the findings that are only in the trace, each once."""
    told = (event for event in run.events() if event.get("event") == "finding" and not misfit(event, FINDING))
    found = {event["where"]: event for event in told if event["code"] in HURRIED}
    return [{key: value for key, value in event.items() if key not in {"t", "event"}} for event in found.values()]


def record_export(run: Run, assembly: Assembly, format_name: str, *, strict: bool = False, **choices: Any) -> Report:
    """Save an export; return its report `articad.losses/1`, with the folder. For `choices` see `articad.formats.write`."""
    bundle = formats.NAMED[format_name].write(assembly, strict=strict, **choices)
    return record_files(run, format_name, bundle.files, bundle.to_json())


def record_files(run: Run, format_name: str, files: Mapping[str, bytes], report: Report) -> Report:
    """Save the files of an export, the main one first, and its report `articad.losses/1`; return the report, with the folder."""
    run.save_export(format_name, files, report)
    run.trace("artifact", kind=format_name, file=f"export/{format_name}/{next(iter(files))}")
    return run.exports()[format_name]


def record_objections(run: Run, format_name: str, findings: Findings) -> None:
    """Add what a simulator says against an export to the export's report, and to the trace that it was asked."""
    tried = "W_SIM_NOT_TRIED" not in findings.codes
    message = "loaded and held at rest in MuJoCo" if tried else "not tried in MuJoCo, which did not finish in time"
    run.trace("note", where=f"export.{format_name}", message=message, ok=findings.ok)
    if findings:
        report = {key: value for key, value in run.exports()[format_name].items() if key not in {"folder", "main"}}
        said = report["findings"] + [finding.to_json() for finding in findings]
        run.save_export(format_name, {}, report | {"ok": report["ok"] and findings.ok, "findings": said})
        for finding in findings:
            run.trace_finding(finding)


def run_report(run: Run) -> Report:
    """Return the report `articad.build/1` of a finished run, from those of its assembly, checks and exports.

    Raises:
        ReadError: If the run is not finished.
    """
    assembly, checks, exports = run.assembly(), run.checks(), run.exports()
    if assembly is None or checks is None:
        raise ReadError(f"{run.path} is not finished: it has no {'assembly' if assembly is None else 'checks'} yet.", path=str(run.path))
    certificate = run.certificate()
    proven: dict[str, Report] = (
        {}
        if certificate is None
        else {"certificate": {key: certificate[key] for key in ("schema", "ok", "covers", "findings", "epsilon_mm", "pairs", "ranges")}}
    )
    verdict = run.verdict()
    if verdict is not None:
        proven["verdict"] = {key: verdict[key] for key in ("schema", "ok", "findings", "by", "round", "rulings")}
    if (edit := run.edit()) is not None:
        proven["edit"] = edit
    if (review := run.review()) is not None:
        proven["review"] = review
    return {
        "schema": "articad.build/1",
        "ok": all(report["ok"] for report in (assembly, checks, *proven.values(), *exports.values())),
        "run": str(run.path),
        "assembly": assembly,
        "checks": checks,
        "exports": exports,
        "findings": _hurried(run),
    } | proven


def assembly_of(run: Run, *, cache: BuildCache | None = None, sandbox: Sandbox = "strict", progress: Progress | None = None) -> Assembly:
    """Restore a run's assembly from its plan and part scripts; parts in the cache are not built again.

    Raises:
        ReadError: If the run has no plan, or not all parts.
        ArticadError: The errors of building.
    """
    plan = _plan_of(run)
    scripts = {name: script for name in run.part_names() if (script := run.script(name)) is not None}
    parameters: Mapping[str, float] = run.request.options.get("parameters", {})
    kernel = kernel_named(str(run.request.options.get("kernel", plan.kernel)), sandbox=sandbox)
    return Assembly.from_plan(plan, scripts, kernel=kernel, cache=cache, progress=progress, parameters=parameters)


def _record_part(run: Run, assembly: Assembly, name: str, realised: RealisedPart) -> None:
    assert assembly.resolved is not None
    built = realised.built
    # What depends on the machine and not on the part is in the trace, so that a replay elsewhere compares equal.
    run.trace("build", part=name, sandbox=built.sandbox, cached=realised.cached, derived_from=realised.derived_from)
    kernel = run.request.options.get("kernel", assembly.resolved.plan.kernel)
    record: Report = {"kernel": kernel, "editable": realised.derived_from is None, "shape": _shape_json(built.solid)}
    if realised.derived_from is not None:
        run.save_part(name, record=record | {"derived_from": realised.derived_from})
        return
    planned = assembly.resolved.parts[name].connectors
    run.save_part(
        name,
        record=record | {"digests": dict(realised.digests)},
        brief=brief(assembly.resolved, name),
        script=realised.script,
        connectors={connector: _connector_json(realised_one, planned[connector]) for connector, realised_one in built.connectors.items()},
        stl=write_stl(built.solid.mesh),
        files={file: built.folder / file for file in _KERNEL_FILES if (built.folder / file).is_file()},
    )


def _shape_json(solid: Solid) -> Report:
    return {
        "volume_mm3": solid.volume,
        "area_mm2": solid.area,
        "bbox_mm": solid.bbox.tolist(),
        "com_mm": solid.com.tolist(),
        "inertia_mm5": solid.inertia_mm5.tolist(),
        "triangles": len(solid.mesh.triangles),
        "mesh_sha256": solid.mesh.digest,
        "deflection_mm": solid.deflection,
    }


def _connector_json(realised: Connector, planned: Connector) -> Report:
    """Return a connector of the script, and its distance from the plan's."""
    frame, drift = realised.frame, planned.drift(realised.frame)
    return {
        "o": frame.translation.tolist(),
        "z": frame.z_axis.tolist(),
        "x": frame.x_axis.tolist(),
        "drift": {"radial_mm": drift.radial, "along_mm": drift.along, "axis_rad": drift.axis, "roll_rad": drift.roll},
    }


def _finite(bound: float) -> float | None:
    """Return a bound that JSON can represent; None if there is none."""
    return bound if abs(bound) < float("inf") else None
