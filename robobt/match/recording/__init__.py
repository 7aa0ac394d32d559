"""Recordings: a match's frames and what its trees did, in one file.

docs/recording.md describes the file and its queries. Writer and reader are imported at first use: they need
the extra ``record``, which a match without a recording does not.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from robobt.config.extras import need
from robobt.match.recording.header import Event as Event
from robobt.match.recording.header import RecordedNode as RecordedNode
from robobt.match.recording.header import RecordedRobot as RecordedRobot
from robobt.match.recording.header import RecordingError as RecordingError
from robobt.match.recording.header import RecordingHeader as RecordingHeader
from robobt.match.recording.header import RobotFlag as RobotFlag

if TYPE_CHECKING:
    from robobt.match.recording.reader import load_recording as load_recording
    from robobt.match.recording.recorder import Recorder as Recorder
    from robobt.match.recording.recording import Recording as Recording

_HOMES = {"load_recording": "reader", "Recorder": "recorder", "Recording": "recording"}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    need("record", "pyarrow")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
