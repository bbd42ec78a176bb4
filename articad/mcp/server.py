"""The server: tools over one folder of designs. Agents read the docstring of each tool, so it is short."""

from __future__ import annotations

import asyncio
import inspect
import json
import shutil
from collections import defaultdict
from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from mcp.server.apps import APP_MIME_TYPE, Apps
from mcp.server.mcpserver import Context, Image, MCPServer
from mcp.server.mcpserver.exceptions import ResourceError, ToolError
from pydantic import Field

from articad import __version__
from articad.aliases import Json
from articad.errors import ArticadError, ReadError, did_you_mean
from articad.files import is_file
from articad.findings.codes import CODES
from articad.mcp import answers
from articad.mcp.skill import page, section
from articad.mcp.wire import ArticadServer
from articad.mcp.workbench import BRIEF_BYTES, Tell, Workbench, condensed, gathered
from articad.plan.amending import amended
from articad.processes import scratch
from articad.runs.run import REQUEST_FILE, require_idle, write_atomically

Tool = Callable[..., Awaitable[Any]]
Dialect = Literal["build123d", "freecad"]
Kernel = Annotated[Dialect | None, Field(description="the plan's by default")]
Paper = Literal["manual", "bom", "drawing"]
Format = Literal["urdf", "mjcf", "freecad", "step", "glb", "3mf", "sdf", "usd"]

_BUILD_S: Final = 600.0
_COMPLETE_S: Final = 2400.0
_PART_S: Final = 180.0
_MORE_PARTS_S: Final = 30.0  # for each part beside the first
_LOOK_S: Final = 300.0
_GRACE_S: Final = 60.0  # beyond a certificate's own budget: for reading, and for the claim in progress
_PICTURES: Final = 4  # of one answer
_PIXELS: Final = 320  # a host charges for the area: a third of 512 x 512, and joints can still be told apart

_CHARACTERS: Final = 100_000  # of an argument that is neither a plan nor a script; the system passes no word of 128 KiB to a command
_INTENT: Final = 1_000  # characters that are looked up in the documentation

_SHOWING: Final = "render"  # the tool beside whose pictures a host that knows MCP Apps shows the design's page
_SHELL: Final = "ui://articad/page.html"
_PAGES: Final = "ui://articad/designs/{design}"
_SHELL_FILE: Final = Path(__file__).with_name("page.html")

Design = Annotated[str, Field(description="name of a design: a folder under the root")]
Detail = Annotated[bool, Field(description="the whole report, up to 60 kB")]


class Tools:
    """The tools of an agent: each public method is one, and its docstring is the description that the agent reads.

    Args:
        root: The folder of designs; made if it is not there.
    """

    def __init__(self, root: str | Path) -> None:
        self.bench = Workbench(root)
        self._known: dict[str, list[Json]] = {}  # design -> findings of its plan when it was checked last
        self._plans: dict[str, bytes] = {}  # design -> the plan that was checked then
        self._turns: defaultdict[str, asyncio.Lock] = defaultdict(asyncio.Lock)  # design -> whose turn it is to change its plan or its run

    async def schema(
        self,
        topic: Annotated[
            str,
            Field(
                description='a type: "plan", "part", "connector", "joint", "revolute", "coupling", "derive", "fit", ...; or a page: "short", "script", "copies", "rest"'
            ),
        ],
    ) -> str:
        """Fields of the plan's types, or a page on part scripts, copies, couplings, rest poses, room or findings."""
        return page(
            "script_freecad" if topic == "part_script_freecad" else topic.removeprefix("part_") if topic == "part_script" else topic
        )

    async def check_plan(
        self,
        design: Design,
        plan: Annotated[dict[str, Any] | None, Field(description="the whole plan; without it, the plan.json that is there")] = None,
        script: Annotated[str | None, Field(description="parts.py, a function for each part")] = None,
        detail: Detail = False,
    ) -> Json:
        """Save a plan and report everything that is wrong with it, before any geometry exists."""
        async with self._turns[design]:
            if plan is not None:
                self.bench.write_plan(design, plan)
            if script is not None:
                self.bench.write_common_script(design, script)
            report = await self._checked(design)
        return condensed(report, detail=True) if detail else answers.verdict(report)

    async def edit_plan(
        self,
        design: Design,
        changes: Annotated[
            dict[str, Any],
            Field(description='new values by address, {"joints.lid.angle_deg": [0, 90]}; null removes, a new name adds'),
        ],
    ) -> Json:
        """Change a plan at the addresses that findings name, check it, and return only findings that are new."""
        async with self._turns[design]:
            before = self._known.get(design) if self._current(design) else None
            if before is None:
                before = gathered(await self._checked(design))
            self.bench.amend_plan(design, changes)
            return answers.changed(before, await self._checked(design))

    async def build_part(
        self, context: Context, design: Design, part: str, script: str | None = None, kernel: Kernel = None, detail: Detail = False
    ) -> Json:
        """Save a part's script, build it, and check it against its contract."""
        folder = self.bench.design(design)
        if script is not None:
            self.bench.write_script(design, part, script, kernel)
        words = [str(folder), self.bench.part(part)]
        report = await self.bench.run("part", *_with(kernel), on=words, seconds=_PART_S, tell=_teller(context))
        return condensed(answers.tidied(report), detail=detail, keep=("volume_mm3", "mass_kg", "bbox_mm"))

    async def build_parts(
        self,
        context: Context,
        design: Design,
        files: Annotated[
            dict[str, str] | None,
            Field(
                description='scripts in files under the root, by part: {"crank,rocker": "bar.py"}; without it, all scripts of the design'
            ),
        ] = None,
        kernel: Kernel = None,
        detail: Detail = False,
    ) -> Json:
        """Build several parts, or all, in parallel, and check them against their contracts."""
        folder = self.bench.design(design)
        names: list[str] = []
        for parts, file in (files or {}).items():
            script = self.bench.read(file).decode(errors="replace")
            for name in (part.strip() for part in parts.split(",")):
                self.bench.write_script(design, name, script, kernel)
                names.append(name)
        seconds = _PART_S + _MORE_PARTS_S * len(names or self.bench.parts(design))
        report = await self.bench.run("part", *_with(kernel), on=[str(folder), *names], seconds=seconds, tell=_teller(context))
        return condensed(report if detail else report | {"parts": answers.solids(report)}, detail=detail, keep=("parts",))

    async def build(
        self,
        context: Context,
        design: Design,
        kernel: Kernel = None,
        complete: Annotated[bool, Field(description="also certify, have the proof checked, and write every format")] = False,
        detail: Detail = False,
    ) -> Json:
        """Build all parts, assemble them, check interference at rest, write URDF and MJCF."""
        folder = self.bench.design(design)
        async with self._turns[design]:
            report = await self._built(context, folder, kernel, complete=complete)
        if "certificate" in report and not detail:
            report |= {"proven": report["certificate"]["covers"], "accepted": report["verification"]["ok"]}
        keep = ("freedoms", "mass_kg", "drivers", "deepest_overlap_mm", "files", "proven", "accepted")
        return condensed(report, detail=detail, keep=keep)

    async def check(self, context: Context, design: Design, detail: Detail = False) -> Json:
        """Check interference at rest again, pair by pair."""
        report = await self.bench.run("check", on=[str(self.bench.target(design))], seconds=_BUILD_S, tell=_teller(context))
        return condensed(report, detail=detail)

    async def certify(
        self,
        context: Context,
        design: Design,
        joints: Sequence[str] = (),
        pairs: bool = True,
        budget_s: Annotated[float, Field(gt=0, le=3600)] = 120.0,
        within_tolerance: Annotated[bool, Field(description="for all parts within ISO 2768-m and their fits")] = False,
        detail: Detail = False,
    ) -> Json:
        """Prove that no parts meet over the whole range of each joint, and of pairs of joints. What is not proven in time is not ok."""
        words = [f"--joints={','.join(joints)}"] if joints else []
        words += ["--pairs" if pairs else "--no-pairs", f"--budget={budget_s!r}"]
        words += ["--within-tolerance"] if within_tolerance else []
        run = str(self.bench.target(design))
        report = await self.bench.run("certify", *words, on=[run], seconds=budget_s + _GRACE_S, tell=_teller(context))
        return condensed(report if detail else report | {"proven": answers.proof(report)}, detail=detail, keep=("proven",))

    async def verify_certificate(self, context: Context, design: Design, detail: Detail = False) -> Json:
        """Have an independent checker read the certificate of a design, and say what it covers and what it leaves out."""
        run = self.bench.target(design)
        report = await self.bench.run("verify-certificate", on=[str(run)], seconds=_BUILD_S, tell=_teller(context))
        return condensed(report, detail=detail, keep=("faults", "stated"))

    async def adopt(
        self,
        context: Context,
        source: Annotated[str, Field(description="a URDF, MJCF, SDF, FCStd or STEP file under the root")],
        design: Annotated[str, Field(description="name of the new design")],
        detail: Detail = False,
    ) -> Json:
        """Turn a file into a new design: a plan, part scripts and meshes, which build at once."""
        folder = self.bench.design(design, new=True)
        place = str(self.bench.target(source))
        report = await self.bench.run("adopt", f"--out={folder}", on=[place], seconds=_BUILD_S, tell=_teller(context))
        return condensed(report, detail=detail, keep=("parts", "joints", "freedoms"))

    async def audit(
        self,
        context: Context,
        design: Annotated[str, Field(description="a design, or a URDF, MJCF or FCStd file under the root")],
        detail: Detail = False,
    ) -> Json:
        """Say what is wrong with a file, whoever made it: structure, units, inertias, collision, overlap, motion, engines."""
        report = await self.bench.run("audit", on=[str(self.bench.target(design))], seconds=_BUILD_S, tell=_teller(context))
        return condensed(
            report if detail else report | {"engines": answers.engines(report)}, detail=detail, keep=("engines", "links", "joints")
        )

    async def sim(
        self, context: Context, design: Annotated[str, Field(description="a design, or a file under the root")], detail: Detail = False
    ) -> Json:
        """Run it in simulators: does it load, settle, reach the ends of its joints, and keep its energy?"""
        report = await self.bench.run("sim", on=[str(self.bench.target(design))], seconds=_BUILD_S, tell=_teller(context))
        return condensed(report if detail else report | {"engines": answers.trials(report)}, detail=detail, keep=("engines",))

    async def render(
        self,
        context: Context,
        design: Annotated[str, Field(description="a design, or a file under the root")],
        views: Sequence[str] = ("iso",),
        motion: Annotated[str | None, Field(description="a joint: its motion as a filmstrip instead of views")] = None,
        parts: Annotated[Sequence[str], Field(description="shown in full; the others are faded")] = (),
        explode: float = 0.0,
        overlaps: bool = False,
        pixels: Annotated[int, Field(ge=64, le=1024, description="width and height of a picture")] = _PIXELS,
    ) -> list[Any]:
        """Pictures: views (iso, iso_left, iso_back, iso_below, front, back, left, right, top, bottom), or a joint's motion."""
        with scratch.folder("pictures") as folder:
            words = [f"--motion={motion}"] if motion else [f"--views={','.join(views[:_PICTURES])}", f"--explode={explode!r}"]
            words += [
                *([f"--parts={','.join(parts)}"] if parts and not motion else []),
                *(["--overlaps"] if overlaps and not motion else []),
            ]
            place = self.bench.target(design)
            words += [f"--size={pixels}", f"--out={folder}"]
            report = await self.bench.run("render", *words, on=[str(place)], seconds=_LOOK_S, tell=_teller(context))
            files = [Path(file) for file in report.get("files", ()) if file.endswith(".png")][:_PICTURES]
            pictures = [Image(data=file.read_bytes(), format="png") for file in files]
        return pictures or [json.dumps(condensed(report, detail=False))]

    async def export(
        self,
        context: Context,
        design: Design,
        formats: Sequence[Format] = ("urdf", "mjcf", "step"),
        strict: bool = False,
        detail: Detail = False,
    ) -> Json:
        """Write a built design in other formats; says what each cannot hold."""
        words = [f"--to={','.join(formats)}", *(["--strict"] if strict else [])]
        report = await self.bench.run("export", *words, on=[str(self.bench.target(design))], seconds=_BUILD_S, tell=_teller(context))
        exports = {
            name: {"file": self._shown(entry.get("main", "")), "lost": answers.losses(entry.get("rows", ()))}
            for name, entry in report.get("exports", {}).items()
        }
        return condensed(report if detail else report | {"exports": exports}, detail=detail, keep=("exports",))

    async def manual(
        self,
        context: Context,
        design: Design,
        papers: Annotated[Sequence[Paper], Field(description="written into the design's folder papers/")] = ("manual",),
        detail: Detail = False,
    ) -> Json:
        """Find an order in which the parts can be put together, and write papers: assembly manual, parts list, workshop drawings."""
        run = str(self.bench.target(str(self.bench.design(design).relative_to(self.bench.root))))
        out = self.bench.path(f"{design}/papers")
        reports: dict[str, Json] = {
            name: await self.bench.run(name, f"--out={out}", on=[run], seconds=_BUILD_S, tell=_teller(context))
            for name in dict.fromkeys(papers)
        }
        whole: Json = {"ok": all(report.get("ok") for report in reports.values()), **reports}
        files = [self._shown(file) for report in reports.values() for file in report.get("files", ())]
        steps = answers.steps(reports.get("manual", {}).get("order", {}))
        return condensed(whole if detail else whole | {"steps": steps, "files": files}, detail=detail, keep=("steps", "files"))

    async def convert(self, context: Context, source: str, target: str, strict: bool = False, detail: Detail = False) -> Json:
        """Convert a URDF, MJCF or FCStd file under the root into another format; the ending says which."""
        files = [str(self.bench.target(source)), str(self.bench.path(target))]
        report = await self.bench.run("convert", *(["--strict"] if strict else []), on=files, seconds=_BUILD_S, tell=_teller(context))
        return condensed(report, detail=detail, keep=("main", "rows"))

    async def edit_parameters(self, context: Context, design: Design, values: dict[str, float], kernel: Kernel = None) -> Json:
        """Change parameters of the plan, build again, and say which parts changed and which are provably the same."""
        async with self._turns[design]:
            return await self._edited(context, design, values, kernel)

    async def _edited(self, context: Context, design: str, values: Mapping[str, float], kernel: Kernel) -> Json:
        folder = self.bench.design(design)
        kept = self.bench.read(f"{design}/plan.json")
        plan = self.bench.document(design)
        known = [entry["name"] for entry in self.bench.plan(design).get("parameters", ())]
        for name in values:
            if name not in known:
                raise ToolError(f"There is no parameter {name!r}.{did_you_mean(name, known)} There are {', '.join(known) or 'none'}.")
        plan = amended(plan, {f"parameters.{name}": value for name, value in values.items()})
        before, built = self._shapes(design), False
        self._require_run(folder)
        with scratch.set_aside(folder / "run") as replace:
            self.bench.write_plan(design, plan)
            try:
                report = await self._built(context, folder, kernel)
                built = "error" not in report
            finally:  # nothing was built, or the call was cancelled: the design is unchanged
                if not built:
                    write_atomically(folder / "plan.json", kept)
            if not built:
                return condensed(report, detail=False)
            replace()
        after = self._shapes(design)
        changed = sorted(name for name in after if after[name] != before.get(name))
        report |= {"changed": changed, "same": sorted(set(after) - set(changed)), "removed": sorted(set(before) - set(after))}
        return condensed(report, detail=False, keep=("changed", "same", "removed", "freedoms"))

    async def explain(self, code: str) -> str:
        """What a finding's code means and what to do about it."""
        entry = CODES.get(code)
        if entry is None:
            raise ToolError(f"There is no code {code!r}.{did_you_mean(code, CODES)}")
        return f"{code} (stage {entry.stage}, to be fixed in the {entry.route or 'request'}): {entry.meaning} {entry.remedy}"

    async def docs(
        self,
        dialect: Dialect,
        intent: Annotated[str, Field(description='what to do, or names: "fillet, Helix"')],
        limit: int = 5,
        example: bool = False,
    ) -> str:
        """Look up a kernel's functions: exact signatures, and a worked script if asked."""
        from articad.memory.documentation import DocumentationStore  # noqa: PLC0415 - takes a second to load

        store = DocumentationStore(dialect)
        names = [name.strip() for name in intent.split(",")]
        entries = store.named(names, limit) if len(names) > 1 or " " not in intent.strip() else store.find(intent, min(limit, 20))
        found = [f"{entry.signature}\n    {entry.summary.partition('. ')[0].removesuffix('.')}." for entry in entries]
        if example:
            snippet = store.example(intent)
            found.append(f"{snippet.title}\n{snippet.script}")
        return "\n".join(found)[:BRIEF_BYTES]

    async def _checked(self, design: str) -> Json:
        """Check the plan of a design, and remember what was found."""
        folder = self.bench.design(design)
        content = self.bench.read(f"{design}/plan.json")
        report = await self.bench.run("check", on=[str(folder / "plan.json")], seconds=_PART_S)
        self._known[design], self._plans[design] = gathered(report), content
        return report

    def _current(self, design: str) -> bool:
        """Return whether the plan of a design is the one that was checked last."""
        self.bench.design(design)
        return self._plans.get(design) == self.bench.read(f"{design}/plan.json")

    async def _built(self, context: Context, folder: Path, kernel: Kernel, *, complete: bool = False) -> Json:
        out = self._require_run(folder)
        if out.exists():
            shutil.rmtree(out)  # the run is derived from the design
        words = [f"--out={out}", *_with(kernel), "--no-pictures", *(["--complete"] if complete else [])]
        seconds = _COMPLETE_S if complete else _BUILD_S
        report = await self.bench.run("build", *words, on=[str(folder)], seconds=seconds, tell=_teller(context))
        assembly, checks = report.get("assembly", {}), report.get("checks", {})
        depths = [pair.get("depth_mm") or 0.0 for pair in checks.get("pairs", ())]
        return report | {
            "freedoms": assembly.get("freedoms"),
            "mass_kg": assembly.get("mass_kg"),
            "drivers": answers.drivers(assembly.get("drivers", [])),
            "deepest_overlap_mm": max(depths, default=0.0),
            "files": {name: self._shown(entry["main"]) for name, entry in report.get("exports", {}).items()},
        }

    def _require_run(self, folder: Path) -> Path:
        """Return the place of a design's run.

        Raises:
            ReadError: If a link or anything but a run is there.
            RunError: If another process works in it.
        """
        out = folder / "run"
        if out.is_symlink():
            raise ReadError.at(out, f"{out.name} of {folder.name} is a link.", "Remove the link; a build makes the folder.")
        if out.exists():
            others = [entry for entry in out.iterdir() if not entry.name.startswith(scratch.BESIDE)] if out.is_dir() else [out]
            if others and not is_file(out / REQUEST_FILE, root=self.bench.root):
                raise ReadError.at(out, f"{out.name} of {folder.name} is not a run.", "Move the folder away; a build makes it.")
            require_idle(out)  # it is about to be removed
        return out

    def _shapes(self, design: str) -> dict[str, str]:
        """Return the digest of each built part's mesh and its source."""
        found = {}
        for file in sorted((self.bench.root / design / "run" / "parts").glob("*/part.json")):
            try:
                record = json.loads(self.bench.read(str(file.relative_to(self.bench.root))))
                found[file.parent.name] = str(record["shape"]["mesh_sha256"])
            except (ValueError, RecursionError, TypeError, KeyError):
                continue  # somebody else wrote it: the part counts as changed
        return found

    def _shown(self, file: str) -> str:
        """Return a file's name as the tools accept it: relative to the root."""
        path = Path(file)
        return str(path.relative_to(self.bench.root)) if path.is_absolute() and path.is_relative_to(self.bench.root) else file


def make_server(root: str | Path) -> MCPServer:
    """Return a server whose tools can access one folder only.

    Args:
        root: The folder of designs; made if it is not there.
    """
    tools, apps = Tools(root), Apps()
    apps.add_html_resource(_SHELL, _SHELL_FILE.read_text(encoding="utf-8"), title="Page of a design")
    for name, method in inspect.getmembers(tools, inspect.iscoroutinefunction):
        if name == _SHOWING:
            apps.tool(resource_uri=_SHELL, structured_output=False)(_told(method))
    server = ArticadServer("articad", version=__version__, instructions=section("The loop"), log_level="WARNING", extensions=[apps])
    for name, method in inspect.getmembers(tools, inspect.iscoroutinefunction):
        if not name.startswith("_") and name != _SHOWING:
            server.tool(structured_output=False)(_told(method))

    server.resource(_PAGES, name="page", mime_type=APP_MIME_TYPE)(_told(tools.bench.page, ResourceError))
    return server


def _told(method: Tool, refusal: type[Exception] = ToolError) -> Tool:
    """Convert the error of a refused call to one message for the agent."""

    @wraps(method)
    async def told(*arguments: Any, **named: Any) -> Any:
        try:
            _require_short(named)
            answer = await method(*arguments, **named)
        except ArticadError as error:
            raise refusal("\n".join(map(str, error.findings)) or str(error)) from error
        except OSError as error:
            raise refusal(f"{error.filename or 'A file'} cannot be read or written: {error.strerror}.") from None
        return answers.compact(answer) if isinstance(answer, dict) else answer

    return told


def _with(kernel: Kernel) -> list[str]:
    """Return the option that chooses a kernel; without one, the command takes the plan's."""
    return [] if kernel is None else [f"--kernel={kernel}"]


def _size(value: Any) -> int:
    """Return the number of characters of a text, or of a value's JSON."""
    try:
        return len(value) if isinstance(value, str) else len(json.dumps(value))
    except ValueError:  # a whole number of thousands of digits, which the tools refuse
        return 0


def _require_short(arguments: Mapping[str, Any]) -> None:
    """Check the size of the arguments of a tool that have no bounds of their own.

    Raises:
        ReadError: If one is too long.
    """
    for name, value in arguments.items():
        if name in {"plan", "script"} or not isinstance(value, str | list | tuple | dict):
            continue
        most = _INTENT if name == "intent" else _CHARACTERS
        if (size := _size(value)) > most:
            raise ReadError.at(name, f"{name} has {size} characters; at most {most} are accepted.", "Ask for less at once.")


def _teller(context: Context) -> Tell:
    """Return a function that reports progress to the client, if it requested it."""

    async def tell(seconds: float, message: str) -> None:
        await context.report_progress(seconds, None, message)

    return tell
