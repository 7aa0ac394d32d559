"""Robots' measured delays and round trips, as a table and as JSON data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from robobt.cli.common import console, table

if TYPE_CHECKING:
    from robobt.league.serve.server import SimServer
    from robobt.match.results.delays import DelayResult


def trip_figures(server: SimServer) -> dict[str, Any]:
    """Return delay and round trips of each robot of a served field by its name."""
    from robobt.match.results.delays import delay_results

    delays = delay_results(server.delays())
    return {
        str(robot): {
            "delay": (delay := delays[str(robot)]) and asdict(delay),
            "commands": it.commands,
            "lost": it.lost,
            "round_trip": {
                "count": it.answered,
                "mean": it.mean,
                "variance": it.variance,
                "maximum": it.maximum,
                "lost": it.unanswered,
            },
        }
        for robot, it in sorted(server.field.trips.robots.items())
    }


def print_delays(delays: Mapping[str, DelayResult | None]) -> None:
    """Print each robot's delay, if any is measured."""
    if delays:
        shown = table("robot", "delay, with 95 % interval")
        for robot, it in delays.items():
            shown.add_row(robot, _delay(it))
        console.print(shown)


def print_trips(server: SimServer) -> None:
    """Print delay and round trips of each robot of a served field, if any was commanded."""
    from robobt.match.results.delays import delay_results

    delays, robots = delay_results(server.delays()), server.field.trips.robots
    if not robots:
        return
    shown = table(
        "robot", "delay", "round trips", "mean", "variance", "maximum", "unanswered", "commands", "lost"
    )
    for robot, it in sorted(robots.items()):
        shown.add_row(
            str(robot),
            _delay(delays[str(robot)]),
            str(it.answered),
            f"{1e3 * it.mean:.1f} ms",
            f"{1e6 * it.variance:.1f} ms²",
            f"{1e3 * it.maximum:.1f} ms",
            str(it.unanswered),
            str(it.commands),
            str(it.lost),
        )
    console.print(shown)


def _delay(delay: DelayResult | None) -> str:
    if delay is None:
        return "not seen enough"
    return f"{1e3 * delay.seconds:.0f} ms ({1e3 * delay.low:.0f} to {1e3 * delay.high:.0f})"
