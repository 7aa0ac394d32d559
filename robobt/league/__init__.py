"""The league's network protocols: a world over SSL-Vision, and the simulator served to others."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "AutoRefConnection": "remote",
    "OfficialRefereeFactory": "referee.official",
    "RemoteControl": "remote",
    "TeamConnection": "remote",
    "find_game_controller": "referee.process",
}

if TYPE_CHECKING:
    from robobt.league.referee.official import OfficialRefereeFactory as OfficialRefereeFactory
    from robobt.league.referee.process import find_game_controller as find_game_controller
    from robobt.league.remote import AutoRefConnection as AutoRefConnection
    from robobt.league.remote import RemoteControl as RemoteControl
    from robobt.league.remote import TeamConnection as TeamConnection
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
