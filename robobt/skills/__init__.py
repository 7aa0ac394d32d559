"""One leaf behaviour a file, each usable alone: skills that move a robot, and conditions.

Importing this package enters every one of them in :data:`SKILLS`.
"""

from robobt.skills.aim_at_goal_point import AimAtGoalPoint
from robobt.skills.aim_upfield import AimUpfield
from robobt.skills.assign_roles import AssignRoles
from robobt.skills.ball_aimed_at_goal import BallAimedAtGoal
from robobt.skills.ball_at_defense_edge import BallAtDefenseEdge
from robobt.skills.ball_coming import BallComing
from robobt.skills.ball_in_own_defense_area import BallInOwnDefenseArea
from robobt.skills.ball_in_own_half import BallInOwnHalf
from robobt.skills.ball_in_play import BallInPlay
from robobt.skills.ball_is_moving import BallIsMoving
from robobt.skills.ball_rests_in_defense import BallRestsInDefense
from robobt.skills.base import SKILLS, Skill, skill
from robobt.skills.best_field_position import BestFieldPosition
from robobt.skills.block_shot import BlockShot
from robobt.skills.carried_far import CarriedFar
from robobt.skills.challenge_ball import ChallengeBall
from robobt.skills.cover_angle import CoverAngle
from robobt.skills.cover_near_post import CoverNearPost
from robobt.skills.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.dribble_to import DribbleTo
from robobt.skills.face_ball import FaceBall
from robobt.skills.faces_target import FacesTarget
from robobt.skills.fetch_ball import FetchBall
from robobt.skills.go_to_ball import GoToBall
from robobt.skills.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.go_to_pose import GoToPose
from robobt.skills.has_ball import HasBall
from robobt.skills.has_role import HasRole
from robobt.skills.intercept import Intercept
from robobt.skills.is_attacker import IsAttacker
from robobt.skills.is_closest_to_ball import IsClosestToBall
from robobt.skills.is_halted import IsHalted
from robobt.skills.is_restart import IsRestart
from robobt.skills.keep_distance import KeepDistance
from robobt.skills.kick_to_target import KickToTarget
from robobt.skills.learned_skill import LearnedSkill
from robobt.skills.mark_opponent import MarkOpponent
from robobt.skills.mate_aims_at_me import MateAimsAtMe
from robobt.skills.may_touch_ball import MayTouchBall
from robobt.skills.opponent_has_ball import OpponentHasBall
from robobt.skills.pass_is_coming import PassIsComing
from robobt.skills.pass_is_open import PassIsOpen
from robobt.skills.pass_is_steady import PassIsSteady
from robobt.skills.pick_up_ball import PickUpBall
from robobt.skills.prepare_restart import PrepareRestart
from robobt.skills.referee_switch import RefereeSwitch
from robobt.skills.return_to_goal import ReturnToGoal
from robobt.skills.select_clearance import SelectClearance
from robobt.skills.select_pass import SelectPass
from robobt.skills.select_shot import SelectShot
from robobt.skills.select_support_position import SelectSupportPosition
from robobt.skills.shoot import Shoot
from robobt.skills.shot_coming import ShotComing
from robobt.skills.shot_is_open import ShotIsOpen
from robobt.skills.shot_is_steady import ShotIsSteady
from robobt.skills.stop import Stop
from robobt.skills.store import Pass, Shot, Store, TeamStore
from robobt.skills.team_has_ball import TeamHasBall
from robobt.skills.under_pressure import UnderPressure
from robobt.skills.wall import Wall

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
