"""Ticks any py_trees tree without generators, many times faster, with the same effect.

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

# Makes the closures of py_trees' own composites known.
from robobt.tree.engine import composites as composites
from robobt.tree.engine.closures import FAILURE as FAILURE
from robobt.tree.engine.closures import INVALID as INVALID
from robobt.tree.engine.closures import RUNNING as RUNNING
from robobt.tree.engine.closures import BringsClosures as BringsClosures
from robobt.tree.engine.closures import Marks as Marks
from robobt.tree.engine.closures import Stop as Stop
from robobt.tree.engine.closures import Tick as Tick
from robobt.tree.engine.closures import Visit as Visit
from robobt.tree.engine.closures import marks_of as marks_of
from robobt.tree.engine.closures import not_a_status as not_a_status
from robobt.tree.engine.closures import own_method as own_method
from robobt.tree.engine.closures import shown as shown
from robobt.tree.engine.dispatch import compile_node as compile_node
from robobt.tree.engine.dispatch import compile_tree as compile_tree
from robobt.tree.engine.dispatch import register as register
from robobt.tree.engine.dispatch import ticked_children as ticked_children
from robobt.tree.engine.fast_tree import LEAVING as LEAVING
from robobt.tree.engine.fast_tree import FastTree as FastTree
from robobt.tree.engine.fast_tree import abandon as abandon
from robobt.tree.engine.plan import Plan as Plan
from robobt.tree.engine.plan import composite_stop as composite_stop
from robobt.tree.engine.plan import replan as replan
