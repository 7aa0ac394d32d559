"""The preset ``grsim`` does what the real grSim did, where its recorded manoeuvres are at hand."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.sim.manoeuvres import commands_of, read_manoeuvres, replay, table

FILE = os.environ.get("ROBOBT_GRSIM_MANOEUVRES")


def test_the_names_say_what_was_commanded() -> None:
    command = commands_of("turnwhile_v2_w10")
    assert (command(59).omega, command(60).vx, command(60).omega) == (0.0, 2.0, 10.0)
    assert commands_of("square_ramped_2mss")(30).vx == pytest.approx(1.0)
    with pytest.raises(ValueError, match="'somersault'"):
        commands_of("somersault")


@pytest.mark.slow
@pytest.mark.skipif(FILE is None, reason="ROBOBT_GRSIM_MANOEUVRES names no file of recorded manoeuvres")
def test_the_manoeuvres_go_as_in_the_real_grsim_but_for_the_known_ones() -> None:
    deviations = [replay(manoeuvre) for manoeuvre in read_manoeuvres(Path(str(FILE)))]
    print(table(deviations))
    # Beyond: robots that meet head-on; and the ball, where a fast robot's plate or its corner hits it.
    assert sum(found.robot_close for found in deviations) >= 0.97 * len(deviations), table(deviations)
    assert sum(found.close for found in deviations) >= 0.72 * len(deviations), table(deviations)
