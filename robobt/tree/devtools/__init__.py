"""Tools for writing and testing trees: a linter, substitution, statistics; see docs/trees.md."""

from robobt.tree.devtools.linter import Finding as Finding
from robobt.tree.devtools.linter import lint_tree as lint_tree
from robobt.tree.devtools.statistics import NodeCounts as NodeCounts
from robobt.tree.devtools.statistics import NodeStatistics as NodeStatistics
from robobt.tree.devtools.substitution import ScriptedLeaf as ScriptedLeaf
from robobt.tree.devtools.substitution import Substitution as Substitution
from robobt.tree.devtools.substitution import read_substitutions as read_substitutions
from robobt.tree.devtools.substitution import substitute as substitute
from robobt.tree.devtools.substitution import substitutions as substitutions
