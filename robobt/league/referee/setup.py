"""Setting up a match at the official controller, and the changes that people would click.

Source: ssl-game-controller, ``statemachine/`` for the changes, ``config/config.go`` for the settings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from robobt.league.wire.gameevents import write_event
from robobt.league.wire.messages import AutoRefConfig, Change, Command, Config, GameEvent
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.openings import Opening
from robobt.match.referee.restarts import PLACEMENT_COMMANDS
from robobt.match.referee.settings import RefereeSettings
from robobt.world.division import division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import RefereeCommand, Restart, Stage, Team
from robobt.world.geometry import Point

ORIGIN = "robobt"
"""The name under which our automatic referee reports."""

_FOR_EVER = 86_400.0
"""Longer than any match [s]."""


@dataclass(slots=True, frozen=True)
class MatchSetup:
    """The data of a match for the controller.

    ``field`` is its field, ``robots`` the number per team, and ``settings`` have its times.
    """

    field: FieldGeometry
    settings: RefereeSettings
    robots: Mapping[Team, int]

    def game_settings(self) -> dict[str, object]:
        """Return the settings of the controller's game: goals are approved at once, and times are ours.

        Halves without end, and events never to be raised, get the longest time that it can count.
        """
        given = self.settings
        normal, extra = (
            {"half-duration": _time(length)} for length in (given.half_length, given.extra_length)
        )
        game: dict[str, object] = {
            "auto-approve-goals": True,
            "normal": normal,
            "overtime": extra,
            "preparation-time-before-resume": _time(given.stop_time),
            "preparation-time-after-halt": _time(given.stop_after_halt),
            "ball-placement-time": _time(given.placement_time),
            "yellow-card-duration": _time(given.yellow_card_time),
        }
        for name, time in (
            ("free-kick-timeout", given.kick_timeout),
            ("no-progress-timeout", given.no_progress_time),
            ("keeper-held-ball-timeout", given.keeper_hold_time),
        ):
            if time != "rules":
                game[name] = dict.fromkeys(("DIV_A", "DIV_B"), _time(time))
        return game

    def config(self) -> Config:
        """Return its configuration: it continues by itself and accepts our automatic referee's reports."""
        config = Config(auto_continue=True)
        behaviours: AutoRefConfig = config.auto_ref_configs[ORIGIN]
        for name in GameEvent.Type.keys():  # noqa: SIM118 (an enum's wrapper is no mapping)
            behaviours.game_event_behavior[name] = AutoRefConfig.BEHAVIOR_ACCEPT
        return config

    def changes(self, opening: Opening) -> list[Change]:
        """Return the changes that set up and start the match; blue defends -x."""
        division = division_of(self.field)
        most = self.settings.max_robots or max(division.robots, *self.robots.values())
        update = Change.UpdateConfig(
            division="DIV_A" if division.name == "A" else "DIV_B",
            first_kickoff_team=self.settings.opening_team.name,
            match_type="FRIENDLY",
            max_robots_per_team={"value": most},
        )
        set_up = [Change(update_config_change=update), *[self._team(team) for team in Team]]
        return set_up + _begin(opening)

    def _team(self, team: Team) -> Change:
        update = Change.UpdateTeamState(
            for_team=team.name,
            team_name={"value": team.value},
            goalkeeper={"value": self.settings.keeper(team).number},
            on_positive_half={"value": team is Team.YELLOW},
            can_place_ball={"value": self._places(team)},
        )
        return Change(update_team_state_change=update)

    def _places(self, team: Team) -> bool:
        given = self.settings
        able = given.blue_can_place if team is Team.BLUE else given.yellow_can_place
        return able and given.placement == "robots"


def _begin(opening: Opening) -> list[Change]:
    """Return what lets a match begin so: a restart follows from what the controller takes for its cause."""
    if opening.command is RefereeCommand.FORCE_START:
        return [command("FORCE_START")]
    begin = [command("STOP")]
    if opening.stage is not Stage.NORMAL_FIRST_HALF_PRE:
        begin.insert(0, stage(opening.stage))
    restart, team = opening.resumption.restart, opening.resumption.team
    cause = _CAUSES.get(restart) if opening.stage is Stage.NORMAL_FIRST_HALF and restart else None
    if cause is not None and team is not None:
        event = write_event(RefereeEvent(0.0, cause, team.other, None, *opening.resumption.spot), 0.0, "UI")
        event.ClearField("created_timestamp")
        begin.append(game_event(event))
    if team is not None and opening.command is PLACEMENT_COMMANDS[team]:
        begin.append(command("BALL_PLACEMENT", team))
    return begin


_CAUSES = {
    Restart.FREE_KICK: EventKind.ATTACKER_DOUBLE_TOUCHED_BALL,
    Restart.PENALTY: EventKind.DEFENDER_IN_DEFENSE_AREA,
}
"""Offences that lead to these restarts without being counted."""


def _time(seconds: float | None) -> str:
    return f"{_FOR_EVER if seconds is None else seconds:.3f}s"


def command(kind: str, team: Team | None = None) -> Change:
    """Return the change that gives a command, ``kind`` by its name in ``Command.Type``."""
    given = Command(type=kind, for_team="UNKNOWN" if team is None else team.name)
    return Change(new_command_change={"command": given})


def stage(new: Stage) -> Change:
    """Return the change that brings on a stage, which is never an earlier one."""
    return Change(change_stage_change={"new_stage": new.name})


def ball_position(spot: Point) -> Change:
    """Return the change that says where the ball has to be for the next restart [m]."""
    return Change(set_ball_placement_pos_change={"pos": {"x": spot[0], "y": spot[1]}})


def game_event(event: GameEvent) -> Change:
    """Return the change that reports a game event."""
    return Change(add_game_event_change={"game_event": event})
