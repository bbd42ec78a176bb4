"""Prove motion free of collisions; check such a proof without trusting it."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command
from articad.commands.options import amount, names
from articad.files import is_file, read_file

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal
    from articad.plan.iso2768 import ToleranceClass

CERTIFICATE = "certificate.json"


@command(
    "certify",
    "Prove that the parts of a run do not collide while its joints move over their whole ranges, one or two at a time.",
    argument("run", metavar="RUN"),
    argument("--joints", metavar="A,B", type=names, default=None, help="joints to prove (all that move)"),
    argument("--pairs", action=argparse.BooleanOptionalAction, default=True, help="move joints two at a time as well (yes)"),
    argument(
        "--budget",
        metavar="SECONDS",
        type=amount,
        default=600.0,
        help="nominal seconds of work, the same work on every machine; pairs not proven within it count as not checked, which is not ok (600)",
    ),
    argument("--epsilon", metavar="MM", type=amount, default=0.001, help="distances up to this count as contact (0.001)"),
    argument(
        "--within-tolerance",
        action="store_true",
        help="prove it for all parts whose surfaces lie anywhere within their general tolerance and declared fits",
    ),
    argument(
        "--tolerance-class",
        choices=("f", "m", "c", "v"),
        default=None,
        help="class of the general tolerance of ISO 2768-1, and the same as --within-tolerance (m)",
    ),
)
def _certify(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries
    from articad.runs.record import assembly_of, record_certificate
    from articad.runs.run import Run

    with Run.open(options.run) as run:
        with terminal.progress("Reading") as tell:
            assembly = assembly_of(run, progress=tell)
        with terminal.progress("Proving"):
            tolerance: ToleranceClass | None = options.tolerance_class or ("m" if options.within_tolerance else None)
            certificate = assembly.certify(
                options.joints, pairs=options.pairs, budget=options.budget, epsilon=options.epsilon, tolerance=tolerance
            )
        report = record_certificate(run, certificate)
        summaries.print_certificate(report, terminal)
        terminal.say(f"Certificate: {run.path / 'certificate.json'}, {len(certificate.claims)} claims")
    return report


@command(
    "verify-certificate",
    "Check a certificate without trusting whoever wrote it.",
    argument("file", metavar="FILE", help="certificate.json, or the folder of a run that has one"),
    argument("--meshes", metavar="DIR", help="its meshes, <part>.npz (the folder certificate/ beside it)"),
)
def _verify_certificate(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.certificates.verifier import verify_file
    from articad.certificates.verifier_files import TEXT, UNREAD
    from articad.errors import ReadError

    named = Path(options.file)
    file = named / CERTIFICATE if named.is_dir() else named
    if not is_file(file, root=named if named.is_dir() else None):
        message = f"The folder {named} has no {CERTIFICATE}." if named.is_dir() else f"There is no file {file}."
        hint = (
            f"Write it: articad certify {named}."
            if named.is_dir()
            else "Name a run, or the certificate.json that `articad certify RUN` wrote into it."
        )
        raise ReadError.at(str(file), message, hint, said=message)
    with terminal.progress("Checking"):
        meshes = Path(options.meshes) if options.meshes else file.parent / "certificate"
        faults = verify_file(file, meshes)
    stated: list[str] = []
    if not faults:
        certificate = json.loads(read_file(file, TEXT))
        faults, product = _compared(named, certificate, meshes)
        stated = [] if faults else [*_stated(certificate), product]
    is_unread = any(fault.startswith(UNREAD) for fault in faults)
    advice = ["Prove some joints at a time: articad certify RUN --joints A,B"] if is_unread else []
    for line in [*faults, *stated, *advice]:
        terminal.say(f"  {line}")
    verdict = "accepted" if not faults else "not checked" if is_unread else "refuted"
    terminal.say(f"{file}: {verdict}.")
    return {"schema": "articad.verification/1", "ok": not faults, "file": str(file), "faults": faults, "stated": stated, "findings": []}


def _compared(named: Path, certificate: Report, meshes: Path) -> tuple[list[str], str]:
    """Return how a certificate is about another product than the run beside it, and what an accepted one was compared with."""
    from articad.runs.record import departures
    from articad.runs.run import REQUEST_FILE, Run

    run = Run.view(named) if named.is_dir() and (named / REQUEST_FILE).exists() else None
    if run is None or run.plan_text() is None:
        return [], "It was compared with no product: to hold it against the parts and joints of a run, name the run's folder."
    return departures(run, certificate, meshes), "Its parts and joints are those that the run records."


def _stated(certificate: Report) -> list[str]:
    """Return what an accepted certificate covers: its author chose that, and no proof shows whether it is enough."""
    from articad.certificates.covers import covered

    moving = [joint["name"] for joint in certificate["mechanism"]["joints"] if joint["freedoms"]]
    still = [name for name in moving if name not in certificate["asked"]]
    sentence = covered(certificate)
    refused = "The certificate is not ok: its claims hold, but something that was requested is not proven."
    lines = [sentence[0].upper() + sentence[1:] if certificate["ok"] else refused]
    if still:
        lines.append(f"These joints were not requested: {', '.join(still)}.")
    waived = {"/".join(pair["parts"]): pair["strength"] for pair in certificate["pairs"] if pair["strength"]["kind"] == "waived"}
    lines += [f"Waived, so not checked: {parts} ({how.get('reason') or 'no reason given'})." for parts, how in waived.items()]
    return lines
