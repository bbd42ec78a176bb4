"""The sections beside the model: tables of parts, checks, proofs, fits, exports, and the conversation with models."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from urllib.parse import quote

from articad.aliases import Json
from articad.assembly import Assembly
from articad.disassembly.steps import AssemblyOrder, words_of
from articad.findings import measured_against
from articad.interference.statements import statements
from articad.report.tables import Cell, Html, html_table

_LONGEST_TEXT = 20_000  # characters of one message: a page is read, and the run keeps the rest
_SEVERITY = {"error": "bad", "warning": "warn", "info": "quiet"}
_VERDICT = {"clear": "good", "contact": "good", "overlap": "bad", "unknown": "warn"}


@dataclass(frozen=True)
class Documents:
    """The documents about an assembly, as the reports of a run; each may be omitted.

    Attributes:
        prompt: The request.
        checks: Report `articad.checks/1`.
        certificate: Report `articad.certificate/2`.
        verdict: Report `articad.verdict/1`.
        audit: Report `articad.audit/1`.
        order: Report `articad.order/1`.
        exports: Reports `articad.losses/1` by format.
        replies: Records `articad.llm/1`, in reading order.
        plan: The plan's text.
        files: Paths beside the page, to be linked.
        repeated: Whether the reports are read from the files of a run that anybody may have written, and nothing was checked for the page.
    """

    prompt: str = ""
    checks: Json | None = None
    certificate: Json | None = None
    verdict: Json | None = None
    audit: Json | None = None
    order: Json | None = None
    exports: Mapping[str, Json] = field(default_factory=dict)
    replies: Sequence[Json] = ()
    plan: str | None = None
    files: Sequence[str] = ()
    repeated: bool = False

    @property
    def is_repeating(self) -> bool:
        """Whether any statement of the page is only repeated from somebody's files."""
        return self.repeated and any(report is not None for report in (self.checks, self.certificate, self.verdict))

    @property
    def findings(self) -> list[Json]:
        """Findings of all reports, errors first, each once."""
        reports = [self.checks, self.certificate, self.verdict, self.audit, self.order, *self.exports.values()]
        found = {json.dumps(finding, sort_keys=True): finding for report in reports if report for finding in report.get("findings", ())}
        return sorted(found.values(), key=lambda finding: "EWI".find(finding["code"][0]))


def all_sections(assembly: Assembly, documents: Documents) -> str:
    """Return all sections with content."""
    known = set(assembly.parts)
    findings = [*documents.findings, *(finding.to_json() for finding in assembly.findings)]
    return "".join(
        [
            f'<p class="quiet">{escape(provenance(documents))}</p>' if documents.is_repeating else "",
            _section("What was asked for", f"<p>{escape(documents.prompt)}</p>" if documents.prompt else ""),
            _section(f"Findings ({len(findings)})", _findings(findings, known), opened=bool(findings)),
            _section("Audit", _audit(documents.audit), opened=True),
            _section("Parts", _parts(assembly), opened=True),
            _section("Joints", _joints(assembly)),
            _section("Order of assembly", _steps(documents.order), opened=True),
            _section("Interference", _pairs(documents.checks, known)),
            _section("Proven motion", _certificate(documents.certificate, known)),
            _section("Least clearances over the motion", _clearances(documents.certificate, known)),
            _section("Joints that follow the drivers", _follows(documents.certificate, known)),
            _section("Fits", _fits(assembly, documents.checks, known)),
            _section("Exports and what they cannot hold", _exports(documents.exports)),
            _section("Conversation with the model", _conversation(documents.replies)),
            _section("Files", _files(documents)),
        ]
    )


def provenance(documents: Documents) -> str:
    """Return the sentence that says of a page that it repeats what a run states, and how to check that; empty if it repeats nothing."""
    if not documents.is_repeating:
        return ""
    check = "articad check RUN" + (" and articad verify-certificate RUN" if documents.certificate is not None else "")
    return f"Checks, proofs and verdicts are repeated from the files of the run, whoever wrote them; none was checked for this page. To check them: {check}."


def badges(documents: Documents, *, moves: bool = True) -> str:
    """Return what is proven, sampled or not checked, in a few words each; `moves`: whether any joint can move."""
    told = [("repeated, not checked now", "quiet", provenance(documents))] if documents.is_repeating else []
    told += [(each.badge, each.state, each.sentence) for each in statements(documents.checks, documents.certificate, moves=moves)]
    for report, good, bad in (
        (documents.verdict, "accepted", "not accepted"),
        (documents.audit, "audit passed", "audit failed"),
    ):
        if report is not None:
            told.append((good, "good", "") if report["ok"] else (bad, "bad", ""))
    errors = sum(finding["severity"] == "error" for finding in documents.findings)
    if errors:
        told.append((f"{errors} error{'' if errors == 1 else 's'}", "bad", "See the findings."))
    return "".join(
        f'<span class="badge {state}" title="{escape(sentence or badge)}">{escape(badge)}</span>' for badge, state, sentence in told
    )


def summary(assembly: Assembly, documents: Documents) -> str:
    """Return what is known in a few sentences, for those who do not see the picture."""
    told = [each.sentence for each in statements(documents.checks, documents.certificate, moves=bool(assembly.drivers))]
    moves = ", ".join(
        f"{driver.name} ({_bounds(driver.lower, driver.upper, driver.unit)})" for driver in assembly.drivers if driver.unit != "1"
    )
    findings = Counter(finding["severity"] for finding in documents.findings)
    listed = ", ".join(f"{count} {kind}{'' if count == 1 else 's'}" for kind, count in findings.items())
    return " ".join(
        [
            f"{assembly.name} has {len(assembly.parts)} parts. What moves: {moves or 'nothing'}.",
            *told,
            *filter(None, [provenance(documents)]),
            f"Findings: {listed or 'none'}.",
        ]
    )


def facts_about(part: str, documents: Documents) -> list[list[str]]:
    """Return what the reports say about one part, as pairs of a heading and a sentence."""
    facts = []
    for heading, report in (("at rest", documents.checks), ("motion", documents.certificate)):
        if report is None:
            continue
        own = [pair for pair in report["pairs"] if part in pair["parts"]]
        if heading == "at rest":
            own = [pair for pair in own if pair["over"] == "rest"]
            count = Counter(pair["verdict"] for pair in own)
            words = ", ".join(f"{number} {verdict}" for verdict, number in count.items())
            facts.append([heading, f"{_pairs_counted(len(own))} checked: {words}" if own else "no other part is near"])
        else:
            proven = sum(pair["strength"]["kind"] == "certified" for pair in own)
            facts.append([heading, f"{proven} of {_pairs_counted(len(own))} certified" if own else "no other part comes near"])
    if documents.certificate is None:
        facts.append(["motion", "not certified"])
    concerned = sum(part in (finding.get("parts") or ()) for finding in documents.findings)
    if concerned:
        facts.append(["findings", str(concerned)])
    return facts


def _pairs_counted(count: int) -> str:
    return f"{count} pair{'' if count == 1 else 's'}"


def _section(title: str, content: str, *, opened: bool = False) -> str:
    if not content:
        return ""
    return f'<details class="section"{" open" if opened else ""}><summary><h2>{escape(title)}</h2></summary>\n{content}</details>\n'


def _show(text: str, parts: Sequence[str], pose: Mapping[str, float] | None, known: set[str]) -> Html:
    """Return a button that moves the model to a pose and fades all other parts."""
    target = {"pose": dict(pose) if pose else None, "parts": [part for part in parts if part in known], "text": text}
    return Html(f'<button type="button" data-show="{escape(json.dumps(target, ensure_ascii=False))}">Show</button>')


def _findings(findings: Sequence[Json], known: set[str]) -> str:
    if not findings:
        return '<p class="quiet">No findings.</p>'
    rows: list[list[Cell]] = []
    same = Counter((finding["code"], finding["message"]) for finding in findings)
    for finding in {(entry["code"], entry["message"]): entry for entry in reversed(findings)}.values():
        numbers = measured_against(finding)
        times = same[finding["code"], finding["message"]]
        cause = finding.get("cause") or ""
        told = [cause if " " in cause else "", finding.get("hint")]  # one word is for programs
        hint = "".join(f'<br><span class="hint">{escape(words)}</span>' for words in told if words)
        parts, pose = finding.get("parts") or [], finding.get("pose")
        rows.append(
            [
                Html(f'<span class="{_SEVERITY[finding["severity"]]}">{escape(finding["code"])}</span>'),
                Html(f"{escape(finding['message'] + numbers)}{f' <b>{times} times</b>' if times > 1 else ''}{hint}"),
                _show(finding["code"], parts, pose, known) if pose or known.intersection(parts) else None,
            ]
        )
    return _scroll(html_table(["code", "what", ""], rows[::-1]), "scroll findings")


def _audit(audit: Json | None) -> str:
    """Return which engines load the file, how its motion was examined, and what was not looked at."""
    if audit is None:
        return ""
    words = {True: "loads", False: "does not load", None: "was not asked"}
    engines = [[loading["engine"], words[loading["loads"]]] for loading in audit["engines"]]
    undone = "".join(f"<li>{escape(line)}</li>" for line in audit["not_checked"])
    return (
        f"<p>{escape(audit['file'])}: {audit['links']} links, {audit['joints']} joints that move; motion {escape(audit['motion'])}.</p>"
        + _scroll(html_table(["engine", "the file"], engines))
        + (f"<h3>Not looked at</h3><ul>{undone}</ul>" if undone else "")
    )


def _steps(order: Json | None) -> str:
    """Return the steps of an order of assembly, each with a button that plays it."""
    if order is None:
        return ""
    rows: list[list[Cell]] = []
    for index, step in enumerate(AssemblyOrder.from_json(order).steps):
        told = [words_of(step), *(f"{name}: {how}." for name, how in step.fastened.items())]
        if step.assembly != order["name"]:
            told.insert(0, f"{step.assembly}:")
        strength = Html(f'<span class="{"good" if step.strength == "proven" else "warn"}">{step.strength}</span>') if step.moves else None
        button = Html(f'<button type="button" data-step="{index}" aria-label="Play step {step.number}">▶</button>')
        rows.append([str(step.number), " ".join(told), strength, button])
    return (
        '<p><button type="button" id="all-steps">▶ Play all steps</button></p>'
        + _scroll(html_table(["step", "what", "path", ""], rows, numbers=(0,)))
        + f'<p class="quiet">{escape(order["not_checked"])}</p>'
    )


def _parts(assembly: Assembly) -> str:
    depth = {assembly.ground: 0}
    for edge in assembly.mechanism.tree.edges:
        depth[edge.part] = depth[edge.parent] + 1
    order = [assembly.ground, *(edge.part for edge in assembly.mechanism.tree.edges)]
    index = {name: number for number, name in enumerate(assembly.mechanism.parts)}
    rows: list[list[Cell]] = []
    for name in order:
        part, number = assembly.parts[name], index[name]
        indent = "\N{NO-BREAK SPACE}" * (3 * depth[name])
        rows.append(
            [
                Html(f'<input type="checkbox" class="eye" checked data-visible="{number}" aria-label="show {escape(name)}">'),
                Html(
                    f'<span class="part">{indent}<svg class="swatch" viewBox="0 0 1 1" aria-hidden="true"><rect width="1" height="1" '
                    f'fill="{escape(part.color)}"/></svg><button type="button" class="plain" data-part="{number}">{escape(name)}</button></span>'
                ),
                part.material,
                None if part.mass is None else f"{part.mass.mass:.4g}",
                None if part.solid is None else f"{part.solid.volume:,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}"),
                Html(f'<button type="button" class="plain" data-stl="{number}" aria-label="save {escape(name)} as STL">STL</button>'),
            ]
        )
    note = (
        f'<p class="quiet">Total: {total_mass(assembly)}. Click a name to select the part; indented parts are attached to those above.</p>'
    )
    return _scroll(html_table(["", "part", "material", "mass kg", "volume mm³", ""], rows, numbers=(3, 4))) + note


def total_mass(assembly: Assembly) -> str:
    """Return the mass of all parts, and the number of parts with unknown mass."""
    known = [part.mass.mass for part in assembly.parts.values() if part.mass is not None]
    if not known:
        return "mass unknown"
    unknown = len(assembly.parts) - len(known)
    return f"{sum(known):.4g} kg" + (f" without {unknown} of unknown mass" if unknown else "")


def _joints(assembly: Assembly) -> str:
    rows = []
    for joint in assembly.joints:
        limits = "; ".join(_bounds(column.lower, column.upper, column.unit) for column in joint.columns if column.unit != "1")
        if joint.limits.cone is not None:
            limits = f"cone {math.degrees(joint.limits.cone):.6g}°"
        rows.append([joint.name, str(joint.type), joint.parent, joint.child, limits])
    return _scroll(html_table(["joint", "type", "parent", "child", "range"], rows))


def _bounds(lower: float, upper: float, unit: str) -> str:
    if math.isinf(lower) and math.isinf(upper):
        return "endless"
    factor, sign = (180 / math.pi, "°") if unit == "rad" else (1.0, " mm")
    return f"{lower * factor:.6g} … {upper * factor:.6g}{sign}"


def _pairs(checks: Json | None, known: set[str]) -> str:
    if checks is None:
        return ""
    rows = [_pair(pair, known) for pair in checks["pairs"]]
    return _scroll(html_table(_PAIR_COLUMNS, rows, numbers=(3, 4))) or '<p class="quiet">No two parts come near each other.</p>'


_PAIR_COLUMNS = ("parts", "over", "verdict", "depth mm", "gap mm", "")


def _pair(pair: Json, known: set[str]) -> list[Cell]:
    over = pair["over"] if isinstance(pair["over"], str) else ", ".join(pair["over"])
    strength = pair["strength"]
    known_by = {
        "certified": "proven",
        "sampled": "one pose sampled" if strength.get("poses") == 1 else f"{strength.get('poses')} poses sampled",
        "waived": f"allowed: {strength.get('reason')}",
        "not_checked": f"not checked: {strength.get('reason')}",
    }[strength["kind"]]
    return [
        " – ".join(pair["parts"]),
        over,
        Html(f'<span class="{_VERDICT[pair["verdict"]]}">{escape(pair["verdict"])}</span>, {escape(known_by)}'),
        pair["depth_mm"],
        pair["gap_mm"],
        _show(" – ".join(pair["parts"]) + ".", pair["parts"], pair.get("pose"), known),
    ]


def _certificate(certificate: Json | None, known: set[str]) -> str:
    if certificate is None:
        return ""
    lengths = _lengths(certificate)
    ranges = [
        [r["joint"], *(" … ".join(_quantity(r["joint"], end, lengths) for end in r[key]) for key in ("free", "declared"))]
        for r in certificate.get("ranges", ())
    ]
    covers = certificate.get("covers", "")
    told = f"<p>{escape(covers[:1].upper() + covers[1:])}</p>" if covers else ""
    told += f'<p class="quiet">Distances up to {certificate["epsilon_mm"]:g} mm count as contact.</p>'
    return (
        told
        + _scroll(html_table(["joint", "proven free", "declared"], ranges))
        + _scroll(html_table(_PAIR_COLUMNS, [_pair(pair, known) for pair in certificate["pairs"]], numbers=(3, 4)))
    )


def _clearances(certificate: Json | None, known: set[str]) -> str:
    """Return the table of least clearances over the motion, the nearest first."""
    if not certificate or not certificate.get("clearances"):
        return ""
    lengths = _lengths(certificate)
    rows: list[list[Cell]] = []
    for row in sorted(certificate["clearances"], key=lambda row: float(row["gap_mm"])):
        at = ", ".join(f"{name} = {_quantity(name, value, lengths)}" for name, value in row["pose"].items()) or "rest"
        joined = "joined" if row["relation"] == "mating" else ""
        shown = _show(f"Least clearance of {' and '.join(row['parts'])}.", row["parts"], row["pose"], known)
        rows.append([" – ".join(row["parts"]), joined, f"{row['gap_mm']:.4g}", at, row["strength"].get("poses"), shown])
    told = (
        '<p class="quiet">The smallest distance found between every two parts over the motion, the nearest pairs first. '
        "It is sampled: the true minimum may be smaller. “Proven motion” shows what is proven.</p>"
    )
    return told + _scroll(html_table(["parts", "", "gap mm", "at", "poses sampled", ""], rows, numbers=(2, 4)))


def _follows(certificate: Json | None, known: set[str]) -> str:
    """Return a table for each driver: its values, and those of its followers."""
    found = []
    for table in (certificate or {}).get("follows", ()):
        followers, units = table["followers"], table["units"]
        names = [table["driver"], *followers]
        columns = [*(f"{name} {'°' if units[name] == 'rad' else 'mm'}" for name in names), ""]
        rows: list[list[Cell]] = []
        for at, value in enumerate(table["values"]):
            numbers = [value, *(values[at] for values in followers.values())]
            shown = _show(f"{table['driver']}.", (), {table["driver"]: value}, known)
            rows.append([*(_plain(number, units[name]) for number, name in zip(numbers, names, strict=True)), shown])
        found.append(_scroll(html_table(columns, rows, numbers=range(len(names)))))
    told = '<p class="quiet">The followers of each driver while the other drivers are at rest.</p>'
    return told + "".join(found) if found else ""


def _lengths(certificate: Json) -> set[str]:
    """Return the names of the coordinates that are lengths; all others are angles."""
    joints = certificate.get("mechanism", {}).get("joints", ())
    return {freedom["name"] for joint in joints for freedom in joint["freedoms"] if not any(freedom["turn"])}


def _quantity(name: str, value: float, lengths: set[str]) -> str:
    return f"{_plain(value, 'mm')} mm" if name in lengths else f"{_plain(value, 'rad')}°"


def _plain(value: float, unit: str) -> str:
    """Return a value in degrees or mm, to a hundredth and no further."""
    return f"{(math.degrees(value) if unit == 'rad' else value) + 0.0:.2f}".replace("-0.00", "0.00")


def _fits(assembly: Assembly, checks: Json | None, known: set[str]) -> str:
    gaps = {frozenset(pair["parts"]): pair["gap_mm"] for pair in (checks or {}).get("pairs", ()) if pair["over"] == "rest"}
    measured = {row["joint"]: row for row in (checks or {}).get("fits", ())}
    rows: list[list[Cell]] = []
    for joint in assembly.joints:
        fit = assembly.fits.get(joint.name)
        if fit is None:
            continue
        row = measured.get(joint.name, {})
        wanted = f"{'' if fit.gap_min is None else f'{fit.gap_min:.6g}'} … {'' if fit.gap_max is None else f'{fit.gap_max:.6g}'}"
        rows.append(
            [
                joint.name,
                f"{joint.parent} – {joint.child}",
                " ".join(filter(None, [fit.name, wanted if wanted != " … " else "" if fit.name else "not declared"])),
                row.get("least_mm", gaps.get(frozenset({joint.parent, joint.child}))),
                row.get("play_mm"),
                fit.contact,
                row.get("verdict", "not measured"),
                _show(joint.name + ".", [joint.parent, joint.child], None, known),
            ]
        )
    return _scroll(
        html_table(["joint", "between", "gap declared mm", "least gap mm", "play mm", "contact", "verdict", ""], rows, numbers=(3, 4))
    )


def _exports(exports: Mapping[str, Json]) -> str:
    rows: list[list[Cell]] = []
    for name, report in sorted(exports.items()):
        main = _link(report["main"]) if "main" in report else Html("")
        if not report["rows"]:
            rows.append([name, main, Html('<span class="good">nothing is lost</span>'), None])
        rows += [[name, main, f"{row['where']}: written as {row['kept']}", f"lost: {row['lost']}"] for row in report["rows"]]
    return _scroll(html_table(["format", "file", "what", ""], rows))


def _conversation(replies: Sequence[Json]) -> str:
    if not replies:
        return ""
    tokens = [0, 0]
    costs: list[float | None] = []
    talks = []
    for record in replies:
        reply = record["reply"]
        usage = reply.get("usage") or {}
        tokens[0] += usage.get("input_tokens") or 0
        tokens[1] += usage.get("output_tokens") or 0
        costs.append(reply.get("cost"))
        head = f"{escape(record['step'])} <span class='quiet'>{escape(str(reply.get('model', '')))}, {_price(reply.get('cost'))}</span>"
        said = "".join(
            f'<details class="talk"><summary>{escape(message["role"])}</summary><pre>{escape(_cut(_text_of(message)))}</pre></details>'
            for message in record["messages"]
        )
        answer = f"<pre>{escape(_cut(str(reply.get('text', ''))))}</pre>"
        talks.append(f'<details class="talk"><summary>{head}</summary>{said}{answer}</details>')
    cost = "cost not known" if any(one is None for one in costs) else f"${sum(one or 0.0 for one in costs):.4f}"
    return f'<p class="quiet">{len(replies)} answers, {tokens[0]} tokens in, {tokens[1]} out, {cost}.</p>' + "".join(talks)


def _price(cost: float | None) -> str:
    return "cost not known" if cost is None else f"${cost:.4f}"


def _text_of(message: Json) -> str:
    content = message["content"]
    if isinstance(content, str):
        return content
    return "\n\n".join(str(part.get("text") or f"[{part.get('type', 'picture')}]") for part in content)


def _cut(text: str) -> str:
    if len(text) <= _LONGEST_TEXT:
        return text
    return text[:_LONGEST_TEXT] + f"\n… {len(text) - _LONGEST_TEXT} more characters are in the run's folder llm/."


def _files(documents: Documents) -> str:
    buttons = [("save-pose", "this pose"), ("save-stl", "STL of this pose")]
    if documents.plan is not None:
        buttons.append(("save-plan", "plan.json"))
    made = "".join(f'<button type="button" id="{key}">{escape(label)}</button>' for key, label in buttons)
    beside = "".join(f"<li>{_link(path).text}</li>" for path in documents.files)
    listed = f'<p class="quiet">In the folder of this page:</p><ul class="files">{beside}</ul>' if beside else ""
    return f'<div class="tools-row">Save {made}</div>{listed}'


def _link(path: str) -> Html:
    """Return a link to a file in the page's folder; a path cannot become another kind of address."""
    return Html(f'<a href="{escape("./" + quote(path))}">{escape(path)}</a>')


def _scroll(table: str, kind: str = "scroll") -> str:
    return f'<div class="{kind}" tabindex="0" role="group">{table}</div>' if table else ""
