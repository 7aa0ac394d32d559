"""Recordings: what a match looked like and what its trees thought, in one file.

docs/recording.md describes the file and what can be asked of it.
"""

from robobt.match.recording.header import (
    FORMAT,
    VERSION,
    Event,
    RecordedNode,
    RecordedRobot,
    RecordingError,
    RecordingHeader,
    RobotFlag,
)
from robobt.match.recording.reader import load_recording
from robobt.match.recording.recorder import Recorder
from robobt.match.recording.recording import Recording

__all__ = [
    "FORMAT",
    "VERSION",
    "Event",
    "RecordedNode",
    "RecordedRobot",
    "Recorder",
    "Recording",
    "RecordingError",
    "RecordingHeader",
    "RobotFlag",
    "load_recording",
]
