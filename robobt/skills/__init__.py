"""Skills that move a robot, and conditions: one leaf behaviour per file, each usable alone.

Importing this package imports every module below it, so a new skill needs only one new file in a subpackage:
its ``@skill`` decorator adds it to :data:`SKILLS`. The explicit imports below list the shipped skills for
type checkers and editors.
"""

from robobt.skills.aim.aim_at_goal_point import AimAtGoalPoint as AimAtGoalPoint
from robobt.skills.aim.aim_upfield import AimUpfield as AimUpfield
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper as DrawGoalkeeper
from robobt.skills.aim.pass_is_open import PassIsOpen as PassIsOpen
from robobt.skills.aim.pass_is_steady import PassIsSteady as PassIsSteady
from robobt.skills.aim.raters import RATERS as RATERS
from robobt.skills.aim.raters import ExpectedGoal as ExpectedGoal
from robobt.skills.aim.raters import NNFiltered as NNFiltered
from robobt.skills.aim.raters import Rater as Rater
from robobt.skills.aim.raters import ShotRater as ShotRater
from robobt.skills.aim.raters.goal_line import goal_candidates as goal_candidates
from robobt.skills.aim.select_clearance import SelectClearance as SelectClearance
from robobt.skills.aim.select_pass import SelectPass as SelectPass
from robobt.skills.aim.select_shot import SelectShot as SelectShot
from robobt.skills.aim.shot_is_open import ShotIsOpen as ShotIsOpen
from robobt.skills.aim.shot_is_steady import ShotIsSteady as ShotIsSteady
from robobt.skills.ball.dribble_to import DribbleTo as DribbleTo
from robobt.skills.ball.duel import Duel as Duel
from robobt.skills.ball.face_ball import FaceBall as FaceBall
from robobt.skills.ball.fetch_ball import FetchBall as FetchBall
from robobt.skills.ball.go_to_ball import GO_TO_BALL_POLICIES as GO_TO_BALL_POLICIES
from robobt.skills.ball.go_to_ball import HANDOVER_DISTANCE as HANDOVER_DISTANCE
from robobt.skills.ball.go_to_ball import Approach as Approach
from robobt.skills.ball.go_to_ball import GoToBall as GoToBall
from robobt.skills.ball.intercept import Intercept as Intercept
from robobt.skills.ball.kick_loose import KickLoose as KickLoose
from robobt.skills.ball.kick_to_target import KickToTarget as KickToTarget
from robobt.skills.ball.learned_skill import LearnedSkill as LearnedSkill
from robobt.skills.ball.let_go import LetGo as LetGo
from robobt.skills.ball.pick_up_ball import PickUpBall as PickUpBall
from robobt.skills.ball.score import Score as Score
from robobt.skills.ball.settle_ball import SettleBall as SettleBall
from robobt.skills.ball.shoot import SHOOT_POLICIES as SHOOT_POLICIES
from robobt.skills.ball.shoot import Shoot as Shoot
from robobt.skills.base import SKILLS as SKILLS
from robobt.skills.base import Condition as Condition
from robobt.skills.base import Skill as Skill
from robobt.skills.base import skill as skill
from robobt.skills.challenges.aim_at_spot import AimAtSpot as AimAtSpot
from robobt.skills.challenges.carry_along import CarryAlong as CarryAlong
from robobt.skills.challenges.drive_straight import DriveStraight as DriveStraight
from robobt.skills.challenges.has_passed import HasPassed as HasPassed
from robobt.skills.challenges.is_number import IsNumber as IsNumber
from robobt.skills.challenges.mate_has_kicked import MateHasKicked as MateHasKicked
from robobt.skills.challenges.to_and_fro import ToAndFro as ToAndFro
from robobt.skills.conditions.ball_aimed_at_goal import BallAimedAtGoal as BallAimedAtGoal
from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge as BallAtDefenseEdge
from robobt.skills.conditions.ball_coming import BallComing as BallComing
from robobt.skills.conditions.ball_in_own_defense_area import BallInOwnDefenseArea as BallInOwnDefenseArea
from robobt.skills.conditions.ball_in_own_half import BallInOwnHalf as BallInOwnHalf
from robobt.skills.conditions.ball_in_play import BallInPlay as BallInPlay
from robobt.skills.conditions.ball_is_moving import BallIsMoving as BallIsMoving
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense as BallRestsInDefense
from robobt.skills.conditions.carried_far import CarriedFar as CarriedFar
from robobt.skills.conditions.faces_target import FacesTarget as FacesTarget
from robobt.skills.conditions.has_ball import HasBall as HasBall
from robobt.skills.conditions.is_closest_to_ball import IsClosestToBall as IsClosestToBall
from robobt.skills.conditions.is_halted import IsHalted as IsHalted
from robobt.skills.conditions.is_restart import IsRestart as IsRestart
from robobt.skills.conditions.is_second_to_ball import IsSecondToBall as IsSecondToBall
from robobt.skills.conditions.may_touch_ball import MayTouchBall as MayTouchBall
from robobt.skills.conditions.opponent_has_ball import OpponentHasBall as OpponentHasBall
from robobt.skills.conditions.small_team import SmallTeam as SmallTeam
from robobt.skills.conditions.stuck_at_ball import StuckAtBall as StuckAtBall
from robobt.skills.conditions.team_has_ball import TeamHasBall as TeamHasBall
from robobt.skills.conditions.under_pressure import UnderPressure as UnderPressure
from robobt.skills.defence.avoid_crash import AvoidCrash as AvoidCrash
from robobt.skills.defence.block_shot import BlockShot as BlockShot
from robobt.skills.defence.challenge_ball import ChallengeBall as ChallengeBall
from robobt.skills.defence.close_down import CloseDown as CloseDown
from robobt.skills.defence.cover_angle import CoverAngle as CoverAngle
from robobt.skills.defence.cover_near_post import CoverNearPost as CoverNearPost
from robobt.skills.defence.goalkeeper import Goalkeeper as Goalkeeper
from robobt.skills.defence.return_to_goal import ReturnToGoal as ReturnToGoal
from robobt.skills.defence.shot_coming import ShotComing as ShotComing
from robobt.skills.defence.stay_out import StayOut as StayOut
from robobt.skills.defence.wall import Wall as Wall
from robobt.skills.go_to_pose import GoToPose as GoToPose
from robobt.skills.keep_clear import KeepClear as KeepClear
from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition as GoToKickoffPosition
from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition as GoToPenaltyPosition
from robobt.skills.restarts.keep_distance import KeepDistance as KeepDistance
from robobt.skills.restarts.place_ball import PlaceBall as PlaceBall
from robobt.skills.restarts.prepare_restart import PrepareRestart as PrepareRestart
from robobt.skills.restarts.referee_switch import RefereeSwitch as RefereeSwitch
from robobt.skills.robobulls.kick_as_robobulls import KickAsRobobulls as KickAsRobobulls
from robobt.skills.stop import Stop as Stop
from robobt.skills.store import Pass as Pass
from robobt.skills.store import Shot as Shot
from robobt.skills.store import Store as Store
from robobt.skills.store import TeamStore as TeamStore
from robobt.skills.tactics.choose_kick import ChooseKick as ChooseKick
from robobt.skills.tactics.choose_safe_pass import ChooseSafePass as ChooseSafePass
from robobt.skills.tactics.receive_pass import ReceivePass as ReceivePass
from robobt.skills.tactics.show_for_pass import ShowForPass as ShowForPass
from robobt.skills.tactics.take_place import TakePlace as TakePlace
from robobt.skills.tactics.task_switch import TaskSwitch as TaskSwitch
from robobt.skills.team.best_field_position import BestFieldPosition as BestFieldPosition
from robobt.skills.team.mate_aims_at_me import MateAimsAtMe as MateAimsAtMe
from robobt.skills.team.pass_is_coming import PassIsComing as PassIsComing
from robobt.skills.team.select_support_position import SelectSupportPosition as SelectSupportPosition
from robobt.tree.discovery import import_all

import_all(__name__, __path__)

_OF_BASELINES = {"IsAttacker": "is_attacker", "MarkOpponent": "mark_opponent"}


def __getattr__(name: str) -> object:
    if name in _OF_BASELINES:
        place = f"robobt.plays.baselines.{_OF_BASELINES[name]}"
        raise ImportError(f"{name} belongs to the team of November 2026: import it from {place}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
