"""The pymunk simulator: settings with presets, many arenas at once, and one as a World."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "Arenas": "arenas",
    "COMMAND": "records",
    "PRESETS": "settings",
    "REALISM": "realism",
    "SimSettings": "settings",
    "SimWorld": "world",
    "preset": "settings",
    "settings_from": "settings",
}

if TYPE_CHECKING:
    from robobt.sim.arenas import Arenas as Arenas
    from robobt.sim.realism import REALISM as REALISM
    from robobt.sim.records import COMMAND as COMMAND
    from robobt.sim.settings import PRESETS as PRESETS
    from robobt.sim.settings import SimSettings as SimSettings
    from robobt.sim.settings import preset as preset
    from robobt.sim.settings import settings_from as settings_from
    from robobt.sim.world import SimWorld as SimWorld
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
