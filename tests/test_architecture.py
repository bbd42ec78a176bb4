"""The house: who may import whom, what an import costs, and that what is declared is used."""

from __future__ import annotations

import ast
import functools
import graphlib
import importlib
import re
import subprocess
import sys
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

import articad

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "articad"
HEAVY = ("litellm", "mujoco", "build123d", "OCP", "pinocchio", "scipy", "trimesh", "fcl", "manifold3d", "rich", "pydantic")
MOST_MODULES_OF_HELP = 45  # of the standard library, beyond those of Python itself: 34 when this was written

# Distribution -> module, for the packages that articad is made of.
FIXED = {
    "numpy": "numpy",
    "scipy": "scipy",
    "pin": "pinocchio",
    "yourdfpy": "yourdfpy",
    "trimesh": "trimesh",
    "python-fcl": "fcl",
    "manifold3d": "manifold3d",
    "pydantic": "pydantic",
    "litellm": "litellm",
}


def modules_after(statement: str) -> set[str]:
    """Return the top-level modules that a fresh interpreter has loaded after a statement."""
    code = f"import sys\n{statement}\nprint(*sorted({{name.partition('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True, timeout=120)
    return set(done.stdout.split())


@functools.cache
def imported_by(path: Path) -> set[str]:
    """Return the top-level modules that a source file imports anywhere, inside functions too."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names.add(node.module.partition(".")[0])
    return names


def third_party(modules: set[str]) -> set[str]:
    return {name for name in modules if name not in sys.stdlib_module_names and not name.startswith("_")} - {"articad", "articad_bench"}


SOURCES = sorted(
    path
    for path in PACKAGE.rglob("*.py")
    if path.parent.name != "inside_freecad"  # those run in FreeCAD's own Python
)


def test_import_contracts_hold() -> None:
    code = "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command(['--no-cache']))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout[-4000:]
    assert "0 broken" in done.stdout


MODULES = {".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path for path in SOURCES}


def imports_of(module: str, *, late: bool) -> set[str]:
    """Return the modules of the package that a module imports when it is imported; with `late` also those that its functions import."""

    def named(node: ast.AST) -> Iterator[str]:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield from (inner if (inner := f"{node.module}.{alias.name}") in MODULES else node.module for alias in node.names)
        elif not (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)) and (
            late or not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        ):
            for child in ast.iter_child_nodes(node):
                yield from named(child)

    return {name for name in named(ast.parse(MODULES[module].read_text())) if name in MODULES} - {module, "articad"}


def has_no_cycle(graph: dict[str, set[str]]) -> None:
    tuple(graphlib.TopologicalSorter(graph).static_order())  # raises CycleError, which names the modules


def test_no_modules_import_each_other() -> None:
    has_no_cycle({module: imports_of(module, late=False) for module in MODULES})


def test_functions_import_in_circles_only_where_that_is_documented() -> None:
    contract = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"][0]
    documented = [tuple(line.split(" -> ")) for line in contract["ignore_imports"]]
    graph = {
        module: {
            name
            for name in imports_of(module, late=True)
            if not any(module == source and (name == target or name.startswith(f"{target}.")) for source, target in documented)
        }
        for module in MODULES
    }
    has_no_cycle(graph)


def classes(path: Path) -> Iterable[str]:
    return (node.name for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ClassDef))


def test_every_class_has_a_name_of_its_own() -> None:
    where = defaultdict(list)
    for path in PACKAGE.rglob("*.py"):
        for name in classes(path):
            where[name].append(str(path.relative_to(PACKAGE)))
    assert not {name: places for name, places in where.items() if len(places) > 1 and not name.startswith("_")}


@pytest.mark.parametrize("name", sorted(set(articad.__all__) - {"__version__"}))
def test_every_public_name_is_defined_where_the_table_says_and_nowhere_else(name: str) -> None:
    assert getattr(articad, name).__module__ == f"articad.{articad._MODULE_OF[name]}"
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.py")]
    inner = re.compile(rf"from articad\.[\w.]+ import [^\n]*\b{name}\b")
    assert not [str(page) for page in pages if inner.search(page.read_text())]  # users are shown one place


MUTATED = """
import sys, types
import numpy as np
import articad

room = sys.modules["articad.kinematics"] = types.ModuleType("articad.kinematics")  # joints alone, before what is derived from them
room.__path__ = [articad.__path__[0] + "/kinematics"]
from articad.kinematics import joints
from articad.kinematics.joints import Step, _Kind

kinds = {
    "revolute": _Kind(("angle",), Step("turn", 0, 0)),
    "slider": _Kind(("travel",), Step("slide", 1, 0)),
    "cylindrical": _Kind(("travel", "angle"), Step("slide", 1, 0), Step("turn", 1, 1)),
    "planar": _Kind(("x", "y", "angle"), Step("slide", 1, 0), Step("slide", 2, 1), Step("turn", 0, 2)),
    "universal": _Kind(("a", "b"), Step("turn", 2, 0), Step("turn", 0, 1)),
}
joints._KINDS.update(kinds)
del sys.modules["articad.kinematics"]

from articad.connectors import SE3, flip
from articad.interference.motion import Chain, Route
from articad.kinematics import Joint, JointLimits, JointType, Mechanism

rng = np.random.default_rng(0)
frame = lambda: SE3.exp(np.concatenate([rng.uniform(-50, 50, 3), rng.normal(size=3)]))
made = []
for name in (*kinds, "ball"):
    kind = JointType(name)
    n = len(kind.coordinates)
    limits = JointLimits(cone=3.0) if name == "ball" else JointLimits((-9.0,) * n, (9.0,) * n)
    made.append(Joint(name=name, type=kind, parent=f"p{len(made)}", child=f"p{len(made) + 1}", parent_connector="a", child_connector="b",
        T_parent_connector=frame(), T_child_connector=frame(), limits=limits, rest=kind.neutral))
mechanism = Mechanism([f"p{i}" for i in range(len(made) + 1)], "p0", made)
Q = rng.uniform(-1, 1, (100, mechanism.nq))
Q[:, -4:] /= np.linalg.norm(Q[:, -4:], axis=1)[:, None]

def exponential(step, value):  # the test's own motion of one step
    T, axis = np.eye(4), np.eye(3)[step.axis]
    if step.kind == "slide":
        T[:3, 3] = value * axis
    else:
        K = np.cross(axis, np.eye(3)).T
        T[:3, :3] += np.sin(value) * K + (1 - np.cos(value)) * K @ K
    return T

def moved(joint, q):
    if joint.type is JointType.BALL:
        return SE3.from_quaternion(q).matrix
    T = np.eye(4)
    for step in kinds[joint.type].steps:
        T = T @ exponential(step, q[step.coordinate])
    return T

def placed(Q):
    T, rows = np.eye(4), [np.eye(4)]
    for joint in made:
        own = mechanism.layout.columns[joint.name]
        T = T @ joint.T_parent_connector.matrix @ moved(joint, Q[own]) @ flip(joint.mate).matrix @ np.linalg.inv(joint.T_child_connector.matrix)
        rows.append(T)
    return np.array(rows)

expected, q, tip = np.array([placed(row) for row in Q]), Q[0], f"p{len(made)}"
error = lambda T, true: float(np.abs(np.asarray(T) - true).max())
wrong = {
    "one configuration": error(mechanism.poses(q).matrix, expected[0]),
    "few": error(mechanism.poses(Q[:3]).matrix, expected[:3]),
    "many": error(mechanism.poses(Q).matrix, expected),
    "joint by joint": max(error(j.motion(q[mechanism.layout.columns[j.name]]).matrix, moved(j, q[mechanism.layout.columns[j.name]])) for j in made),
}
J, h = mechanism.jacobian(q, tip), 1e-6
for k in range(mechanism.nq - 4):
    step = h * np.eye(mechanism.nq)[k]
    slope = (placed(q + step)[-1][:3, 3] - placed(q - step)[-1][:3, 3]) / (2 * h)
    wrong[f"jacobian {k}"] = 1e-3 * error(J[:3, k], slope)
for joint in made[:-1]:
    chain = Chain(Route(mechanism.tree.path(joint.parent, joint.child), (joint,)), [joint.name])
    own = q[mechanism.layout.columns[joint.name]]
    there = joint.T_parent_connector.matrix @ moved(joint, own) @ flip(joint.mate).matrix @ np.linalg.inv(joint.T_child_connector.matrix)
    wrong[f"interference {joint.name}"] = error(chain.matrix(list(own)), there)
print({name: value for name, value in wrong.items() if not value < 1e-6})
"""


def test_one_table_defines_the_motion_of_every_joint_type() -> None:
    # Other axes in the table of steps: all that places parts must follow it, or it has a definition of its own. Screws stay as they are:
    # matrices place what turns about and slides along z by one product with constants.
    done = subprocess.run([sys.executable, "-c", MUTATED], cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)
    assert done.stdout.strip() == "{}", done.stdout + done.stderr


@pytest.mark.parametrize("name", articad.__all__)
def test_every_public_name_is_there(name: str) -> None:
    assert getattr(articad, name) is not None


def test_the_namespace_is_all() -> None:
    assert dir(articad) == sorted(articad.__all__)
    assert len(set(articad.__all__)) == len(articad.__all__)
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = articad.no_such_name


def test_the_names_that_type_checkers_see_are_all() -> None:
    tree = ast.parse((PACKAGE / "__init__.py").read_text())
    blocks = [node for node in tree.body if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"]
    seen = {
        alias.asname or alias.name for block in blocks for node in block.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    assert seen | {"__version__"} == set(articad.__all__)


def test_import_articad_loads_nothing_heavy() -> None:
    assert not modules_after("import articad") & set(HEAVY)


def test_using_the_public_names_loads_no_model_simulator_or_kernel() -> None:
    loaded = modules_after("import articad\nfor name in articad.__all__: getattr(articad, name)")
    assert not loaded & {"litellm", "mujoco", "build123d", "OCP", "rich"}


@pytest.mark.parametrize("argument", ["--help", "--version"])
def test_help_and_version_load_neither_numpy_nor_rich(argument: str) -> None:
    statement = f"import contextlib, io, articad.cli\nwith contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()): articad.cli.main(['{argument}'])"
    loaded = modules_after(statement) - modules_after("pass")
    assert not third_party(loaded)
    assert len(loaded) <= MOST_MODULES_OF_HELP


def test_kinematics_loads_only_numpy_and_pinocchio() -> None:
    exercise = """
from articad.connectors.attachment import Attachment
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.kinematics.declare import revolute
from articad.kinematics.mechanism import Mechanism

axis = Connector("axis", SE3.identity())
arm = Mechanism(("base", "arm"), "base", [revolute("elbow", Attachment("base", axis), Attachment("arm", axis), limits=(-1, 1))])
arm.poses(arm.rest), arm.jacobian(arm.rest, "arm")
"""
    with_pinocchio = modules_after("import pinocchio")  # its own bindings: eigenpy, coal, cmeel
    assert third_party(modules_after(exercise)) <= third_party(with_pinocchio)
    allowed = {"numpy", "pinocchio"}
    for room in ("kinematics", "connectors"):
        for source in sorted((PACKAGE / room).glob("*.py")):
            foreign = third_party(imported_by(source)) - allowed
            assert foreign <= {"factors.py": {"threadpoolctl"}}.get(source.name, set()), source  # asked for late


@pytest.mark.parametrize(("distribution", "module"), FIXED.items())
def test_every_fixed_package_is_declared_and_imported(distribution: str, module: str) -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    assert any(line.startswith(distribution) for line in declared), f"{distribution} is not declared"
    assert any(module in imported_by(source) for source in SOURCES), f"{module} is imported by no module"


def test_every_import_is_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = (line for extra in ("render", "faiss", "mcp", "batch", "xacro", "papers") for line in project["optional-dependencies"][extra])
    declared = [*project["dependencies"], *extras]
    names = {re.split(r"[^A-Za-z0-9_-]", line, maxsplit=1)[0] for line in declared}
    module_of = FIXED | {"pillow": "PIL", "faiss-cpu": "faiss"}
    known = {module_of.get(name, name) for name in names} | {"OCP", "pydantic_core"}  # these come with build123d and pydantic, and only so
    inside = {"FreeCAD", "Part", "Sketcher", "Mesh", "JointObject"}  # of FreeCAD's own Python, where these programs run
    unknown = {
        (source.name, name)
        for source in SOURCES
        for name in third_party(imported_by(source)) - (known | inside if source.parent.name == "inside_freecad" else known)
    }
    assert not unknown


def test_the_table_of_dependencies_says_which_rooms_import_each() -> None:
    rows = re.search(r"## At run time\n\n(.*?)\n\n", (ROOT / "docs" / "dependencies.md").read_text(), re.DOTALL)
    stated = {cells[0].split()[0]: cells[3] for line in (rows or [""])[1].splitlines()[2:] if (cells := line.strip("| ").split(" | "))}
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    assert stated.keys() == {re.split(r"[^A-Za-z0-9_-]", line, maxsplit=1)[0] for line in declared}
    for name, rooms in stated.items():
        module = (FIXED | {"pillow": "PIL"}).get(name, name)
        found = {source.relative_to(PACKAGE).parts[0].removesuffix(".py") for source in SOURCES if module in imported_by(source)}
        assert rooms.startswith(("nearly", "none")) or set(rooms.split(", ")) == found - {"starter"}, name


@pytest.mark.parametrize(
    ("module", "owner"),
    [
        (
            "pinocchio",
            ("kinematics/forward.py", "kinematics/dynamics.py", "simulation/loading.py"),
        ),  # the latter only asks whether it loads a file
        ("fcl", ("interference/",)),
        ("litellm", ("agents/provider.py",)),
        ("mujoco", ("simulation/", "importers/mjcf_compiled.py")),  # the process that compiles foreign MJCF
    ],
)
def test_one_place_each_imports_the_engines(module: str, owner: tuple[str, ...]) -> None:
    users = {str(source.relative_to(PACKAGE)) for source in SOURCES if module in imported_by(source)}
    assert all(user.startswith(owner) for user in users), users


def test_every_module_says_what_it_is() -> None:
    for source in SOURCES:
        assert ast.get_docstring(ast.parse(source.read_text())), f"{source} has no docstring"


def test_no_room_is_a_lumber_room() -> None:
    for source in SOURCES:
        assert source.stem not in {"utils", "core", "common", "manager", "helper", "helpers"}, source


def test_the_lock_names_no_registry_and_hashes_everything() -> None:
    lines = (ROOT / "requirements.lock").read_text().splitlines()
    assert not [line for line in lines if "://" in line or line.lstrip().startswith(("-i", "--index", "--extra", "--find"))]
    requirements = [line for line in lines if "==" in line]
    assert len(requirements) > 100
    assert all(line.endswith("\\") for line in requirements)


def test_the_package_s_version_is_its_module_s() -> None:
    assert tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"] == articad.__version__


def test_the_typed_marker_is_shipped() -> None:
    assert (PACKAGE / "py.typed").is_file()
    assert importlib.import_module("articad").__file__ == str(PACKAGE / "__init__.py")


def test_every_test_that_is_left_to_the_long_run_exists() -> None:
    lines = [line.split(maxsplit=1)[1] for line in (ROOT / "tests" / "sampled.txt").read_text().splitlines() if not line.startswith("#")]
    assert len(lines) > 20
    for name in lines:
        file, function = name.partition("[")[0].split("::")
        assert f"def {function}(" in (ROOT / file).read_text(), name
