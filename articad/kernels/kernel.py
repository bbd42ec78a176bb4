"""The interface between plans and B-rep kernels: what a kernel is asked for, what it returns, and how a part is seated in the plan."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from articad.arrays import FloatArray
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import KernelError
from articad.findings import Finding, Findings
from articad.geometry.part import Part, Solid
from articad.kernels.cache import BuildCache
from articad.kernels.contract import dimension_findings, drift_findings, lengths_of, primary_connector, seating
from articad.kernels.features import Order, bore_findings, feature_findings
from articad.kernels.radii import radius_findings
from articad.kernels.results import read_mesh
from articad.plan.brief import brief, brief_digest, build_digest
from articad.plan.fields import lengths_in
from articad.plan.resolve import ResolvedPart, ResolvedPlan

__all__ = ["BuildCache", "BuiltPart", "Inspect", "PartKernel", "build_part", "mirror_part", "realise"]

_HURRIED = "W_BUILD_UNCHECKED"  # of a build that was cut short by time
_OF_PROBE = {"W_DIMENSION_UNUSED", "W_DIMENSION_REFUSED", _HURRIED}
SEATED_MM, SEATED_RAD = 1e-7, 1e-10  # a smaller seat is rounding of numbers in a script; the files stay as they are

Inspect = Callable[[Mapping[str, Connector], FloatArray], Findings]
"""Checks the realised connectors, given the bounding box `(2, 3)`; its findings join the kernel's own."""


@dataclass(frozen=True, eq=False)
class BuiltPart:
    """One solid with its files.

    Attributes:
        folder: Holds result.json, part.npz, part.brep, part.step.
        solid: Its mesh and exact numbers.
        connectors: The actual places of the features, in the part's frame.
        findings: Warnings of the build and of the dimension probe.
        sandbox: The level of isolation under which the script ran.
        cached: True when nothing had to be built.
        brief: The input of the script; its `connectors` name the joints at each connector.
    """

    folder: Path
    solid: Solid
    connectors: Mapping[str, Connector]
    findings: Findings
    sandbox: str
    cached: bool = False
    brief: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def load(cls, folder: Path, *, cached: bool = False) -> BuiltPart:
        """Read a folder that a kernel has written."""
        result = json.loads((folder / "result.json").read_text())
        shape = result["shape"]
        solid = Solid(
            mesh=read_mesh((folder / "part.npz").read_bytes()),
            brep=folder / "part.brep",
            step=folder / "part.step",
            deflection=float(result["deflection_mm"]),
            volume=float(shape["volume_mm3"]),
            area=float(shape["area_mm2"]),
            com=np.array(shape["com_mm"]),
            inertia_mm5=np.array(shape["inertia_mm5"]),
            bbox=np.array(shape["bbox_mm"]),
        )
        connectors = {
            name: Connector(name, SE3.from_axes(frame["o"], frame["z"], frame["x"]), label=frame.get("label", ""))
            for name, frame in result["connectors"].items()
        }
        findings = Findings(finding_from_json(finding) for finding in result["findings"])
        return cls(folder, solid, connectors, findings, result["sandbox"], cached, result["part"])


class PartKernel(Protocol):
    """Converts part scripts to solids."""

    @property
    def name(self) -> str:
        """Name in plans: `build123d`, `freecad`."""
        ...

    @property
    def version(self) -> str:
        """Version of everything that a part's geometry depends on besides its script."""
        ...

    def build(
        self,
        script: bytes,
        brief: Mapping[str, Any],
        *,
        folder: Path,
        deflection: float = 0.01,
        probe: bool = True,
        inspect: Inspect | None = None,
    ) -> BuiltPart:
        """Run a script and check its part against the contract.

        Args:
            script: Its source.
            brief: Its input (`articad.plan.brief`).
            folder: An empty folder for the files.
            deflection: Largest distance of the mesh from the solid [mm].
            probe: Whether to change each dimension and build again.
            inspect: A further check of the connectors.

        Raises:
            BuildError: If the script fails; `partial` holds the solids that it had.
            ContractError: With every breach at once; it has `partial` as well.
        """
        ...

    def moved(self, built: BuiltPart, matrix: ArrayLike, folder: Path) -> BuiltPart:
        """Return the part under a rigid motion or a reflection `(4, 4)`, with its files, in an empty folder."""
        ...


def build_part(
    resolved: ResolvedPlan, name: str, script: bytes, *, kernel: PartKernel, cache: BuildCache, deflection: float = 0.01
) -> BuiltPart:
    """Build a part of a plan, or take it from the cache.

    Its files are in the plan's frame: if the script put the connector to the tree parent elsewhere, the whole part is moved to match the
    plan. A script whose part follows all dimensions is not probed again for other numbers. One whose part does not is: a cut in the air for
    one number may be a slot for another. A part whose checks were cut short by time is kept under another digest and built again when it is
    needed next.

    Args:
        resolved: The plan with its numbers.
        name: A part that a script builds.
        script: Its source.
        kernel: Builds it.
        cache: Stores it, by build digest.
        deflection: Largest distance of the mesh from the solid [mm].

    Raises:
        BuildError: If the script fails.
        ContractError: If the result breaks the contract.
    """
    target = resolved.parts[name]
    digest = build_digest(resolved, name, script, kernel.name, kernel.version, deflection)
    folder = cache.get(digest)
    cached = folder is not None
    if folder is None:
        told = brief(resolved, name)
        script_digest = _digest(brief_digest(resolved, name), script.hex(), kernel.name, kernel.version)
        probed = cache.get(f"{script_digest}.follows")
        try:
            with cache.writing(lambda: stored) as empty:
                built = kernel.build(
                    script,
                    told,
                    folder=empty,
                    deflection=deflection,
                    probe=probed is None,
                    inspect=lambda connectors, bbox: drift_findings(target, told, connectors, bbox),
                )
                stored = f"{digest}.hurried" if _HURRIED in built.findings.codes else digest
        except KernelError as error:
            error.partial = _kept(cache, digest, error.partial)
            raise
        if probed is None and not any(finding.code in _OF_PROBE for finding in built.findings):
            with cache.writing(f"{script_digest}.follows") as empty:
                (empty / "probed.json").write_text("{}")
        folder = cache.root / stored
    return _seated(target, BuiltPart.load(folder, cached=cached), kernel)


def mirror_part(kernel: PartKernel, built: BuiltPart, S: ArrayLike) -> BuiltPart:
    """Return the mirror image of a built part under `S (4, 4)`, beside it in the cache."""
    return _moved(kernel, built, np.asarray(S, dtype=np.float64))


def realise(resolved_part: ResolvedPart, built: BuiltPart) -> tuple[Part, Findings]:
    """Seat a built part in the plan.

    Its connectors are the plan's: the mechanism never follows a script. The geometry is seated by the connector to the tree parent,
    C*·C⁻¹·G; the remaining deviation at the other connectors is drift.

    Returns:
        The part, and the findings that `built.findings` does not already contain: `E_CONNECTOR_DRIFT` if drift exceeds the bounds,
        `W_CONNECTOR_FEATURE` if a connector's kind orders a feature that is not there, `W_BORE_NARROW` for a bore that cannot be made,
        `W_RADIUS_MISTAKEN` for a round face with twice or half of the radius that a dimension states,
        `W_SCALE` for a dimension far longer than the part, or a thickness out of proportion.
    """
    T = seating(resolved_part, built.connectors, primary_connector(resolved_part, built.brief))
    solid = built.solid if T.allclose(SE3.identity(), mm=SEATED_MM, rad=SEATED_RAD) else built.solid.moved(T)
    part = Part.from_solid(
        resolved_part.name,
        solid,
        density=resolved_part.material.density,
        connectors=resolved_part.connectors,
        color=resolved_part.color,
        material=resolved_part.material.name,
    )
    known = {(finding.code, finding.where) for finding in built.findings}
    drift = drift_findings(resolved_part, built.brief, built.connectors, built.solid.bbox)
    name = resolved_part.name
    features = feature_findings(name, resolved_part.connectors, solid.mesh, _order(resolved_part))
    features += bore_findings(name, solid.mesh, lengths_of(resolved_part))
    features += radius_findings(name, solid.mesh, lengths_in(resolved_part.dimensions) if resolved_part.derivation is None else {})
    found = drift + features + dimension_findings(resolved_part, solid.bbox)
    return part, Findings(finding for finding in found if (finding.code, finding.where) not in known)


def _order(part: ResolvedPart) -> Order | None:
    """Return what decides whether a connector or the feature beside it is at fault; None for a derived part, which has neither of its own."""
    if part.derivation is not None:
        return None
    stated = {spec.name: part.T_rest if spec.frame == "assembly" else SE3.identity() for spec in part.spec.connectors}
    return Order(lengths_in(part.dimensions), stated)


def finding_from_json(form: Mapping[str, Any]) -> Finding:
    """Return the finding stored as JSON."""
    names = ("code", "where", "message", "hint", "value", "limit", "unit", "cause", "pose", "stage", "route")
    return Finding(**{name: form[name] for name in names}, parts=tuple(form["parts"]))


def _seated(target: ResolvedPart, built: BuiltPart, kernel: PartKernel) -> BuiltPart:
    T = seating(target, built.connectors, primary_connector(target, built.brief))
    if T.allclose(SE3.identity(), mm=SEATED_MM, rad=SEATED_RAD):
        return built
    return _moved(kernel, built, T.matrix)


def _moved(kernel: PartKernel, built: BuiltPart, matrix: FloatArray) -> BuiltPart:
    cache = BuildCache(built.folder.parent)
    digest = f"{built.folder.name}.{_digest(json.dumps(matrix.tolist()))[:16]}"
    folder = cache.get(digest)
    if folder is None:
        with cache.writing(digest) as empty:
            kernel.moved(built, matrix, empty)
        folder = cache.root / digest
    return replace(BuiltPart.load(folder, cached=built.cached), findings=built.findings)


def _kept(cache: BuildCache, digest: str, partial: Path | None) -> Path | None:
    if partial is None or not partial.is_dir():
        return None
    return cache.keep_failed(digest, {path.name: path.read_bytes() for path in partial.iterdir() if path.is_file()})


def _digest(*parts: str) -> str:
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()
