"""7. Play over the network: one process is the simulator, the other plays, as with grSim.

Serves our simulator over the league's protocols on ports nobody uses, and plays
the same scenario against it. `robobt serve` and `--world league://grsim` do the
same from two terminals; grSim itself takes the place of the first.

    python examples/07_play_over_the_network.py [trials]
"""

import socket
import subprocess
import sys

import robobt


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for sock in sockets:
        sock.bind(("127.0.0.1", 0))
    ports = [sock.getsockname()[1] for sock in sockets]
    for sock in sockets:
        sock.close()
    return ports


def main(trials: int = 3) -> None:
    names = ("grsim", "control", "blue", "yellow", "blue_status", "yellow_status")
    *commands, vision, tracker = free_ports(8)
    ports = dict(zip(names, commands, strict=True))
    ports |= {"vision": f"224.5.23.2:{vision}", "tracker": f"224.5.23.2:{tracker}"}
    options: list[str] = []
    for name, port in ports.items():
        option = name if name in ("vision", "tracker") else f"{name.replace('_', '-')}-port"
        options += [f"--{option}", str(port)]
    serve = [sys.executable, "-m", "robobt", "serve", "striker_vs_goalie", *options]
    server = subprocess.Popen(serve, stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        print(server.stdout.readline(), end="")  # says that it serves
        # What is served are the scenario's robots, not those of grSim itself.
        address = "league://grsim?physics=default&" + "&".join(
            f"{name}={port}" for name, port in ports.items()
        )
        run = robobt.run_trials(robobt.load_scenario("striker_vs_goalie"), trials, world=address)
    finally:
        server.terminate()
        server.communicate()
    scored = run.summary().goals["blue"].trials
    print(f"{scored.count} of {trials} scored over the network")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
