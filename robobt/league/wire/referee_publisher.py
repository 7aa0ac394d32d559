"""Game states as the game controller's messages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from robobt.league.wire.messages import GameEvent
from robobt.league.wire.messages import Referee as RefereeMessage
from robobt.league.wire.packets import MM_PER_M
from robobt.league.wire.tracker import SOURCE
from robobt.world.game import GameState, RefereeCommand, Restart, Team


class RefereePublisher:
    """Encodes game states as the game controller's messages."""

    def __init__(self, keepers: Mapping[Team, int] | None = None) -> None:
        self._keepers = keepers or {}
        self._last: tuple[RefereeCommand, Restart | None, Team | None] | None = None
        self._counter = 0
        self._command_time = 0

    def write(self, game: GameState, time: float, events: Sequence[GameEvent] = ()) -> bytes:
        """Return the packet for a state in world coordinates (blue defends -x).

        Args:
            game: the state.
            time: when it is sent [s].
            events: the messages of the state's game events; without them only their kinds are sent.
        """
        now = max(0, round(time * 1e6))
        last, current = self._last, (game.command, game.restart if game.stopped else None, game.restart_team)
        if last is None or current[0] is not last[0] or (game.stopped and current != last):
            self._counter += last is not None
            self._command_time = now
        self._last = current
        message = RefereeMessage(
            source_identifier=SOURCE,
            packet_timestamp=now,
            stage=game.stage.name,
            command=game.command.name,
            command_counter=self._counter,
            command_timestamp=self._command_time,
            blue_team_on_positive_half=False,
        )
        for team, info, score in (
            (Team.YELLOW, message.yellow, game.yellow_score),
            (Team.BLUE, message.blue, game.blue_score),
        ):
            status = game.status(team)
            info.name = team.value
            info.score = score
            info.timeouts = info.timeout_time = 0
            info.red_cards, info.yellow_cards = status.red_cards, status.yellow_cards
            # Only how many there are is known here, not how long each lasts.
            info.yellow_card_times.extend([0] * status.yellow_cards)
            info.goalkeeper = self._keepers.get(team, 0) if status.keeper is None else status.keeper
            info.can_place_ball = status.can_place_ball
            info.bot_substitution_allowed = status.substituting
            if status.max_robots is not None:
                info.max_allowed_bots = status.max_robots
        if game.placement is not None:
            message.designated_position.x = game.placement[0] * MM_PER_M
            message.designated_position.y = game.placement[1] * MM_PER_M
        if game.upcoming is not None:
            message.next_command = RefereeMessage.Command.Value(game.upcoming.name)
        if game.action_time is not None:
            message.current_action_time_remaining = round(game.action_time * 1e6)
        if game.stage_time is not None:
            message.stage_time_left = round(game.stage_time * 1e6)
        message.game_events.extend(events)
        for event in () if events else game.events:
            message.game_events.add().type = GameEvent.Type.Value(event.upper())
        return bytes(message.SerializeToString())
