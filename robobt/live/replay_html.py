"""A recording as one HTML page that needs nothing else: no network, no files beside it.

The page's address may say where to start: ``#t=12.5&robot=blue 3&labels``.
"""

from __future__ import annotations

import html
import json
from dataclasses import asdict
from pathlib import Path

from robobt.config.atomic import write_atomically
from robobt.live.page_data import ChunkEncoder, header_data
from robobt.live.page_files import bundle, page_text
from robobt.match.recording import Recording, load_recording
from robobt.match.recording.recording import Timeline
from robobt.match.recording.statistics import recorded_statistics
from robobt.match.recording.stores import plain

MOST_FRAMES = 36_000
"""Frames a page holds, ten minutes at 60 Hz; of a longer recording every second, third, ... is shown."""

MOST_FEEDBACK = 40_000
"""Changes of feedback a page holds as they came; beyond, a node's words change ten times a second at most."""

_FEEDBACK_PERIOD = 0.1

_PAGE_HEAD = """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; \
style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:">
<style>
{style}</style>"""

_PAGE_SCRIPTS = """<script type="application/json" id="recording">{data}</script>
<script>
{script}</script>"""


_TITLE_END = " · robobt replay"
"""How the titles of replay pages end."""


def is_replay(path: Path) -> bool:
    """Return whether the file at ``path`` begins as a page that :func:`write_html` has written."""
    with path.open("rb") as file:
        return f"{_TITLE_END}</title>".encode() in file.read(2**16)


def write_html(recording: Recording | str | Path, path: str | Path) -> Path:
    """Write the page of a recording, or of a recording's file, and return where it is."""
    if not isinstance(recording, Recording):
        recording = load_recording(recording)
    path = Path(path)
    write_atomically(path, replay_html(recording))
    return path


def replay_html(recording: Recording) -> str:
    """Return the page: field, robots, ball, timeline, and the tree of the robot that is selected."""
    header = recording.header
    title = html.escape(f"{header.scenario or 'match'}, trial {header.trial}{_TITLE_END}")
    # Cut the page before anything is put in: what a recording says may look like a place to fill.
    start, rest = page_text("viewer.html").split("{{title}}")
    middle, rest = rest.split("{{head}}")
    body, end = rest.split("{{scripts}}")
    head = _PAGE_HEAD.replace("{style}", page_text("viewer.css"))
    before, after = _PAGE_SCRIPTS.replace("{script}", bundle("replay.js")).split("{data}")
    data = _for_script(page_data(recording))
    return f"{start}{title}{middle}{head}{body}{before}{data}{after}{end}"


def page_data(recording: Recording) -> dict[str, object]:
    """Return what the page is given, as JSON can hold it; see :mod:`robobt.live.page_data`."""
    header = recording.header
    stride = max(1, -(-len(recording) // MOST_FRAMES))
    feedback = recording.feedback
    if sum(len(said) for tree in feedback for _, said in tree) > MOST_FEEDBACK:
        feedback = [_thinned(recording, slot) for slot in range(len(header.robots))]
    known = header_data(header)
    chunk = ChunkEncoder(header).chunk(recording, recording.statuses, feedback, stride)
    robots = [{**fixed, **robot} for fixed, robot in zip(known["robots"], chunk["robots"], strict=True)]  # type: ignore[call-overload]
    figures = {name: asdict(team) for name, team in recorded_statistics(recording).items()}
    return {**known, **chunk, "robots": robots, "outcome": plain(recording.outcome), "figures": figures}


def _for_script(data: dict[str, object]) -> str:
    """Return JSON that a script element can hold: it has no tag, no comment and no entity in it."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _thinned(recording: Recording, slot: int) -> Timeline[dict[int, str]]:
    """Return the feedback of one tree, a node's ten times a second unless the tree changed as well."""
    turns = {tick for tick, _ in recording.letters[slot]}
    times = recording.times.tolist()
    shown: dict[int, float] = {}
    kept = []
    for tick, said in recording.feedback[slot]:
        now = times[tick]
        fresh = {
            node: text
            for node, text in said.items()
            if tick in turns or now - shown.get(node, -1.0) >= _FEEDBACK_PERIOD
        }
        if fresh:
            shown.update(dict.fromkeys(fresh, now))
            kept.append((tick, fresh))
    return kept
