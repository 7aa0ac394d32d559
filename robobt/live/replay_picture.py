"""A moment of a recording as a picture, or a stretch of it as an animation, as documents show them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from robobt.config.atomic import replacing
from robobt.config.errors import RobobtError
from robobt.match.recording import Recording
from robobt.world.painting import Painter, font
from robobt.world.state import RobotId

MOST_PICTURES = 1500
"""Pictures an animation holds, two minutes: a longer one is a page's work."""

_PERIOD = 0.08
"""Time from one picture of an animation to the next; the format counts hundredths [s]."""

_TRAIL_TIME = 1.0
"""Duration of the ball's path that is shown [s]."""

_BAR_HEIGHT, _ROW_HEIGHT, _PANEL_WIDTH, _INDENT_WIDTH = 28, 19, 300, 14
_PAPER, _INK, _FAINT = (246, 248, 250), (23, 33, 43), (150, 160, 170)
_STATUS_COLOURS = {"S": (31, 157, 91), "F": (221, 75, 65), "R": (47, 125, 240)}


class RecordingPainter:
    """Paints a recording: the field, time and score below it, and the tree of one robot beside it.

    Args:
        recording: the recording that is shown.
        robot: whose tree is shown; None for none.
        width: of the field's picture [px].
    """

    def __init__(self, recording: Recording, robot: RobotId | None = None, width: int = 640) -> None:
        self.recording, self.robot = recording, robot
        self._painter = Painter(recording.header.field, width=width)

    def paint(self, tick: int) -> Image.Image:
        """Return the picture of a tick."""
        recording = self.recording
        frame = recording.frame(tick)
        robots = [
            (robot.team, str(robot.number), state.x, state.y, state.heading)
            for robot, state in frame.robots().items()
        ]
        first = int(np.searchsorted(recording.times, frame.time - _TRAIL_TIME))
        way = recording.truth.ball[first : tick + 1, :2]
        trail = [(x, y) for x, y in way[np.isfinite(way).all(axis=1)].tolist()]
        field = self._painter.paint(robots, frame.ball.position, ball_trail=trail)
        panel = _PANEL_WIDTH if self.robot is not None else 0
        picture = Image.new("RGB", (field.width + panel, field.height + _BAR_HEIGHT), _PAPER)
        picture.paste(field, (0, 0))
        pen = ImageDraw.Draw(picture)
        score = f"blue {frame.game.blue_score} : {frame.game.yellow_score} yellow"
        told = [event for event in recording.events if frame.time - _TRAIL_TIME < event.time <= frame.time]
        parts = [f"{frame.time:.2f} s", score, *[event.kind.replace("_", " ") for event in told[-1:]]]
        pen.text(
            (10, field.height + _BAR_HEIGHT / 2), "     ".join(parts), fill=_INK, font=font(14), anchor="lm"
        )
        if self.robot is not None:
            self._paint_tree(pen, self.robot, tick, field.width + 12, field.height + _BAR_HEIGHT)
        return picture

    def _paint_tree(self, pen: ImageDraw.ImageDraw, robot: RobotId, tick: int, x: int, height: int) -> None:
        nodes, letters = self.recording.nodes(robot), self.recording.letters_at(robot, tick)
        if letters.islower():  # the match is over: what was ticked last
            letters = letters.upper()
        pen.text((x, 16), f"{robot}", fill=_INK, font=font(15), anchor="lm")
        rows = list(zip(nodes, letters, strict=True))
        room = (height - 2 * _ROW_HEIGHT) // _ROW_HEIGHT
        if len(rows) > room:  # too large to show whole: what was ticked
            rows = [(node, letter) for node, letter in rows if letter in _STATUS_COLOURS][:room]
        for row, (node, letter) in enumerate(rows):
            left, middle = x + node.depth * _INDENT_WIDTH, 2 * _ROW_HEIGHT + row * _ROW_HEIGHT
            colour = _STATUS_COLOURS.get(letter)
            pen.ellipse((left, middle - 4, left + 8, middle + 4), fill=colour, outline=colour or _FAINT)
            ink = _FAINT if colour is None else _INK
            pen.text((left + 14, middle), " ".join(node.name.split()), fill=ink, font=font(13), anchor="lm")


def tick_of(recording: Recording, time: float | None, otherwise: int) -> int:
    """Return the last tick not after a time [s]; without one the one at ``otherwise``.

    Raises:
        RobobtError: nothing was recorded then.
    """
    times = recording.times
    if not len(times):
        raise RobobtError(f"{recording.path} holds no tick")
    if time is None:
        return range(len(times))[otherwise]
    if not times[0] <= time <= times[-1] + recording.header.period:
        raise RobobtError(f"{recording.path} holds {times[0]:.2f} to {times[-1]:.2f} s, not {time:g} s")
    return int(np.searchsorted(times, time, side="right")) - 1


def write_png(
    recording: Recording, path: Path, time: float | None = None, robot: RobotId | None = None
) -> Path:
    """Write the picture of a time [s], of the end by default, and return where it is.

    Raises:
        RobobtError: that time was not recorded.
    """
    picture = RecordingPainter(recording, robot).paint(tick_of(recording, time, -1))
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as draft:
        picture.save(draft, "PNG", optimize=True)
    return path


def write_gif(
    recording: Recording,
    path: Path,
    start: float | None = None,
    end: float | None = None,
    robot: RobotId | None = None,
) -> Path:
    """Write an animation that runs in real time from ``start`` to ``end`` [s], and return where it is.

    Raises:
        RobobtError: that stretch was not recorded, is empty or would take more than two minutes.
    """
    begin, until = recording.times[[tick_of(recording, start, 0), tick_of(recording, end, -1)]].tolist()
    moments = np.arange(begin, until + 1e-9, _PERIOD)
    if not 2 <= len(moments) <= MOST_PICTURES:
        most = MOST_PICTURES * _PERIOD
        raise RobobtError(f"{until - begin:.2f} s are no animation: choose between {_PERIOD} and {most:g} s")
    stage = RecordingPainter(recording, robot)
    ticks = [tick_of(recording, moment, 0) for moment in moments]
    palette = _palette([stage.paint(ticks[place]) for place in (0, len(ticks) // 2, -1)])

    def pictures() -> Iterator[Image.Image]:
        for tick in ticks:
            yield stage.paint(tick).quantize(palette=palette, dither=Image.Dither.NONE)

    following = pictures()
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as draft:
        next(following).save(
            draft, "GIF", save_all=True, append_images=following, duration=round(1000 * _PERIOD), loop=0
        )
    return path


def _palette(pictures: list[Image.Image]) -> Image.Image:
    """Return colours that serve all of an animation: of one picture's own, the next would flicker."""
    width, height = pictures[0].size
    together = Image.new("RGB", (width, height * len(pictures)))
    for place, picture in enumerate(pictures):
        together.paste(picture, (0, place * height))
    return together.quantize(64, dither=Image.Dither.NONE)
