"""One leaf behaviour a file, each usable alone: skills that move a robot, and conditions.

Importing this package enters every one of them in :data:`SKILLS`.
"""

from robobt.skills.aim.aim_at_goal_point import AimAtGoalPoint
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.aim.pass_is_open import PassIsOpen
from robobt.skills.aim.pass_is_steady import PassIsSteady
from robobt.skills.aim.select_clearance import SelectClearance
from robobt.skills.aim.select_pass import SelectPass
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.aim.shot_is_open import ShotIsOpen
from robobt.skills.aim.shot_is_steady import ShotIsSteady
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.face_ball import FaceBall
from robobt.skills.ball.fetch_ball import FetchBall
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.intercept import Intercept
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.learned_skill import LearnedSkill
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.ball.shoot import Shoot
from robobt.skills.base import SKILLS, Skill, skill
from robobt.skills.conditions.ball_aimed_at_goal import BallAimedAtGoal
from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge
from robobt.skills.conditions.ball_coming import BallComing
from robobt.skills.conditions.ball_in_own_defense_area import BallInOwnDefenseArea
from robobt.skills.conditions.ball_in_own_half import BallInOwnHalf
from robobt.skills.conditions.ball_in_play import BallInPlay
from robobt.skills.conditions.ball_is_moving import BallIsMoving
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.skills.conditions.carried_far import CarriedFar
from robobt.skills.conditions.faces_target import FacesTarget
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.conditions.is_closest_to_ball import IsClosestToBall
from robobt.skills.conditions.is_halted import IsHalted
from robobt.skills.conditions.is_restart import IsRestart
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.conditions.opponent_has_ball import OpponentHasBall
from robobt.skills.conditions.team_has_ball import TeamHasBall
from robobt.skills.conditions.under_pressure import UnderPressure
from robobt.skills.defence.block_shot import BlockShot
from robobt.skills.defence.challenge_ball import ChallengeBall
from robobt.skills.defence.cover_angle import CoverAngle
from robobt.skills.defence.cover_near_post import CoverNearPost
from robobt.skills.defence.mark_opponent import MarkOpponent
from robobt.skills.defence.return_to_goal import ReturnToGoal
from robobt.skills.defence.shot_coming import ShotComing
from robobt.skills.defence.wall import Wall
from robobt.skills.go_to_pose import GoToPose
from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.skills.restarts.prepare_restart import PrepareRestart
from robobt.skills.restarts.referee_switch import RefereeSwitch
from robobt.skills.stop import Stop
from robobt.skills.store import Pass, Shot, Store, TeamStore
from robobt.skills.team.assign_roles import AssignRoles
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.skills.team.has_role import HasRole
from robobt.skills.team.is_attacker import IsAttacker
from robobt.skills.team.mate_aims_at_me import MateAimsAtMe
from robobt.skills.team.pass_is_coming import PassIsComing
from robobt.skills.team.select_support_position import SelectSupportPosition

__all__ = [
    "SKILLS",
    "AimAtGoalPoint",
    "AimUpfield",
    "AssignRoles",
    "BallAimedAtGoal",
    "BallAtDefenseEdge",
    "BallComing",
    "BallInOwnDefenseArea",
    "BallInOwnHalf",
    "BallInPlay",
    "BallIsMoving",
    "BallRestsInDefense",
    "BestFieldPosition",
    "BlockShot",
    "CarriedFar",
    "ChallengeBall",
    "CoverAngle",
    "CoverNearPost",
    "DrawGoalkeeper",
    "DribbleTo",
    "FaceBall",
    "FacesTarget",
    "FetchBall",
    "GoToBall",
    "GoToKickoffPosition",
    "GoToPenaltyPosition",
    "GoToPose",
    "HasBall",
    "HasRole",
    "Intercept",
    "IsAttacker",
    "IsClosestToBall",
    "IsHalted",
    "IsRestart",
    "KeepDistance",
    "KickToTarget",
    "LearnedSkill",
    "MarkOpponent",
    "MateAimsAtMe",
    "MayTouchBall",
    "OpponentHasBall",
    "Pass",
    "PassIsComing",
    "PassIsOpen",
    "PassIsSteady",
    "PickUpBall",
    "PrepareRestart",
    "RefereeSwitch",
    "ReturnToGoal",
    "SelectClearance",
    "SelectPass",
    "SelectShot",
    "SelectSupportPosition",
    "Shoot",
    "Shot",
    "ShotComing",
    "ShotIsOpen",
    "ShotIsSteady",
    "Skill",
    "Stop",
    "Store",
    "TeamHasBall",
    "TeamStore",
    "UnderPressure",
    "Wall",
    "skill",
]
