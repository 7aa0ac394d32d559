"""A game controller in miniature, which answers as the official one was measured to in its simulation mode.

Each time makes one answer with the state before whatever follows from it, and each change, ours or its own,
another one. Run as a program it takes the official one's flags.
"""

from __future__ import annotations

import json
import socket
import sys
from collections.abc import Callable
from pathlib import Path

from robobt.league.wire.messages import Change, CiInput, CiOutput, GameEvent, Referee
from robobt.league.wire.stream import MessageStream, StreamError

OTHER = {"YELLOW": "BLUE", "BLUE": "YELLOW"}
NAMES = {
    "KICKOFF": "PREPARE_KICKOFF",
    "PENALTY": "PREPARE_PENALTY",
    "DIRECT": "DIRECT_FREE",
    "BALL_PLACEMENT": "BALL_PLACEMENT",
    "TIMEOUT": "TIMEOUT",
}
"""Commands of a team, and how its messages call them."""

TEAM = {1: "YELLOW", 2: "BLUE"}


class FakeController:
    """The state of a match, and what changes it."""

    def __init__(self, half: float = 300.0) -> None:
        self.half = half
        self.state = Referee(packet_timestamp=0, stage="NORMAL_FIRST_HALF_PRE", command="HALT")
        self.state.command_counter = self.state.command_timestamp = 0
        self.state.stage_time_left = self.state.current_action_time_remaining = 0
        self.state.next_command = Referee.Command.Value("PREPARE_KICKOFF_BLUE")
        self.state.designated_position.x = self.state.designated_position.y = 0.0
        for team in (self.state.yellow, self.state.blue):
            team.name, team.goalkeeper, team.max_allowed_bots = "Unknown", 0, 6
            team.score = team.red_cards = team.yellow_cards = team.timeouts = team.timeout_time = 0
        self.time = self.since = 0.0
        self.ready = 0.0
        self.inputs: list[CiInput] = []
        self._proposed: list[tuple[float, GameEvent]] = []
        self._answers: list[Referee] = []

    def handle(self, message: CiInput) -> list[Referee]:
        """What it says to a message."""
        self.inputs.append(message)
        self._answers = []
        for given in message.api_inputs:
            if given.HasField("change"):
                self._change(given.change)
        if message.HasField("timestamp"):
            now = message.timestamp / 1e9
            self._tick(now - self.time if self.time else 0.0)
            self.time = now
        return self._answers

    @property
    def command(self) -> str:
        return Referee.Command.Name(self.state.command)

    def _say(self) -> None:
        said = Referee()
        said.CopyFrom(self.state)
        self._answers.append(said)

    def _tick(self, passed: float) -> None:
        running = self.command in ("NORMAL_START", "FORCE_START") or self.command.startswith("DIRECT")
        if running:
            self.state.stage_time_left -= round(passed * 1e6)
            self.state.current_action_time_remaining -= round(passed * 1e6)
        self._say()
        self.time += passed
        for seen, event in [it for it in self._proposed if self.time - it[0] >= 1.0]:
            self._proposed.remove((seen, event))
            self._accept(event)
        lasted = self.time - self.since
        follows = Referee.Command.Name(self.state.next_command) if self.state.HasField("next_command") else ""
        over = self.state.stage_time_left < 0 and self.state.stage in (1, 4)
        if self.command == "STOP" and follows and not over and lasted >= self.ready:
            self._command(follows)
        elif self.command.startswith("PREPARE") and lasted >= 2.0:
            self._command("NORMAL_START")

    def _change(self, change: Change) -> None:
        kind = change.WhichOneof("change")
        if kind == "new_command_change":
            given = change.new_command_change.command
            name = type(given).Type.Name(given.type)
            self._command(f"{NAMES[name]}_{TEAM[given.for_team]}" if name in NAMES else name)
            return
        if kind == "change_stage_change":
            self._stage(change.change_stage_change.new_stage)
            self._command("HALT")
            return
        if kind == "set_status_message_change":
            self.state.status_message = change.set_status_message_change.status_message
        elif kind == "add_game_event_change":
            event = GameEvent()
            event.CopyFrom(change.add_game_event_change.game_event)
            event.id = f"event {len(self.inputs)}"
            self._proposed.append((self.time, event))
        elif kind == "update_team_state_change":
            update = change.update_team_state_change
            info = self.state.blue if update.for_team == 2 else self.state.yellow
            info.name, info.goalkeeper = update.team_name.value, update.goalkeeper.value
        self._say()

    def _command(self, name: str) -> None:
        self.ready = 10.0 if self.command == "HALT" else 2.0
        self.state.command = Referee.Command.Value(name)
        self.state.command_counter += 1
        self.state.current_action_time_remaining = 10_000_000
        self.since = self.time
        if name in ("NORMAL_START", "FORCE_START") or name.startswith("DIRECT"):
            self.state.ClearField("next_command")
            del self.state.game_events[:]
            if self.state.stage in (0, 3):
                self._stage(self.state.stage + 1)
        self._say()

    def _stage(self, number: int) -> None:
        self.state.stage = number  # type: ignore[assignment]
        self.state.stage_time_left = round(self.half * 1e6)
        if number == 3:
            self.state.next_command = Referee.Command.Value("PREPARE_KICKOFF_YELLOW")

    def _accept(self, event: GameEvent) -> None:
        self.state.game_events.add().CopyFrom(event)
        self._say()
        kind = GameEvent.Type.Name(event.type)
        if kind.startswith("BALL_LEFT") or kind == "AIMLESS_KICK":
            team = TEAM[getattr(event, kind.lower()).by_team]
            self.state.next_command = Referee.Command.Value(f"DIRECT_FREE_{OTHER[team]}")
            self._command("STOP")
        elif kind == "POSSIBLE_GOAL":
            self._goal(event)

    def _goal(self, possible: GameEvent) -> None:
        team = TEAM[possible.possible_goal.by_team]
        self.state.ClearField("next_command")
        self._command("HALT")
        goal = self.state.game_events.add(type="GOAL", id=f"{possible.id} goal")
        goal.goal.CopyFrom(possible.possible_goal)
        goal.goal.message = "Valid and auto approved"
        (self.state.blue if team == "BLUE" else self.state.yellow).score += 1
        self.state.next_command = Referee.Command.Value(f"PREPARE_KICKOFF_{OTHER[team]}")
        # Told as a command once, and then the one in force again.
        self.state.command_counter += 1
        self._say()
        self._answers[-1].command = Referee.Command.Value(f"GOAL_{team}")
        self._say()


def serve(connection: socket.socket, handle: Callable[[CiInput], list[Referee]]) -> None:
    """Answer until the other side closes the connection."""
    with MessageStream(connection, "the client") as stream:
        try:
            while True:
                data = stream.receive(60.0)
                if data is None:
                    return
                for answer in handle(CiInput.FromString(data)):
                    stream.send(CiOutput(referee_msg=answer).SerializePartialToString())
        except StreamError:
            return


def main(flags: list[str]) -> None:
    settings = json.loads(Path("config/ssl-game-controller.yaml").read_text())
    if settings["network"]["publish-address"] or "-backendOnly" not in flags:
        raise SystemExit("panic: it would be heard")
    host, port = flags[flags.index("-ciAddress") + 1].split(":")
    normal = settings["game"].get("normal", {"half-duration": "300s"})
    controller = FakeController(float(normal["half-duration"].removesuffix("s")))
    with socket.create_server((host, int(port))) as server:
        connection, _ = server.accept()
    serve(connection, controller.handle)


if __name__ == "__main__":
    main(sys.argv[1:])
