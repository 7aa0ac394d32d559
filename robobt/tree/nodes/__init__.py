"""Control nodes beyond those of py_trees; docs/control_nodes.md describes each.

They are py_trees nodes like all others. Those with a time read it from the store
they are bound to, never from the wall clock.
"""

from robobt.tree.nodes.commit_for import CommitFor as CommitFor
from robobt.tree.nodes.commit_for import CommittingSelector as CommittingSelector
from robobt.tree.nodes.cooldown import Cooldown as Cooldown
from robobt.tree.nodes.delay import Delay as Delay
from robobt.tree.nodes.gate import Gate as Gate
from robobt.tree.nodes.hold_success import HoldSuccess as HoldSuccess
from robobt.tree.nodes.parallel_count import ParallelCount as ParallelCount
from robobt.tree.nodes.sequence_with_memory import SequenceWithMemory as SequenceWithMemory
from robobt.tree.nodes.switch import Switch as Switch
from robobt.tree.nodes.tick_divider import TickDivider as TickDivider
from robobt.tree.nodes.timeout import Timeout as Timeout
from robobt.tree.nodes.timer import HasTime as HasTime
from robobt.tree.nodes.timer import Timer as Timer
from robobt.tree.nodes.wait import Wait as Wait
