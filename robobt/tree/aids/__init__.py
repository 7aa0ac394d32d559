"""Aids for writing and testing trees: a linter, see docs/trees.md."""

from robobt.tree.aids.linter import Finding, lint_tree
from robobt.tree.aids.outcomes import Outcomes, outcomes

__all__ = ["Finding", "Outcomes", "lint_tree", "outcomes"]
