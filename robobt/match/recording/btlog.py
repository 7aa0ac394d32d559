"""A robot's part of a recording as a ``.btlog`` file, the form of BehaviorTree.CPP's FileLogger2.

| part | bytes |
| --- | --- |
| magic | ``BTCPP4-FileLogger2`` (18) |
| version | 1 (1 byte) |
| tree | its XML's size (int32) and the XML, with ``_uid`` and ``_fullpath`` at each node |
| start | time of the first tick in microseconds (int64) |
| changes | 9 bytes each: microseconds since the start (6), ``_uid`` (2), status (1) |

All numbers are little-endian. Statuses: 0 idle, 1 running, 2 success, 3 failure. Times are simulated, so a
match starts near 0 and not at the date it was played.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import quoteattr

from robobt.config.atomic import write_atomically
from robobt.config.wording import counted
from robobt.match.recording import RecordedNode, RecordedRobot, Recording
from robobt.tree.interop.btcpp import OTHER_TAGS, TAGS
from robobt.world.state import RobotId

MAGIC = b"BTCPP4-FileLogger2"
BTLOG_VERSION = 1
MOST_NODES = 2**16 - 1
"""Most nodes whose numbers, counted from 1, fit two bytes."""

_STATUS_CODES = {"-": 0, "R": 1, "S": 2, "F": 3}
_MODELS = {"leaf": "Action", "decorator": "Decorator", "composite": "Control"}


def write_btlog(recording: Recording, robot: RobotId, path: str | Path) -> Path:
    """Write the status changes of a robot's tree, from the recording alone, and return the file's path.

    Raises:
        KeyError: no such robot in this recording.
        ValueError: no tree was recorded for it, or one of too many nodes.
        OSError: the file cannot be written.
    """
    path = Path(path)
    write_atomically(path, btlog(recording, robot))
    return path


def btlog(recording: Recording, robot: RobotId) -> bytes:
    """The bytes of the file; see :func:`write_btlog`."""
    slot = recording.slot(robot)
    told = recording.header.robots[slot]
    if not told.tree:
        raise ValueError(f"no tree was recorded for {robot} in {recording.path}")
    if len(told.tree) > MOST_NODES:
        raise ValueError(
            f"the tree of {robot} has {counted(len(told.tree), 'node')}; a .btlog holds {MOST_NODES}"
        )
    xml = tree_xml(told).encode()
    start = _microseconds(recording.times[0]) if len(recording) else 0
    head = MAGIC + struct.pack("<Bi", BTLOG_VERSION, len(xml)) + xml + struct.pack("<q", start)
    return head + b"".join(_changes(recording, slot, start))


def tree_xml(robot: RecordedRobot) -> str:
    """The tree of a recorded robot in BehaviorTree.CPP's XML: nodes and their numbers, no parameters."""
    name = quoteattr(_printable(robot.tree[0].name))
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<root BTCPP_format="4" main_tree_to_execute={name}>',
        f'  <BehaviorTree ID={name} _fullpath="">',
    ]
    opened: list[str] = []
    tags = [_tag(node) for node in robot.tree]
    depths = [node.depth for node in robot.tree] + [0]
    for place, (node, tag) in enumerate(zip(robot.tree, tags, strict=True)):
        while len(opened) > node.depth:
            lines.append(f"{'  ' * (len(opened) + 1)}</{opened.pop()}>")
        indent = "  " * (node.depth + 2)
        attributes = (
            f"name={quoteattr(_printable(node.name))} _uid={quoteattr(str(place + 1))} "
            f"_fullpath={quoteattr(_printable(node.path))}"
        )
        if depths[place + 1] > node.depth:
            lines.append(f"{indent}<{tag} {attributes}>")
            opened.append(tag)
        else:
            lines.append(f"{indent}<{tag} {attributes}/>")
    while opened:
        lines.append(f"{'  ' * (len(opened) + 1)}</{opened.pop()}>")
    lines += ["  </BehaviorTree>", "  <TreeNodesModel>"]
    models = {
        tag: _MODELS[node.kind]
        for node, tag in zip(robot.tree, tags, strict=True)
        if node.kind == "leaf" or tag not in TAGS
    }
    lines += [f"    <{kind} ID={quoteattr(tag)}/>" for tag, kind in models.items()]
    return "\n".join([*lines, "  </TreeNodesModel>", "</root>", ""])


def _changes(recording: Recording, slot: int, start: int) -> Iterator[bytes]:
    before = "-" * len(recording.header.robots[slot].tree)
    for tick, letters in recording.statuses[slot]:
        time = (_microseconds(recording.times[tick]) - start).to_bytes(6, "little")
        for place, (letter, old) in enumerate(zip(letters, before, strict=True)):
            if letter != old:
                yield time + struct.pack("<HB", place + 1, _STATUS_CODES[letter])
        before = letters


def _tag(node: RecordedNode) -> str:
    if node.kind == "leaf":
        # A skill may have the name of one of BehaviorTree.CPP's leaves without being that leaf.
        return node.type
    for tag, entry in TAGS.items():
        memory = entry.fixed.get("memory")
        if entry.type == node.type and memory in (None, node.detail == "memory"):
            return tag
    return next((tag for tag, name in OTHER_TAGS.items() if name == node.type), node.type)


def _microseconds(seconds: float) -> int:
    return round(float(seconds) * 1e6)


def _printable(text: str) -> str:
    """The text without the characters that XML does not have."""
    return re.sub(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\ufffd", text)
