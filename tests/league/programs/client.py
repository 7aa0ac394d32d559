"""A team's program for tests: drives its robots by grSim's packets, or misbehaves.

python client.py BEHAVIOUR TEAM PORT
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time

from robobt.league.wire.grsim import write_grsim
from robobt.world.command import RobotCommand
from robobt.world.game import Team

behaviour, team, port = sys.argv[1], Team(sys.argv[2]), int(sys.argv[3])
sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)


def send(vx: float) -> None:
    sock.sendto(write_grsim(team, {0: RobotCommand(vx=vx)}, 0.0), ("127.0.0.1", port))


if behaviour == "exits":
    sys.exit("nothing to do here")
if behaviour == "stubborn":
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    # A child in a session of its own, which ignores it too.
    code = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)"
    subprocess.Popen([sys.executable, "-S", "-c", code], start_new_session=True)
print("ready", flush=True)
began = time.monotonic()
while True:
    playing = time.monotonic() - began
    if behaviour == "silent" and playing > 0.5:
        time.sleep(600)
    if behaviour == "crashes" and playing > 0.5:
        raise RuntimeError("on purpose")
    if behaviour == "mute":
        time.sleep(600)
    send(float("nan") if behaviour == "nan" else 1.0)
    if behaviour == "shouts":
        os.write(1, b"x" * (1 << 20))
    if behaviour != "floods":
        time.sleep(0.01)
