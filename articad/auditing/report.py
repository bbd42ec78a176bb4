"""The report of an audit."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from articad.certificates.certificate import Certificate
from articad.findings import Findings
from articad.simulation.loading import Loading


@dataclass(frozen=True)
class Audit:
    """The result of an audit.

    Attributes:
        file: The audited file.
        format: "urdf", "mjcf", "freecad", "step", "plan" or "run".
        name: Name of the robot or product.
        links: Number of links.
        joints: Number of moving joints.
        findings: All, in order of severity.
        engines: Results of loading the file in simulators.
        undone: What was not checked, in words.
        motion: How the motion was checked: "sampled", "certified", "certified in part" or "none".
        seconds: Time spent.
        certificate: Certificate of the motion, if a proof was requested.
    """

    file: str
    format: str
    name: str = ""
    links: int = 0
    joints: int = 0
    findings: Findings = field(default_factory=Findings)
    engines: tuple[Loading, ...] = ()
    undone: tuple[str, ...] = ()
    motion: str = "none"
    seconds: float = 0.0
    certificate: Certificate | None = None

    @property
    def ok(self) -> bool:
        """True when there is neither an error nor a warning; notes do not count."""
        return all(finding.severity == "info" for finding in self.findings)

    def count(self, severity: str) -> int:
        """Return how many findings have a severity."""
        return sum(finding.severity == severity for finding in self.findings)

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.audit/1`."""
        return {
            "schema": "articad.audit/1",
            "ok": self.ok,
            "file": self.file,
            "format": self.format,
            "name": self.name[:200],
            "links": self.links,
            "joints": self.joints,
            "findings": [finding.to_json() for finding in self.findings],
            "engines": [loading.to_json() for loading in self.engines],
            "motion": self.motion,
            "free": []
            if self.certificate is None
            else [{"joint": r.joint, "free": [r.lower, r.upper], "declared": list(r.declared)} for r in self.certificate.ranges],
            "not_checked": list(self.undone),
            "seconds": round(self.seconds, 3),
        }


@dataclass(frozen=True)
class Scoreboard:
    """Audits of many files, side by side."""

    folder: str
    audits: tuple[Audit, ...]

    @property
    def ok(self) -> bool:
        """True if every file is."""
        return all(audit.ok for audit in self.audits)

    @property
    def codes(self) -> list[tuple[str, int, int]]:
        """Each code with the number of its findings and of the files that have it, the most frequent first."""
        findings = Counter(finding.code for audit in self.audits for finding in audit.findings)
        files = Counter(code for audit in self.audits for code in set(audit.findings.codes))
        return [(code, count, files[code]) for code, count in sorted(findings.items(), key=lambda item: (-files[item[0]], item[0]))]

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.scoreboard/1`."""
        return {
            "schema": "articad.scoreboard/1",
            "ok": self.ok,
            "folder": self.folder,
            "codes": [{"code": code, "findings": count, "files": files} for code, count, files in self.codes],
            "files": [audit.to_json() for audit in self.audits],
            "findings": [],
        }
