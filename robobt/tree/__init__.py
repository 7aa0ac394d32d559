"""The engine over py_trees: leaf base, runner, registry. It is independent of physics.

Composites and decorators are py_trees' own, under their own names.
"""

from typing import TYPE_CHECKING

from py_trees.behaviour import Behaviour as Behaviour
from py_trees.common import Status as Status
from py_trees.composites import Parallel as Parallel
from py_trees.composites import Selector as Selector
from py_trees.composites import Sequence as Sequence
from py_trees.decorators import FailureIsSuccess as FailureIsSuccess
from py_trees.decorators import Inverter as Inverter
from py_trees.decorators import OneShot as OneShot
from py_trees.decorators import Repeat as Repeat
from py_trees.decorators import Retry as Retry
from py_trees.decorators import SuccessIsFailure as SuccessIsFailure

from robobt.config.lazy import lazily
from robobt.tree.check import WiringError as WiringError
from robobt.tree.check import check_tree as check_tree
from robobt.tree.drawing import tree_dot as tree_dot
from robobt.tree.drawing import tree_text as tree_text
from robobt.tree.engine import FastTree as FastTree
from robobt.tree.engine import compile_tree as compile_tree
from robobt.tree.leaf import Leaf as Leaf
from robobt.tree.leaf import bind as bind
from robobt.tree.registry import Registry as Registry
from robobt.tree.runner import TreeError as TreeError
from robobt.tree.runner import TreeRunner as TreeRunner
from robobt.tree.svg import tree_svg as tree_svg
from robobt.tree.walk import node_path as node_path
from robobt.tree.walk import preorder as preorder

_HOMES = {
    "CommitFor": "nodes",
    "CommittingSelector": "nodes",
    "Cooldown": "nodes",
    "Delay": "nodes",
    "Finding": "devtools",
    "Gate": "nodes",
    "HoldSuccess": "nodes",
    "NodeStatistics": "devtools",
    "ParallelCount": "nodes",
    "SequenceWithMemory": "nodes",
    "Switch": "nodes",
    "TickDivider": "nodes",
    "Timeout": "nodes",
    "Timer": "nodes",
    "Wait": "nodes",
    "lint_tree": "devtools",
    "substitute": "devtools",
}

if TYPE_CHECKING:
    from robobt.tree.devtools import Finding as Finding
    from robobt.tree.devtools import NodeStatistics as NodeStatistics
    from robobt.tree.devtools import lint_tree as lint_tree
    from robobt.tree.devtools import substitute as substitute
    from robobt.tree.nodes import CommitFor as CommitFor
    from robobt.tree.nodes import CommittingSelector as CommittingSelector
    from robobt.tree.nodes import Cooldown as Cooldown
    from robobt.tree.nodes import Delay as Delay
    from robobt.tree.nodes import Gate as Gate
    from robobt.tree.nodes import HoldSuccess as HoldSuccess
    from robobt.tree.nodes import ParallelCount as ParallelCount
    from robobt.tree.nodes import SequenceWithMemory as SequenceWithMemory
    from robobt.tree.nodes import Switch as Switch
    from robobt.tree.nodes import TickDivider as TickDivider
    from robobt.tree.nodes import Timeout as Timeout
    from robobt.tree.nodes import Timer as Timer
    from robobt.tree.nodes import Wait as Wait
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
