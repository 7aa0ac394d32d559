from robobt.config.errors import RobobtError as RobobtError
from robobt.match import MatchResult as MatchResult
from robobt.match import Run as Run
from robobt.match import Scenario as Scenario
from robobt.match import ScenarioError as ScenarioError
from robobt.match import Summary as Summary
from robobt.match import load_scenario as load_scenario
from robobt.models.policy import load_policy as load_policy
from robobt.plays import PLAYS as PLAYS
from robobt.world import BallState as BallState
from robobt.world import Frame as Frame
from robobt.world import RobotCommand as RobotCommand
from robobt.world import RobotState as RobotState
from robobt.world import World as World
from robobt.worlds import Match as Match
from robobt.worlds import play_match as play_match
from robobt.worlds import run_trials as run_trials
from robobt.worlds import sim_world as sim_world
from robobt.worlds import world_from as world_from

__version__: str
