"""The engine over py_trees: leaf base, runner, registry. Knows nothing of physics.

Composites and decorators are py_trees' own, under their own names.
"""

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
