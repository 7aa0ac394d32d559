"""The engine over py_trees: leaf base, runner, registry. Knows nothing of physics.

Composites and decorators are py_trees' own, under their own names.
"""

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Parallel, Selector, Sequence
from py_trees.decorators import FailureIsSuccess, Inverter, OneShot, Repeat, Retry, SuccessIsFailure

from robobt.tree.check import WiringError, check_tree
from robobt.tree.drawing import tree_dot, tree_svg, tree_text
from robobt.tree.engine import FastTree, compile_tree
from robobt.tree.leaf import Leaf, bind
from robobt.tree.registry import Registry
from robobt.tree.runner import TreeError, TreeRunner, node_path, preorder

__all__ = [
    "Behaviour",
    "FailureIsSuccess",
    "FastTree",
    "Inverter",
    "Leaf",
    "OneShot",
    "Parallel",
    "Registry",
    "Repeat",
    "Retry",
    "Selector",
    "Sequence",
    "Status",
    "SuccessIsFailure",
    "TreeError",
    "TreeRunner",
    "WiringError",
    "bind",
    "check_tree",
    "compile_tree",
    "node_path",
    "preorder",
    "tree_dot",
    "tree_svg",
    "tree_text",
]
