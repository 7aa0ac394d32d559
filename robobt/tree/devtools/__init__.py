"""Aids for writing and testing trees: a linter, substitution, statistics; see docs/trees.md."""

from robobt.tree.devtools.linter import Finding, lint_tree
from robobt.tree.devtools.possible_outcomes import Outcomes, outcomes
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
    "Outcomes",
    "ScriptedLeaf",
    "Substitution",
    "lint_tree",
    "outcomes",
    "read_substitutions",
    "substitute",
    "substitutions",
]
