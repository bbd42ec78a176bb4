"""Draw an assembly and its motion."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from articad.commands.command import argument, command, output_folder
from articad.commands.options import SANDBOX, extent
from articad.commands.steps import loaded

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal


@command(
    "render",
    "Draw a run, a plan or a URDF, MJCF or FreeCAD file from several sides, or the motion of a joint.",
    argument("target", metavar="RUN|PLAN_DIR|FILE"),
    argument("--views", metavar="VIEWS", default="iso,front,right,top", help="views, each a picture (iso,front,right,top)"),
    argument("--motion", metavar="JOINT", help="draw this joint's motion instead, as a filmstrip and an animation"),
    argument("--parts", metavar="NAMES", help="parts shown in full; the others are faded"),
    argument("--section", metavar="AXIS[=MM]", help="cut away everything beyond x, y or z (such as -y=12.5)"),
    argument(
        "--explode", metavar="SHARE", type=float, default=0.0, help="pull parts out of each other along their joints; at 1 all are free"
    ),
    argument("--overlaps", action="store_true", help="draw overlaps of parts in red, on top of everything"),
    argument(
        "--size", metavar="PIXELS|WxH", type=extent, default=(512, 512), help="width and height of a picture, such as 512 or 1280x720 (512)"
    ),
    argument("--clean", action="store_true", help="a product picture: materials, soft light and shadow, no labels"),
    argument("--transparent", action="store_true", help="a clean picture without background; its shadow stays"),
    argument("--renderer", choices=["embree", "pyvista"], default="embree", help="pyvista is smoother but needs OpenGL"),
    output_folder("--out", "pictures", "where to write"),
    SANDBOX,
)
def _render(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.errors import ArticadError
    from articad.render.files import write_motion, write_views

    clean = options.clean or options.transparent
    if clean and options.renderer != "embree":
        raise ArticadError("--clean and --transparent draw with --renderer embree only.", stage="render")
    if not clean and options.size[0] != options.size[1]:
        raise ArticadError("A picture with labels is square: give --size one number, or add --clean.", stage="render")
    if options.transparent and options.motion:
        raise ArticadError("An animation has a background: leave out --transparent, or draw --views.", stage="render")
    assembly = loaded(options.target, options, terminal)
    out = Path(options.out)
    with terminal.progress("Drawing"):
        if options.motion:
            files = write_motion(assembly, options.motion, out, size=options.size, clean=clean)
        else:
            only = options.parts.split(",") if options.parts else None
            files = write_views(
                assembly,
                [view for view in options.views.split(",") if view],
                out,
                size=options.size,
                only=only,
                section=options.section,
                explode=options.explode,
                renderer=options.renderer,
                show_overlaps=options.overlaps,
                clean=clean,
                transparent=options.transparent,
            )
    for file in files:
        terminal.say(str(file))
    return {"schema": "articad.pictures/1", "ok": True, "files": [str(file) for file in files], "findings": []}
