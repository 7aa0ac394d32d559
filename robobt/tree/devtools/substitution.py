"""Replaces nodes of a built tree by leaves that follow a script, to test the rest of the tree."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import cast

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Composite, Parallel
from py_trees.decorators import Decorator

from robobt.config.yaml import MAX_YAML_BYTES, Marked, Scalar, parse_marked, read_limited
from robobt.tree.interop.model import TreeFileError
from robobt.tree.walk import node_path


class ScriptedLeaf(Behaviour):
    """Returns the statuses of a script in turn, a tick each, and the last one from then on.

    Neither its end nor an interruption restarts the script.

    Args:
        script: at least one status.
    """

    def __init__(self, name: str, script: Iterable[Status]) -> None:
        super().__init__(name)
        self.script = tuple(script)
        self.ticks = 0
        if not self.script:
            raise ValueError(f"the script of {name!r} is empty")

    def update(self) -> Status:
        """Return the next status of the script."""
        status = self.script[min(self.ticks, len(self.script) - 1)]
        self.ticks += 1
        self.feedback_message = f"scripted, tick {self.ticks}"
        return status


@dataclass(frozen=True, slots=True)
class Substitution:
    """A rule: which nodes are replaced, and by what.

    Attributes:
        pattern: pattern of the nodes' paths, such as ``*/GoToBall``; ``*`` stands for any text,
            slashes too, ``?`` and ``[...]`` as in file names; upper and lower case differ.
        script: statuses that the replacing leaf returns, one per tick; the last one stays.
        source, line: place of the rule, for messages.
    """

    pattern: str
    script: tuple[Status, ...]
    source: str = "rules"
    line: int | None = None


def read_substitutions(path: str | Path) -> list[Substitution]:
    """Read the rules of a YAML file.

    A mapping from patterns to a status, a list of statuses, or a mapping with one of both
    under ``status`` or ``script``::

        "*/GoToBall": SUCCESS
        "*/kick away/*/KickToTarget": [RUNNING, RUNNING, FAILURE]
        "*/HasBall": {script: [FAILURE, SUCCESS]}
    """
    source = str(path)
    content = read_limited(Path(path), MAX_YAML_BYTES, TreeFileError)
    return _rules(parse_marked(content, source, TreeFileError), source)


def substitutions(rules: Mapping[str, object], source: str = "rules") -> list[Substitution]:
    """Return the rules of a mapping such as a file holds; statuses may also be :class:`Status`."""
    return _rules(_marked(dict(rules)), source)


def substitute(
    root: Behaviour, rules: Iterable[Substitution] | Mapping[str, object] | str | Path
) -> Behaviour:
    """Replace every node whose path matches a rule by a :class:`ScriptedLeaf` of its name.

    The first matching rule counts, and everything below a replaced node is removed. Call it before the tree
    is bound to a store and ticked.

    Args:
        root: the tree; it is changed.
        rules: the rules, or the path of a file with rules.

    Returns:
        The tree's root, another one when the root itself was replaced.

    Raises:
        TreeFileError: a rule is wrong, or there is no node for it.
    """
    if isinstance(rules, str | Path):
        rules = read_substitutions(rules)
    elif isinstance(rules, Mapping):
        rules = substitutions(rules)
    chosen = list(rules)
    matched: set[int] = set()
    # Nodes are chosen before anything is replaced, so that a broken rule leaves the tree unchanged.
    picked = _choose(root, chosen, matched)
    for number, rule in enumerate(chosen):
        if number not in matched:
            raise TreeFileError(
                rule.source, f"no node of the tree is left for {rule.pattern!r}", line=rule.line
            )
    for node, rule in picked:
        root = replaced(root, node, ScriptedLeaf(node.name, rule.script))
    return root


def _choose(
    node: Behaviour, rules: list[Substitution], matched: set[int]
) -> list[tuple[Behaviour, Substitution]]:
    path = node_path(node)
    for number, rule in enumerate(rules):
        if fnmatchcase(path, rule.pattern):
            matched.add(number)
            return [(node, rule)]
    return [pair for child in node.children for pair in _choose(child, rules, matched)]


def replaced(root: Behaviour, node: Behaviour, leaf: Behaviour) -> Behaviour:
    """Put a leaf in the place of a node; return the tree's root, which may be the leaf."""
    if node is root:
        return leaf
    parent = node.parent
    if isinstance(parent, Composite):
        parent.replace_child(node, leaf)
    elif isinstance(parent, Decorator):
        parent.decorated, parent.children, leaf.parent = leaf, [leaf], parent
    if isinstance(parent, Parallel) and isinstance(parent.policy, ParallelPolicy.SuccessOnSelected):
        parent.policy.children = [leaf if child is node else child for child in parent.policy.children]
    return root


def _rules(marked: Marked, source: str) -> list[Substitution]:
    if not isinstance(marked.value, dict) or not marked.value:
        problem = "rules map patterns of paths to statuses: '*/HasBall': SUCCESS"
        raise TreeFileError(source, problem, line=marked.line or None)
    return [
        Substitution(pattern, _script(pattern, part, source), source, part.line or None)
        for pattern, part in marked.value.items()
    ]


def _script(pattern: str, marked: Marked, source: str) -> tuple[Status, ...]:
    line = marked.line or None
    if isinstance(marked.value, dict):
        for key, part in marked.value.items():
            if key not in ("status", "script"):
                problem = f"{pattern}: unknown key {key!r}; a rule has status or script"
                raise TreeFileError(source, problem, line=part.line or None)
        if len(marked.value) != 1:
            raise TreeFileError(source, f"{pattern}: a rule has either status or script", line=line)
        ((key, marked),) = marked.value.items()
        if isinstance(marked.value, list) is not (key == "script"):
            one = "a list of statuses" if key == "script" else "one status"
            raise TreeFileError(source, f"{pattern}: {key} is {one}", line=marked.line or None)
    steps = marked.value if isinstance(marked.value, list) else [marked]
    if not steps:
        raise TreeFileError(source, f"{pattern}: the script is empty", line=line)
    return tuple(_status(pattern, step, source) for step in steps)


def _status(pattern: str, marked: Marked, source: str) -> Status:
    for status in (Status.SUCCESS, Status.FAILURE, Status.RUNNING):
        if marked.value == status.value:
            return status
    problem = f"{pattern}: {_say(marked.value)} is not SUCCESS, FAILURE or RUNNING"
    raise TreeFileError(source, problem, line=marked.line or None)


def _say(value: object) -> str:
    kinds: dict[type, str] = {dict: "a mapping", list: "a list"}
    return kinds.get(type(value)) or repr(value)[:40]


def _marked(value: object) -> Marked:
    """Return given data in the form of read data, on line 0."""
    if isinstance(value, Mapping):
        return Marked({str(key): _marked(part) for key, part in value.items()}, 0, 0)
    if isinstance(value, list | tuple):
        return Marked([_marked(part) for part in value], 0, 0)
    return Marked(cast(Scalar, value.value if isinstance(value, Status) else value), 0, 0)
