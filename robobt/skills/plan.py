"""What a team has agreed on in one frame: who does what, and where."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Literal, TypeAlias

import numpy as np

from robobt.motion.ball_watch import BallWatch
from robobt.skills.aims import Pass
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings, applied
from robobt.world.ball_model import BallModel
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import MOVER_SIZE
from robobt.world.state import Frame


class Task(StrEnum):
    """What a field player does."""

    ATTACK = "attack"
    """Goes for the ball, or has it."""
    RECEIVE = "receive"
    """Is to get the pass that the attacker is about to play."""
    WALL = "wall"
    """Covers the goal before the own defence area."""
    MARK = "mark"
    """Keeps an opponent from getting a pass."""
    SUPPORT = "support"
    """Waits where a pass can reach it and is worth something."""


Omitted: TypeAlias = Literal[
    "nothing", "wall", "marks", "short_place", "one_touch", "kick_loose", "score", "draw", "avoid_crash"
]
"""What a team can do without, to see what it is worth.

In this order: robots before the own area, marking, the mate beside the ball of a free kick, shots with one
touch, kicking a held ball loose, the learned attack, drawing the goalkeeper, braking before opponents.
"""


@dataclass(slots=True)
class Plan:
    """The agreement of one team; made anew every frame out of the last one.

    Attributes:
        frame: the frame it was made for.
        players: numbers of the field players that take part.
        without: what the team does without.
        tactics: what it weighs, and how.
        numbers: of :func:`~robobt.skills.tactics_settings.applied`, for the present field and ball.
        tasks: of every player.
        places: where each of them is to stand that has no other aim [m].
        marks: which opponent each marker marks.
        next_pass: the pass that the attacker is about to play, None without one.
        next_pass_time: when it was chosen last [s].
        meant: when each player was last the receiver of that pass, and where [s, m].
        own_times, their_times: when each of the team's and of the opponents' robots can have the ball [s].
        own_movers, their_movers: all robots of either team as :func:`robobt.world.records.movers`, opponents
            with no more speed and acceleration than they are taken to use.
        meetings: when and where each robot can meet the ball, as :func:`robobt.motion.arrival.meetings`.
        attacker_since: since when the attacker is the one it is [s].
        ours: whether the ball counts as the own team's.
        ours_since: since when [s].
        turned: when that last changed [s].
        ahead: whether the ball counts as in the opponents' half.
        support: the places chosen for supporters last, the best first [m].
        support_time: when they were chosen [s].
        short: where a team-mate stands close to the ball of an own restart [m], None without one.
        watch: tells whether the ball slides or rolls.
        rolling: the speed from which on it rolls [m/s].
    """

    frame: Frame | None = None
    players: set[int] = field(default_factory=set)
    without: Omitted = "nothing"
    tactics: TacticsSettings = DEFAULT_TACTICS
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

    def change_tactics(self, given: TacticsSettings) -> None:
        """Weigh by the settings ``given`` from now on; those that are not set stay as they are."""
        if given.model_fields_set:
            changed = {name: getattr(given, name) for name in given.model_fields_set}
            self.tactics = self.tactics.model_copy(update=changed)

    def apply_tactics(self, geometry: FieldGeometry, model: BallModel) -> None:
        """Bring ``numbers`` up to the settings, on this field and with this ball."""
        tactics, (before, field_before, ball_before) = self.tactics, self._applied
        # By identity: to compare all settings in every frame takes longer than what follows from them.
        if before is not tactics or field_before is not geometry or ball_before is not model:
            self.numbers, self._applied = applied(tactics, geometry, model), (tactics, geometry, model)
