"""Choose the pass after which the team most likely still has the ball."""

from __future__ import annotations

from dataclasses import field
from math import hypot, inf, pi

import numpy as np

from robobt.skills.base import Skill, skill
from robobt.skills.rate_limit import RateLimit
from robobt.skills.store import Pass
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.keeping import SHORTEST, rate_receptions, worth_of
from robobt.tree import Status
from robobt.world.rules import has_ball

_RUNS_ON = 0.2
"""A pass goes to where its receiver will be after this time; one with farther to go seldom takes it [s]."""

_KICK_DELAY = 0.15
"""Time until the kick of a robot that is turned to its receiver [s]."""

_TACKLE_SPREAD, _TACKLE_MARGIN = 0.2, 0.15
"""How gradually passes count less that come after a tackle, and how soon before one waiting ends [s]."""


@skill
class ChooseSafePass(Skill):
    """Write the safest pass to ``pass_``, and None to ``shot``. FAILURE while none is good enough.

    A pass is worth its chance to arrive times how free its receiver then is. It is kicked only when the robot
    has turned to it, so while the robot has the ball, passes that an opponent may prevent by then count less.
    What is good enough falls with the time that the robot has had the ball; an opponent close by, or one that
    may be there before the kick, ends the waiting.

    Args:
        enough: worth from which a pass is played at once, 0 to 1.
        least: worth below which no pass is played.
        patience: time in which ``enough`` falls to ``least`` [s].
        pressed: distance of an opponent from the ball that ends the waiting [m].
        turn_speed: how fast the robot is assumed to turn with the ball [rad/s].
        every: time between two ratings [s].
        keep: factor on the worth of a pass to the receiver that was chosen last.

    Raises:
        ValueError: ``patience`` or ``turn_speed`` is not positive.
    """

    reads = ("team",)
    writes = ("team", "shot", "pass_")

    enough: float = 0.6
    least: float = 0.05
    patience: float = 1.0
    pressed: float = 0.45
    turn_speed: float = 4.0
    every: float = 0.05
    keep: float = 1.25
    _pass: Pass | None = field(default=None, init=False)
    _since: float = field(default=0.0, init=False)
    _seen: float = field(default=-10.0, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        for setting in ("patience", "turn_speed"):
            if not getattr(self, setting) > 0.0:
                raise ValueError(f"{setting} must be positive, not {getattr(self, setting)}")
        self._look = RateLimit(self.every)

    def on_running(self) -> Status:
        """Rate the passes."""
        frame, store = self.frame, self.store
        plan = agree(frame, store.team)
        if frame.time - self._seen > plan.tactics.anew_after:
            self._pass, self._since = None, frame.time
        self._seen = frame.time
        if self._look.due(frame.time):
            self._choose()
        store.shot, store.pass_ = None, self._pass
        plan.next_pass = self._pass
        if self._pass is None:
            return self.fail("no pass is good enough")
        plan.next_pass_time = frame.time
        return self.succeed(f"pass to {self._pass.receiver}, {self._pass.score:.2f}")

    def _choose(self) -> None:
        frame, me, ball, team = self.frame, self.me, self.ball, self.store.team
        plan, last = team.plan, self._pass
        self._pass = None
        points, owners = [], []
        for mate in frame.teammates(me.id):
            x, y = mate.x + _RUNS_ON * mate.vx, mate.y + _RUNS_ON * mate.vy
            if hypot(x - ball.x, y - ball.y) >= SHORTEST and frame.field.contains(x, y, -0.2):
                points.append((x, y))
                owners.append(mate.id)
        if not points:
            return
        at = np.array(points)
        turn = np.abs((np.arctan2(at[:, 1] - ball.y, at[:, 0] - ball.x) - me.heading + pi) % (2.0 * pi) - pi)
        delays = _KICK_DELAY + turn / self.turn_speed
        rated = rate_receptions(at, ball.x, ball.y, delays, plan.their_movers, plan.numbers)
        rank = worth = worth_of(rated)
        if last is not None:
            rank = rank * np.where(np.array(owners) == last.receiver, self.keep, 1.0)
        held = has_ball(me, ball)
        tackled = min(plan.their_times.values(), default=inf) if held else inf
        if held:
            in_time = (tackled - delays) / _TACKLE_SPREAD
            rank = rank / (1.0 + np.exp(-np.clip(in_time, -30.0, 30.0)))
        else:
            rank = rank * (1.0 - 0.1 * turn / pi)
        best = int(rank.argmax())
        waited = min(1.0, (frame.time - self._since) / self.patience)
        enough = self.least + (self.enough - self.least) * (1.0 - waited)
        near = any(hypot(r.x - ball.x, r.y - ball.y) < self.pressed for r in frame.opponents)
        if held and (near or tackled < delays[best] + _TACKLE_MARGIN):
            enough = self.least
        if worth[best] >= enough:
            self._pass = Pass(owners[best], points[best], float(rated[best, 1]), float(worth[best]), 0.0)
