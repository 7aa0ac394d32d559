"""Looks at all that a tree file says, whether it would be built or not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches

from robobt.tree.interop.model import (
    Choice,
    Definition,
    Entry,
    Formula,
    Name,
    Node,
    Spec,
    SubTree,
    Text,
    TreeFile,
    TreeFileError,
    Value,
    names_in,
)
from robobt.tree.interop.vocabulary import NodeType, Vocabulary
from robobt.tree.parameters import Parameter, ParameterError, check_names, parameters_of
from robobt.tree.registry import Registry


def verify(file: TreeFile, vocabulary: Vocabulary) -> None:
    """Check every tree of a file.

    Every type, tree and parameter that is named exists, all that is needed is
    given, what is written out fits its type, and no tree contains itself. What
    hangs on the tree's parameters shows when it is built.

    Raises:
        TreeFileError: the first thing that is wrong.
    """
    verifier = _Verifier(file, vocabulary)
    try:
        verifier.circles()
        for definition in file.trees.values():
            verifier.definition(definition)
    except RecursionError as error:
        raise TreeFileError(file.source, "it is nested too deeply") from error


class _Verifier:
    def __init__(self, file: TreeFile, vocabulary: Vocabulary) -> None:
        self.file, self.vocabulary = file, vocabulary
        self.ports: dict[str, set[str]] = {}

    def circles(self) -> None:
        done: set[str] = set()

        def follow(definition: Definition, way: list[str]) -> None:
            for spec in sub_trees(definition.root):
                if spec.tree in way:
                    raise self._error(spec.line, f"the tree {spec.tree!r} contains itself")
                if spec.tree in self.file.trees and spec.tree not in done:
                    follow(self.file.trees[spec.tree], [*way, spec.tree])
            done.add(definition.name)

        for definition in self.file.trees.values():
            follow(definition, [definition.name])

    def definition(self, definition: Definition) -> None:
        known = set(definition.parameters)
        for name, value in definition.let.items():
            self._names(value, known, definition.line)
            known.add(name)
        self._spec(definition.root, known)

    def _spec(self, spec: Spec, known: set[str]) -> None:
        if isinstance(spec, Choice):
            self._names(spec.by, known, spec.line)
            for case in spec.cases.values():
                self._spec(case, known)
        elif isinstance(spec, SubTree):
            self._sub_tree(spec, known)
        else:
            self._node(spec, known)

    def _node(self, spec: Node, known: set[str]) -> None:
        kind = self._type(spec)
        if kind.name_required and spec.name is None:
            raise self._error(spec.line, f"{spec.type}: name: {spec.type} needs this parameter")
        for name, value in spec.parameters.items():
            self._names(value, known, spec.line_of(name))
        entries = {*kind.reads, *kind.writes} - set(kind.parameters)
        given = {name: value for name, value in spec.parameters.items() if name not in entries}
        self._parameters(spec, spec.type, kind.parameters, given)
        for name, shape in kind.branches.items():
            if name not in spec.branches and shape in ("one", "cases"):
                raise self._error(spec.line, f"{spec.type}: {name}: {spec.type} needs this branch")
        for child in spec.children():
            self._spec(child, known)

    def _type(self, spec: Node) -> NodeType:
        try:
            kind = self.vocabulary.type(spec.type)
        except ValueError as error:
            raise self._error(spec.line, str(error)) from error
        if kind is None:
            raise self._error(spec.line, unknown_type(spec.type, self.vocabulary))
        return kind

    def _sub_tree(self, spec: SubTree, known: set[str]) -> None:
        for name, value in spec.parameters.items():
            self._names(value, known, spec.line_of(name))
        definition = self.file.trees.get(spec.tree)
        is_play = spec.tree in self.vocabulary.plays
        if definition is None and not is_play:
            there = ", ".join([*self.file.trees, *self.vocabulary.plays])
            raise self._error(spec.line, f"no tree or play is called {spec.tree!r}; there are {there}")
        if definition is None:
            try:
                parameters = {entry.name: entry for entry in parameters_of(self.vocabulary.plays[spec.tree])}
            except (TypeError, ValueError, NameError) as error:
                raise self._error(
                    spec.line, f"the parameters of {spec.tree} cannot be read: {error}"
                ) from error
            self._parameters(spec, spec.tree, parameters, spec.parameters)
        elif self.file.language == "xml":
            if spec.tree not in self.ports:
                self.ports[spec.tree] = ports_of(definition, self.file)
            ports = self.ports[spec.tree]
            for name in spec.parameters:
                if name not in ports:
                    there = f"it has {', '.join(sorted(ports))}" if ports else "it has none"
                    raise self._error(
                        spec.line_of(name), f"{spec.tree}: {name}: {spec.tree} has no such port; {there}"
                    )
            if not spec.autoremap:
                for name, parameter in definition.parameters.items():
                    if parameter.required and name not in spec.parameters:
                        raise self._error(spec.line, f"{spec.tree}: {name}: {spec.tree} needs this port")
        else:
            self._parameters(spec, spec.tree, definition.parameters, spec.parameters)

    def _parameters(
        self, spec: Node | SubTree, what: str, known: Mapping[str, Parameter], given: Mapping[str, Value]
    ) -> None:
        try:
            check_names(what, known, given)
        except ParameterError as error:
            raise self._error(spec.line_of(error.parameter), f"{what}: {error.parameter}: {error}") from error
        for name, value in given.items():
            if not is_written_out(value):
                continue
            try:
                if isinstance(value, Text):
                    self.vocabulary.from_text(known[name], value.text)
                else:
                    self.vocabulary.convert(known[name], value)
            except ParameterError as error:
                raise self._error(spec.line_of(name), f"{what}: {error.parameter}: {error}") from error

    def _names(self, value: Value, known: set[str], line: int) -> None:
        try:
            names = list(names_in(value))
        except ValueError as error:
            raise self._error(line, str(error)) from error
        for name in names:
            if name not in known and self.file.language == "yaml":
                there = f"it has {', '.join(sorted(known))}" if known else "it has none"
                raise self._error(line, f"the tree has no parameter {name!r}; {there}")

    def _error(self, line: int, problem: str) -> TreeFileError:
        return TreeFileError(self.file.source, problem, line=line)


def unknown_type(name: str, vocabulary: Vocabulary, tags: Iterable[str] = ()) -> str:
    """What to say about a type that does not exist, or that another package failed to bring.

    Args:
        tags: what else could have been meant.
    """
    if isinstance(vocabulary.leaves, Registry) and (problem := vocabulary.leaves.problem_with(name)):
        return problem
    by_lower = {known.lower(): known for known in (*vocabulary, *tags)}
    close = [by_lower[word] for word in get_close_matches(name[:80].lower(), by_lower)]
    hint = f"is it {' or '.join(close)}?" if close else f"there are {', '.join(vocabulary)}"
    return f"no node is called {name!r:.80}; {hint}"


def is_written_out(value: Value) -> bool:
    """Whether a value hangs on no parameter."""
    if isinstance(value, list):
        return all(is_written_out(part) for part in value)
    if isinstance(value, dict):
        return all(is_written_out(part) for part in value.values())
    return not isinstance(value, Name | Formula | Choice | Entry)


def sub_trees(spec: Spec) -> Iterator[SubTree]:
    """The sub-trees of a tree, not those within them."""
    if isinstance(spec, SubTree):
        yield spec
    elif isinstance(spec, Choice):
        for case in spec.cases.values():
            yield from sub_trees(case)
    else:
        for child in spec.children():
            yield from sub_trees(child)


def ports_of(definition: Definition, file: TreeFile) -> set[str]:
    """What a tree of an XML file can be given: what is declared, and the names it uses."""
    ports: set[str] = set()
    seen: set[str] = set()

    def collect(definition: Definition) -> None:
        seen.add(definition.name)
        ports.update(definition.parameters)
        nodes(definition.root)

    def nodes(spec: Spec) -> None:
        if isinstance(spec, Choice):
            return
        for value in spec.parameters.values():
            ports.update(name for name in names_in(value) if not name.startswith("@"))
        if isinstance(spec, Node):
            for child in spec.children():
                nodes(child)
        elif spec.autoremap and spec.tree in file.trees and spec.tree not in seen:
            collect(file.trees[spec.tree])

    collect(definition)
    return ports
