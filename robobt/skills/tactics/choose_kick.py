"""Decide what to do with the ball: shoot, pass, or wait."""

from __future__ import annotations

from dataclasses import field, replace
from math import hypot

from robobt.motion.dribbling import MAX_ACCELERATION, carrying_share
from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.base import Skill, skill
from robobt.skills.rate_limit import RateLimit
from robobt.skills.store import Pass, Shot
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.candidates import passes
from robobt.skills.tactics.chances import worth_at
from robobt.tree import Status
from robobt.world.rules import has_ball

_SHOWN_PASSES = 5
"""Number of candidate passes that are shown."""


@skill
class ChooseKick(Skill):
    """Write the best shot to ``shot`` or the best pass to ``pass_``, and None to the other.

    Both are rated by the chance of a goal that follows from them. The thresholds fall while the robot has the
    ball, and an opponent close by ends the waiting. FAILURE while neither is good enough.

    Args:
        shoot_at: chance of a goal from which a shot is taken at once, 0 to 1.
        pass_at: value from which a pass is played at once, 0 to 1.
        patience: time in which both thresholds fall to their floor [s]; less with a weak dribbler.
        floor: share of both thresholds that remains.
        keep: factor on the value of the last choice.
        least: least chance that a pass arrives, 0 to 1.
        every: time between two ratings [s].
        max_distance: no shots from farther than this from the goal [m].
        model: predictor of a shot's scene: a shipped model or a file.
        chips: whether passes may fly over opponents.
        restart: whether an own restart is to be taken; the time then counts from when it may be taken.

    Raises:
        ValueError: a chance, worth or share is not 0 to 1, ``patience`` is not positive, or ``keep``,
            ``every`` or ``max_distance`` is negative.
    """

    reads = ("team",)
    writes = ("team", "shot", "pass_", "candidates")

    shoot_at: float = 0.55
    pass_at: float = 0.35
    patience: float = 1.2
    floor: float = 0.1
    keep: float = 1.6
    least: float = 0.15
    every: float = 0.05
    chips: bool = True
    restart: bool = False
    max_distance: float = 5.0
    model: str = "shot_expected"
    _since: float = field(default=-1.0, init=False)
    _seen: float = field(default=-10.0, init=False)
    _had: float = field(default=-10.0, init=False)
    _shot: Shot | None = field(default=None, init=False)
    _pass: Pass | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        for setting in ("shoot_at", "pass_at", "floor", "least"):
            if not 0.0 <= getattr(self, setting) <= 1.0:
                raise ValueError(f"{setting} must be 0 to 1, not {getattr(self, setting)}")
        if not self.patience > 0.0:
            raise ValueError(f"patience must be positive, not {self.patience}")
        for setting in ("keep", "max_distance"):
            if not getattr(self, setting) >= 0.0:
                raise ValueError(f"{setting} must be 0 or more, not {getattr(self, setting)}")
        self._look = RateLimit(self.every)
        self._rater = ExpectedGoal(model=self.model, threshold=0.6)

    def on_running(self) -> Status:
        """Rate shots and passes."""
        store, frame, me, ball = self.store, self.frame, self.me, self.ball
        plan = agree(frame, store.team)
        tactics = plan.tactics
        has = has_ball(me, ball)
        if has:
            self._had = frame.time
        kept = (
            frame.time - self._had < tactics.kept_for
            and hypot(ball.x - me.x, ball.y - me.y) < tactics.kept_within
        )
        if not self.restart and not kept:
            mine = plan.own_times.get(me.id, 0.0)
            if ball.speed > tactics.run_up_below or mine + tactics.run_up_lead > min(
                plan.their_times.values(), default=10.0
            ):
                return self.fail("it does not have the ball")
        if frame.time - self._seen > tactics.anew_after:
            self._shot = self._pass = None
            self._since = frame.time
        if self.restart and not frame.game.may_touch:
            self._since = frame.time
        self._seen = frame.time
        if self._look.due(frame.time):
            self._choose(has)
        store.shot, store.pass_ = self._shot, self._pass
        plan.next_pass = self._pass
        if self._pass is not None:
            plan.next_pass_time = frame.time
            if self.restart and self._pass.wait > 0.0:
                # A robot that waits at a restart must not touch the ball yet.
                return self.fail(f"{self._pass.receiver} is not there yet")
            return self.succeed(f"pass to {self._pass.receiver}, {self._pass.score:.2f}")
        if self._shot is not None:
            return self.succeed(f"shot, {self._shot.score:.2f}")
        return self.fail("nothing good enough")

    def _choose(self, has: bool) -> None:
        frame, me, ball, team = self.frame, self.me, self.ball, self.store.team
        old_pass, plan, tactics = self._pass, team.plan, team.plan.tactics
        self._shot = self._pass = None
        # A robot that can hardly brake with the ball gains little by waiting.
        patience = self.patience * min(1.0, me.limits.holds_straight / MAX_ACCELERATION)
        falling = 1.0 - (frame.time - self._since) / patience
        share = max(self.floor, falling)
        pressed = has and any(hypot(r.x - ball.x, r.y - ball.y) < tactics.pressed for r in frame.opponents)
        # It soon loses a ball that it keeps among opponents, so that a pass worth less is better than none.
        held = carrying_share(me.limits) if pressed or ball.x < 0.0 else 1.0
        lowest = self.floor * held
        keen = max(lowest, falling)
        if pressed:
            share, keen = min(share, 2.0 * self.floor), min(keen, 2.0 * lowest)
        shot = self._best_shot()
        behind = (ball.x - 1.0, ball.y)
        hold = worth_at(behind, ball.position, tactics.holds, plan.their_movers, plan.numbers)
        enough = min(self.pass_at * keen, tactics.better * hold)
        late = self.restart and frame.time - self._since > self.patience + tactics.late
        least = 0.0 if late else self.least
        candidates = passes(frame, team, me, old_pass, self.keep, least=least, chips=self.chips)
        self.store.candidates = candidates[:_SHOWN_PASSES]
        best = candidates[0] if candidates else None
        shot_score = 0.0 if shot is None else shot.score
        pass_score = 0.0 if best is None else best.score
        if shot_score >= max(self.shoot_at * share, 0.9 * pass_score):
            self._shot = shot
        elif best is not None and (pass_score >= enough or late):
            # Kick no later than the receiver is there, unless an opponent is about to take the ball.
            self._pass = best if best.wait > tactics.in_time and not pressed else replace(best, wait=0.0)
        elif shot_score >= self.shoot_at * share:
            self._shot = shot
        elif late:
            self._pass = self._into_space()

    def _into_space(self) -> Pass:
        """Return a short kick towards the opponents' goal, for any robot that gets there."""
        ball, (x, y) = self.ball, self.frame.field.their_goal
        tactics = self.store.team.plan.tactics
        space = tactics.into_space
        way = max(hypot(x - ball.x, y - ball.y), space)
        target = (ball.x + space / way * (x - ball.x), ball.y + space / way * (y - ball.y))
        return Pass(self.me.id, target, tactics.slowest_pass, 0.0)

    def _best_shot(self) -> Shot | None:
        frame, me, ball, field = self.frame, self.me, self.ball, self.frame.field
        if hypot(field.half_length - ball.x, ball.y) > self.max_distance:
            return None
        watch = self.store.team.shared(GoalkeeperWatch)
        shots, _ = self._rater.judge(frame, ball.position, me, watch=watch)
        return shots[0] if shots else None
