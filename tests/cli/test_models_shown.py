"""A model's card in the terminal."""

from __future__ import annotations

from robobt.cli.shown.models import in_short


def test_what_every_numbered_robot_has_is_told_once() -> None:
    robots = [
        f"{kind}_{number}_{entry}" for kind in ("mate", "opponent") for number in range(3) for entry in "xy"
    ]
    assert in_short(["vx [m/s]", *robots, "restart"]) == (
        "vx [m/s], mate_0 to mate_2 (x, y of each), opponent_0 to opponent_2 (x, y of each), restart"
    )


def test_what_does_not_repeat_stays_as_it_is() -> None:
    names = ["vx", "mate_0_x", "mate_0_y", "opponent_0_x", "opponent_1_y"]
    assert in_short(names) == ", ".join(names)
