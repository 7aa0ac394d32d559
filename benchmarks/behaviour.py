"""The behaviour of each room, as a hash: equal hashes mean equal behaviour in the probes.

A probe is a short run with a fixed seed. Whether a figure still holds is asked of the rooms that it rests on
(:mod:`benchmarks.measurements`).
"""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

Probe = Callable[[], object]
"""A run whose result, plain data, is hashed."""

_SEED = 11

_MATCHES = {
    "striker_vs_goalkeeper": 6.0,
    "score_on_two_defenders": 4.0,
    "placement_drill": 6.0,
    "three_v_three": 12.0,
    "team_v_baseline": 12.0,
}
"""Scenarios that are played, and for how long [s]."""


def _sim() -> object:
    from robobt.sim import SimWorld, preset
    from robobt.world import DIVISION_B, Placement, RobotCommand, RobotId, Team

    seen = []
    for name in ("default", "grsim", "erforce"):
        rng = np.random.default_rng(_SEED)
        robots = [RobotId(team, number) for team in Team for number in range(3)]
        world = SimWorld(DIVISION_B, dict.fromkeys(robots), preset(name), 1 / 60)
        poses = {robot: (0.3 * i - 0.8, 0.2 * (-1) ** i, 0.5 * i) for i, robot in enumerate(robots)}
        world.reset(Placement(poses, (0.0, 0.0, 0.6, 0.2)), _SEED)
        for _ in range(180):
            drives = rng.uniform(-2.0, 2.0, (len(robots), 4))
            world.act(
                {
                    robot: RobotCommand(vx, vy, omega, max(kick, 0.0), dribbler=kick < 0.5)
                    for robot, (vx, vy, omega, kick) in zip(robots, drives.tolist(), strict=True)
                }
            )
            frame = world.truth()
            seen.append([(one.x, one.y, one.heading) for one in (*frame.own, *frame.opponents)])
            seen.append([(frame.ball.x, frame.ball.y, frame.ball.z)])
    return seen


def _motion() -> object:
    from robobt.motion import drive
    from robobt.world import RobotLimits, RobotState

    rng = np.random.default_rng(_SEED)
    commands = []
    for x, y, heading, vx, vy, omega, to_x, to_y, facing in rng.uniform(-3.0, 3.0, (300, 9)).tolist():
        me = RobotState(id=1, x=x, y=y, heading=heading, vx=vx, vy=vy, omega=omega)
        command = drive(me, (to_x, to_y), facing, RobotLimits(), 1 / 60)
        commands.append((command.vx, command.vy, command.omega))
    return commands


def _world() -> object:
    from robobt.world import DIVISION_B, GO_TO_BALL
    from robobt.world.features import go_to_ball_rows, shoot_rows, shot_features
    from robobt.world.records import BALL_SIZE, ROBOT_SIZE
    from robobt.world.rules import is_out

    rng = np.random.default_rng(_SEED)
    robots = rng.uniform(-3.0, 3.0, (100, ROBOT_SIZE))
    balls = rng.uniform(-3.0, 3.0, (100, BALL_SIZE))
    places = rng.uniform(-3.0, 3.0, (3, 100, 2))
    return (
        [is_out(x, y, DIVISION_B.length / 2, DIVISION_B.width / 2) for x, y in (2.0 * places[0]).tolist()],
        go_to_ball_rows(robots, balls, 4.5, GO_TO_BALL.size).tolist(),
        shoot_rows(robots, balls, 4.5, 0.5).tolist(),
        shot_features(places[0, 0], places[1], places[2]).tolist(),
    )


def _tree() -> object:
    from robobt.tree import Behaviour, CommittingSelector, Selector, Sequence, Status, TreeRunner

    rng = np.random.default_rng(_SEED)
    statuses = (Status.SUCCESS, Status.FAILURE, Status.RUNNING)

    class Drawn(Behaviour):
        def update(self) -> Status:
            return statuses[int(rng.integers(3))]

    def steps(name: str, memory: bool) -> Behaviour:
        return Sequence(name, memory=memory, children=[Drawn(f"{name} {number}") for number in range(3)])

    committed = CommittingSelector("committed", children=[steps("fresh", False), Drawn("other")])
    root = Selector("root", memory=False, children=[steps("kept", True), committed, Drawn("last")])
    runner = TreeRunner(root, None)
    ticked = []
    for _ in range(300):
        runner.tick()
        ticked.append([node.status.value for node in runner.nodes])
    return ticked


@cache
def _matches() -> list[object]:
    from robobt import load_scenario, play_match

    results = [play_match(load_scenario(name).lasting(time), _SEED) for name, time in _MATCHES.items()]
    # What a result reports besides may grow; this is what happened.
    return [
        (
            one.trace,
            one.outcome,
            one.blue_score,
            one.yellow_score,
            [asdict(team) for team in one.teams.values()],
        )
        for one in results
    ]


def _models() -> object:
    from robobt import load_policy
    from robobt.config.resources import models_folder
    from robobt.models.find import list_models

    answers = []
    for path in list_models(models_folder()):
        policy = load_policy(path)
        inputs = np.random.default_rng(_SEED).normal(size=(20, policy.card.observation.size))
        answers.append((path.stem, policy(inputs).tolist()))
    return answers


def _shots() -> object:
    from robobt.shots import CollectionSettings, collect_shots, read_shots

    with TemporaryDirectory() as folder:
        file = Path(folder) / "shots.csv"
        collect_shots(CollectionSettings(seed=_SEED), file, 6)
        return read_shots(file).to_pydict()


def _learning() -> object:
    import gymnasium

    import robobt.learning  # noqa: F401 - registers the environments

    stepped = []
    for name in ("GoToBall-v0", "ShootTowardsGoal-v0", "ScoreOnGoalkeeper-v0"):
        environment = gymnasium.make(f"robobt/{name}")
        environment.action_space.seed(_SEED)
        environment.reset(seed=_SEED)
        for _ in range(150):
            seen, reward, terminated, truncated, _ = environment.step(environment.action_space.sample())
            stepped.append((np.asarray(seen).tolist(), float(reward), terminated, truncated))
            if terminated or truncated:
                environment.reset()
    return stepped


def _league() -> object:
    from benchmarks.filter import bench_filter
    from robobt import load_scenario

    return bench_filter(load_scenario("three_v_three"), 4.0, _SEED)


def _tournament() -> object:
    from robobt.tournament.ratings import bradley_terry

    rng = np.random.default_rng(_SEED)
    names = ("a", "b", "c", "d")
    met = [(*rng.choice(names, 2, replace=False).tolist(), rng.choice((0.0, 0.5, 1.0))) for _ in range(60)]
    return [asdict(rating) for rating in bradley_terry(names, met).values()]


ROOMS: Mapping[str, tuple[Probe, ...]] = {
    "world": (_world,),
    "tree": (_tree,),
    "motion": (_motion,),
    "sim": (_sim,),
    "skills": (_motion, _matches),
    "plays": (_matches,),
    "match": (_matches,),
    "models": (_models,),
    "shots": (_shots,),
    "learning": (_learning,),
    "league": (_league,),
    "tournament": (_tournament,),
}
"""The probes of each room. Whole matches stand for skills, plays and match together."""


def behaviour(rooms: Iterable[str] = tuple(ROOMS)) -> dict[str, str]:
    """Return a hash of the behaviour of each of ``rooms``, 12 hexadecimal digits.

    Raises:
        KeyError: there is no such room.
    """
    return {room: _hash([probe() for probe in ROOMS[room]]) for room in rooms}


def processor() -> str:
    """Return the machine's properties that affect compiled arithmetic; hashes are compared for equal ones."""
    from llvmlite.binding import get_host_cpu_name

    return (
        f"{platform.system()} {platform.machine()} {get_host_cpu_name()}, Python {platform.python_version()}"
    )


def _hash(result: object) -> str:
    return hashlib.sha256(json.dumps(result, default=str).encode()).hexdigest()[:12]
