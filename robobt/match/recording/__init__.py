"""Recordings: what a match looked like and what its trees thought, in one file.

docs/recording.md describes the file and what can be asked of it.
"""

from robobt.match.recording.header import Event as Event
from robobt.match.recording.header import RecordedNode as RecordedNode
from robobt.match.recording.header import RecordedRobot as RecordedRobot
from robobt.match.recording.header import RecordingError as RecordingError
from robobt.match.recording.header import RecordingHeader as RecordingHeader
from robobt.match.recording.header import RobotFlag as RobotFlag
from robobt.match.recording.reader import load_recording as load_recording
from robobt.match.recording.recorder import Recorder as Recorder
from robobt.match.recording.recording import Recording as Recording
