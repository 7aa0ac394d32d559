"""The compiled field players stand where the skills that they are called after stand."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from robobt.learning.opponents.field_players import FieldPlayers
from robobt.plays.baselines.agreement import Agreement
from robobt.plays.baselines.mark_opponent import MarkOpponent
from robobt.sim.records import COMMAND, size
from robobt.skills import Wall
from robobt.skills.base import Skill
from robobt.testing.frames import HELD
from robobt.tree import Behaviour
from robobt.world import RobotLimits
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.state import BallState, Frame, RobotState
from tests.skills.fixed_world import Alone

SIDE = 3
AGE = 1000.0
"""A control period in which a robot drives as far as its target, however slowly [s]."""


def scenes(n: int) -> tuple[FloatArray, FloatArray, np.ndarray]:
    """Two teams of three anywhere, and the ball, in half of the scenes in a mouth of the second team."""
    rng = np.random.default_rng(12)
    robots = np.zeros((n, 2 * SIDE, 6))
    robots[..., 0], robots[..., 1] = rng.uniform(-4.0, 4.0, (2, n, 2 * SIDE)) * [[[1.0]], [[0.7]]]
    robots[..., 2] = rng.uniform(-pi, pi, (n, 2 * SIDE))
    balls = np.zeros((n, 4))
    balls[:, 0], balls[:, 1] = rng.uniform(-4.4, 4.4, n), rng.uniform(-2.9, 2.9, n)
    contact = np.zeros((n, 2 * SIDE), dtype=np.bool_)
    contact[::2, SIDE] = True
    holder = robots[::2, SIDE]
    balls[::2, 0] = holder[:, 0] + HELD * np.cos(holder[:, 2])
    balls[::2, 1] = holder[:, 1] + HELD * np.sin(holder[:, 2])
    return robots, balls, contact


def frame_of(robots: FloatArray, ball: FloatArray, contact: np.ndarray, team: Team) -> Frame:
    """What a team sees of a scene, attacking towards +x; robots are numbered from 0 in either team."""
    sign = 1.0 if team is Team.BLUE else -1.0
    seen = [
        RobotState(
            k % SIDE,
            sign * x,
            sign * y,
            heading if sign > 0 else heading - pi,
            0.0,
            0.0,
            0.0,
            bool(contact[k]),
        )
        for k, (x, y, heading) in enumerate(robots[:, :3].tolist())
    ]
    first, second = tuple(seen[:SIDE]), tuple(seen[SIDE:])
    own, others = (first, second) if team is Team.BLUE else (second, first)
    return Frame(0.0, DIVISION_B, BallState(*(sign * ball).tolist()), own, others, team)


def targets(
    skills: list[Behaviour], frame: Frame, monkeypatch: pytest.MonkeyPatch
) -> list[tuple[float, float] | None]:
    """Where the skills, of the robots 0, 1, ... of a team, drive to; None where one does not."""
    found: dict[int, tuple[float, float]] = {}
    monkeypatch.setattr(
        Skill, "drive_to", lambda skill, target, *_, **__: found.__setitem__(skill.me.id, tuple(target))
    )
    alone = [Alone(skill) for skill in skills]
    for one in alone:
        one.store.team = alone[0].store.team
    # All have asked to mark before, and nobody marks anybody yet.
    alone[0].store.team.shared(Agreement).markers.update(range(len(skills)))
    for number, one in enumerate(alone):
        one.tick(frame, number)
    return [found.get(number) for number in range(len(skills))]


@pytest.mark.parametrize("role", ["wall", "mark"])
@pytest.mark.parametrize("team", Team)
def test_they_stand_where_the_skill_stands(role: str, team: Team, monkeypatch: pytest.MonkeyPatch) -> None:
    n, first = 60, 0 if team is Team.BLUE else SIDE
    robots, balls, contact = scenes(n)
    roles = [role if first <= k < first + SIDE else "learner" for k in range(2 * SIDE)]
    players = FieldPlayers(DIVISION_B, RobotLimits(), AGE, roles, SIDE)
    commands = np.zeros((n, 2 * SIDE, size(COMMAND)))
    players.decide(robots, balls, contact, commands)
    c, s = np.cos(robots[..., 2]), np.sin(robots[..., 2])
    vx, vy = commands[..., 0], commands[..., 1]
    stands = robots[..., :2] + AGE * np.stack((c * vx - s * vy, s * vx + c * vy), axis=-1)
    sign, compared = 1.0 if team is Team.BLUE else -1.0, 0
    for i in range(n):
        skills = [Wall(place=k, size=SIDE) if role == "wall" else MarkOpponent() for k in range(SIDE)]
        expected = targets(skills, frame_of(robots[i], balls[i], contact[i], team), monkeypatch)
        for k, target in enumerate(expected, first):
            # A marker for whom nobody is left stays.
            place = robots[i, k, :2] if target is None else sign * np.array(target)
            np.testing.assert_allclose(stands[i, k], place, atol=1e-9)
            compared += target is not None
    assert compared > n
