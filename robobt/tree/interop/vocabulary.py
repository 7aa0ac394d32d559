"""Which nodes a tree file may name, what they take, and what made the nodes of a tree."""

from __future__ import annotations

import inspect
import json
import types
import typing
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal, Protocol

from py_trees import behaviours, composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, ParallelPolicy
from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from robobt.config.errors import short_repr
from robobt.tree import nodes
from robobt.tree.interop.model import Entry
from robobt.tree.leaf import Bound
from robobt.tree.parameters import Parameter, ParameterError, parameters_of


class Named(Protocol):
    """Things by name, as a :class:`~robobt.tree.registry.Registry` or a dict has them."""

    def __getitem__(self, name: str, /) -> Any: ...
    def __contains__(self, name: object, /) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...


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
    make: Callable[[str | None, dict[str, Any], dict[str, Any]], Behaviour]
    arguments: Callable[[Any], dict[str, Any]]

    @property
    def leaf(self) -> bool:
        """Whether it has no children."""
        return not self.branches

    @property
    def reads(self) -> tuple[str, ...]:
        """Entries of the store that its nodes read."""
        return tuple(getattr(self.cls, "reads", ()))

    @property
    def writes(self) -> tuple[str, ...]:
        """Entries of the store that its nodes write."""
        return tuple(getattr(self.cls, "writes", ()))


@dataclass
class Vocabulary:
    """What tree files may name.

    Control nodes are py_trees' and those of :mod:`robobt.tree.nodes`; they come
    before leaves of the same name.

    Attributes:
        leaves: classes of leaves.
        controls: classes of control nodes besides these.
        plays: functions that return a tree.
        values: for parameters of a type, the classes by whose names a file may give
            one: ``{gaussian: {sigma: 0.1}}``.
        store: the class of the store, to check entries against; None to leave them unchecked.
    """

    leaves: Named
    plays: Named = field(default_factory=dict[str, Any])
    controls: tuple[type[Behaviour], ...] = ()
    values: Mapping[type, Named] = field(default_factory=dict)
    store: type | None = None
    _types: dict[str, NodeType] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        own = {cls.__name__: node_type(cls) for cls in self.controls}
        self._control = {**CONTROL, **own}
        self._by_class = {known.cls: known for known in self._control.values()}

    def type(self, name: str) -> NodeType | None:
        """The type of this name, None when there is none.

        Raises:
            ValueError: the class cannot be used in files; the message says why.
        """
        known = self._control.get(name) or self._types.get(name)
        if known is None and name in self.leaves:
            known = self._types[name] = node_type(self.leaves[name], name)
        return known

    def type_of(self, node: Behaviour) -> NodeType | None:
        """The type of a node, None when no file can name it."""
        cls = type(node)
        if cls in self._by_class:
            return self._by_class[cls]
        for name in (cls.__name__, *self.leaves):
            if name in self.leaves and self.leaves[name] is cls:
                return self.type(name)
        return None

    def __iter__(self) -> Iterator[str]:
        return iter(sorted({*self._control, *self.leaves}))

    def convert(self, parameter: Parameter, value: Any) -> Any:
        """Plain data, or an entry, as a parameter's type.

        Raises:
            ParameterError: it does not fit.
        """
        if isinstance(value, Entry):
            if not takes_entry(parameter):
                raise ParameterError(
                    parameter.name, f"takes a value, and cannot be wired to the entry {value.entry!r}"
                )
            return value
        named = self._named(parameter)
        if named is not None and isinstance(value, dict) and len(value) == 1:
            ((name, settings),) = value.items()
            if name in named:
                return self._make_value(parameter, named[name], name, settings)
        return parameter.convert(value)

    def plain(self, parameter: Parameter, value: Any) -> Any:
        """The plain data that :meth:`convert` makes into an equal value.

        Raises:
            ParameterError: there is none.
        """
        named = self._named(parameter)
        if named is not None and not isinstance(value, str):
            for name in named:
                if named[name] is type(value):
                    settings = Parameter(parameter.name, named[name]).plain(value)
                    return {name: settings}
        return parameter.plain(value)

    def from_text(self, parameter: Parameter, text: str) -> Any:
        """The plain data that a text stands for, as BehaviorTree.CPP writes values.

        Tried in this order: the text itself; after ``json:``, JSON; JSON without
        that; ``true`` and ``false`` in any case, ``1`` and ``0`` for them; a list
        with semicolons, of texts and then of what they are in JSON.

        Raises:
            ParameterError: none of them fits the parameter.
        """
        first: ParameterError | None = None
        for value in _readings(text):
            try:
                self.convert(parameter, value)
                return value
            except ParameterError as error:
                first = first or error
                if self._is_refused(parameter, value):
                    raise
        raise ParameterError(parameter.name, f"{short_repr(text)} is no {parameter.kind}") from first

    def to_text(self, parameter: Parameter | None, value: Any) -> str:
        """The text that :meth:`from_text` reads as this plain data; for any type where none is named."""
        exact = f"json:{json.dumps(value)}"
        if isinstance(value, list) and len(value) > 1 and all(type(part) in _SIMPLE for part in value):
            simple = ";".join([part if isinstance(part, str) else repr(part) for part in value])
        elif type(value) in (*_SIMPLE, bool):
            simple = value if isinstance(value, str) else json.dumps(value)
        else:
            return exact
        if is_pointer(simple) or simple.startswith("json:"):
            return exact
        if parameter is not None:
            try:
                return simple if _same(self.from_text(parameter, simple), value) else exact
            except ParameterError:
                return exact
        return simple

    def _is_refused(self, parameter: Parameter, value: Any) -> bool:
        """Whether a value is of the parameter's type, and only what is said beside the type refuses it."""
        if typing.get_origin(parameter.hint) is not Annotated:
            return False
        try:
            self.convert(Parameter(parameter.name, typing.get_args(parameter.hint)[0]), value)
        except ParameterError:
            return False
        return True

    def _named(self, parameter: Parameter) -> Named | None:
        for member in _members(parameter.hint):
            if member in self.values:
                return self.values[member]
        return None

    def _make_value(self, parameter: Parameter, cls: Any, name: str, settings: Any) -> Any:
        try:
            return Parameter(parameter.name, cls).convert({} if settings is None else settings)
        except ParameterError as error:
            place = error.parameter.partition(".")[2]
            where = ".".join([parameter.name, name, *([place] if place else [])])
            raise ParameterError(where, str(error)) from error


def takes_entry(parameter: Parameter) -> bool:
    """Whether a parameter may be wired to any entry of the store."""
    return Entry in _members(parameter.hint)


def is_pointer(text: str) -> bool:
    """Whether BehaviorTree.CPP takes a text for the name of an entry: ``{name}``."""
    return len(text) >= 3 and text.startswith("{") and text.endswith("}")


def node_type(cls: type[Behaviour], name: str = "") -> NodeType:
    """The type of a class's nodes, read from its constructor.

    Raises:
        ValueError: a parameter has no name, or its annotations cannot be read.
    """
    name = name or cls.__name__
    signature = inspect.signature(cls)
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

    def make(own_name: str | None, given: dict[str, Any], children: dict[str, Any]) -> Behaviour:
        named = {} if own_name is None else {"name": own_name}
        return cls(**named, **given, **children)

    def arguments(node: Behaviour) -> dict[str, Any]:
        if isinstance(node, Bound):
            known = node.parameters()
            return {entry: known[entry] for entry in parameters}
        return {entry: getattr(node, entry) for entry in parameters}

    return NodeType(name, cls, parameters, branches, name_default is inspect.Parameter.empty, make, arguments)


def _shape(parameter: Parameter) -> Shape | None:
    members = _members(parameter.hint)
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


def _members(hint: Any) -> set[Any]:
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return {member for part in typing.get_args(hint) for member in _members(part)}
    try:
        return {hint}
    except TypeError:
        # Annotations may carry what cannot be hashed.
        return set()


def _readings(text: str) -> Iterator[Any]:
    if text.startswith("json:"):
        yield from _json(text.removeprefix("json:"))
        return
    yield text
    yield from _json(text)
    words = {"true": True, "false": False, "1": True, "0": False}
    if text.lower() in words:
        yield words[text.lower()]
    if ";" in text:
        parts = text.split(";")
        yield parts
        read = [list(_json(part)) for part in parts]
        if all(read):
            yield [part[0] for part in read]


_SIMPLE = (int, float, str)


def _same(one: Any, other: Any) -> bool:
    # 1 and 1.0 are the same number, but 1 and true are not the same value.
    return bool(one == other) and isinstance(one, bool) is isinstance(other, bool)


def _json(text: str) -> Iterator[Any]:
    try:
        yield json.loads(text)
    except (ValueError, RecursionError):
        return


def _parallel() -> NodeType:
    """py_trees' Parallel, whose policy is an object."""
    policies = ("success_on_all", "success_on_one")

    def make(name: str | None, given: dict[str, Any], children: dict[str, Any]) -> Behaviour:
        assert name is not None
        policy: ParallelPolicy.Base
        if given["policy"] == "success_on_all":
            policy = ParallelPolicy.SuccessOnAll(synchronise=given["synchronise"])
        elif given["synchronise"]:
            raise ValueError("success_on_one does not synchronise")
        else:
            policy = ParallelPolicy.SuccessOnOne()
        return composites.Parallel(name, policy, **children)

    def arguments(node: composites.Parallel) -> dict[str, Any]:
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
    """py_trees' OneShot, whose policy is an enumeration of lists."""
    policies = {
        "on_completion": OneShotPolicy.ON_COMPLETION,
        "on_success": OneShotPolicy.ON_SUCCESSFUL_COMPLETION,
    }

    def make(name: str | None, given: dict[str, Any], children: dict[str, Any]) -> Behaviour:
        assert name is not None
        return decorators.OneShot(name, policy=policies[given["policy"]], **children)

    def arguments(node: decorators.OneShot) -> dict[str, Any]:
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


def _repeat() -> NodeType:
    """py_trees' Repeat, which takes every number that is never reached for without end."""
    return _with_hint(
        node_type(decorators.Repeat), "num_success", Annotated[int, AfterValidator(_times_or_for_ever)]
    )


def _retry() -> NodeType:
    """py_trees' Retry, which has no number for without end: it fails at once when it is given one below 1."""
    return _with_hint(node_type(decorators.Retry), "num_failures", Annotated[int, AfterValidator(_times)])


def _with_hint(known: NodeType, name: str, hint: Any) -> NodeType:
    return replace(known, parameters={**known.parameters, name: Parameter(name, hint)})


def _times_or_for_ever(number: int) -> int:
    if number < 1 and number != -1:
        raise PydanticCustomError("times", "Should be 1 or more, or -1 for without end")
    return number


def _times(number: int) -> int:
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
    for known in (_parallel(), _one_shot(), _repeat(), _retry(), *(node_type(cls) for cls in _PLAIN_CLASSES))
}
"""The control nodes, and leaves without a task of their own, that every file may name."""
