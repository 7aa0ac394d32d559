"""Goalkeepers of several kinds over many arenas, for attackers to be trained against and evaluated on.

Four simple kinds differ in what they follow. Two kinds are for evaluations: "shipped" is the play
``goalkeeper``, "fitted" the play ``fitted_goalkeeper`` with the traits of the goalkeepers in the paper's real
shots (:mod:`robobt.learning.opponents.goalkeepers`).
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from functools import partial
from math import cos, hypot, inf, tan
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.goalkeeper_cases import Case
from robobt.learning.opponents.goalkeepers import FittedGoalkeepers, Goalkeepers
from robobt.learning.opponents.sides import FIELD_GEOMETRY, Arenas, see_ball, see_robot
from robobt.learning.opponents.straight import DRIVING_LIMITS, TURN, DrivingLimits, drive_of, drive_straight
from robobt.sim.records import COMMAND, Command, size
from robobt.world.compiled import compilable, compiled_lean, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.limits import RobotLimits
from robobt.world.records import BALL, ROBOT, ROBOT_SIZE, Ball, Robot
from robobt.world.rules import in_area
from robobt.world.state import ROBOT_RADIUS

if TYPE_CHECKING:
    from robobt.shots.keepers.population import Population


class Kind(IntEnum):
    """A goalkeeper's behaviour until a shot comes; then all kinds drive onto its line.

    ``line`` stays level with the ball, ``angle`` between ball and goal; ``aim`` does the same, but goes where
    the attacker's heading crosses the goal line if that is between the posts; ``rush`` comes out to a near
    ball.
    """

    LINE = 0
    ANGLE = 1
    AIM = 2
    RUSH = 3
    SHIPPED = 4
    FITTED = 5


GOALKEEPER_KINDS = tuple(kind.name.lower() for kind in Kind)
"""The kinds as settings name them."""


class Keeper(Protocol):
    """The traits of a goalkeeper.

    Attributes:
        keeper_kind: of :class:`Kind`.
        keeper_speed: top speed [m/s].
        keeper_out: distance in front of the goal line [m]; not used by ``shipped`` and ``fitted``.
    """

    keeper_kind: float
    keeper_speed: float
    keeper_out: float


KEEPER = record_dtype(Keeper)
GOALKEEPER_TRAITS = KEEPER.names or ()
_INCOMING_SHOT_SPEED = 1.0
"""A ball this fast towards the goal is a shot [m/s]."""
_BESIDE_POSTS = 0.1
"""How far beside the posts a shot still counts [m]."""
_RUSHING_DISTANCE = 3.0
"""Distance of the ball below which ``rush`` comes out [m]."""
_FARTHEST_RUSH = 0.9
"""How far it comes out, which is inside the defence area [m]."""
_KEPT_BALL_SPEED = 0.1
"""A ball slower than this rests [m/s]."""


class Keepers:
    """The robot ``index`` of each of ``n`` arenas as a goalkeeper, which considers one opponent only.

    That is the one nearest to the ball.

    Args:
        field: dimensions.
        limits: what the goalkeepers can do.
        period: control period [s].
        n: number of arenas.
        index: of the robot.
        blue: number of blue robots, the first ones, whose goal is at -x.

    Attributes:
        index: of the robot.
        kept: (n,) whether the ball rests where the goalkeeper may fetch it.
    """

    def __init__(
        self, field: FieldGeometry, limits: RobotLimits, period: float, n: int, index: int = 1, blue: int = 1
    ) -> None:
        self.index = index
        self.kept: NDArray[np.bool_] = np.zeros(n, dtype=np.bool_)
        self._blue = blue
        self._field = numbers_of(field)
        self._drive = drive_of(limits, period)
        self._top = limits.max_speed
        self._traits = np.zeros((n, len(GOALKEEPER_TRAITS)))
        self._shipped = Goalkeepers(field, limits, period, n)
        self._fitted: FittedGoalkeepers | None = None
        self._new_fitted = partial(_real, field, limits, period, n)
        self._theirs = np.zeros((n, size(COMMAND)))
        # The plays in use, and in which arenas.
        self._played: list[tuple[Goalkeepers, NDArray[np.bool_]]] = []
        # Opponent, goalkeeper, ball and its holder, turned so that the goalkeeper's goal is at +x.
        self._pairs, self._balls = np.zeros((n, 2, ROBOT_SIZE)), np.zeros((n, size(BALL)))
        self._holds: NDArray[np.bool_] = np.zeros((n, 2), dtype=np.bool_)

    def restart(self, which: NDArray[np.int64], traits: FloatArray) -> None:
        """Reset the arenas ``which``, with goalkeepers of ``traits`` (m, 3), :class:`Keeper`."""
        self._traits[which] = traits
        self.kept[which] = False
        kind, speed, _ = traits.T
        shipped, fitted = kind == Kind.SHIPPED, kind == Kind.FITTED
        self._shipped.restart(which[shipped], speed[shipped] / self._top)
        if fitted.any():
            self._fitted = self._fitted or self._new_fitted()
            self._fitted.restart(which[fitted], speed[fitted])
        kinds = self._traits.view(KEEPER)["keeper_kind"][:, 0]
        plays = ((Kind.SHIPPED, self._shipped), (Kind.FITTED, self._fitted))
        self._played = [
            (play, these) for each, play in plays if play is not None and (these := kinds == each).any()
        ]

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick: fill in its commands among those of all robots (n, R, size(COMMAND))."""
        arenas, seen = (robots, balls, contact), (self._pairs, self._balls, self._holds)
        who = (self.index, self._blue)
        _decide(self._field, self._drive, self._traits, who, arenas, seen, commands, self.kept)
        for play, these in self._played:
            play.decide(*seen, 1, self._theirs)
            commands[these, self.index] = self._theirs[these]
            self.kept[these] |= np.isin(play.cases[these], (Case.FETCH, Case.CLEAR))


def _real(field: FieldGeometry, limits: RobotLimits, period: float, n: int) -> FittedGoalkeepers:
    real = real_population()
    return FittedGoalkeepers(field, limits, period, n, real.acceleration, real.braking, real.delay)


def real_population() -> Population:
    """Return the goalkeepers fitted to the paper's real shots.

    Raises:
        MissingExtraError: the extra "shots" is not installed.
    """
    from robobt.shots.keepers.population import REAL, read_population

    return read_population(REAL)


@compiled_lean
def _decide(
    field_: FloatArray,
    drive_: FloatArray,
    traits: FloatArray,
    who: tuple[int, int],
    arenas: Arenas,
    seen: Arenas,
    commands: FloatArray,
    kept: NDArray[np.bool_],
) -> None:
    field: FieldGeometry = field_.view(FIELD_GEOMETRY)[0]
    drive: DrivingLimits = drive_.view(DRIVING_LIMITS)[0]
    (index, blue), (robots_, balls_, contact), (pairs_, turned_, holds) = who, arenas, seen
    robots, balls = robots_.view(ROBOT)[..., 0], balls_.view(BALL)[:, 0]
    pairs, turned = pairs_.view(ROBOT)[..., 0], turned_.view(BALL)[:, 0]
    keepers, orders = traits.view(KEEPER)[:, 0], commands.view(COMMAND)[..., 0]
    # To where its goal is at +x.
    sign = -1.0 if index < blue else 1.0
    for i in range(len(balls)):
        nearest = _nearest(robots[i], balls[i], index, blue)
        see_ball(balls[i], sign, turned[i])
        for row in range(2):
            one = index if row else nearest
            see_robot(robots[i, one], sign, pairs[i, row])
            holds[i, row] = contact[i, one]
        attacker, me, ball, keeper = pairs[i, 0], pairs[i, 1], turned[i], keepers[i]
        near = in_area(
            ball.x, ball.y, field.length / 2, field.defense_depth, field.defense_width, ROBOT_RADIUS
        )
        kept[i] = near and not holds[i, 0] and hypot(ball.vx, ball.vy) < _KEPT_BALL_SPEED
        place = _place(keeper, attacker, me, ball, field.length / 2, field.goal_width / 2)
        commands[i, index] = 0.0
        command: Command = orders[i, index]
        command.vx, command.vy, command.omega = drive_straight(
            me, place, (ball.x, ball.y), keeper.keeper_speed, TURN, drive
        )
        command.dribbler = 1.0


@compilable
def _nearest(robots: Sequence[Robot], ball: Ball, index: int, blue: int) -> int:
    """Return the opponent of the robot ``index`` that is nearest to the ball."""
    best, nearest = inf, 0
    for r in range(len(robots)):
        far = hypot(robots[r].x - ball.x, robots[r].y - ball.y)
        if (r < blue) != (index < blue) and far < best:
            best, nearest = far, r
    return nearest


@compiled_lean
def _place(keeper: Keeper, attacker: Robot, me: Robot, ball: Ball, goal_x: float, half_goal: float) -> Point:
    """Return where a goalkeeper drives now."""
    kind, out = int(keeper.keeper_kind), keeper.keeper_out
    line = goal_x - out
    if ball.vx > _INCOMING_SHOT_SPEED and not _pointed_by(attacker, ball):
        crosses = ball.y + (goal_x - ball.x) * ball.vy / ball.vx
        if abs(crosses) < half_goal + _BESIDE_POSTS and ball.x < goal_x:
            # The nearest point on the shot's line, not behind the goal line.
            fast = hypot(ball.vx, ball.vy)
            ux, uy = ball.vx / fast, ball.vy / fast
            along = max((me.x - ball.x) * ux + (me.y - ball.y) * uy, 0.0)
            x = min(ball.x + along * ux, goal_x - ROBOT_RADIUS)
            return x, ball.y + (x - ball.x) * uy / ux
    if kind == Kind.LINE:
        return line, min(max(ball.y, -half_goal), half_goal)
    if kind == Kind.AIM and cos(attacker.heading) > 0.1:
        slope = tan(attacker.heading)
        if abs(ball.y + (goal_x - ball.x) * slope) < half_goal:
            return line, ball.y + (line - ball.x) * slope
    dx, dy = ball.x - goal_x, ball.y
    far = max(hypot(dx, dy), 1e-6)
    if kind == Kind.RUSH:
        out += max(min(_FARTHEST_RUSH, far - 1.0) - out, 0.0) if far < _RUSHING_DISTANCE else 0.0
    return goal_x + min(out * dx / far, -ROBOT_RADIUS), out * dy / far


@compiled_lean
def _pointed_by(attacker: Robot, ball: Ball) -> bool:
    """Return whether the attacker still has the ball, so that it has not shot yet."""
    near = hypot(ball.x - attacker.x, ball.y - attacker.y) < 2.0 * ROBOT_RADIUS
    return near and hypot(ball.vx - attacker.vx, ball.vy - attacker.vy) < _INCOMING_SHOT_SPEED
