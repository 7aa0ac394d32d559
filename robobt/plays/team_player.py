"""A field player of a team that shares out its tasks: attack, passes, support, marking and the wall."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.penalty_kick import penalty_kick
from robobt.plays.stuck import get_where_stuck
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.aim.shot_is_open import ShotIsOpen
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.kick_loose import KickLoose
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.learned_skill import LearnedSkill
from robobt.skills.ball.let_go import LetGo
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.ball.score import Score
from robobt.skills.ball.settle_ball import SettleBall
from robobt.skills.conditions.ball_in_own_half import BallInOwnHalf
from robobt.skills.conditions.carried_far import CarriedFar
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.defence.avoid_crash import AvoidCrash
from robobt.skills.defence.stay_out import StayOut
from robobt.skills.plan import Omitted
from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.skills.restarts.place_ball import PlaceBall
from robobt.skills.restarts.prepare_restart import PrepareRestart
from robobt.skills.stop import Stop
from robobt.skills.tactics.choose_kick import ChooseKick
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.skills.tactics.take_place import TakePlace
from robobt.skills.tactics.task_switch import TaskSwitch
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.tree import Behaviour, Inverter, Sequence

PASS_TOLERANCE = 0.06
"""Angle by which a pass may be off [rad]."""

CARRIED = 0.9
"""Carried distance after which it releases the ball [m]."""

CARRYING, KEEP_WAY = 1.5, 0.25
"""Speed with the ball [m/s], and how long it keeps its way after the planner proposes another [s]."""

SURE = 0.5
"""Least chance that a pass from a restart arrives; the ball is safe before it."""


OpenPlayTasks = Literal["all", "attack", "near_ball"]
"""Tasks that a model plays in open play."""

NEAR_BALL = 3
"""Number of robots that a model moves with the tasks ``near_ball``."""

WEAKEST = 0.5
"""Share of the dribbler in training with which the team's learned attack still plays."""


@PLAYS.register("team_player")
def team_player(
    *,
    shoot_at: float = 0.55,
    pass_at: float = 0.35,
    patience: float = 1.5,
    chips: bool = True,
    score: str = "score_on_defender_ppo",
    go: str = "",
    open_play: str = "",
    open_play_tasks: OpenPlayTasks = "all",
    without: Omitted = "nothing",
    tactics: TacticsSettings = DEFAULT_TACTICS,
) -> Behaviour:
    """Follow the referee's commands, else do the task in the team's plan.

    Any number of robots may play it, all with the same parameters; the goalkeeper plays ``team_goalkeeper``.
    The team assigns attacker, receivers, wall, markers and supporters in every frame
    (:mod:`robobt.skills.tactics.agree`).

    Args:
        shoot_at: chance of a goal for which a shot is taken at once, 0 to 1.
        pass_at: worth for which a pass is played at once, 0 to 1.
        patience: time in which both thresholds fall to their floor [s].
        chips: whether passes may fly over opponents.
        score: name or file of a model for Score, which plays in the opponents' half while the robot has the
            ball and neither shot nor pass is good enough, and its dribbler is at least half as strong as in
            training; ``without="score"`` for none.
        go: name or file of a model for driving to places among moving robots
            (:class:`~robobt.skills.go_to_pose.GoToPose`); empty for the planner alone.
        open_play: name or file of a model for a task with several robots, which plays while the ball is in
            play and replaces ``score``; empty for the hand-written tasks.
        open_play_tasks: tasks that this model plays: ``all``, which replaces ``go`` too, or with ``attack``
            those of attacker, receivers and supporters; the wall and the markers are then hand-written. With
            ``near_ball`` it moves the three field players that can have the ball first.
        without: a part of the tactics to switch off, for every robot of the team, so that a tournament
            measures its worth.
        tactics: settings of the team's tactics, such as ``{switch_gain: 0.5}``; settings of one robot apply
            to all.
    """

    def choose() -> ChooseKick:
        return ChooseKick(shoot_at=shoot_at, pass_at=pass_at, patience=patience, chips=chips)

    in_play: dict[str, Behaviour] = {} if open_play else {"attack": attack(choose, without, score)}
    if open_play and open_play_tasks == "attack":
        in_play = {task: play_on(open_play, f"{task} by model") for task in ("attack", "receive", "support")}
    elif open_play and open_play_tasks == "near_ball":
        in_play = dict.fromkeys(("attack", "assist"), play_on(open_play))
    player = TaskSwitch(
        "part",
        {
            "halt": Stop(),
            "take_penalty": first_of(
                "our penalty",
                when("wait", Inverter("not yet", MayTouchBall()), PrepareRestart()),
                penalty_kick(),
            ),
            "penalty": GoToPenaltyPosition(),
            "place_ball": PlaceBall(),
            "take_restart": take_restart(shoot_at, pass_at, chips),
            "kickoff": GoToKickoffPosition(spare_mates=True),
            "dead_ball": first_of(
                "ball is dead",
                when("ours", MayTouchBall(), TakePlace()),
                when("keep away", KeepDistance(), TakePlace()),
            ),
            **in_play,
        },
        otherwise=play_on(open_play) if open_play and open_play_tasks == "all" else TakePlace(policy=go),
        without=without,
        tactics=tactics,
        at_ball=NEAR_BALL if open_play and open_play_tasks == "near_ball" else 0,
    )
    return StayOut("team player", player if without == "avoid_crash" else AvoidCrash("no crash", player))


def attack(choose: Callable[[], ChooseKick], without: Omitted = "nothing", score: str = "") -> Behaviour:
    """Get the ball, and shoot, pass or carry it; ``score`` is a model for Score, empty for none."""
    if without == "score":
        score = ""
    options = {
        "let_go": let_go(),
        "kick_loose": KickLoose(),
        "receive": ReceivePass(),
        "settle": SettleBall(),
        "kick": when("kick", choose(), kick()),
        "score": when(
            "score", HasBall(), Inverter("ahead", BallInOwnHalf()), Score(policy=score, weakest=WEAKEST)
        ),
        "draw": when(
            "draw", HasBall(), ShotIsOpen(rater="open_angle", max_distance=4.0), DrawGoalkeeper(patience=1.5)
        ),
        "carry": when(
            "carry",
            HasBall(),
            BestFieldPosition(),
            DribbleTo(max_speed=CARRYING, max_distance=0.6, keep=KEEP_WAY),
        ),
        "get": when("get the ball", GoToBall(), PickUpBall()),
    }
    left_out = {without} if score else {without, "score"}
    return first_of("attack", *(option for name, option in options.items() if name not in left_out))


def play_on(model: str, name: str = "open play") -> Behaviour:
    """Play by a model, which does not observe how far it may still carry the ball; ``name`` is the tree's."""
    return first_of(name, let_go(), get_where_stuck(), LearnedSkill(model=model))


def let_go() -> Behaviour:
    """Release a ball that has been carried as far as is allowed."""
    return when("let go", CarriedFar(limit=CARRIED), LetGo())


def kick() -> KickToTarget:
    """Kick quickly instead of to the last degree."""
    return KickToTarget(take=True, round_ball=True, pass_tolerance=PASS_TOLERANCE)


def take_restart(shoot_at: float, pass_at: float, chips: bool) -> Behaviour:
    """Take an own restart."""

    def choose() -> ChooseKick:
        return ChooseKick(
            shoot_at=shoot_at,
            pass_at=pass_at,
            patience=2.5,
            floor=0.04,
            least=SURE,
            chips=chips,
            restart=True,
        )

    return first_of(
        "restart",
        Sequence(
            "take it",
            memory=True,
            children=[MayTouchBall(), choose(), KickToTarget(pass_tolerance=PASS_TOLERANCE)],
        ),
        when("get ready", first_of("where to", choose(), AimUpfield()), PrepareRestart(stay=True)),
    )
