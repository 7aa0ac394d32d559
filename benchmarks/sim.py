"""How fast the simulator is: a match with frames and commands beside the bare space, and many arenas."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, pi, sin
from time import process_time
from typing import Annotated

import numpy as np
import typer
from numpy.typing import NDArray

from benchmarks.minimal_kernel import FloatArray, MinimalArenas
from robobt.cli import Json, console, print_json, say, table
from robobt.cli.common import errors
from robobt.sim import COMMAND, Arenas, SimWorld, preset
from robobt.sim.records import size
from robobt.world import DIVISION_A, DIVISION_B, Frame, Placement, RobotCommand, RobotId, RobotState, Team

CASES = {"one_v_one": 1, "six_v_six": 6, "eleven_v_eleven": 11}
"""Keys of the benchmark's result and robots a team."""

PERIOD = 0.025
"""Control period, five sub-steps [s]."""

_CHUNK = 200
"""Steps measured at once: long beside the clock's resolution, short beside the load of other programs."""

SIDES = (1, 2, 3, 6)
"""Robots a team in the crowded arenas."""

ARENAS = (64, 256, 1024)
"""How many of them there are."""

TRAINING_PERIOD, TRAINING_STEPS = 0.03, 4
"""Control period of training and physics steps in it [s]."""


MINIMAL_SIDES, MINIMAL_ARENAS = (1, 3, 6), 256
"""Robots a team, and arenas, of the comparison with :mod:`benchmarks.minimal_kernel`."""


def bench_arenas(
    seconds: float = 2.0, sides: Sequence[int] = SIDES, arenas: Sequence[int] = ARENAS
) -> dict[int, dict[int, float]]:
    """Measure crowded play in many arenas on one core: everybody drives at the ball, dribbles and kicks.

    Args:
        seconds: CPU time for each figure. They begin in a ring of 0.8 m around the ball, meet within a second
            that does not count, and restart after two more: the same play whatever their number. The
            median step counts.
        sides: robots a team.
        arenas: how many of them.

    Returns:
        for each of ``sides`` and each of ``arenas``, control steps a second of CPU time, all arenas
        together. Deciding what to do is not in the time.
    """
    return {
        side: {n: float(n / np.median(_crowded((_arenas(side, n),), seconds))) for n in arenas}
        for side in sides
    }


def bench_minimal(
    seconds: float = 2.0, sides: Sequence[int] = MINIMAL_SIDES, n: int = MINIMAL_ARENAS
) -> dict[int, dict[str, float]]:
    """Measure crowded play beside the minimal kernel, in turn, step by step.

    Args:
        seconds: CPU time for each of ``sides``, both together.
        sides: robots a team.
        n: how many arenas.

    Returns:
        for each of ``sides`` control steps a second of CPU time, ``arenas`` and ``minimal``, and
        ``minimal_ratio``, the median over the steps of the arenas' time over the kernel's.
    """
    figures = {}
    for side in sides:
        minimal = MinimalArenas(n, 2 * side, TRAINING_STEPS, TRAINING_PERIOD / TRAINING_STEPS)
        spent = _crowded((_arenas(side, n), minimal), seconds)
        ours, least = n / np.median(spent, axis=0)
        ratio = float(np.median(spent[:, 0] / spent[:, 1]))
        figures[side] = {"arenas": float(ours), "minimal": float(least), "minimal_ratio": ratio}
    return figures


def _arenas(side: int, n: int) -> Arenas:
    settings = preset("default").model_copy(update={"sub_step": TRAINING_PERIOD / TRAINING_STEPS})
    return Arenas(DIVISION_B, [None] * (2 * side), settings, TRAINING_PERIOD, n)


def _crowded(fields: Sequence[Arenas | MinimalArenas], seconds: float) -> FloatArray:
    """Return the CPU time of each counted step of each of the fields, which play in turn, (steps, fields)."""
    n, robots = fields[0].contact.shape
    angles = np.random.default_rng(0).uniform(0, 2 * pi, (n, 1)) + np.arange(robots) * 2.0 * pi / robots
    starts = np.stack([0.8 * np.cos(angles), 0.8 * np.sin(angles), angles + pi], axis=-1)
    commands = np.zeros((n, robots, size(COMMAND)))
    spent: list[list[float]] = []
    second = round(1.0 / TRAINING_PERIOD)
    while sum(map(sum, spent)) < seconds:
        for field in fields:
            field.place(starts, np.zeros((n, 4)))
        for step in range(3 * second):
            times = []
            for field in fields:
                _chase_all(field, commands.view(COMMAND)[..., 0])
                begin = process_time()
                field.step(commands)
                times.append(process_time() - begin)
            if step >= second:
                spent.append(times)
    return np.array(spent)


def _chase_all(field: Arenas | MinimalArenas, told: NDArray[np.void]) -> None:
    """Let all robots drive at the ball, and dribble or kick it."""
    gap = field.balls[:, None, :2] - field.robots[..., :2]
    error = np.arctan2(gap[..., 1], gap[..., 0]) - field.robots[..., 2]
    told["vx"], told["vy"] = 2.0 * np.cos(error), 2.0 * np.sin(error)
    told["omega"] = 5.0 * np.sin(error)
    told["kick_speed"] = np.where(field.contact, 2.0, 0.0)
    told["dribbler"] = 1.0


def bench_sim(seconds: float = 4.0) -> dict[str, dict[str, float]]:
    """Measure each of :data:`CASES` on one core.

    Everybody chases the ball, dribbles and kicks it, so that robots and ball
    move and meet. A control step observes a frame, makes both teams' views,
    takes a command a robot and advances the physics. ``bare_ratio`` divides its
    time by that of stepping the same space with pymunk's own call and nothing else.

    Args:
        seconds: CPU time for each case, in chunks of 200 steps with frames
            and 200 bare ones in turn, after one of each that does not count.

    Returns:
        for each case, of CPU time, medians over the chunks: ``steps_per_s``, ``bare_steps_per_s`` and
        ``bare_ratio``, of a chunk to the one beside it; ``pairs``, how many there were; and
        ``contacts_per_s``, ball touches by another robot than before and kicks
        per simulated second, which show that things do meet.
    """
    return {name: _measure(count, seconds) for name, count in CASES.items()}


def _measure(count: int, seconds: float) -> dict[str, float]:
    world = _crowd(count)
    _pair(world)
    pairs: list[tuple[float, float]] = []
    meetings = 0
    end = process_time() + seconds
    while process_time() < end or not pairs:
        with_frames, bare, met = _pair(world)
        pairs.append((with_frames, bare))
        meetings += met
    taken = np.array(pairs)
    with_frames, bare = np.median(taken, axis=0)
    return {
        "steps_per_s": float(_CHUNK / with_frames),
        "bare_steps_per_s": float(_CHUNK / bare),
        "bare_ratio": float(np.median(taken[:, 0] / taken[:, 1])),
        "pairs": len(pairs),
        "contacts_per_s": meetings / (len(pairs) * _CHUNK * PERIOD),
    }


def _pair(world: SimWorld) -> tuple[float, float, int]:
    """Return the CPU time of a chunk of steps with frames and of one of bare steps [s], and the meetings."""
    begin = process_time()
    meetings = _play(world, _CHUNK)
    between = process_time()
    for _ in range(_CHUNK):
        world.step_bare()
    return between - begin, process_time() - between, meetings


def _crowd(count: int) -> SimWorld:
    ids = [RobotId(team, number) for team in Team for number in range(count)]
    world = SimWorld(DIVISION_A, dict.fromkeys(ids), preset("default"), PERIOD)
    poses = {}
    for i, robot in enumerate(ids):
        angle = 2 * pi * i / len(ids)
        poses[robot] = (3.0 * cos(angle), 3.0 * sin(angle), angle + pi)
    world.reset(Placement(poses), seed=0)
    return world


def _play(world: SimWorld, steps: int) -> int:
    """Let everybody chase the ball for some steps; how often it changed hands or was kicked."""
    meetings = 0
    last = None
    for _ in range(steps):
        frame = world.observe()
        views = {Team.BLUE: frame, Team.YELLOW: frame.mirrored()}
        commands = {}
        for team, view in views.items():
            for robot in view.own:
                commands[RobotId(team, robot.id)] = _chase(view, robot)
        world.act(commands)
        meetings += len(world.kicks) + (frame.last_touch != last)
        last = frame.last_touch
    return meetings


def _chase(view: Frame, robot: RobotState) -> RobotCommand:
    ball = view.ball
    error = atan2(ball.y - robot.y, ball.x - robot.x) - robot.heading
    return RobotCommand(
        2.0 * cos(error),
        2.0 * sin(error),
        5.0 * sin(error),
        3.0 if robot.ball_contact else 0.0,
        dribbler=True,
    )


def sim(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each case.")
    ] = 4.0,
    as_json: Json = False,
) -> None:
    """Measure the simulator: control steps a second of CPU time with frames and commands, 25 ms control.

    Chunks of 200 steps and of 200 bare steps take turns, after one of each that does not count; medians.

    Keys of --json: one_v_one, six_v_six and eleven_v_eleven, each with
    steps_per_s, bare_steps_per_s (the same space stepped by pymunk alone),
    bare_ratio (time of a step over that of a bare one), pairs (how many were measured) and contacts_per_s
    (how often the ball meets robots, a simulated second).
    """

    with errors.status("measuring the simulator"):
        figures = bench_sim(seconds=seconds)
    if as_json:
        print_json(figures)
        return
    listed = table("case", "steps/s", "bare steps/s", "ratio to bare")
    for case, figure in figures.items():
        listed.add_row(
            case.replace("_", " "),
            f"{figure['steps_per_s']:,.0f}",
            f"{figure['bare_steps_per_s']:,.0f}",
            f"{figure['bare_ratio']:.2f}",
        )
    console.print(listed)
    say(
        f"Compared: CPU time of {_CHUNK} control steps with frames, views and commands beside {_CHUNK} steps "
        "of the same pymunk space alone, in turn; medians, after a warm-up of one pair."
    )


def arenas(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each figure.")
    ] = 2.0,
    as_json: Json = False,
) -> None:
    """Measure crowded play in many arenas: control steps a second of CPU time, 4 physics steps in 30 ms.

    Keys of --json: by robots a team, by number of arenas, the steps a second of all arenas together; minimal:
    by robots a team, 256 arenas beside a kernel of a hundred lines that does the least that still plays, with
    steps a second of both (arenas, minimal) and how many times as long the arenas take (minimal_ratio), the
    median over steps in turn.
    """

    with errors.status("measuring many arenas"):
        figures, beside = bench_arenas(seconds=seconds), bench_minimal(seconds=seconds)
    if as_json:
        print_json({**{str(side): speeds for side, speeds in figures.items()}, "minimal": beside})
        return
    listed = table("a team", *(f"{n:,} arenas" for n in ARENAS), "minimal kernel", "ratio to it")
    for side, speeds in figures.items():
        least = beside.get(side)
        listed.add_row(
            str(side),
            *(f"{speeds[n]:,.0f}" for n in ARENAS),
            "" if least is None else f"{least['minimal']:,.0f}",
            "" if least is None else f"{least['minimal_ratio']:.1f}",
        )
    console.print(listed)
    say(
        f"Compared: CPU time of a control step of {MINIMAL_ARENAS} arenas beside one of the minimal kernel, "
        "in turn; medians, after a second of play that does not count."
    )
