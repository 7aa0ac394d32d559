"""A team's program for tests: drives its robots by grSim's packets, or misbehaves.

python client.py BEHAVIOUR TEAM PORT

In lock step it runs to the ball and kicks it, which takes looking at every answer.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time

from robobt.league.wire.grsim import write_grsim
from robobt.league.wire.messages import SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.simulation import write_control
from robobt.league.wire.stream import MessageStream
from robobt.world.command import RobotCommand
from robobt.world.game import Team

behaviour, team, port = sys.argv[1], Team(sys.argv[2]), int(sys.argv[3])
sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)


def play_in_lock_step() -> None:
    """Drive where the ball is."""
    stream = MessageStream(socket.create_connection(("127.0.0.1", port)), "the match")
    command = RobotCommand()
    while True:
        request = SimulationSyncRequest(sim_step=0.02)
        request.robot_control.MergeFromString(write_control({0: command}))
        stream.send(request.SerializeToString())
        data = stream.receive(60.0)
        assert data is not None
        seen = SimulationSyncResponse.FromString(data).detection[0]
        (robot,) = seen.robots_blue if team is Team.BLUE else seen.robots_yellow
        dx, dy = (seen.balls[0].x - robot.x) / 1000.0, (seen.balls[0].y - robot.y) / 1000.0
        speed = 1.0 if behaviour == "steps" else 0.7
        command = RobotCommand(speed * dx, speed * dy, kick_speed=3.0 if abs(dx) + abs(dy) < 0.2 else 0.0)


packet = write_grsim(team, {0: RobotCommand(vx=float("nan") if behaviour == "nan" else 1.0)}, 0.0)


if behaviour.startswith("steps"):
    play_in_lock_step()
if behaviour == "exits":
    sys.exit("nothing to do here")
if behaviour == "deaf":
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
if behaviour == "stubborn":
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
    sock.sendto(packet, ("127.0.0.1", port))
    if behaviour == "shouts":
        os.write(1, b"x" * (1 << 20))
    if behaviour != "floods":
        time.sleep(0.01)
