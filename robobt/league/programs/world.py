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

from robobt.config.systems import need_posix
from robobt.league.programs.ports import MOST_PACKETS, MatchPorts, StepPort
from robobt.league.programs.process import MOST_OUTPUT, TeamProcess
from robobt.league.programs.program import ForfeitError, Program
from robobt.league.serve.cameras import Cameras
from robobt.league.serve.publishing import GEOMETRY_INTERVAL
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.simulation import read_control
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import CameraFrame, write_vision
from robobt.match.scenario.scenario import Scenario
from robobt.sim.realism import REALISM
from robobt.world.command import RobotCommand
from robobt.world.game import GameState, RefereeCommand, Team
from robobt.world.protocol import Placement, World, WrappedWorld
from robobt.world.state import Frame, RobotId

_PROGRAM_POLL = 0.05
"""How long a program in lock step is waited for until the others are looked at [s]."""

_TIMEOUT = 0.1
"""A robot that gets no command for this long stops [s]. Source: ER-Force's standby time."""


class ProgramWorld(WrappedWorld):
    """Another world in which programs command the robots of one or both teams. A context manager.

    The field, as cameras without noise see it, is published once a control period, and so are the
    referee's decisions. The match waits for programs in lock step and answers each with its view after the
    time it asked for; with such programs only, a match is as fast as they are, and repeatable. Programs are
    started when the world is reset; the match begins once each of them has commanded its robots. Until then
    they are shown the field at rest and HALT.

    Args:
        world: the world to play in.
        scenario: the scenario that is played.
        programs: programs by team.
        folders: working folders of the programs, by team.
        outputs: files for the programs' output, by team.
        speed: simulated time over real time.

    Raises:
        OSError: there is no free port.
        SystemUnfitError: this is Windows.
    """

    def __init__(
        self,
        world: World,
        scenario: Scenario,
        programs: Mapping[Team, Program],
        folders: Mapping[Team, Path],
        outputs: Mapping[Team, Path],
        speed: float = 1.0,
    ) -> None:
        need_posix("a team's own program")
        super().__init__(world)
        self._programs, self._folders, self._outputs = programs, folders, outputs
        self._step, self._period = scenario.period / speed, scenario.period
        self._publisher = RefereePublisher(scenario.goalkeepers())
        self._uuid = str(UUID(bytes=np.random.default_rng(0).bytes(16), version=4))
        self._camera = Cameras(scenario.field, REALISM["none"], 1, np.random.default_rng(0))
        self._processes: dict[Team, TeamProcess] = {}
        self._commands: dict[RobotId, tuple[float, RobotCommand]] = {}
        self._heard: dict[Team, float] = {}
        self._judged: Frame | None = None
        self._seen: CameraFrame | None = None
        self._frames, self._stamp, self._stamped_from, self._began, self._due = 0, 0.0, 0.0, 0.0, 0.0
        self._printed: dict[Team, int] = {}
        shared = {name for program in programs.values() for name in program.league_groups}
        with ExitStack() as opened:
            self._ports = opened.enter_context(MatchPorts(programs, shared))
            self._steps = {
                team: opened.enter_context(StepPort(scenario.period))
                for team, program in programs.items()
                if program.lockstep
            }
            self._opened = opened.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is None:
                self._dismiss()
        finally:
            self.close()

    def close(self) -> None:
        """End the programs and release the ports."""
        self._opened.close()

    def _dismiss(self) -> None:
        """Let the programs end by themselves after a match that was played to its end.

        Raises:
            ForfeitError: one of them does not.
        """
        for process in self._processes.values():
            process.tell()
        for team, process in self._processes.items():
            within = self._programs[team].ends_within
            process.leave(within)
            if process.stubborn:
                problem = f"its program, or a child of it, did not end within {within:g} s of SIGTERM"
                raise ForfeitError(team, problem)

    def reset(self, placement: Placement, seed: int) -> None:
        """Put everything in its place and wait for the programs; see :meth:`robobt.world.World.reset`.

        Those that still run from another match play this one.

        Raises:
            ForfeitError: a program cannot be started, ends, or is not ready in time.
        """
        super().reset(placement, seed)
        self._heard.clear()
        self._judged, self._stamped_from = None, self._stamp
        for team, program in self._programs.items():
            running = self._processes.get(team)
            if running is not None and running.ended() is None:
                self._printed[team] = running.printed
                continue
            addresses = self._ports.addresses(team)
            if team in self._steps:
                addresses["steps"] = str(self._steps[team].port)
            command = program.words(addresses)
            try:
                self._outputs[team].parent.mkdir(parents=True, exist_ok=True)
                process = TeamProcess(command, self._folders[team], self._outputs[team])
            except OSError as error:
                raise ForfeitError(team, f"{command[0]}: {error.strerror or error}") from error
            self._processes[team] = self._opened.enter_context(process)
            self._printed[team] = 0
        self._began = self._due = time.monotonic()
        halted = GameState(command=RefereeCommand.HALT)
        while len(self._heard) < len(self._programs):
            truth = super().truth()
            truth.game = halted
            self._stamped_from += self._period
            self._publish(truth)
            self._wait(truth)
        self._stamped_from += self._period
        self._commands.clear()

    def truth(self) -> Frame:
        """See :meth:`robobt.world.World.truth`."""
        # The match writes the referee's decision into the frame.
        self._judged = super().truth()
        return self._judged

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Let the programs see the field and command their robots for a control period.

        Raises:
            ForfeitError: a program has ended, was silent for too long, floods its ports or prints too much.
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
        """Take in what the programs command until the control period may pass."""
        # What was lost is not caught up with: programs could not follow.
        self._due = max(self._due, time.monotonic() - self._step) + self._step
        in_real_time = len(self._steps) < len(self._programs)
        while True:
            for team, commands in self._ports.commands(truth).items():
                if team not in self._steps:
                    self._heard[team] = time.monotonic()
                    self._commands |= {robot: (truth.time, one) for robot, one in commands.items()}
            for team, port in self._steps.items():
                self._take_step(team, port, truth)
            waited_for = [port for port in self._steps.values() if not port.left]
            left = self._due - time.monotonic() if in_real_time else 0.0
            if left <= 0.0 and not waited_for:
                break
            if left <= 0.0:
                self._check()
            sockets = [one.fileno() for one in self._ports.sockets()] + [one.fileno() for one in waited_for]
            if select.select(sockets, [], [], left if left > 0.0 else _PROGRAM_POLL)[0]:
                # Who floods its port is read at most a thousand times a second.
                time.sleep(max(0.0, min(0.001, left)))
        self._ports.period_over()
        self._check()
        for port in self._steps.values():
            port.passed()

    def _take_step(self, team: Team, port: StepPort, truth: Frame) -> None:
        """Take in the request of a program in lock step, if it has come."""
        data = port.receive()
        if data is None:
            return
        states = {robot.number: state for robot, state in truth.robots().items() if robot.team is team}
        headings = {number: state.heading for number, state in states.items()}
        request = read_control(data, team, headings, port.counts)
        commands = {} if request is None else request.commands
        if commands or team in self._heard:
            self._heard[team] = time.monotonic()
        self._commands |= {robot: (truth.time, one) for robot, one in commands.items()}
        self._answer(team, port, truth)

    def _answer(self, team: Team, port: StepPort, truth: Frame) -> None:
        """Answer a program in lock step if as much time has passed as it asked for."""
        if self._seen is not None:
            robots = truth.robots().items()
            port.answer(
                self._seen, [one.number for one, state in robots if one.team is team and state.ball_contact]
            )

    def _check(self) -> None:
        """End the match if a program has lost it by rule."""
        if self._ports.flooded is not None:
            problem = f"its program sent more than {MOST_PACKETS} packets a control period, for too long"
            raise ForfeitError(self._ports.flooded, problem)
        for team, process in self._processes.items():
            program, port = self._programs[team], self._steps.get(team)
            ended = process.ended(wait=port is not None and port.problem is not None)
            if ended is not None:
                raise ForfeitError(team, ended)
            if process.printed - self._printed[team] > MOST_OUTPUT:
                raise ForfeitError(team, f"its program printed more than {MOST_OUTPUT >> 20} MB")
            if port is not None and port.problem is not None:
                raise ForfeitError(team, port.problem)
            now = time.monotonic()
            if team not in self._heard:
                if now - self._began > program.ready_within:
                    problem = f"its program did not command a robot within {program.ready_within:g} s"
                    raise ForfeitError(team, problem)
            elif now - self._heard[team] > program.silent_for:
                if port is not None and port.left:
                    # It is not its turn.
                    self._heard[team] = now
                    continue
                raise ForfeitError(team, f"its program was silent for {program.silent_for:g} s")

    def _publish(self, frame: Frame) -> None:
        stamp = self._stamp = self._stamped_from + frame.time
        (self._seen,) = self._camera.capture(frame, stamp, stamp)
        geometry = None
        if self._frames % GEOMETRY_INTERVAL == 0:
            geometry = write_geometry(frame.field, self._camera.places)
        senders = self._ports.senders
        senders["vision"].send(write_vision(self._seen, geometry))
        senders["tracker"].send(write_tracked(frame, self._frames, stamp, self._uuid))
        senders["referee"].send(self._publisher.write(frame.game, stamp))
        self._frames += 1
        # Last, as who plays in lock step then finds all else that is of this instant.
        for team, port in self._steps.items():
            self._answer(team, port, frame)
