"""The pymunk simulator: settings with presets, many arenas at once, and one as a World."""

from robobt.sim.arenas import Arenas as Arenas
from robobt.sim.settings import PRESETS as PRESETS
from robobt.sim.settings import REALISM as REALISM
from robobt.sim.settings import SimSettings as SimSettings
from robobt.sim.settings import preset as preset
from robobt.sim.settings import settings_from as settings_from
from robobt.sim.world import SimWorld as SimWorld
