"""How a match is set up at the official controller, and the changes that its people would click.

Source: ssl-game-controller, ``statemachine/`` for the changes, ``config/config.go`` for the settings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from robobt.league.wire.messages import AutoRefConfig, Change, Command, Config, GameEvent
from robobt.match.referee.settings import RefereeSettings
from robobt.world.division import division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import Stage, Team

ORIGIN = "robobt"
"""The name under which our automatic referee reports."""


@dataclass(slots=True, frozen=True)
class MatchSetup:
    """What the controller has to know of a match.

    ``field`` is where it is played, by ``robots`` of each team, for halves as long as the ``settings`` say;
    ``first_kickoff`` begins.
    """

    field: FieldGeometry
    settings: RefereeSettings
    robots: Mapping[Team, int]
    first_kickoff: Team = Team.BLUE

    def game_settings(self) -> dict[str, object]:
        """Return the settings of the controller that differ from its own.

        Nobody is there to look at goals again, and halves without end last as long as it can count.
        """
        length = self.settings.half_length
        seconds = 86_400.0 if length is None else length
        return {"auto-approve-goals": True, "normal": {"half-duration": f"{seconds:.3f}s"}}

    def config(self) -> Config:
        """Return how the controller has to work: by itself, and believing our automatic referee."""
        config = Config(auto_continue=True)
        behaviours: AutoRefConfig = config.auto_ref_configs[ORIGIN]
        for name in GameEvent.Type.keys():  # noqa: SIM118 (an enum's wrapper is no mapping)
            behaviours.game_event_behavior[name] = AutoRefConfig.BEHAVIOR_ACCEPT
        return config

    def changes(self) -> list[Change]:
        """Return what sets the match up and begins it; blue defends -x."""
        division = division_of(self.field)
        update = Change.UpdateConfig(
            division="DIV_A" if division.name == "A" else "DIV_B",
            first_kickoff_team=self.first_kickoff.name,
            match_type="FRIENDLY",
            max_robots_per_team={"value": max(division.robots, *self.robots.values())},
        )
        begin = command("FORCE_START" if self.settings.opening == "force_start" else "STOP")
        return [Change(update_config_change=update), *[self._team(team) for team in Team], begin]

    def _team(self, team: Team) -> Change:
        update = Change.UpdateTeamState(
            for_team=team.name,
            team_name={"value": team.value},
            goalkeeper={"value": self.settings.keeper(team).number},
            on_positive_half={"value": team is Team.YELLOW},
            can_place_ball={"value": True},
        )
        return Change(update_team_state_change=update)


def command(kind: str, team: Team | None = None) -> Change:
    """Return the change that gives a command, ``kind`` by its name in ``Command.Type``."""
    given = Command(type=kind, for_team="UNKNOWN" if team is None else team.name)
    return Change(new_command_change={"command": given})


def stage(new: Stage) -> Change:
    """Return the change that brings on a stage, which is never an earlier one."""
    return Change(change_stage_change={"new_stage": new.name})


def game_event(event: GameEvent) -> Change:
    """Return the change that reports a game event."""
    return Change(add_game_event_change={"game_event": event})
