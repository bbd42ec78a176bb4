"""Pictures where no OpenGL, EGL, OSMesa or X library can be loaded: as in a bare root of a distribution."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HIDDEN = (
    "libGL.so*",
    "libGLX*.so*",
    "libGLdispatch.so*",
    "libOpenGL.so*",
    "libEGL*.so*",
    "libGLES*.so*",
    "libOSMesa.so*",
    "libX11*.so*",
    "libvulkan.so*",
)
FOLDERS = ("/usr/lib", "/usr/lib64", "/usr/local/lib", "/lib", "/lib64")

DRAW = """
import ctypes, sys
for name in ("libGL.so.1", "libEGL.so.1", "libX11.so.6"):
    try:
        ctypes.CDLL(name)
    except OSError:
        continue
    sys.exit(f"{name} is not hidden")
from articad.assembly import Assembly
from articad.connectors import SE3, Connector
from articad.errors import KernelUnavailableError
from articad.geometry.part import Part
from articad.geometry.shapes import box, sphere
from articad.kinematics import declare
from articad.render import filmstrip, motion_gif, png, product_sheet, render_motion
frame = {"c": Connector("c", SE3.identity())}
base, ball = Part.from_mesh("base", box(9, 9, 9), connectors=frame), Part.from_mesh("ball", sphere(6), connectors=frame)
made = Assembly.from_parts("made", parts=[base, ball], joints=[declare.slider("go", base["c"], ball["c"], limits=(0, 9))], ground="base")
made.render(["iso"], show_overlaps=True, section="x", explode=0.5, size=64)
png(filmstrip(render_motion(made, "go", frames=2, size=64)))
motion_gif(render_motion(made, "go", frames=2, size=64))
png(product_sheet(made, size=64))
try:
    made.render(["iso"], renderer="pyvista", size=64)
except KernelUnavailableError as error:
    print("drawn;", error)
"""


def hidden_libraries() -> list[str]:
    found = {path.resolve() for folder in FOLDERS for pattern in HIDDEN for path in Path(folder).glob(f"**/{pattern}")}
    return sorted(str(path) for path in found if path.is_file())


def test_everything_is_drawn_where_no_library_of_opengl_can_be_loaded() -> None:
    if shutil.which("bwrap") is None:
        pytest.skip("bubblewrap is missing: nothing hides libraries from a process")
    hide = [word for library in hidden_libraries() for word in ("--ro-bind", "/dev/null", library)]
    inside = ["bwrap", "--dev-bind", "/", "/", *hide, "--chdir", str(ROOT), "--setenv", "PYTHONPATH", str(ROOT)]
    if subprocess.run([*inside, "true"], capture_output=True, check=False).returncode != 0:
        pytest.skip("this machine lets nobody make a namespace")

    done = subprocess.run([*inside, sys.executable, "-c", DRAW], capture_output=True, text=True, check=False)

    assert done.returncode == 0, done.stderr
    assert "drawn; PyVista cannot draw here" in done.stdout
