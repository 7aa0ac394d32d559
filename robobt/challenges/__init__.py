"""The league's technical challenges, played and scored by its rules."""

from robobt.challenges.ball_placement import BallPlacement as BallPlacement
from robobt.challenges.challenge import CHALLENGES as CHALLENGES
from robobt.challenges.challenge import Challenge as Challenge
from robobt.challenges.challenge import ChallengeAttempt as ChallengeAttempt
from robobt.challenges.challenge import Figures as Figures
from robobt.challenges.challenge import FixedChallenge as FixedChallenge
from robobt.challenges.challenge import Judge as Judge
from robobt.challenges.cooperation import Cooperation as Cooperation
from robobt.challenges.dribbling import GateDribbling as GateDribbling
from robobt.challenges.obstacles import Obstacles as Obstacles
from robobt.challenges.obstacles import ObstaclesUnseen as ObstaclesUnseen
from robobt.challenges.passing import Passing as Passing
