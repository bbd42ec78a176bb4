"""All parts of a plan: scripts are found, parts built in parallel, derived parts made from their sources.

Every failure of every part is reported at once; finished parts stay in the cache.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from articad.aliases import Progress
from articad.errors import BuildError, ContractError, KernelError, ReadError, did_you_mean
from articad.files import SCRIPT_BYTES, read_file
from articad.findings import Finding, Findings
from articad.geometry.part import Part
from articad.kernels.kernel import BuildCache, BuiltPart, PartKernel, build_part, mirror_part, realise
from articad.kernels.slips import explained
from articad.plan.brief import brief_digest, build_digest
from articad.plan.resolve import ResolvedPart, ResolvedPlan
from articad.plan.signatures import functions_in, names_for
from articad.plan.standard_joints import is_pin

SCRIPT_SUFFIX = {"build123d": ".py", "freecad": ".freecad.py"}
PIN_SCRIPT: Final = b"def build(part):\n    return part.made(None)\n"
"""Draws a part that consists of the features of its joints, with every kernel."""


@dataclass(frozen=True)
class RealisedPart:
    """A part of the plan with its geometry.

    Attributes:
        part: The part that assemblies, checks and exports use; its connectors are the plan's.
        built: The kernel's files and the connectors as the script realised them.
        script: Source of the part script; None for a derived part.
        digests: `brief` and `build`; empty for a derived part.
        derived_from: Name of the source part, if derived.
        cached: True when nothing had to be built.
        findings: Warnings of the build.
    """

    part: Part
    built: BuiltPart
    script: bytes | None
    digests: Mapping[str, str]
    derived_from: str | None
    cached: bool
    findings: Findings


def script_file(folder: Path, name: str, kernel: str) -> Path:
    """Return where the script of a part is: `<name>.py` in a folder, else the one beside the folder that builds all other parts."""
    own = folder / f"{name}{SCRIPT_SUFFIX[kernel]}"
    common = folder.parent / f"{folder.name}{SCRIPT_SUFFIX[kernel]}"
    return common if not _is_there(own) and _is_there(common) else own


def script_of(folder: Path, part: ResolvedPart, kernel: str) -> bytes | None:
    """Return the script of a part; for a pin that a joint makes and no script draws, one that returns the pin; None if there is none.

    Raises:
        ReadError: If its file cannot be read.
    """
    path = script_file(folder, part.name, kernel)
    script = read_script(path, folder.parent) if _is_there(path) else None
    if not is_pin(part.dimensions):
        return script
    if script is None or (
        path.parent != folder and (held := functions_in(script)) and not any(name in held for name in names_for(part.name))
    ):
        return PIN_SCRIPT
    return script


def _is_there(path: Path) -> bool:
    return path.is_symlink() or path.exists()


def find_scripts(folder: Path, resolved: ResolvedPlan, kernel: str) -> dict[str, bytes]:
    """Read the script of every part that is not derived.

    Args:
        folder: Holds `<part>.py` for each part; `parts.py` beside a folder `parts` builds all parts that have no script of their own.
        resolved: The plan with its numbers.
        kernel: Whose scripts are read.

    Raises:
        ContractError: With `E_SCRIPT_MISSING` for each part that has none.
    """
    scripts: dict[str, bytes] = {}
    missing = []
    present = sorted(path.name for path in folder.glob("*.py")) if folder.is_dir() else []
    for name, part in resolved.parts.items():
        if part.derivation is not None:
            continue
        script = script_of(folder, part, kernel)
        if script is not None:
            scripts[name] = script
        else:
            missing.append(_script_missing(name, script_file(folder, name, kernel), present))
    if missing:
        raise ContractError("\n".join(map(str, missing)), findings=missing)
    return scripts


def read_script(path: Path, root: Path) -> bytes:
    """Return a part's script.

    Args:
        path: Of the script.
        root: No link on the way from here is followed.

    Raises:
        ReadError: If it is not a file, is too large, or is a link.
    """
    try:
        return read_file(path, SCRIPT_BYTES, root=root)
    except OSError as error:
        raise ReadError.at(path, f"{path} cannot be read: {error.strerror}.", "Write the script there.") from None


def build_parts(
    resolved: ResolvedPlan,
    scripts: Mapping[str, bytes],
    *,
    kernel: PartKernel,
    cache: BuildCache,
    deflection: float,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> dict[str, RealisedPart]:
    """Build every part, independent ones in parallel, in the order of the plan.

    Args:
        resolved: The plan with its numbers.
        scripts: Source of each part script by part name.
        kernel: Builds a script.
        cache: Stores what was built, by its build digest.
        deflection: Largest distance of a mesh from its solid [mm].
        jobs: How many parts at once; by default the number of processors.
        progress: Called with the outcome of each part.

    Raises:
        ContractError: With the findings of every part that failed.
    """
    tell = progress or _silent
    sources = [name for name, part in resolved.parts.items() if part.derivation is None]
    missing = [
        _script_missing(name, Path("parts", f"{name}{SCRIPT_SUFFIX[kernel.name]}"), sorted(scripts))
        for name in sources
        if name not in scripts
    ]
    if missing:
        raise ContractError("\n".join(map(str, missing)), findings=missing)

    def build(name: str) -> RealisedPart | KernelError:
        tell(name, "started")
        try:
            realised = build_source(resolved, name, scripts[name], kernel=kernel, cache=cache, deflection=deflection)
        except KernelError as error:
            tell(name, "failed")
            return error
        tell(name, "cached" if realised.cached else "built")
        return realised

    with ThreadPoolExecutor(max_workers=jobs or os.cpu_count()) as pool:
        outcomes = dict(zip(sources, pool.map(build, sources), strict=True))
    errors = {name: outcome for name, outcome in outcomes.items() if isinstance(outcome, KernelError)}
    if errors:
        raise _all_failures(errors, len(sources))
    realised = {name: outcome for name, outcome in outcomes.items() if isinstance(outcome, RealisedPart)}
    for name in _derived_in_order(resolved):
        realised[name] = derive_part(resolved, name, realised, kernel=kernel)
        tell(name, "derived")
    return {name: realised[name] for name in resolved.parts}


def build_source(
    resolved: ResolvedPlan, name: str, script: bytes, *, kernel: PartKernel, cache: BuildCache, deflection: float
) -> RealisedPart:
    """Build one part that is not derived and check it against its contract.

    Raises:
        BuildError: If its script fails.
        ContractError: If the result breaks the contract, connector drift included. If one number in another unit, or with the other sign,
            would heal either failure, its findings go to the designer.
    """
    try:
        built, part, findings = _kept(resolved, name, script, kernel, cache, deflection)
    except (BuildError, ContractError) as error:
        raise explained(error, resolved, name, script, kernel) from None
    digests = {
        "brief": brief_digest(resolved, name),
        "build": build_digest(resolved, name, script, kernel.name, kernel.version, deflection),
    }
    return RealisedPart(part=part, built=built, script=script, digests=digests, derived_from=None, cached=built.cached, findings=findings)


def _kept(
    resolved: ResolvedPlan, name: str, script: bytes, kernel: PartKernel, cache: BuildCache, deflection: float
) -> tuple[BuiltPart, Part, Findings]:
    """Return a part that keeps its contract, as built and as seated in the plan, with its warnings."""
    built = build_part(resolved, name, script, kernel=kernel, cache=cache, deflection=deflection)
    part, drift = realise(resolved.parts[name], built)
    findings = _without_effects_of_slips(built.findings + drift)
    if not findings.ok:
        raise ContractError("\n".join(map(str, findings.errors)), findings=findings, parts=(name,))
    return built, part, findings


def _without_effects_of_slips(findings: Findings) -> Findings:
    """Return findings without dimensions that have no effect because they are out of proportion, as a cut far longer than its part is."""
    doubted = {finding.where for finding in findings.of("W_SCALE")}
    return Findings(finding for finding in findings if finding.code != "W_DIMENSION_UNUSED" or finding.where not in doubted)


def derive_part(resolved: ResolvedPlan, name: str, realised: Mapping[str, RealisedPart], *, kernel: PartKernel) -> RealisedPart:
    """Make a derived part from its source's geometry: the same for rigid and pattern, reflected for mirror."""
    target = resolved.parts[name]
    derivation = target.derivation
    assert derivation is not None
    source = realised[derivation.source]
    if derivation.S is None:
        built, part = source.built, source.part.renamed(name)
    else:
        built = mirror_part(kernel, source.built, derivation.S)
        part = _with_files(source.part.mirrored(name, derivation.S), built)
    part = replace(part, connectors=target.connectors, color=target.color)
    return RealisedPart(
        part=part, built=built, script=None, digests={}, derived_from=derivation.source, cached=source.cached, findings=Findings()
    )


def _with_files(part: Part, built: BuiltPart) -> Part:
    """Return a mirror image with the B-rep files that the kernel wrote for it."""
    if part.solid is None:
        return part
    return replace(part, solid=replace(part.solid, brep=built.solid.brep, step=built.solid.step))


def _derived_in_order(resolved: ResolvedPlan) -> Iterator[str]:
    """Yield derived parts, each after its source; `resolve` has refused cycles."""
    done = {name for name, part in resolved.parts.items() if part.derivation is None}
    waiting = [name for name in resolved.parts if name not in done]
    while waiting:
        for name in waiting:
            derivation = resolved.parts[name].derivation
            if derivation is not None and derivation.source in done:
                done.add(name)
                yield name
        waiting = [name for name in waiting if name not in done]


def _all_failures(errors: Mapping[str, KernelError], total: int) -> ContractError:
    findings = Findings(finding for error in errors.values() for finding in error.findings)
    reasons = dict.fromkeys(str(error) for error in errors.values())  # one for all, if it is the machine's
    lines = [f"{len(errors)} of {total} parts could not be built.", *reasons]
    return ContractError("\n".join(lines), findings=findings, parts=tuple(errors))


def _script_missing(name: str, file: Path, present: list[str]) -> Finding:
    return Finding(
        code="E_SCRIPT_MISSING",
        where=f"parts.{name}",
        parts=(name,),
        message=f"Part {name!r} has no script {file.name!r}.{did_you_mean(file.name, present)}",
        hint=f"Write {file.name} with a function build(part) that returns (shape, connectors), "
        f"or one script {file.parent.name}{''.join(file.suffixes)} beside {file.parent.name}/ for all parts that have none.",
    )


def _silent(name: str, event: str) -> None:
    """Ignore an event."""
