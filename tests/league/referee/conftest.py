from __future__ import annotations

import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from robobt.league.referee.lockstep import LockstepController
from robobt.league.wire.messages import CiInput, Referee
from robobt.league.wire.stream import MessageStream
from tests.league.referee.fake_controller import serve

ROOT = Path(__file__).parents[3]

Connect = Callable[[Callable[[CiInput], list[Referee]]], LockstepController]


@pytest.fixture
def connect() -> Iterator[Connect]:
    """A controller in a thread of this process, driven by ours."""
    with ExitStack() as stack:

        def connected(handle: Callable[[CiInput], list[Referee]]) -> LockstepController:
            here, there = _pair(stack)
            thread = threading.Thread(target=serve, args=(there, handle))
            thread.start()
            stack.callback(thread.join)
            stream = stack.enter_context(MessageStream(here, "the game controller"))
            return LockstepController(stream)

        yield connected


def _pair(stack: ExitStack) -> tuple[socket.socket, socket.socket]:
    server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
    here = socket.create_connection(server.getsockname())
    there, _ = server.accept()
    return here, there


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program that takes the place of the official one."""
    path = tmp_path / "fake-game-controller"
    module = "tests.league.referee.fake_controller"
    path.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m {module} "$@" "{path}"\n')
    path.chmod(0o755)
    return path
