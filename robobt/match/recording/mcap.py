"""A recording as an MCAP file, which Foxglove and Rerun open.

| topic | message | written |
| --- | --- | --- |
| ``/truth`` | ``foxglove.FrameTransforms``: ball and robots as they were | at every tick |
| ``/vision`` | the same as the trees saw them | at every tick |
| ``/field`` | ``foxglove.SceneUpdate``: lines and goals | at the first tick |
| ``/truth/shapes`` | ``foxglove.SceneUpdate``: bodies of ball and robots | when one comes or goes |
| ``/vision/shapes`` | the same where the trees saw them | when one comes or goes |
| ``/drawings/blue/3`` | ``foxglove.SceneUpdate``: what the skills of a robot drew | when that changed |
| ``/numbers/blue/3`` | ``robobt.Number``: a number that a skill published | when that changed |
| ``/trees/blue/3`` | ``robobt.TreeStatus``: every node's status and reason | when one changed |
| ``/referee`` | ``foxglove.Log``: command and score | when they changed |
| ``/events`` | ``foxglove.Log``: goals, kicks, fouls, errors | at the event |

What the world itself drew is on ``/drawings/field``. Coordinates are those of the world, in metres, from the
field's centre; blue defends -x. Times are those of the frames: simulated ones start near 0. Messages are
Protocol Buffers, the only encoding in which both Foxglove and Rerun know Foxglove's schemas
(https://docs.foxglove.dev/docs/sdk/schemas, https://rerun.io/docs/reference/mcap/message-formats).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from heapq import merge
from math import isnan
from operator import itemgetter
from pathlib import Path
from typing import Any, TypeAlias

from robobt.config.atomic import replacing
from robobt.config.errors import naming
from robobt.config.extras import need
from robobt.match.recording.header import Event, RecordedRobot
from robobt.match.recording.recording import Poses, Recording, Timeline
from robobt.world.game import GameState, Team
from robobt.world.sketch import Shape

need("mcap", "mcap_protobuf", "foxglove_schemas_protobuf")

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms  # noqa: E402
from foxglove_schemas_protobuf.Log_pb2 import Log  # noqa: E402
from mcap_protobuf.writer import Writer  # noqa: E402

from robobt.match.recording import mcap_scene as scene  # noqa: E402
from robobt.match.recording.mcap_messages import NUMBER, TREE_STATUS, stamp  # noqa: E402

Message: TypeAlias = tuple[int, str, Any]
"""Time [ns], topic, and the message itself."""

_STATUS_NUMBERS = {"-": 0, "R": 1, "S": 2, "F": 3}
_time_of = itemgetter(0)


def write_mcap(recording: Recording, path: str | Path) -> Path:
    """Write a recording as an MCAP file and return where it is.

    Args:
        recording: what to write, incomplete ones too.
        path: the file; it takes its place once it is whole.

    Raises:
        ValueError: the recording has times before 0, which MCAP has not.
        OSError: the file cannot be written.
    """
    path = Path(path)
    header = recording.header
    about = header.model_dump(mode="json", include={"scenario", "trial", "seed", "period", "teams", "robobt"})
    about["plays"] = {str(robot.id): robot.play for robot in header.robots}
    with replacing(path) as temporary, naming(path), temporary.open("wb") as file, Writer(file) as writer:
        writer.add_metadata("recording", _texts(about))
        for time, topic, message in messages(recording):
            writer.write_message(topic, message, log_time=time, publish_time=time)
        if recording.outcome is not None:
            writer.add_metadata("outcome", _texts(recording.outcome))
    return path


def messages(recording: Recording) -> Iterator[Message]:
    """Yield the messages of a recording in the order of their times.

    Raises:
        ValueError: the recording has times before 0.
    """
    times = [_nanoseconds(time) for time in recording.times.tolist()]
    events = [_event(event) for event in recording.events]
    # A tick holds the events since the one before it, in the order in which they were noticed.
    events.sort(key=_time_of)
    if any(time < 0 for time in [*times[:1], *map(_time_of, events[:1])]):
        raise ValueError(f"{recording.path} begins before time 0, and MCAP has no times before it")
    streams: list[Iterable[Message]] = [
        _poses("/truth", recording, recording.truth, times),
        _poses("/vision", recording, recording.observed or recording.truth, times),
        [(time, "/field", scene.field(recording.header.field, time)) for time in times[:1]],
        events,
        [_referee(game, times[tick]) for tick, game in recording.games],
    ]
    for slot, robot in enumerate(recording.header.robots):
        if robot.tree:
            streams.append(_tree(robot, recording.letters[slot], recording.feedback[slot], times))
    streams += [_drawings(owner, drawn, times) for owner, drawn in recording.drawn.items()]
    return merge(*streams, key=_time_of)


def _poses(topic: str, recording: Recording, poses: Poses, times: list[int]) -> Iterator[Message]:
    """Where ball and robots are at every tick, and their bodies whenever one comes or goes."""
    robots = recording.header.robots
    frames = {robot.id: f"{topic[1:]}/{robot.id}" for robot in robots}
    ball_frame = f"{topic[1:]}/ball"
    before: list[bool] | None = None
    for time, ball, rows in zip(times, poses.ball.tolist(), poses.robots.tolist(), strict=True):
        seen = [not isnan(ball[0]), *[not isnan(row[0]) for row in rows]]
        if seen != before:
            bodies = [scene.ball(ball_frame, time)] if seen[0] else []
            bodies += [
                scene.robot(robot, frames[robot.id], time)
                for robot, there in zip(robots, seen[1:], strict=True)
                if there
            ]
            yield time, f"{topic}/shapes", scene.update(bodies, time)
            before = seen
        placed = [scene.transform(ball_frame, ball[0], ball[1], ball[4], 0.0, time)] if seen[0] else []
        placed += [
            scene.transform(frames[robot.id], row[0], row[1], 0.0, row[2], time)
            for robot, row, there in zip(robots, rows, seen[1:], strict=True)
            if there
        ]
        yield time, topic, FrameTransforms(transforms=placed)


def _tree(
    robot: RecordedRobot, letters: Timeline[str], feedback: Timeline[dict[int, str]], times: list[int]
) -> Iterator[Message]:
    """Every node of a robot's tree whenever a status or a reason changed."""
    new_letters, new_feedback = dict(letters), dict(feedback)
    now, reasons = "-" * len(robot.tree), [""] * len(robot.tree)
    for tick in sorted({*new_letters, *new_feedback}):
        now = new_letters.get(tick, now)
        for place, text in new_feedback.get(tick, {}).items():
            reasons[place] = text
        nodes = [
            {
                "path": node.path,
                "name": node.name,
                "type": node.type,
                "status": _STATUS_NUMBERS[letter.upper()],
                "ticked": letter in "SFR",
                "reason": "" if letter == "-" else reason,
            }
            for node, letter, reason in zip(robot.tree, now, reasons, strict=True)
        ]
        yield (
            times[tick],
            _topic("trees", str(robot.id)),
            TREE_STATUS(timestamp=stamp(times[tick]), nodes=nodes),
        )


def _drawings(owner: str, drawn: Timeline[list[Shape]], times: list[int]) -> Iterator[Message]:
    """What somebody drew whenever it changed, and the numbers among it."""
    # Skills draw in the view of their team, in which its goal is at -x.
    sign = -1.0 if owner.startswith(Team.YELLOW.value) else 1.0
    for tick, shapes in drawn:
        time = times[tick]
        yield time, _topic("drawings", owner), scene.update(scene.drawing(shapes, sign, time), time)
        for layer, kind, *rest in shapes:
            if kind == "number":
                value, name = rest
                number = NUMBER(timestamp=stamp(time), layer=layer, name=name, value=value)
                yield time, _topic("numbers", owner), number


def _event(event: Event) -> Message:
    time = _nanoseconds(event.time)
    name = str(event.robot or event.team or "match")
    text = f"{event.kind}: {event.text}" if event.text else event.kind
    level = Log.Level.ERROR if event.kind == "error" else Log.Level.INFO
    return time, "/events", Log(timestamp=stamp(time), level=level, name=name, message=text)


def _referee(game: GameState, time: int) -> Message:
    text = f"{game.command.name}, blue {game.blue_score} : {game.yellow_score} yellow"
    return time, "/referee", Log(timestamp=stamp(time), level=Log.Level.INFO, name="referee", message=text)


def _topic(kind: str, owner: str) -> str:
    return f"/{kind}/{owner.replace(' ', '/')}"


def _texts(data: Mapping[str, object]) -> dict[str, str]:
    return {
        name: value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
        for name, value in data.items()
    }


def _nanoseconds(seconds: float) -> int:
    return round(seconds * 1e9)
