"""The types of nodes that tree files name: what their constructors take, and what made a node."""

from __future__ import annotations

import inspect
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, TypeAlias

from py_trees import behaviours, composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, ParallelPolicy
from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from robobt.tree import nodes
from robobt.tree.leaf import Bound
from robobt.tree.parameters import Parameter, members_of, parameters_of
from robobt.tree.signatures import signature_of

Arguments: TypeAlias = dict[str, Any]
"""Values or children by the names of a constructor's parameters."""

Shape = Literal["one", "optional", "many", "cases"]
"""How many children a branch has: a node, perhaps one, a list, or one for each of several cases."""


@dataclass(frozen=True)
class NodeType:
    """A type of nodes.

    Attributes:
        name: what files call it.
        cls: its class.
        parameters: what its constructor takes besides its name and its children.
        branches: where it has children.
        name_required: whether every node has to be named.
        make: a node from its name (None for the type's default), parameters and branches.
        arguments: the parameters a node was made from.
    """

    name: str
    cls: type[Behaviour]
    parameters: Mapping[str, Parameter]
    branches: Mapping[str, Shape]
    name_required: bool
    make: Callable[[str | None, Arguments, Arguments], Behaviour]
    arguments: Callable[[Any], Arguments]

    @property
    def leaf(self) -> bool:
        """Whether it has no children."""
        return not self.branches

    @property
    def condition(self) -> bool:
        """Whether it is a leaf that only looks."""
        return bool(getattr(self.cls, "condition", False))

    @property
    def reads(self) -> tuple[str, ...]:
        """Entries of the store that its nodes read."""
        return tuple(getattr(self.cls, "reads", ()))

    @property
    def writes(self) -> tuple[str, ...]:
        """Entries of the store that its nodes write."""
        return tuple(getattr(self.cls, "writes", ()))


def node_type(cls: type[Behaviour], name: str = "") -> NodeType:
    """Return the type of a class's nodes, read from its constructor.

    Raises:
        ValueError: a parameter has no name, or its annotations cannot be read.
    """
    name = name or cls.__name__
    signature = signature_of(cls)
    kinds = {parameter.kind for parameter in signature.parameters.values()}
    if kinds & {inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD}:
        raise ValueError(f"{name} takes more than named parameters, so that files cannot name it")
    try:
        listed = parameters_of(cls)
    except (NameError, TypeError, AttributeError) as error:
        raise ValueError(f"the parameters of {name} have no types: {error}") from error
    branches = {entry.name: shape for entry in listed if (shape := _shape(entry)) is not None}
    parameters = {
        entry.name: entry for entry in listed if entry.name not in branches and entry.name != "name"
    }
    name_default = signature.parameters["name"].default if "name" in signature.parameters else None

    def make(own_name: str | None, given: Arguments, children: Arguments) -> Behaviour:
        named = {} if own_name is None else {"name": own_name}
        return cls(**named, **given, **children)

    def arguments(node: Behaviour) -> Arguments:
        if isinstance(node, Bound):
            known = node.parameters()
            return {entry: known[entry] for entry in parameters}
        return {entry: getattr(node, entry) for entry in parameters}

    return NodeType(name, cls, parameters, branches, name_default is inspect.Parameter.empty, make, arguments)


def _shape(parameter: Parameter) -> Shape | None:
    members = members_of(parameter.hint)
    optional = type(None) in members
    (*rest,) = members - {type(None)}
    if len(rest) != 1:
        return None
    hint = rest[0]
    if isinstance(hint, type) and issubclass(hint, Behaviour):
        return "optional" if optional else "one"
    arguments = typing.get_args(hint)
    if not arguments or not isinstance(arguments[-1], type) or not issubclass(arguments[-1], Behaviour):
        return None
    origin = typing.get_origin(hint)
    return "cases" if isinstance(origin, type) and issubclass(origin, Mapping) else "many"


def split_cases(cases: str) -> list[str]:
    """Return the cases that one branch of a switch serves: ``halt | stop``."""
    return [case.strip() for case in cases.split("|")]


def _parallel() -> NodeType:
    """Return the type of py_trees' Parallel, whose policy is an object."""
    policies = ("success_on_all", "success_on_one")

    def make(name: str | None, given: Arguments, children: Arguments) -> Behaviour:
        assert name is not None
        policy: ParallelPolicy.Base
        if given["policy"] == "success_on_all":
            policy = ParallelPolicy.SuccessOnAll(synchronise=given["synchronise"])
        elif given["synchronise"]:
            raise ValueError("success_on_one does not synchronise")
        else:
            policy = ParallelPolicy.SuccessOnOne()
        return composites.Parallel(name, policy, **children)

    def arguments(node: composites.Parallel) -> Arguments:
        known = {ParallelPolicy.SuccessOnAll: policies[0], ParallelPolicy.SuccessOnOne: policies[1]}
        policy = type(node.policy)
        if policy not in known:
            raise ValueError(f"files cannot name the policy {policy.__name__}")
        return {"policy": known[policy], "synchronise": node.policy.synchronise}

    parameters = [Parameter("policy", Literal[policies]), Parameter("synchronise", bool)]
    return NodeType(
        "Parallel",
        composites.Parallel,
        {parameter.name: parameter for parameter in parameters},
        {"children": "many"},
        True,
        make,
        arguments,
    )


def _one_shot() -> NodeType:
    """Return the type of py_trees' OneShot, whose policy is an enumeration of lists."""
    policies = {
        "on_completion": OneShotPolicy.ON_COMPLETION,
        "on_success": OneShotPolicy.ON_SUCCESSFUL_COMPLETION,
    }

    def make(name: str | None, given: Arguments, children: Arguments) -> Behaviour:
        assert name is not None
        return decorators.OneShot(name, policy=policies[given["policy"]], **children)

    def arguments(node: decorators.OneShot) -> Arguments:
        return {"policy": next(word for word, policy in policies.items() if policy is node.policy)}

    return NodeType(
        "OneShot",
        decorators.OneShot,
        {"policy": Parameter("policy", Literal[tuple(policies)])},
        {"child": "one"},
        True,
        make,
        arguments,
    )


def _counted(cls: type[Behaviour], name: str, check: Callable[[int], int]) -> NodeType:
    """Return the type of py_trees' Repeat or Retry with its number of times checked."""
    known, counted = node_type(cls), Parameter(name, Annotated[int, AfterValidator(check)])
    return replace(known, parameters={**known.parameters, name: counted})


def _times_or_for_ever(number: int) -> int:
    if number < 1 and number != -1:
        raise PydanticCustomError("times", "Should be 1 or more, or -1 for without end")
    return number


def _times(number: int) -> int:
    # Retry has no number for without end: below 1 it fails at once.
    if number < 1:
        raise PydanticCustomError("times", "Should be 1 or more; FailureIsRunning tries without end")
    return number


_PLAIN_CLASSES: tuple[type[Behaviour], ...] = (
    composites.Selector,
    composites.Sequence,
    decorators.Count,
    decorators.FailureIsRunning,
    decorators.FailureIsSuccess,
    decorators.Inverter,
    decorators.PassThrough,
    decorators.RunningIsFailure,
    decorators.RunningIsSuccess,
    decorators.SuccessIsFailure,
    decorators.SuccessIsRunning,
    behaviours.Failure,
    behaviours.Running,
    behaviours.Success,
    nodes.CommitFor,
    nodes.CommittingSelector,
    nodes.Cooldown,
    nodes.Delay,
    nodes.HoldSuccess,
    nodes.ParallelCount,
    nodes.SequenceWithMemory,
    nodes.TickDivider,
    nodes.Timeout,
    nodes.Wait,
)

CONTROL: Mapping[str, NodeType] = {
    known.name: known
    for known in (
        _parallel(),
        _one_shot(),
        _counted(decorators.Repeat, "num_success", _times_or_for_ever),
        _counted(decorators.Retry, "num_failures", _times),
        *(node_type(cls) for cls in _PLAIN_CLASSES),
    )
}
"""The control nodes, and leaves without a task of their own, that every file may name."""
