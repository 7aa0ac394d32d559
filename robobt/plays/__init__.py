"""Trees composed of skills; a play is a function that returns a tree, registered by name.

Importing this package enters every one of them in :data:`PLAYS`.
"""

from robobt.plays.attack_expected import attack_expected
from robobt.plays.attack_main import attack_main
from robobt.plays.attack_nn import attack_nn
from robobt.plays.attack_support import attack_support
from robobt.plays.base import PLAYS, Play
from robobt.plays.go_to_ball_and_shoot import go_to_ball_and_shoot
from robobt.plays.goalkeeper import goalkeeper
from robobt.plays.take_shot import take_shot
from robobt.plays.team import defender, field_player, keeper

__all__ = [
    "PLAYS",
    "Play",
    "attack_expected",
    "attack_main",
    "attack_nn",
    "attack_support",
    "defender",
    "field_player",
    "go_to_ball_and_shoot",
    "goalkeeper",
    "keeper",
    "take_shot",
]
