"""The pymunk simulator: settings with presets, many arenas at once, and one as a World."""

from robobt.sim.arenas import Arenas
from robobt.sim.settings import PRESETS, REALISM, SimSettings, preset, settings_from
from robobt.sim.world import SimWorld

__all__ = ["PRESETS", "REALISM", "Arenas", "SimSettings", "SimWorld", "preset", "settings_from"]
