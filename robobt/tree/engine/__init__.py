"""Ticks any py_trees tree without generators, many times faster, to the same effect.

py_trees ticks by yielding every node through every level, builds log strings
nobody reads, and makes a new generator at every stop. :func:`compile_tree` walks
a tree once and makes, for every node whose class ticks and stops as py_trees'
own classes do, a pair of closures that do the same to the node: the same order
of visits, the same ``initialise``, ``update`` and ``terminate`` calls with the
same arguments, the same ``status``, ``current_child`` and feedback. All state
stays on the nodes, so ``tip()``, ``display`` and ``stop()`` work as ever, and
ticks of both kinds may be mixed. A node whose class has a ``tick`` or ``stop``
of its own is ticked through them, unless the class that defines them brings its
own closures, see :class:`BringsClosures`.

What differs: the attribute ``iterator`` of a node is not renewed, and nothing
is logged at debug level.
"""

from robobt.tree.engine.closures import BringsClosures, Marks, Stop, Tick, Visit, not_a_status, own_method
from robobt.tree.engine.dispatch import compile_node, compile_tree
from robobt.tree.engine.fast_tree import LEAVING, FastTree, abandon
from robobt.tree.engine.plan import Plan, composite_stop, replan
from robobt.tree.engine.reach import stops_children, ticked_children

__all__ = [
    "LEAVING",
    "BringsClosures",
    "FastTree",
    "Marks",
    "Plan",
    "Stop",
    "Tick",
    "Visit",
    "abandon",
    "compile_node",
    "compile_tree",
    "composite_stop",
    "not_a_status",
    "own_method",
    "replan",
    "stops_children",
    "ticked_children",
]
