"""The policy of an evaluation in the live page."""

from time import perf_counter
from typing import Any

import numpy as np
import pytest

from robobt.learning.training import watched
from robobt.learning.training.problems import problem_of
from robobt.learning.training.results import FloatArray
from robobt.learning.training.settings import load_settings
from robobt.live.messages import Speed
from robobt.live.server import Server
from robobt.live.stream import Stream
from tests.live.test_stream import decoded


def ahead(observation: FloatArray) -> FloatArray:
    """Drive to the ball: its direction in the robot's frame is the first of what is observed."""
    return np.column_stack((observation[:, 1], observation[:, 0], observation[:, 0]))


def test_an_evaluation_is_shown_to_who_watches_and_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = load_settings("go_to_ball", "fast", {})
    monkeypatch.setattr(watched, "SHOWN_STARTS", 1)
    server = Server()
    problem = watched.watched_problem(server, settings)
    alone = problem_of(settings.environment).evaluate(ahead, "validation", 4)
    assert problem.evaluate(ahead, "validation", 4).times.tolist() == alone.times.tolist()
    assert server.audience.stream is None
    watching: Any = {1: object()}
    server.audience.viewers = watching
    server.inbox.put((Speed(do="speed", factor=20.0), perf_counter()))
    shown = problem.evaluate(ahead, "validation", 4)
    assert shown.success.tolist() == alone.success.tolist()
    stream: Stream | None = server.audience.stream
    assert stream is not None
    assert stream.header["scenario"] == f"go_to_ball: {alone.success.mean():.0%} of 4 validation starts"
    assert stream.advance()
    chunk = decoded(stream.messages(0, 2**20)[0][0])
    assert chunk["frames"] > 10
    assert server.audience.state["speed"] == 20.0
