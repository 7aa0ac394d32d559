"""Builds the trees of a tree file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from pydantic import BaseModel, ValidationError

from robobt.config.errors import short_repr
from robobt.config.validation import first_problem
from robobt.tree.check import entries_of
from robobt.tree.interop.model import (
    Definition,
    Entry,
    Name,
    Node,
    Spec,
    SubTree,
    Text,
    TreeFile,
    TreeFileError,
    Value,
    specs_of,
)
from robobt.tree.interop.node_types import Arguments, NodeType, split_cases
from robobt.tree.interop.verify import sub_trees
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.parameters import Parameter, ParameterError, parameters_of
from robobt.tree.walk import preorder

MAX_NODES = 10_000
"""Most nodes of a tree that is built from a file."""


def build_tree(file: TreeFile, vocabulary: Vocabulary, given: Mapping[str, Value] | None = None) -> Behaviour:
    """Build a new main tree of a file.

    The file has been verified; ``given`` are values of the tree's parameters, plain data.
    """
    definition = file.trees[file.main]
    try:
        return _Builder(file, vocabulary).tree(definition, given or {}, None)
    except RecursionError as error:
        raise TreeFileError(file.source, "it is nested too deeply", line=definition.line) from error


@dataclass(slots=True)
class _Scope:
    """The values of names in one tree.

    Attributes:
        values: its parameters.
        outside: scope for looking up unknown names, or None.
    """

    values: dict[str, Value]
    outside: _Scope | None


class _Builder:
    def __init__(self, file: TreeFile, vocabulary: Vocabulary) -> None:
        self.file, self.vocabulary = file, vocabulary
        # How often each tree and play of the file is put in, and how many nodes that makes.
        self.times = _times(file)
        self.count = 0
        self.counted: set[str] = set()
        for name, definition in file.trees.items():
            nodes = sum(1 for _ in specs_of(definition.root))
            self._grow(self.times[name] * nodes, definition.line, name)
        self.open: list[str] = []
        self.top: _Scope | None = None

    def tree(self, definition: Definition, given: Mapping[str, Value], outside: _Scope | None) -> Behaviour:
        self.open.append(definition.name)
        scope = self._scope(definition, given, outside)
        self.top = self.top or scope
        root = self.spec(definition.root, scope)
        self.open.pop()
        return root

    def spec(self, spec: Spec, scope: _Scope) -> Behaviour:
        return self._sub_tree(spec, scope) if isinstance(spec, SubTree) else self._node(spec, scope)

    def _scope(self, definition: Definition, given: Mapping[str, Value], outside: _Scope | None) -> _Scope:
        scope = _Scope(dict(given), outside)
        for name, parameter in definition.parameters.items():
            if name in given:
                if not isinstance(given[name], Entry | Text):
                    with self._at(definition.line, definition.name):
                        parameter.convert(given[name])
            elif not parameter.required and outside is None:
                default = parameter.default
                scope.values[name] = Entry(default.name) if isinstance(default, Name) else default
        return scope

    def _sub_tree(self, spec: SubTree, scope: _Scope) -> Behaviour:
        given = {
            name: self._resolve(value, scope, spec.line_of(name)) for name, value in spec.parameters.items()
        }
        definition = self.file.trees.get(spec.tree)
        if definition is not None:
            if spec.tree in self.open:
                raise self._error(spec.line, f"the tree {spec.tree!r} contains itself")
            for name, parameter in definition.parameters.items():
                if name not in given and isinstance(parameter.default, Name) and not spec.autoremap:
                    given[name] = self._resolve(parameter.default, scope, spec.line)
            return self.tree(definition, given, scope if spec.autoremap else None)
        play = self.vocabulary.plays[spec.tree]
        known = {parameter.name: parameter for parameter in parameters_of(play)}
        converted = {}
        for name, value in given.items():
            with self._at(spec.line_of(name), spec.tree):
                converted[name] = self._converted(known[name], value)
        with self._at(spec.line, spec.tree):
            root = play(**converted)
        if isinstance(root, Behaviour):
            if spec.tree not in self.counted:
                self.counted.add(spec.tree)
                self._grow(self.times[spec.tree] * (len(preorder(root)) - 1), spec.line, self.open[-1])
            return root
        raise self._error(spec.line, f"{spec.tree} is not a play: it made {short_repr(root)}")

    def _node(self, spec: Node, scope: _Scope) -> Behaviour:
        known = self.vocabulary.type(spec.type)
        assert known is not None
        given = {}
        for name, value in spec.parameters.items():
            line = spec.line_of(name)
            resolved = self._resolve(value, scope, line)
            with self._at(line, spec.type):
                if isinstance(resolved, Entry):
                    self._check_entry(resolved)
                if not self._wired(known, name, resolved):
                    given[name] = self._converted(known.parameters[name], resolved)
        branches: Arguments = {}
        for name, branch in spec.branches.items():
            if isinstance(branch, list):
                branches[name] = [self.spec(child, scope) for child in branch]
            elif isinstance(branch, dict):
                made = [(cases, self.spec(child, scope)) for cases, child in branch.items()]
                branches[name] = {case: child for cases, child in made for case in split_cases(cases)}
            else:
                branches[name] = self.spec(branch, scope)
        with self._at(spec.line, spec.type):
            return known.make(spec.name, given, branches)

    def _wired(self, known: NodeType, name: str, value: Value) -> bool:
        """Return whether the value only names an entry that the leaf uses anyway."""
        if name not in (*known.reads, *known.writes):
            return False
        if isinstance(value, Entry):
            if value.entry == name:
                return True
            if name not in known.parameters:
                raise ParameterError(
                    name, f"{known.name} uses the entry {name!r} and cannot be wired to {value.entry!r}"
                )
        elif name not in known.parameters:
            raise ParameterError(
                name, f"is an entry that {known.name} uses; it takes {{{name}}}, not a value"
            )
        return False

    def _check_entry(self, entry: Entry) -> None:
        store = self.vocabulary.store
        if store is not None and entry.entry not in entries_of(store):
            raise ParameterError(
                entry.entry,
                f"is not a parameter of the tree, and {store.__name__} has no such entry; "
                f"there are {', '.join(entries_of(store))}",
            )

    def _converted(self, parameter: Parameter, value: Value) -> object:
        if isinstance(value, Text):
            value = self.vocabulary.from_text(parameter, value.text)
        return self.vocabulary.convert(parameter, value)

    def _resolve(self, value: Value, scope: _Scope, line: int) -> Value:
        """Return the value with every name in it replaced by its value."""
        if isinstance(value, Name):
            return self._find(value.name, scope, line)
        if isinstance(value, list):
            return [self._resolve(part, scope, line) for part in value]
        if isinstance(value, dict):
            return {key: self._resolve(part, scope, line) for key, part in value.items()}
        return value

    def _find(self, name: str, scope: _Scope, line: int) -> Value:
        place: _Scope | None = self.top if name.startswith("@") else scope
        name = name.removeprefix("@")
        last = place
        while place is not None:
            if name in place.values:
                return place.values[name]
            last, place = place, place.outside
        if last is self.top:
            return Entry(name)
        raise self._error(
            line,
            f"the tree {self.open[-1]!r} is not given {name!r}: in BehaviorTree.CPP it would be the "
            f'sub-tree\'s own entry, which robobt does not have; give it {name}="{{{name}}}" or _autoremap',
        )

    def _grow(self, nodes: int, line: int, tree: str) -> None:
        # Before they are built: some take milliseconds each.
        self.count += nodes
        if self.count > MAX_NODES:
            problem = f"the tree has more than {MAX_NODES} nodes"
            raise TreeFileError(self.file.source_of(tree), problem, line=line)

    def _error(self, line: int | None, problem: str) -> TreeFileError:
        return TreeFileError(self.file.source_of(self.open[-1]), problem, line=line)

    @contextmanager
    def _at(self, line: int, what: str) -> Iterator[None]:
        """Turn any exception of a constructor or a play into an error at this line."""
        try:
            yield
        except (TreeFileError, RecursionError):
            raise
        except ParameterError as error:
            raise self._error(line, f"{what}: {error.parameter}: {error}") from error
        except ValidationError as error:
            field, problem = first_problem(error, BaseModel)
            raise self._error(line, f"{what}: {field}: {problem}") from error
        except Exception as error:
            problem = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
            raise self._error(line, f"{what}: {problem}") from error


def _times(file: TreeFile) -> Counter[str]:
    """Count how often every tree and play is part of a file's main tree, by itself and within others."""
    inside = {
        name: Counter([spec.tree for spec in sub_trees(tree.root)]) for name, tree in file.trees.items()
    }
    # Trees within others come after all of those, because no tree contains itself.
    order: dict[str, None] = {}

    def follow(name: str) -> None:
        for inner in inside.get(name, ()):
            if inner not in order:
                follow(inner)
        order[name] = None

    follow(file.main)
    times = Counter({file.main: 1})
    for name in reversed(order):
        for inner, count in inside.get(name, Counter()).items():
            times[inner] += times[name] * count
    return times
