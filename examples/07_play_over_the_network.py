# %% [markdown]
# # Play against grSim
#
# A play does not know what world it plays in. With grSim running, `GRSIM = True` plays in it; else robobt
# serves its own simulator over the same protocols, from a second process, on ports that nobody uses.

# %%
import socket
import subprocess
import sys

import robobt

GRSIM = False
TRIALS = 3


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for sock in sockets:
        sock.bind(("127.0.0.1", 0))
    ports = [sock.getsockname()[1] for sock in sockets]
    for sock in sockets:
        sock.close()
    return ports


def serve() -> tuple[subprocess.Popen[str], str]:
    """Start `robobt serve` and return it with its address, once it serves."""
    *commands, vision, tracker = free_ports(8)
    names = ("grsim", "control", "blue", "yellow", "blue_status", "yellow_status")
    ports = dict(zip(names, commands, strict=True))
    ports |= {"vision": f"224.5.23.2:{vision}", "tracker": f"224.5.23.2:{tracker}"}
    options: list[str] = []
    for name, port in ports.items():
        option = name if name in ("vision", "tracker") else f"{name.replace('_', '-')}-port"
        options += [f"--{option}", str(port)]
    program = [sys.executable, "-m", "robobt", "serve", "striker_vs_goalkeeper", *options]
    server = subprocess.Popen(program, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    print(server.stdout.readline(), end="")  # says that it serves
    # What is served are the scenario's robots, not those of grSim itself.
    return server, "league://grsim?physics=default&" + "&".join(f"{name}={ports[name]}" for name in ports)


# %% [markdown]
# The address of a world is all that a match over the network needs; `robobt match --world ADDRESS` takes
# the same.

# %%
server, address = (None, "league://grsim") if GRSIM else serve()
try:
    run = robobt.run_trials(robobt.load_scenario("striker_vs_goalkeeper"), TRIALS, world=address)
finally:
    if server is not None:
        server.terminate()
        server.communicate()
scored = run.summary().goals["blue"].trials
print(f"{scored.count} of {TRIALS} scored over the network")

# %% [markdown]
# With other ports, other simulators, or on a real field: [the league's protocols](../league.md).
