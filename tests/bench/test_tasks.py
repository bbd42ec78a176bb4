"""The project's own tasks: each reference passes, each check is shown red, and no product or joint graph is asked for too often."""

from __future__ import annotations

import hashlib
from collections import Counter
from functools import cache
from itertools import pairwise

import pytest

from articad.assembly import Assembly
from articad.geometry import Part
from articad.kinematics import Mechanism
from articad.plan.resolve import resolve
from articad_bench.checks import Joints
from articad_bench.reference import given, reference_plan, references
from articad_bench.sentences import sentences
from articad_bench.subject import Subject
from articad_bench.task import TASKS, Task, tasks_in
from tests.bench.wrong import changed, shaped_as, wrong_for
from tests.kinematics.linkages import at, joint

ALL = {task.name: (folder, task) for folder, task in tasks_in(TASKS)}
IN_CI = (
    "wardrobe_double",
    "lamp_two_arms",
    "engine_single",
    "clamp_vertical",
    "bracket_corner",
    "hinge_butt_pin",
    "clock_tower",
    "tusi_couple",
    "repair_bookcase",
    "chain_tool_tote",
)
SEPARATING = tuple(name for name, (_, task) in ALL.items() if task.kind == "separating")
SOAK = tuple(name for name in ALL if name not in IN_CI)


@cache
def stages(name: str) -> tuple[Assembly, ...]:
    return tuple(references(*ALL[name]))


def built(name: str) -> Assembly:
    return stages(name)[0]


@pytest.mark.slow
@pytest.mark.parametrize("name", [*IN_CI, *(pytest.param(name, marks=pytest.mark.soak) for name in SOAK)])
def test_a_reference_passes_its_own_checks_and_each_is_shown_red(name: str) -> None:
    assembly, (folder, task) = built(name), ALL[name]
    begun = given(folder, task)

    wrong = [judgement for judgement in task.judge(Subject(assembly, before=begun)) if not judgement.ok]
    assert not wrong
    if begun is not None:
        _asks_for_a_change(task, begun)
        _refuses_another_change(task, 0, begun, assembly)
    for check in task.checks:
        judgement = check.judge(wrong_for(check, assembly))
        assert not judgement.ok, judgement


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=() if n in IN_CI else pytest.mark.soak) for n, (_, task) in ALL.items() if task.edits]
)
def test_a_reference_makes_the_edits_and_who_leaves_all_as_it_was_does_not(name: str) -> None:
    folder, task = ALL[name]
    assert len(stages(name)) == 1 + len(task.edits)
    for stage, (before, after) in enumerate(pairwise(stages(name)), start=1):
        wrong = [judgement for judgement in task.judge(Subject(after, before=before), stage) if not judgement.ok]
        assert not wrong, (folder.name, stage)
        assert not all(judgement.ok for judgement in task.judge(Subject(before, before=before), stage)), stage
        assert any(check.kind == "unchanged" for check in task.stages[stage])
        _refuses_another_change(task, stage, before, after)
        for check in task.edits[stage - 1].checks:
            judgement = check.judge(wrong_for(check, after))
            assert not judgement.ok, judgement


def _asks_for_a_change(task: Task, begun: Assembly) -> None:
    """The product that is given does not pass, and what the texts do not state of the first one is so of it already."""
    subject = Subject(begun, before=begun)
    failed = [check for check in task.checks if not check.judge(subject).ok]
    assert failed
    stated = {(row.kind, row.check): row.stated for row in sentences(task.model_copy(update={"given": None})).checks}
    assert [check.wanted for check in failed if stated[check.kind, check.wanted] is None] == []


def _refuses_another_change(task: Task, stage: int, before: Assembly, after: Assembly) -> None:
    """Whoever changes one part more than may change, and those like it, does not pass."""
    (check,) = (check for check in task.stages[stage] if check.kind == "unchanged")
    kept = {part.mesh.digest for part in before.parts.values() if part.mesh is not None}
    subject = Subject(after)
    left_out = subject.rigid[after.ground] if check.of.startswith("moving") else None
    shapes = [part.mesh.digest for name, part in after.parts.items() if part.mesh is not None and subject.rigid[name] != left_out]
    stay = [digest for digest in shapes if digest in kept]
    spoilt = set(stay[: max(len(stay) - int(check.number[0]), 0) + 1])
    more = changed(
        after, [_spoilt(part) if part.mesh is not None and part.mesh.digest in spoilt else part for part in after.parts.values()]
    )
    assert not check.judge(Subject(more, before=before)).ok


def _spoilt(part: Part) -> Part:
    return shaped_as(part, None if part.mesh is None else part.mesh.scaled(1.01))


def test_no_product_is_asked_for_more_than_three_times() -> None:
    assert max(Counter(task.product for name, (_, task) in ALL.items() if name not in SEPARATING).values()) <= 3


@pytest.mark.slow
def test_at_least_sixty_joint_graphs_are_asked_for() -> None:
    usual = [pair for name, pair in ALL.items() if name not in SEPARATING]
    graphs = {_graph(resolve(reference_plan(folder, task)).mechanism) for folder, task in usual}

    assert len(graphs) >= 60


def _graph(mechanism: Mechanism) -> str:
    """Return the same for mechanisms whose parts are joined alike, by type of joint and coupling, whatever the parts are called."""
    moved = {joint.name: joint.child for joint in mechanism.joints}
    edges = [(joint.parent, joint.child, str(joint.type)) for joint in mechanism.joints]
    edges += [(moved[c.a.split(".")[0]], moved[c.b.split(".")[0]], f"coupled by {c.kind}") for c in mechanism.couplings]
    colors = {part: "ground" if part == mechanism.ground else "part" for part in mechanism.parts}
    for _ in mechanism.parts:  # each part takes in the colours of its neighbours, until all colours describe how the whole is joined
        around = {part: sorted((kind, colors[b if a == part else a]) for a, b, kind in edges if part in (a, b)) for part in mechanism.parts}
        colors = {part: hashlib.sha256(repr((colors[part], around[part])).encode()).hexdigest() for part in mechanism.parts}
    return repr(sorted(colors.values()))


def test_graphs_differ_by_types_and_neighbours_alone() -> None:
    def chain(*kinds: str, names: str = "abcd") -> Mechanism:
        joints = [joint(f"{kind}_{i}", kind, (names[i], at(0)), (names[i + 1], at(0))) for i, kind in enumerate(kinds)]
        return Mechanism(names[: len(kinds) + 1], names[0], joints)

    assert _graph(chain("revolute", "slider")) == _graph(chain("revolute", "slider", names="wxyz"))
    assert _graph(chain("revolute", "slider")) != _graph(chain("slider", "revolute"))
    assert _graph(chain("revolute", "revolute")) != _graph(chain("revolute", "revolute", "revolute"))


def test_there_are_as_many_tasks_of_each_kind_and_way_of_asking_as_the_benchmark_says() -> None:
    usual = [task for _, task in ALL.values() if task.kind not in {"hard", "separating"}]

    assert Counter(task.kind for _, task in ALL.values() if task.kind != "separating") == {
        "articulated": 50,
        "static": 40,
        "industrial": 30,
        "hard": 40,
    }
    assert Counter(task.modality for task in usual) == {"text": 36, "image": 36, "both": 48}


def test_prompts_are_written_and_not_templated() -> None:
    openings = Counter(" ".join(task.prompt.split()[:6]) for _, task in ALL.values() if task.prompt)
    assert max(openings.values()) == 1


def test_every_task_states_what_it_checks() -> None:
    for _, task in ALL.values():
        assert _stated(task), task.name


def _stated(task: Task) -> bool:
    """A number that a check holds a joint's range to stands in the prompt, unless pictures show it, or a product that is given has it."""
    if task.images or task.given is not None:
        return True
    spans = [check.joint.span for check in task.checks if isinstance(check, Joints)]
    ranges = [span for span in spans if span is not None and span != "endless"]
    numbers = [float(word.strip(".,;:")) for word in task.prompt.replace("-", " ").split() if word.strip(".,;:").isdigit()]
    return all(any(low <= number <= high or low <= 2 * number <= high for number in numbers) or high > 720 for low, high in ranges)


@pytest.mark.slow
def test_a_pin_in_its_slot_is_proven_clear_although_no_pose_is_in_the_middle_of_many_steps() -> None:
    """About the middle of a straight line through many poses pin and slot pierce each other; that is no contact."""
    certificate = built("scotch_yoke_pump").certify(pairs=False, budget=300)
    assert certificate.ok, [str(finding) for finding in certificate.findings]
