"""The tags of BehaviorTree.CPP and the equivalent nodes.

docs/tree_files.md has the table and lists where they differ in detail.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from robobt.tree.interop.node_types import NodeType


@dataclass(frozen=True)
class Attribute:
    """An attribute of a tag.

    Attributes:
        parameter: the parameter of the node that it is.
        default: its value where it is left out, None when it has to be given.
        milliseconds: whether it counts those, and the parameter seconds.
        count: whether it is a number of times: 1 or more, or -1 for without end.
        endless: the type that does without limit what the tag does a number of times; None where the
            tag's own type takes the -1.
    """

    parameter: str
    default: str | None = None
    milliseconds: bool = False
    count: bool = False
    endless: str | None = None


@dataclass(frozen=True)
class Tag:
    """A tag of BehaviorTree.CPP.

    Attributes:
        type: the node's type.
        fixed: parameters implied by the tag.
        attributes: the others, by the names XML gives them.
    """

    type: str
    fixed: Mapping[str, object] = field(default_factory=dict)
    attributes: Mapping[str, Attribute] = field(default_factory=dict)


TAGS: Mapping[str, Tag] = {
    "Sequence": Tag("Sequence", {"memory": True}),
    "ReactiveSequence": Tag("Sequence", {"memory": False}),
    "SequenceWithMemory": Tag("SequenceWithMemory"),
    "Fallback": Tag("Selector", {"memory": True}),
    "ReactiveFallback": Tag("Selector", {"memory": False}),
    "Parallel": Tag(
        "ParallelCount",
        attributes={
            "success_count": Attribute("success_count", default="-1"),
            "failure_count": Attribute("failure_count", default="1"),
        },
    ),
    "Inverter": Tag("Inverter"),
    "ForceSuccess": Tag("FailureIsSuccess"),
    "ForceFailure": Tag("SuccessIsFailure"),
    "KeepRunningUntilFailure": Tag("SuccessIsRunning"),
    "Repeat": Tag("Repeat", attributes={"num_cycles": Attribute("num_success", count=True)}),
    "RetryUntilSuccessful": Tag(
        "Retry",
        attributes={
            # py_trees' Retry fails at the first failure when it is given -1.
            "num_attempts": Attribute("num_failures", count=True, endless="FailureIsRunning")
        },
    ),
    "Timeout": Tag("Timeout", attributes={"msec": Attribute("seconds", milliseconds=True)}),
    "Delay": Tag("Delay", attributes={"delay_msec": Attribute("seconds", milliseconds=True)}),
    "Sleep": Tag("Wait", attributes={"msec": Attribute("seconds", milliseconds=True)}),
    "AlwaysSuccess": Tag("Success"),
    "AlwaysFailure": Tag("Failure"),
}
"""The tags whose nodes robobt has, under its own or another name."""

OTHER_TAGS: Mapping[str, str] = {"ParallelByPolicy": "Parallel"}
"""Tags for types whose own name is the tag of another node."""

UNKNOWN_HERE: Mapping[str, str] = {
    "AsyncSequence": "robobt's trees do not yield between children; use Sequence",
    "AsyncFallback": "robobt's trees do not yield between children; use Fallback",
    "Script": "robobt has no scripts; write a skill",
    "ScriptCondition": "robobt has no scripts; write a condition",
    "Precondition": "robobt has no scripts; write a condition",
    "SetBlackboard": "robobt has no blackboard; write a skill that writes the store",
    "UnsetBlackboard": "robobt has no blackboard; write a skill that writes the store",
    "ParallelAll": "robobt has no such node; Parallel counts too",
    "IfThenElse": "robobt has no such node",
    "WhileDoElse": "robobt has no such node",
    "RunOnce": "robobt has no such node; OneShot is the nearest",
    **{f"Switch{cases}": "robobt has no blackboard; write a switch of your own" for cases in range(2, 7)},
    **dict.fromkeys(
        (
            "LoopInt",
            "LoopBool",
            "LoopDouble",
            "LoopString",
            "SkipUnlessUpdated",
            "WaitValueUpdate",
            "WasEntryUpdated",
        ),
        "robobt has no blackboard and no such node",
    ),
}
"""Messages about tags of BehaviorTree.CPP that cannot be read."""

VERSION_3_TAGS: Mapping[str, str] = {
    "SubTreePlus": "it is SubTree",
    "SequenceStar": "it is SequenceWithMemory",
    "FallbackStar": "it is Fallback, which goes on with the child that runs",
    **dict.fromkeys(
        ("BlackboardCheckInt", "BlackboardCheckDouble", "BlackboardCheckBool", "BlackboardCheckString"),
        "it is a script, which robobt does not have; write a condition",
    ),
    "ManualSelector": "there is none",
}
"""The names in version 4 of tags of version 3."""

VERSION_3_ATTRIBUTES: Mapping[str, Mapping[str, str]] = {
    "SubTree": {
        "__shared_blackboard": 'it is gone; _autoremap="true" is the nearest',
        "__autoremap": "it is _autoremap",
    },
    "Parallel": {
        "success_threshold": "it is success_count",
        "failure_threshold": "it is failure_count",
        "threshold": "it is success_count",
    },
}
"""The names in version 4 of attributes of version 3, by tag."""

NODE_TAGS = ("Action", "Condition", "Control", "Decorator")
"""Tags of the long form, in which the type is the attribute ``ID``."""

METADATA = ("_uid", "_fullpath", "_collapsed", "_description")
"""Attributes that BehaviorTree.CPP and Groot2 write for themselves; read over, not kept."""

SCRIPT_ATTRIBUTES = (
    "_skipIf",
    "_successIf",
    "_failureIf",
    "_while",
    "_onSuccess",
    "_onFailure",
    "_onHalted",
    "_post",
)
"""Attributes with scripts."""


def tags_of(kind: str) -> list[str]:
    """Return the tags of BehaviorTree.CPP for a type of nodes."""
    return [tag for tag, entry in TAGS.items() if entry.type == kind]


def long_tags(kind: NodeType) -> tuple[str, ...]:
    """Return the tags of the long form that a type may have, the usual one first."""
    if kind.leaf:
        return ("Condition", "Action") if kind.condition else ("Action", "Condition")
    return ("Decorator",) if "one" in kind.branches.values() else ("Control",)
