"""Tools for writing and testing trees: a linter, substitution, statistics; see docs/trees.md."""

from robobt.tree.devtools.linter import Finding, lint_tree
from robobt.tree.devtools.statistics import NodeCounts, NodeStatistics
from robobt.tree.devtools.substitution import (
    ScriptedLeaf,
    Substitution,
    read_substitutions,
    substitute,
    substitutions,
)

__all__ = [
    "Finding",
    "NodeCounts",
    "NodeStatistics",
    "ScriptedLeaf",
    "Substitution",
    "lint_tree",
    "read_substitutions",
    "substitute",
    "substitutions",
]
