"""The game controller's messages, converted to a game state.

Source of the states: RoboCup SSL rules, chapter "Referee commands".
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from robobt.league.wire.gameevents import read_event
from robobt.league.wire.messages import GameEvent
from robobt.league.wire.messages import Referee as RefereeMessage
from robobt.league.wire.notices import Notices
from robobt.league.wire.packets import MAX_OBJECTS, MM_PER_M, PacketCounts
from robobt.league.wire.referee_message import (
    ReadMessage,
    clear_nonsense,
    command_in,
    command_of,
    read_message,
)
from robobt.league.wire.sockets import Address, FirstSender
from robobt.match.referee.events import RefereeEvent
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team, TeamStatus
from robobt.world.geometry import Point, distance
from robobt.world.rules import IN_PLAY_DISTANCE
from robobt.world.state import Frame

_KICK_TIMEOUT = 10.0
"""Time after which an untaken restart is over, if the controller does not send the time left [s]."""

_RESTARTS = {
    RefereeCommand[f"{prefix}_{team.name}"]: (restart, team)
    for prefix, restart in (
        ("PREPARE_KICKOFF", Restart.KICKOFF),
        ("PREPARE_PENALTY", Restart.PENALTY),
        ("DIRECT_FREE", Restart.FREE_KICK),
        ("BALL_PLACEMENT", Restart.BALL_PLACEMENT),
    )
    for team in Team
}

_IMMEDIATE_RESTARTS = frozenset({Restart.FREE_KICK, Restart.BALL_PLACEMENT})
"""Restarts that may be taken without NORMAL_START."""


class RefereeFollower:
    """Follows a game controller: its packets give the command, the ball shows when play resumes.

    Attributes:
        game: the current state, in the coordinates of the packets; HALT before the first.
        blue_on_positive_half: whether blue defends +x; None until a packet says so.
        sent: when the last packet was sent, as its sender's clock has it [s].
        counts: what happened to the packets.

    ``notices`` warns of messages that make no sense, and of further controllers.
    """

    def __init__(self, notices: Notices | None = None) -> None:
        self.sent = 0.0
        self.game = GameState(
            RefereeCommand.HALT, stage=Stage.NORMAL_FIRST_HALF_PRE, may_touch=False, placement=None
        )
        self.blue_on_positive_half: bool | None = None
        self.counts = PacketCounts()
        self._news: list[GameEvent] = []
        self._told: set[bytes] = set()
        self._counter: tuple[int, int, int, RefereeCommand | None] | None = None
        self._ready: tuple[Point, float] | None = None
        self._controller = FirstSender[Address]()
        self._notices = notices or Notices()

    def read(self, data: bytes, sender: Address = ("", 0), time: float = 0.0) -> bool:
        """Update the state from a packet; return False (counted) when nothing in it is of use.

        Fields that make no sense are left out, and reported once each; what a message has to hold keeps its
        last value. A command that is not known halts. Of several senders the first is followed until it
        falls silent; each of the others is reported once.

        Args:
            data: the packet.
            sender: who sent it.
            time: when it arrived, on a clock that grows from call to call [s].
        """
        controller = self._controller
        if controller.sender is not None and not controller.follows(sender, time):
            first, second = (f"{host}:{port}" for host, port in (controller.sender, sender))
            self._notices.tell(
                f"controller of {sender[0]}",
                f"two game controllers: following {first}, ignoring {second}; stop one of them",
            )
            self.counts.foreign += 1
            return False
        seen = read_message(data, self.counts)
        if seen is None:
            return False
        controller.heard(sender, time)
        self._update(seen)
        return True

    def follow(self, message: RefereeMessage) -> None:
        """Update the state from a message of the one controller there is."""
        odd = clear_nonsense(message)
        self._update(ReadMessage(message, command_in(message), odd))

    def _update(self, seen: ReadMessage) -> None:
        message, command, odd = seen
        for name in odd:
            self._notices.tell(
                f"referee {name}",
                f"the game controller's field {name} is missing or invalid; it is ignored and the rest of "
                "the message is obeyed",
            )
        placement: Point | None = None
        if message.HasField("designated_position"):
            spot = message.designated_position
            placement = (spot.x / MM_PER_M, spot.y / MM_PER_M)
        if message.HasField("packet_timestamp"):
            self.sent = message.packet_timestamp / 1e6
        events = list(message.game_events)
        told = {event.SerializePartialToString(): event for event in events}
        # They stay in the packets until play goes on.
        self._news = (self._news + [event for each, event in told.items() if each not in self._told])[
            -MAX_OBJECTS:
        ]
        self._told = set(told)
        if message.HasField("blue_team_on_positive_half"):
            self.blue_on_positive_half = message.blue_team_on_positive_half
        upcoming = command_of(message.next_command) if message.HasField("next_command") else None
        # A restarted controller counts from 0 again, but with another timestamp. A goal is sent as a command
        # once, followed by the command in force with the number of the goal.
        counter = (message.command_counter, message.command_timestamp, int(message.command), command)
        if command is not None and counter != self._counter:
            self._counter = counter
            self._follow(command, upcoming, placement)
        elif self.game.command is RefereeCommand.STOP:
            # What happens meanwhile may change what follows.
            restart, team = _following(upcoming)
            placement = placement or self.game.placement
            self.game = replace(self.game, restart=restart, restart_team=team, placement=placement)
        elif self.game.restart is Restart.BALL_PLACEMENT:
            self.game = replace(self.game, placement=placement or self.game.placement)
        game = self.game
        self.game = replace(
            game,
            stage=Stage(int(message.stage)) if message.HasField("stage") else game.stage,
            blue_score=message.blue.score if message.blue.HasField("score") else game.blue_score,
            yellow_score=message.yellow.score if message.yellow.HasField("score") else game.yellow_score,
            blue=_status(message.blue, game.blue) if message.HasField("blue") else game.blue,
            yellow=_status(message.yellow, game.yellow) if message.HasField("yellow") else game.yellow,
            upcoming=upcoming,
            events=tuple([GameEvent.Type.Name(event.type).lower() for event in events]),
            action_time=_seconds(message, "current_action_time_remaining"),
            stage_time=_seconds(message, "stage_time_left"),
        )

    def reported(self, now: float, epoch: float | None = None) -> list[RefereeEvent]:
        """Return the game events that are new in the packets since this was asked last.

        They are in the coordinates of the packets. ``epoch`` is the Unix time at which the frames' time
        was 0 [s]; where it is None, all of them are said to have happened ``now``.
        """
        read = [read_event(message, epoch or 0.0, now) for message in self._news]
        self._news.clear()
        events = [event for event in read if event is not None]
        return events if epoch is not None else [replace(event, time=now) for event in events]

    def watch(self, frame: Frame) -> GameState:
        """Return the state in view of the ball: a restart ends when the ball moves, or times out.

        The frame is in the coordinates of the packets.
        """
        game = self.game
        if game.restart is None or game.restart is Restart.BALL_PLACEMENT or not game.may_touch:
            return game
        if self._ready is None:
            self._ready = frame.ball.position, frame.time
            if game.placement is None:
                self.game = game = replace(game, placement=frame.ball.position)
        ball, since = self._ready
        moved = distance(frame.ball.position, ball) > IN_PLAY_DISTANCE
        # A penalty kick has no timeout here: the controller ends it.
        timeout = frame.time - since > _KICK_TIMEOUT if game.action_time is None else game.action_time < 0.0
        if moved or (timeout and game.restart is not Restart.PENALTY):
            self.game = replace(game, restart=None, restart_team=None, placement=None)
        return self.game

    def _follow(
        self, command: RefereeCommand, upcoming: RefereeCommand | None, placement: Point | None
    ) -> None:
        before = self.game
        self._ready = None
        restart, team = _RESTARTS.get(command, (None, None))
        may_touch = restart in _IMMEDIATE_RESTARTS
        if command is RefereeCommand.NORMAL_START and not before.may_touch:
            # The kick that was prepared may now be taken.
            restart, team, placement, may_touch = before.restart, before.restart_team, before.placement, True
        elif command in (RefereeCommand.FORCE_START, RefereeCommand.NORMAL_START):
            may_touch, placement = True, None
        elif command is RefereeCommand.STOP:
            restart, team = _following(upcoming)
        elif restart is Restart.KICKOFF:
            placement = (0.0, 0.0)
        if restart is Restart.PENALTY and command is not RefereeCommand.STOP:
            # Put down by hand, on the mark: the designated position is still that of another restart.
            placement = before.placement if command is RefereeCommand.NORMAL_START else None
        elif before.command is RefereeCommand.STOP and restart is not None and placement is None:
            placement = before.placement
        kicks = restart is Restart.PENALTY and command is not RefereeCommand.STOP
        self.game = replace(
            before,
            command=command,
            restart=restart,
            restart_team=team,
            penalty=team if kicks else None,
            may_touch=may_touch,
            placement=placement,
        )


def _following(upcoming: RefereeCommand | None) -> tuple[Restart | None, Team | None]:
    return (None, None) if upcoming is None else _RESTARTS.get(upcoming, (None, None))


def _status(info: RefereeMessage.TeamInfo, before: TeamStatus) -> TeamStatus:
    return TeamStatus(
        keeper=info.goalkeeper if info.HasField("goalkeeper") else before.keeper,
        max_robots=info.max_allowed_bots if info.HasField("max_allowed_bots") else None,
        yellow_cards=len(info.yellow_card_times),
        red_cards=info.red_cards if info.HasField("red_cards") else before.red_cards,
        can_place_ball=info.can_place_ball if info.HasField("can_place_ball") else True,
        substituting=info.bot_substitution_allowed,
    )


def _seconds(
    message: RefereeMessage, field: Literal["current_action_time_remaining", "stage_time_left"]
) -> float | None:
    return getattr(message, field) * 1e-6 if message.HasField(field) else None
