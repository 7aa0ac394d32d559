"""Checks the whole content of a tree file, whether or not it would be built."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches

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
    names_in,
    parts_of,
    specs_of,
)
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.parameters import Parameter, ParameterError, check_names, parameters_of
from robobt.tree.registry import Registry


def verify(file: TreeFile, vocabulary: Vocabulary) -> None:
    """Check every tree of a file.

    Every named type, tree and parameter must exist, all required values must be given, literal values must
    fit their types, and no tree may contain itself. Values that depend on the tree's parameters are checked
    when it is built.
    """
    verifier = _Verifier(file, vocabulary)
    verifier.check_cycles()
    for definition in file.trees.values():
        verifier.source = file.source_of(definition.name)
        verifier.spec(definition.root, definition)


class _Verifier:
    def __init__(self, file: TreeFile, vocabulary: Vocabulary) -> None:
        self.file, self.vocabulary = file, vocabulary
        self.ports: dict[str, set[str]] = {}
        self.source = file.source

    def check_cycles(self) -> None:
        done: set[str] = set()

        def follow(definition: Definition, path: list[str]) -> None:
            for spec in sub_trees(definition.root):
                if spec.tree in path:
                    self.source = self.file.source_of(definition.name)
                    raise self._error(spec.line, f"the tree {spec.tree!r} contains itself")
                if spec.tree in self.file.trees and spec.tree not in done:
                    follow(self.file.trees[spec.tree], [*path, spec.tree])
            done.add(definition.name)

        for definition in self.file.trees.values():
            follow(definition, [definition.name])

    def spec(self, spec: Spec, inside: Definition) -> None:
        if self.file.language == "yaml":
            for name, value in spec.parameters.items():
                self._check_names_in(value, inside, spec.line_of(name))
        if isinstance(spec, SubTree):
            self._sub_tree(spec)
        else:
            self._node(spec)
            for child in spec.children():
                self.spec(child, inside)

    def _check_names_in(self, value: Value, inside: Definition, line: int) -> None:
        for name in names_in(value):
            if name not in inside.parameters:
                known = ", ".join(sorted(inside.parameters))
                has = f"it has {known}" if known else "it has none"
                raise self._error(line, f"the tree has no parameter {name!r}; {has}")

    def _node(self, spec: Node) -> None:
        kind = self.vocabulary.type(spec.type)
        assert kind is not None, spec.type
        if kind.name_required and spec.name is None:
            raise self._error(spec.line, f"{spec.type}: name: {spec.type} needs this parameter")
        entries = {*kind.reads, *kind.writes} - set(kind.parameters)
        given = {name: value for name, value in spec.parameters.items() if name not in entries}
        self._parameters(spec, spec.type, kind.parameters, given)
        for name, shape in kind.branches.items():
            if name not in spec.branches and shape in ("one", "cases"):
                raise self._error(spec.line, f"{spec.type}: {name}: {spec.type} needs this branch")

    def _sub_tree(self, spec: SubTree) -> None:
        definition = self.file.trees.get(spec.tree)
        if definition is None:
            self._parameters(spec, spec.tree, self._play_parameters(spec), spec.parameters)
        elif self.file.language == "yaml":
            self._parameters(spec, spec.tree, definition.parameters, spec.parameters)
        else:
            self._ports(spec, definition)

    def _play_parameters(self, spec: SubTree) -> dict[str, Parameter]:
        if spec.tree not in self.vocabulary.plays:
            known = ", ".join([*self.file.trees, *self.vocabulary.plays])
            raise self._error(spec.line, f"no tree or play is called {spec.tree!r}; there are {known}")
        try:
            return {entry.name: entry for entry in parameters_of(self.vocabulary.plays[spec.tree])}
        except (TypeError, ValueError, NameError) as error:
            raise self._error(spec.line, f"the parameters of {spec.tree} cannot be read: {error}") from error

    def _ports(self, spec: SubTree, definition: Definition) -> None:
        ports = ports_of(definition, self.file, self.ports)
        for name in spec.parameters:
            if name not in ports:
                has = f"it has {', '.join(sorted(ports))}" if ports else "it has none"
                problem = f"{spec.tree}: {name}: {spec.tree} has no such port; {has}"
                raise self._error(spec.line_of(name), problem)
        for name, parameter in definition.parameters.items():
            if parameter.required and name not in spec.parameters and not spec.autoremap:
                raise self._error(spec.line, f"{spec.tree}: {name}: {spec.tree} needs this port")

    def _parameters(
        self, spec: Spec, what: str, known: Mapping[str, Parameter], given: Mapping[str, Value]
    ) -> None:
        try:
            check_names(what, known, given)
            for name, value in given.items():
                if isinstance(value, Text):
                    self.vocabulary.from_text(known[name], value.text)
                elif is_written_out(value):
                    self.vocabulary.convert(known[name], value)
        except ParameterError as error:
            line = spec.line_of(error.parameter.partition(".")[0])
            raise self._error(line, f"{what}: {error.parameter}: {error}") from error

    def _error(self, line: int, problem: str) -> TreeFileError:
        return TreeFileError(self.source, problem, line=line)


def unknown_type(name: str, vocabulary: Vocabulary, tags: Iterable[str] = ()) -> str:
    """Return the problem with a type that does not exist, or that another package failed to bring.

    ``tags`` are what else could have been meant.
    """
    if isinstance(vocabulary.leaves, Registry) and (problem := vocabulary.leaves.problem_with(name)):
        return problem
    by_lower = {known.lower(): known for known in (*vocabulary, *tags)}
    close = [by_lower[word] for word in get_close_matches(name[:80].lower(), by_lower)]
    hint = f"is it {' or '.join(close)}?" if close else f"there are {', '.join(vocabulary)}"
    return f"no node is called {name!r:.80}; {hint}"


def is_written_out(value: Value) -> bool:
    """Return whether a value depends on no parameter and no entry."""
    return not any(isinstance(part, Name | Entry) for part in parts_of(value))


def sub_trees(spec: Spec) -> Iterator[SubTree]:
    """Yield the sub-trees of a tree, not those within them."""
    if isinstance(spec, SubTree):
        yield spec
    else:
        for child in spec.children():
            yield from sub_trees(child)


def ports_of(definition: Definition, file: TreeFile, known: dict[str, set[str]] | None = None) -> set[str]:
    """Return the parameters that a tree of an XML file accepts: declared ones, and the names it uses.

    ``known`` has the ports of trees that have been looked at, and gets those of this one and of all it holds.
    """
    known = {} if known is None else known
    if definition.name in known:
        return known[definition.name]
    ports = known[definition.name] = set(definition.parameters)
    for spec in specs_of(definition.root):
        for value in spec.parameters.values():
            ports.update(name for name in names_in(value) if not name.startswith("@"))
        if isinstance(spec, SubTree) and spec.autoremap and spec.tree in file.trees:
            ports |= ports_of(file.trees[spec.tree], file, known)
    return ports
