"""A team's agreement for one frame: each player's task and place."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Literal, TypeAlias

import numpy as np

from robobt.motion.ball_watch import BallWatch
from robobt.skills.aims import Pass
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings, applied
from robobt.world.ball_model import BallModel
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import MOVER_SIZE
from robobt.world.state import Frame


class Task(StrEnum):
    """The task of a field player."""

    ATTACK = "attack"
    """Goes for the ball, or has it."""
    RECEIVE = "receive"
    """Receives the pass that the attacker is about to play."""
    WALL = "wall"
    """Covers the goal in front of the own defence area."""
    MARK = "mark"
    """Keeps an opponent from getting a pass."""
    SUPPORT = "support"
    """Waits where a pass can reach it and is useful."""
    ASSIST = "assist"
    """Goes for the ball beside the attacker, in a team that sends several robots to it."""


# CPython 3.11 takes forty times as long to find a member in its enumeration as a name of this module.
ATTACK, RECEIVE, MARK, SUPPORT, ASSIST = Task.ATTACK, Task.RECEIVE, Task.MARK, Task.SUPPORT, Task.ASSIST


Omitted: TypeAlias = Literal[
    "nothing", "wall", "marks", "short_place", "one_touch", "kick_loose", "score", "draw", "avoid_crash"
]
"""The parts of the tactics that can be switched off, to measure what each is worth.

In this order: robots before the own area, marking, the mate beside the ball of a free kick, shots with one
touch, kicking a held ball loose, the learned attack, drawing the goalkeeper, braking before opponents.
"""


@dataclass(slots=True)
class TeamPlan:
    """The agreement of one team, updated every frame from the last one.

    Attributes:
        frame: the frame it was made for.
        players: numbers of the field players that take part.
        without: parts of the tactics that are switched off.
        tactics: settings of the team's tactics.
        at_ball: number of robots that go for the ball while it is in play, the attacker among them; 0 for the
            attacker alone, beside the receivers of its passes.
        numbers: result of :func:`~robobt.skills.tactics_settings.applied` for the present field and ball.
        tasks: task of every player.
        places: where each player without another target is to stand [m].
        marks: which opponent each marker marks.
        next_pass: the pass that the attacker is about to play, None without one.
        next_pass_time: when that pass was last chosen [s].
        meant: when and where each player was last the receiver of that pass [s, m].
        own_times, their_times: when each of the team's and of the opponents' robots can have the ball [s].
        own_movers, their_movers: all robots of either team, as :func:`robobt.world.records.movers` returns
            them; opponents with at most the speed and acceleration that the settings assume.
        meetings: when and where each robot can meet the ball, from :func:`robobt.motion.arrival.meetings`.
        attacker_since: time at which the attacker became the attacker [s].
        ours: whether the ball counts as the own team's.
        ours_since: time at which ``ours`` became what it is [s].
        turned: when the team last acted on a change of ``ours`` [s].
        ahead: whether the ball counts as in the opponents' half.
        support: the places last chosen for supporters, the best first [m].
        support_time: when they were chosen [s].
        short: where a team-mate stands close to the ball of an own restart [m], None without one.
        watch: detects whether the ball slides or rolls.
        rolling: speed below which the ball rolls [m/s].
        ways: commands on the ways to ``places``, of :mod:`robobt.skills.tactics.ways`; None until asked for.
    """

    frame: Frame | None = None
    players: set[int] = field(default_factory=set)
    without: Omitted = "nothing"
    tactics: TacticsSettings = DEFAULT_TACTICS
    at_ball: int = 0
    numbers: FloatArray = field(default_factory=lambda: np.empty(0))
    _applied: tuple[object, ...] = (None, None, None)
    tasks: dict[int, Task] = field(default_factory=dict)
    places: dict[int, Point] = field(default_factory=dict)
    marks: dict[int, int] = field(default_factory=dict)
    next_pass: Pass | None = None
    next_pass_time: float = -1.0
    meant: dict[int, tuple[float, Point]] = field(default_factory=dict)
    own_times: dict[int, float] = field(default_factory=dict)
    their_times: dict[int, float] = field(default_factory=dict)
    own_movers: FloatArray = field(default_factory=lambda: np.empty((0, MOVER_SIZE)))
    their_movers: FloatArray = field(default_factory=lambda: np.empty((0, MOVER_SIZE)))
    meetings: FloatArray = field(default_factory=lambda: np.empty((0, 3)))
    attacker_since: float = -10.0
    ours: bool = False
    ours_since: float = 0.0
    turned: float = -1.0
    ahead: bool = False
    support: list[Point] = field(default_factory=list)
    support_time: float = -1.0
    short: Point | None = None
    watch: BallWatch = field(default_factory=BallWatch)
    rolling: float = 0.0
    ways: dict[int, RobotCommand] | None = None

    def change_tactics(self, given: TacticsSettings) -> None:
        """Use the settings ``given`` from now on; settings that are not given stay unchanged."""
        if given.model_fields_set:
            changed = {name: getattr(given, name) for name in given.model_fields_set}
            self.tactics = self.tactics.model_copy(update=changed)

    def apply_tactics(self, geometry: FieldGeometry, model: BallModel) -> None:
        """Recompute ``numbers`` for the settings, field and ball."""
        tactics, (before, field_before, ball_before) = self.tactics, self._applied
        # Compared by identity: comparing all settings in every frame takes longer than recomputing the
        # numbers.
        if before is not tactics or field_before is not geometry or ball_before is not model:
            self.numbers, self._applied = applied(tactics, geometry, model), (tactics, geometry, model)
