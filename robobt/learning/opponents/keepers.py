"""Goalkeepers of several kinds over many arenas, for attackers to be trained against and evaluated on.

Four kinds are a few lines each and differ in what they watch. Two are for evaluations: "shipped" is the play
``goalkeeper``, "fitted" the play ``fitted_goalkeeper`` with the traits of those that the paper's real shots
met (:mod:`robobt.learning.opponents.goalkeepers`).
"""

from __future__ import annotations

from functools import partial
from math import atan2, cos, hypot, sin, sqrt, tan
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.goalkeepers import CLEAR, FETCH, FittedGoalkeepers, Goalkeepers
from robobt.world.compiled import compiled, numbers_dtype, numbers_of
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.rules import in_area
from robobt.world.state import ROBOT_RADIUS

if TYPE_CHECKING:
    from robobt.shots.keepers.population import Population

KINDS = ("line", "angle", "aim", "rush", "shipped", "fitted")
"""What a goalkeeper does until a shot comes, onto whose line all of them drive.

``line`` stays level with the ball, ``angle`` between ball and goal; ``aim`` does so too, but while the
attacker's heading leads into the goal goes where it crosses its line; ``rush`` comes out to a near ball.
"""

_LINE, _ANGLE, _AIM, _RUSH, SHIPPED, FITTED = range(6)
TRAITS = ("keeper_kind", "keeper_speed", "keeper_out")
"""What makes a goalkeeper: index of its kind, top speed [m/s], how far before its line it stands [m].

The last says nothing of ``shipped`` and ``fitted``, which have places of their own."""

_FIELD = numbers_dtype(FieldGeometry)
_SHOT = 1.0
"""A ball this fast towards the goal is a shot [m/s]."""
_BESIDE = 0.1
"""How far beside the posts a shot still counts [m]."""
_NEAR = 3.0
"""From this distance of the ball on, ``rush`` comes out [m]."""
_FARTHEST = 0.9
"""It comes so far, which is inside the defence area [m]."""
_REST = 0.1
"""A ball slower than this rests [m/s]."""
_LOOK, _TURN = 6.0, 6.0
"""How fast they turn for each radian [1/s], and at most [rad/s]."""


class Keepers:
    """A goalkeeper in each of ``n`` arenas, the second robot there; it defends the goal at +x.

    Args:
        field: dimensions.
        limits: what the goalkeepers can do.
        period: control period [s].
        n: number of arenas.

    Attributes:
        kept: (n,) whether the ball rests where it is the goalkeeper's to fetch.
    """

    def __init__(self, field: FieldGeometry, limits: RobotLimits, period: float, n: int) -> None:
        self.kept: NDArray[np.bool_] = np.zeros(n, dtype=np.bool_)
        self._field = numbers_of(field)
        self._braking = min(limits.braking, limits.lateral_braking)
        self._period = period
        self._top = limits.max_speed
        self._traits = np.zeros((n, len(TRAITS)))
        self._shipped = Goalkeepers(field, limits, period, n)
        self._fitted: FittedGoalkeepers | None = None
        self._new_fitted = partial(_real, field, limits, period, n)
        self._theirs = np.zeros((n, 6))

    def restart(self, which: NDArray[np.int64], traits: FloatArray) -> None:
        """Begin anew in the arenas ``which``, with goalkeepers of these ``traits`` (m, 3), :data:`TRAITS`."""
        self._traits[which] = traits
        self.kept[which] = False
        shipped, fitted = traits[:, 0] == SHIPPED, traits[:, 0] == FITTED
        self._shipped.restart(which[shipped], traits[shipped, 1] / self._top)
        if fitted.any():
            self._fitted = self._fitted or self._new_fitted()
            self._fitted.restart(which[fitted], traits[fitted, 1])

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick; arguments as for :meth:`Goalkeepers.decide`, which this fills likewise."""
        _decide(
            self._field,
            self._braking,
            self._period,
            self._traits,
            robots,
            balls,
            contact,
            commands,
            self.kept,
        )
        for kind, play in ((SHIPPED, self._shipped), (FITTED, self._fitted)):
            these = self._traits[:, 0] == kind
            if play is not None and these.any():
                play.decide(robots, balls, contact, 1, self._theirs)
                commands[these, :6] = self._theirs[these]
                self.kept[these] |= np.isin(play.cases[these], (FETCH, CLEAR))


def _real(field: FieldGeometry, limits: RobotLimits, period: float, n: int) -> FittedGoalkeepers:
    real = real_population()
    return FittedGoalkeepers(field, limits, period, n, real.acceleration, real.braking, real.delay)


def real_population() -> Population:
    """Return the goalkeepers that the paper's real shots met.

    Raises:
        MissingExtraError: the extra "shots" is not installed.
    """
    from robobt.shots.keepers.population import REAL, read_population

    return read_population(REAL)


@compiled
def _decide(
    field_: FloatArray,
    braking: float,
    period: float,
    traits: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    contact: NDArray[np.bool_],
    commands: FloatArray,
    kept: NDArray[np.bool_],
) -> None:
    field: FieldGeometry = field_.view(_FIELD)[0]
    goal_x, half_goal = field.length / 2, field.goal_width / 2
    for i in range(len(balls)):
        me, ball = robots[i, 1], balls[i]
        near = in_area(ball[0], ball[1], goal_x, field.defense_depth, field.defense_width, ROBOT_RADIUS)
        kept[i] = near and not contact[i, 0] and hypot(ball[2], ball[3]) < _REST
        x, y = _place(int(traits[i, 0]), traits[i, 2], robots[i, 0], me, ball, goal_x, half_goal)
        dx, dy = x - me[0], y - me[1]
        way = hypot(dx, dy)
        # As fast as it may be to stop there.
        speed = min(traits[i, 1], sqrt(2.0 * 0.8 * braking * way), way / period)
        vx, vy = (speed * dx / way, speed * dy / way) if way > 0.0 else (0.0, 0.0)
        c, s = cos(me[2]), sin(me[2])
        command = commands[i]
        command[:] = 0.0
        command[0], command[1] = c * vx + s * vy, c * vy - s * vx
        turn = _LOOK * wrap_angle(atan2(ball[1] - me[1], ball[0] - me[0]) - me[2])
        command[2] = min(max(turn, -_TURN), _TURN)
        command[5] = 1.0


@compiled
def _place(
    kind: int,
    out: float,
    attacker: FloatArray,
    me: FloatArray,
    ball: FloatArray,
    goal_x: float,
    half_goal: float,
) -> tuple[float, float]:
    """Return where a goalkeeper drives now."""
    line = goal_x - out
    if ball[2] > _SHOT and not _pointed_by(attacker, ball):
        crosses = ball[1] + (goal_x - ball[0]) * ball[3] / ball[2]
        if abs(crosses) < half_goal + _BESIDE and ball[0] < goal_x:
            # The nearest point on the shot's line, not behind the goal's.
            fast = hypot(ball[2], ball[3])
            ux, uy = ball[2] / fast, ball[3] / fast
            along = max((me[0] - ball[0]) * ux + (me[1] - ball[1]) * uy, 0.0)
            x = min(ball[0] + along * ux, goal_x - ROBOT_RADIUS)
            return x, ball[1] + (x - ball[0]) * uy / ux
    if kind == _LINE:
        return line, min(max(ball[1], -half_goal), half_goal)
    if kind == _AIM and cos(attacker[2]) > 0.1:
        slope = tan(attacker[2])
        if abs(ball[1] + (goal_x - ball[0]) * slope) < half_goal:
            return line, ball[1] + (line - ball[0]) * slope
    dx, dy = ball[0] - goal_x, ball[1]
    far = max(hypot(dx, dy), 1e-6)
    if kind == _RUSH:
        out += max(min(_FARTHEST, far - 1.0) - out, 0.0) if far < _NEAR else 0.0
    return goal_x + min(out * dx / far, -ROBOT_RADIUS), out * dy / far


@compiled
def _pointed_by(attacker: FloatArray, ball: FloatArray) -> bool:
    """Return whether the attacker still drives the ball: nothing has been shot yet."""
    near = hypot(ball[0] - attacker[0], ball[1] - attacker[1]) < 2.0 * ROBOT_RADIUS
    return near and hypot(ball[2] - attacker[3], ball[3] - attacker[4]) < _SHOT
