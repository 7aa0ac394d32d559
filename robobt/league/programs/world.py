"""A simulated match in which programs command robots over the league's protocols, in real time."""

from __future__ import annotations

import select
import time
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Self
from uuid import UUID

import numpy as np
from pydantic import Field

from robobt.config.errors import RobobtError
from robobt.config.validation import Settings
from robobt.league.programs.ports import MatchPorts
from robobt.league.programs.process import TeamProcess
from robobt.league.serve.cameras import Cameras
from robobt.league.serve.publishing import GEOMETRY_INTERVAL
from robobt.league.wire.gamecontroller import RefereePublisher
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import write_vision
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import REALISM
from robobt.world.command import RobotCommand
from robobt.world.game import GameState, RefereeCommand, Team
from robobt.world.protocol import Placement, World, WrappedWorld
from robobt.world.state import Frame, RobotId

_TIMEOUT = 0.1
"""A robot that gets no command for this long stops [s]. Source: ER-Force's standby time."""


class Program(Settings):
    """How a team's program is started, and what it may do."""

    command: tuple[str, ...] = Field(
        strict=False,
        min_length=1,
        description="program and arguments; {team}, {host}, {vision}, {tracker}, {referee} and the ports "
        "{grsim} and {protocol} are filled in",
    )
    ready_within: float = Field(
        60.0, gt=0, le=600, description="how long it may take until it first commands its robots [s]"
    )
    silent_for: float = Field(
        10.0, gt=0, le=600, description="how long it may then be silent until it has lost [s]"
    )


class ForfeitError(RobobtError, RuntimeError):
    """A team's program crashed, is silent or was never ready.

    Attributes:
        team: whose it is.
    """

    def __init__(self, team: Team, problem: str) -> None:
        super().__init__(problem)
        self.team = team


class ProgramWorld(WrappedWorld):
    """Another world in which programs command the robots of one or both teams. A context manager.

    The field, as cameras without noise see it, is published once a control period, and so are the
    referee's decisions. Programs are started when the world is reset; the match begins once each of them
    has commanded its robots. Until then they are shown the field at rest and HALT.

    Args:
        world: where it is played.
        scenario: what is played.
        programs: by the team.
        folders: where they run, likewise.
        output: where what they print is kept, by team.
        speed: simulated time over real time.

    Raises:
        OSError: there is no free port.
    """

    def __init__(
        self,
        world: World,
        scenario: Scenario,
        programs: Mapping[Team, Program],
        folders: Mapping[Team, Path],
        output: Path,
        speed: float = 1.0,
    ) -> None:
        super().__init__(world)
        self._programs, self._folders, self._output = programs, folders, output
        self._step, self._period = scenario.period / speed, scenario.period
        self._publisher = RefereePublisher(scenario.goalkeepers())
        self._uuid = str(UUID(bytes=np.random.default_rng(0).bytes(16), version=4))
        self._camera = Cameras(scenario.field, REALISM["none"], 1, np.random.default_rng(0))
        self._processes: dict[Team, TeamProcess] = {}
        self._commands: dict[RobotId, tuple[float, RobotCommand]] = {}
        self._heard: dict[Team, float] = {}
        self._judged: Frame | None = None
        self._frames, self._stamped_from, self._due = 0, 0.0, 0.0
        with ExitStack() as opened:
            self._ports = opened.enter_context(MatchPorts(programs))
            self._opened = opened.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the programs and release the ports."""
        self._opened.close()

    def reset(self, placement: Placement, seed: int) -> None:
        """Put everything in its place and wait for the programs; see :meth:`robobt.world.World.reset`.

        Raises:
            ForfeitError: a program cannot be started, ends, or is not ready in time.
        """
        super().reset(placement, seed)
        for team, program in self._programs.items():
            addresses = self._ports.addresses(team)
            command = [_filled(word, addresses) for word in program.command]
            try:
                process = TeamProcess(command, self._folders[team], self._output / f"{team.value}.txt")
            except OSError as error:
                raise ForfeitError(team, f"{command[0]}: {error.strerror or error}") from error
            self._processes[team] = self._opened.enter_context(process)
        began = self._due = time.monotonic()
        halted = GameState(command=RefereeCommand.HALT)
        while len(self._heard) < len(self._programs):
            truth = super().truth()
            truth.game = halted
            self._publish(truth, waiting=True)
            self._wait(truth)
            for team, program in self._programs.items():
                if team not in self._heard and time.monotonic() - began > program.ready_within:
                    problem = f"its program did not command a robot within {program.ready_within:g} s"
                    raise ForfeitError(team, problem)
        self._commands.clear()

    def truth(self) -> Frame:
        """See :meth:`robobt.world.World.truth`."""
        # The match writes the referee's decision into the frame.
        self._judged = super().truth()
        return self._judged

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Let the programs see the field and command their robots for a control period.

        Raises:
            ForfeitError: a program has ended, or was silent for too long.
        """
        truth = self._judged or self.truth()
        self._publish(truth)
        self._wait(truth)
        since = truth.time - _TIMEOUT
        theirs = {robot: one for robot, (when, one) in self._commands.items() if when >= since}
        ours = {robot: one for robot, one in commands.items() if robot.team not in self._programs}
        self.world.act({**ours, **{robot: one for robot, one in theirs.items() if robot in truth.robots()}})
        # A kick fires once; the next one takes another command.
        self._commands = {
            robot: (when, one) for robot, (when, one) in self._commands.items() if one.kick_speed == 0.0
        }

    def _wait(self, truth: Frame) -> None:
        """Take in what the programs command until the control period is over."""
        # What was lost is not caught up with: programs could not follow.
        self._due = max(self._due, time.monotonic() - self._step) + self._step
        sockets = self._ports.sockets()
        while True:
            for team, commands in self._ports.commands(truth).items():
                self._heard[team] = time.monotonic()
                self._commands |= {robot: (truth.time, one) for robot, one in commands.items()}
            left = self._due - time.monotonic()
            if left <= 0.0:
                break
            if select.select(sockets, [], [], left)[0]:
                # Who floods its port is read at most a thousand times a second.
                time.sleep(min(0.001, left))
        now = time.monotonic()
        for team, process in self._processes.items():
            ended = process.ended()
            if ended is not None:
                raise ForfeitError(team, ended)
            patience = self._programs[team].silent_for
            if team in self._heard and now - self._heard[team] > patience:
                raise ForfeitError(team, f"its program was silent for {patience:g} s")

    def _publish(self, frame: Frame, waiting: bool = False) -> None:
        if waiting:
            self._stamped_from += self._period
        stamp = self._stamped_from + frame.time
        (seen,) = self._camera.capture(frame, stamp, stamp)
        geometry = None
        if self._frames % GEOMETRY_INTERVAL == 0:
            geometry = write_geometry(frame.field, self._camera.places)
        senders = self._ports.senders
        senders["vision"].send(write_vision(seen, geometry))
        senders["tracker"].send(write_tracked(frame, self._frames, stamp, self._uuid))
        senders["referee"].send(self._publisher.write(frame.game, stamp))
        self._frames += 1


def _filled(word: str, addresses: Mapping[str, str]) -> str:
    for name, value in addresses.items():
        word = word.replace(f"{{{name}}}", value)
    return word
