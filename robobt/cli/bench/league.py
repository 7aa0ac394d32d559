"""``robobt bench filter``, ``clock`` and ``league``: measure playing over the league's protocols."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.markup import escape

from robobt.cli.common import MAX_SEED, Bundled, Json, console, errors, print_json, say, table


def bench_filter(
    scenario: Annotated[
        str, typer.Argument(help="The match: a scenario file or the name of a bundled one.")
    ] = "six_v_six",
    seconds: Annotated[
        float, typer.Option("--seconds", min=2, max=3600, help="Simulated time of each situation.")
    ] = 60.0,
    realism: Annotated[
        str, typer.Option("--realism", help="none, friendly, rc2021 or realistic.")
    ] = "realistic",
    cameras: Annotated[
        int, typer.Option("--cameras", min=1, max=16, help="Cameras that share the field.")
    ] = 1,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    as_json: Json = False,
) -> None:
    """Measure the filter's errors against the simulator's truth: root mean squares in the plane.

    Keys of --json: realism, seed, seconds, cameras, latency, noise (robot,
    ball, heading); constant_velocity and play, each with at_capture (the estimate
    against the truth at the capture's time), compensated and uncompensated
    (against the truth when the frame is used), each with robot_position,
    robot_heading, robot_velocity, robot_turn, ball_position, ball_velocity (SI)
    and missing_robots (share).
    """
    from robobt.league.bench_filter import bench_filter as measure
    from robobt.match import load_scenario
    from robobt.sim.settings import realism_level

    loaded = load_scenario(scenario)
    level = realism_level(realism)
    with errors.status("filtering"):
        situations = measure(loaded, seconds, seed, realism, cameras)
    if as_json:
        noise = {"robot": level.robot_noise, "ball": level.ball_noise, "heading": level.heading_noise}
        given = {"realism": realism, "seed": seed, "seconds": seconds, "cameras": cameras}
        print_json(given | {"latency": level.vision_delay, "noise": noise} | situations)
        return
    say(
        f"Noise of the cameras ({realism}), an axis: robot {level.robot_noise * 1e3:.1f} mm, "
        f"ball {level.ball_noise * 1e3:.1f} mm, heading {level.heading_noise:.3f} rad; "
        f"latency {level.vision_delay * 1e3:.0f} ms."
    )
    for situation, title in (("constant_velocity", "at constant velocity"), ("play", "in a match")):
        listed = table(title, "robot, mm", "rad", "m/s", "rad/s", "ball, mm", "m/s")
        for when, rms in situations[situation].items():
            listed.add_row(when.replace("_", " "), *_row(rms))
        console.print(listed)


def _row(rms: dict[str, float]) -> list[str]:
    return [
        f"{rms['robot_position'] * 1e3:.2f}",
        f"{rms['robot_heading']:.4f}",
        f"{rms['robot_velocity']:.3f}",
        f"{rms['robot_turn']:.3f}",
        f"{rms['ball_position'] * 1e3:.2f}",
        f"{rms['ball_velocity']:.3f}",
    ]


def bench_clock(
    seconds: Annotated[
        float, typer.Option("--seconds", min=5, max=3600, help="How long each is followed.")
    ] = 30.0,
    jitter: Annotated[
        float, typer.Option("--jitter", min=0, max=0.1, help="Longest irregular delay of a packet, s.")
    ] = 0.005,
    drift: Annotated[
        float, typer.Option("--drift", min=0, max=0.1, help="How far the rate drifts, as a share.")
    ] = 0.02,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    as_json: Json = False,
) -> None:
    """Measure how well the time on a simulated field is known whose clock runs at a rate of its own.

    The lead is the time for which a frame is predicted less what the field's clock shows
    then. Every five seconds the field stands still for half a second, or its packets are lost
    or come late, or it is restarted; the second after is not judged.

    Keys of --json: seconds, jitter, drift, seed; rows, each with speed, fault, frames,
    bias, mean_error, p99_error, largest_error (s).
    """
    from robobt.league.bench_clock import FAULTS, SPEEDS, Peer, lead_figures

    peers = [Peer(speed, drift, jitter, fault) for speed in SPEEDS for fault in FAULTS]
    with errors.status("following clocks"):
        rows = [(peer, lead_figures(peer, seconds, seed)) for peer in peers]
    if as_json:
        given = {"seconds": seconds, "jitter": jitter, "drift": drift, "seed": seed}
        listed = [{"speed": peer.speed, "fault": peer.fault, **figures} for peer, figures in rows]
        print_json({**given, "rows": listed})
        return
    shown = table("speed", "fault", "frames", "bias, ms", "mean error, ms", "p99, ms", "largest, ms")
    for peer, figures in rows:
        times = [figures[name] for name in ("bias", "mean_error", "p99_error", "largest_error")]
        in_ms = [f"{time * 1e3:.2f}" for time in times]
        shown.add_row(f"{peer.speed:g}", peer.fault, f"{figures['frames']:g}", *in_ms)
    console.print(shown)


def bench_league(
    scenario: Bundled = "six_v_six",
    seconds: Annotated[float, typer.Option("--seconds", min=4, max=3600, help="How long to play.")] = 30.0,
    simulator: Annotated[str, typer.Option("--simulator", help="grsim or protocol.")] = "grsim",
    realism: Annotated[
        str | None, typer.Option("--realism", help="Of the server; by default the scenario's.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Play against a served field in a second process over the loopback, at 60 Hz.

    Halfway the vision stalls for a second; at the end the playing process is killed.

    Keys of --json: scenario, simulator, seconds, frame_rate, tick_rate,
    command_rate, stall_command_rate (Hz), latency_median_ms, latency_p95_ms
    (from a frame's arrival to the commands), ticks, robots, lost (robots missing in frames),
    errors (ticks a tree failed), dropped, server_dropped (packets),
    stop_commanded_s and stop_at_rest_s (from the kill until all robots
    are commanded to stop, and stand).
    """
    from robobt.league.bench_network import bench_league as measure
    from robobt.match import load_scenario

    if simulator not in ("grsim", "protocol"):
        raise typer.BadParameter(f"{simulator!r} must be grsim or protocol", param_hint="--simulator")
    loaded = load_scenario(scenario)
    with errors.status(f"playing {escape(loaded.name)} over the loopback"):
        figures = measure(loaded, seconds, simulator, realism)
    if as_json:
        print_json({"scenario": loaded.name, "simulator": simulator, "seconds": seconds} | figures)
        return
    say(
        f"{loaded.name} over {simulator}, {figures['robots']} robots, {figures['ticks']} ticks: vision "
        f"{figures['frame_rate']:.2f} Hz, ticks {figures['tick_rate']:.2f} Hz, commands "
        f"{figures['command_rate']:.2f} Hz ({figures['stall_command_rate']:.2f} Hz while the vision stalled)."
    )
    say(
        f"From a frame's arrival to the commands: median {figures['latency_median_ms']:.2f} ms, 95 % within "
        f"{figures['latency_p95_ms']:.2f} ms. Robots lost {figures['lost']}, errors {figures['errors']}, "
        f"packets dropped {figures['dropped'] + figures['server_dropped']}."
    )
    say(
        f"Player killed: robots commanded to stop after {figures['stop_commanded_s']:.2f} s, at rest after "
        f"{figures['stop_at_rest_s']:.2f} s."
    )
