"""Plays: registered functions that return a tree of skills.

Importing this package registers all shipped plays in :data:`PLAYS`.
"""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily
from robobt.plays.any_number_player import any_number_player as any_number_player
from robobt.plays.attack_expected import attack_expected as attack_expected
from robobt.plays.attack_learned import attack_learned as attack_learned
from robobt.plays.attack_main import attack_main as attack_main
from robobt.plays.attack_nn import attack_nn as attack_nn
from robobt.plays.attack_support import attack_support as attack_support
from robobt.plays.base import PLAYS as PLAYS
from robobt.plays.base import Play as Play
from robobt.plays.base import first_of as first_of
from robobt.plays.base import play as play
from robobt.plays.base import when as when
from robobt.plays.baselines.team_2026_11 import defender as defender
from robobt.plays.baselines.team_2026_11 import defender_2026_11 as defender_2026_11
from robobt.plays.baselines.team_2026_11 import field_player as field_player
from robobt.plays.baselines.team_2026_11 import field_player_2026_11 as field_player_2026_11
from robobt.plays.baselines.team_2026_11 import goalkeeper_2026_11 as goalkeeper_2026_11
from robobt.plays.challenges.carry_to_spot import carry_to_spot as carry_to_spot
from robobt.plays.challenges.gate_run import gate_run as gate_run
from robobt.plays.challenges.obstacle_run import obstacle_run as obstacle_run
from robobt.plays.challenges.pass_and_score import pass_and_score as pass_and_score
from robobt.plays.challenges.pass_player import pass_player as pass_player
from robobt.plays.go_to_ball_and_shoot import go_to_ball_and_shoot as go_to_ball_and_shoot
from robobt.plays.goalkeeper import fitted_goalkeeper as fitted_goalkeeper
from robobt.plays.goalkeeper import goalkeeper as goalkeeper
from robobt.plays.penalty_kick import penalty_kick as penalty_kick
from robobt.plays.refereed_goalkeeper import refereed_goalkeeper as refereed_goalkeeper
from robobt.plays.stand_still import stand_still as stand_still
from robobt.plays.take_shot import take_shot as take_shot
from robobt.plays.team_goalkeeper import team_goalkeeper as team_goalkeeper
from robobt.plays.team_player import team_player as team_player

_HOMES = {
    "import_file": "python_files",
    "load_play": "files",
    "tree_xml": "files",
    "tree_yaml": "files",
}

if TYPE_CHECKING:
    from robobt.plays.files import load_play as load_play
    from robobt.plays.files import tree_xml as tree_xml
    from robobt.plays.files import tree_yaml as tree_yaml
    from robobt.plays.python_files import import_file as import_file
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
