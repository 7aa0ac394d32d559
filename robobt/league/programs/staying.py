"""Programs that keep running after their match and play the next match between their teams."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from multiprocessing.util import Finalize
from pathlib import Path

from robobt.league.programs.program import Program
from robobt.league.programs.world import ProgramWorld
from robobt.match.scenario.scenario import Scenario
from robobt.world.game import Team
from robobt.world.protocol import World

_MOST_STAYING = 4
"""How many matches' programs stay in one process; those that have waited longest are ended for others."""

_STAYING: dict[str, ProgramWorld] = {}
"""Between two matches of this process."""


@contextmanager
def programs_in(
    world: World,
    scenario: Scenario,
    programs: Mapping[Team, Program],
    folders: Mapping[Team, Path],
    outputs: Mapping[Team, Path],
    speed: float = 1.0,
) -> Iterator[ProgramWorld]:
    """Give programs a match in another world; the arguments are those of :class:`ProgramWorld`.

    After it they are ended, unless all of them may stay and it was played to its end.

    Raises:
        OSError: there is no free port.
        ForfeitError: a program does not end when asked to.
    """
    if not all(program.stays for program in programs.values()):
        with ProgramWorld(world, scenario, programs, folders, outputs, speed) as served:
            yield served
        return
    settings = sorted((team, repr(program), str(folders[team])) for team, program in programs.items())
    key = repr((settings, str(scenario.source), scenario.period, speed))
    if key in _STAYING:
        served = _STAYING.pop(key)
    else:
        served = ProgramWorld(world, scenario, programs, folders, outputs, speed)
        # A worker process ends without asking: this is its only chance.
        Finalize(None, end_staying, exitpriority=0)
    served.world = world
    try:
        yield served
    except BaseException:
        served.close()
        raise
    _STAYING[key] = served
    while len(_STAYING) > _MOST_STAYING:
        _STAYING.pop(next(iter(_STAYING))).close()


def end_staying() -> None:
    """End all programs that wait for another match in this process."""
    while _STAYING:
        _STAYING.popitem()[1].close()
