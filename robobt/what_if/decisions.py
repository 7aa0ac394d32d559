"""The decisions that are tried for a robot with the ball: small trees of existing skills."""

from __future__ import annotations

from dataclasses import dataclass

from robobt.match.players import Player, run_tree
from robobt.plays.base import when
from robobt.plays.team_player import team_player
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.pass_rater import PassRater
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.select_pass import SelectPass
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.tree import Behaviour, Status
from robobt.what_if.standing import standing
from robobt.world.command import RobotCommand
from robobt.world.state import Frame, RobotId, RobotState

_LONGEST_TRY = 1.5
"""Time after which a robot goes on with its own play, if its decision is not carried out by then [s]."""

_CARRIES = 1.0
"""How long a robot carries the ball when it decides to [s]."""

_ANY_PASS = {"min_distance": 0.3, "lane_clearance": 0.0}
"""Passes that are tried: nearly all, because branches show what becomes of them."""


@dataclass(slots=True)
class BallDecision:
    """A decision of one robot: to shoot, pass, carry the ball on, kick it upfield or play as ``team_player``.

    Attributes:
        robot: the robot.
        name: what it does: "shoot", "pass to N", "carry", "clear" or "team_player".
        receiver: number of the receiver of a pass.
    """

    robot: RobotId
    name: str
    receiver: int | None = None

    def tree(self) -> Behaviour:
        """Return a new tree that carries it out."""
        if self.name == "shoot":
            return when("shoot", SelectShot(rater="expected_goal"), KickToTarget(take=True))
        if self.receiver is not None:
            rater = PassRater(receiver=self.receiver, **_ANY_PASS)
            choose = SelectPass(rater=rater, min_score=0.0)
            return when("pass", choose, KickToTarget(take=True, pass_tolerance=0.06))
        if self.name == "carry":
            carry = DribbleTo(max_speed=1.5, max_distance=0.6, keep=0.25)
            return when("carry", HasBall(), BestFieldPosition(), carry)
        if self.name == "team_player":
            return team_player()
        return when("clear", AimUpfield(), KickToTarget(take=True))

    def begin(self, player: Player) -> None:
        """Let a robot carry it out, until it is done, has failed or has taken too long.

        Args:
            player: the robot, which goes on with its own play then.
        """
        longest = _CARRIES if self.name == "carry" else _LONGEST_TRY
        store = player.store
        runner = run_tree(player.robot, self.tree(), store, "stop", player.names)
        started: list[float] = []

        def drive(view: Frame, me: RobotState) -> RobotCommand:
            if not started:
                started.append(view.time)
            store.frame, store.me, store.command = view, me, RobotCommand()
            store.shot = store.pass_ = None
            status = runner.tick()
            if self.receiver is not None and store.pass_ is not None:
                # Team-mates that share out their tasks see the pass coming.
                store.team.plan.next_pass, store.team.plan.next_pass_time = store.pass_, view.time
            if status is not Status.RUNNING or view.time - started[0] > longest:
                player.driver = None
                runner.stop()
                runner.shutdown()
                if status is not Status.SUCCESS:
                    # Its own play decides at this tick already.
                    command = player.decide(view, me)
                    return RobotCommand() if command is None else command
            return store.command

        player.driver = drive


def decisions_of(frame: Frame, robot: RobotId) -> list[BallDecision]:
    """Return the decisions that are tried for a robot with the ball.

    They are a shot, a pass to each team-mate that is not the goalkeeper, to carry the ball on, a kick
    upfield, and to play as ``team_player`` for a while.

    Args:
        frame: the frame, from any side.
        robot: the robot that has the ball.
    """
    view = frame.seen_by(robot.team)
    keeper = view.game.status(robot.team).keeper
    mates = [mate.id for mate in view.teammates(robot.number) if mate.id != keeper]
    passes = [BallDecision(robot, f"pass to {number}", number) for number in mates]
    others = [BallDecision(robot, name) for name in ("carry", "clear", "team_player")]
    return [BallDecision(robot, "shoot"), *passes, *others]


def chances_of(frame: Frame, robot: RobotId, rater: ExpectedGoal) -> dict[str, float]:
    """Return how likely a goal is by decisions of a robot with the ball, as raters see it, by their names.

    For a shot, and for ``team_player``, that is the chance from here once the robot has turned. For a pass it
    is half the receiver's chance from where it gets the ball times the safety of the pass
    (:class:`PassRater`), because passes that are rated higher hardly come to more in branches.

    Args:
        frame: the frame, from any side.
        robot: the robot that has the ball.
        rater: rates shots.
    """
    view = frame.seen_by(robot.team)
    me = view.robot(robot.number)
    assert me is not None, "it has the ball"
    passes = PassRater(shot_rater=rater, shot_weight=1.0, **_ANY_PASS).rate_all(view, me)
    chances = {f"pass to {one.receiver}": 0.5 * one.score for one in passes}
    shot = standing(frame, rater, robot.team)
    return {"shoot": shot, "team_player": shot, **chances}
