"""Control nodes where soccer needs more than py_trees has; docs/trees.md describes what each does.

They are py_trees nodes like all others. Those with a time read it from the store
they are bound to, never from the wall clock.
"""

from robobt.tree.nodes.commit_for import CommitFor, CommittingSelector
from robobt.tree.nodes.cooldown import Cooldown
from robobt.tree.nodes.delay import Delay
from robobt.tree.nodes.gate import Gate
from robobt.tree.nodes.hold_success import HoldSuccess
from robobt.tree.nodes.parallel_count import ParallelCount
from robobt.tree.nodes.sequence_with_memory import SequenceWithMemory
from robobt.tree.nodes.switch import Switch
from robobt.tree.nodes.tick_divider import TickDivider
from robobt.tree.nodes.timeout import Timeout
from robobt.tree.nodes.timer import HasTime, Timer
from robobt.tree.nodes.wait import Wait

__all__ = [
    "CommitFor",
    "CommittingSelector",
    "Cooldown",
    "Delay",
    "Gate",
    "HasTime",
    "HoldSuccess",
    "ParallelCount",
    "SequenceWithMemory",
    "Switch",
    "TickDivider",
    "Timeout",
    "Timer",
    "Wait",
]
