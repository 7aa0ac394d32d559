"""The state that the leaves of one robot's tree share: plain typed attributes, nothing process-wide."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeVar

from robobt.skills.aims import GoalLine as GoalLine
from robobt.skills.aims import Pass as Pass
from robobt.skills.aims import Shot as Shot
from robobt.skills.plan import TeamPlan
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point
from robobt.world.sketch import Sketch
from robobt.world.state import Frame, RobotState

T = TypeVar("T")


@dataclass(slots=True)
class TeamStore:
    """The state that the robots of one team share.

    Attributes:
        passer, receiver: numbers of the robots of the current pass, None without one.
        pass_target: where that pass goes [m].
        pass_time: when it was kicked [s].
        attackers: numbers of the robots that may go for the ball.
        attacker: who goes for the ball now.
        marks: the opponent that each marking robot marks.
        threats: numbers of the opponents without the ball that could score soon, the most dangerous first.
        meeting: where the attacker is to meet a rolling ball [m], None without one.
        kicker: number of the robot that took the last restart and may not touch the ball again yet.
        restart_pending: whether a restart of the own team is still to be taken.
        followed: the frame for which ``kicker`` was updated.
        plan: the agreement of the robots that play ``team_player``.
        kept: objects that other plays share, by type; see :meth:`shared`.
    """

    passer: int | None = None
    receiver: int | None = None
    pass_target: Point | None = None
    pass_time: float = 0.0
    attackers: set[int] = field(default_factory=set)
    attacker: int | None = None
    marks: dict[int, int] = field(default_factory=dict)
    threats: list[int] = field(default_factory=list)
    meeting: Point | None = None
    kicker: int | None = None
    restart_pending: bool = False
    followed: Frame | None = None
    plan: TeamPlan = field(default_factory=TeamPlan)
    kept: dict[type, Any] = field(default_factory=dict)

    def shared(self, kind: type[T]) -> T:
        """Return the team's only object of this ``kind``, built without arguments at the first call."""
        found: T | None = self.kept.get(kind)
        if found is None:
            found = self.kept[kind] = kind()
        return found


@dataclass(slots=True)
class Store:
    """The store of one robot.

    ``frame``, ``me`` and a fresh ``command`` (stand still) are set before every
    tick; the leaves fill in the rest and decide the command.

    Attributes:
        frame: what is on the field, from the own team's side.
        me: the robot this tree moves.
        command: what is sent to it after the tick.
        team: what the team shares.
        target: where a skill wants the robot or the ball to go [m].
        shot: the shot selected last, None without one.
        goal_line: the goal line as the rater judged it then; None if the rater does not judge every point.
        pass_: the pass selected last, None without one.
        candidates: the passes compared last, the best first.
        draw: takes what skills draw on the field.
    """

    frame: Frame
    me: RobotState
    command: RobotCommand = field(default_factory=RobotCommand)
    team: TeamStore = field(default_factory=TeamStore)
    target: Point | None = None
    shot: Shot | None = None
    goal_line: GoalLine | None = None
    pass_: Pass | None = None
    candidates: list[Pass] = field(default_factory=list)
    draw: Sketch = field(default_factory=Sketch, compare=False, repr=False)

    @property
    def time(self) -> float:
        """The frame's time: the only clock a tree has [s]."""
        return self.frame.time


GIVEN = ("frame", "me", "command", "team", "draw", "time")
"""The entries of a :class:`Store` that are set without any leaf."""
