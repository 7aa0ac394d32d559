"""Tree files in YAML, the native form."""

from __future__ import annotations

import re

from robobt.config import yaml
from robobt.config.yaml import Marked, parse_marked
from robobt.tree.interop.hints import hint_of, words_of, words_of_default
from robobt.tree.interop.model import (
    Definition,
    Name,
    Node,
    Spec,
    SubTree,
    Text,
    TreeFile,
    TreeFileError,
    Value,
)
from robobt.tree.interop.node_types import NodeType
from robobt.tree.interop.verify import is_written_out, unknown_type, verify
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.parameters import Parameter, ParameterError


def parse_yaml(text: bytes | str, vocabulary: Vocabulary, source: str = "tree") -> TreeFile:
    """Return the trees of a YAML text."""
    try:
        file = _YamlTreeReader(vocabulary, source).file(parse_marked(text, source, TreeFileError))
        verify(file, vocabulary)
    except RecursionError as error:
        raise TreeFileError(source, "it is nested too deeply") from error
    return file


def write_yaml(file: TreeFile) -> str:
    """Return the YAML text of a file.

    Raises:
        ValueError: the file was read from XML and holds what YAML cannot express; build
            its tree and describe that.
    """
    main = file.trees[file.main]
    data: dict[str, object] = {"play": main.name}
    others = {name: _tree_data(tree) for name, tree in file.trees.items() if name != file.main}
    tree = _tree_data(main)
    root = tree.pop("tree")
    data.update(tree)
    if others:
        data["trees"] = others
    data["tree"] = root
    return yaml.write_yaml(data)


class _YamlTreeReader:
    def __init__(self, vocabulary: Vocabulary, source: str) -> None:
        self.vocabulary, self.source = vocabulary, source

    def file(self, marked: Marked) -> TreeFile:
        parts = self._fields("a tree file", marked, ("play", *_TREE_KEYS, "trees"), needed=("play", "tree"))
        own = {key: part for key, part in parts.items() if key not in ("play", "trees")}
        main = self._tree(self._word(parts["play"], "play"), Marked(own, marked.line, marked.column))
        trees = {main.name: main}
        for name, part in self._optional_mapping(parts, "trees").items():
            if name in trees:
                raise self._error(part, f"the tree {name!r} is there twice")
            trees[name] = self._tree(name, part)
        return TreeFile(self.source, main.name, trees, "yaml")

    def _tree(self, name: str, marked: Marked) -> Definition:
        parts = self._fields(f"the tree {name!r}", marked, _TREE_KEYS, needed=("tree",))
        definition = Definition(name, self._spec(parts["tree"]), line=marked.line)
        if "description" in parts:
            description = parts["description"]
            if not isinstance(description.value, str):
                raise self._error(description, "the description is text")
            definition.description = description.value
        for parameter, part in self._optional_mapping(parts, "params").items():
            if not _IDENTIFIER.fullmatch(parameter):
                raise self._error(part, f"{parameter!r} is not a name of a parameter")
            definition.parameters[parameter] = self._parameter(parameter, part)
        return definition

    def _parameter(self, name: str, marked: Marked) -> Parameter:
        default: Marked | None = marked
        words: str | None = None
        if isinstance(marked.value, dict):
            parts = self._fields(f"the parameter {name!r}", marked, ("type", "default"), needed=())
            default = parts.get("default")
            if "type" in parts:
                words = self._word(parts["type"], "type")
            elif default is None:
                raise self._error(marked, f"{name}: it needs a type or a default")
        try:
            value = None if default is None else self._plain(default)
            words = words_of_default(value) if words is None else words
            parameter = Parameter(name, hint_of(words, self.vocabulary.words))
            if default is None:
                return parameter
            parameter.convert(value)
        except ParameterError as error:
            raise self._error(default or marked, f"{error.parameter}: {error}") from error
        except TreeFileError:
            raise
        except ValueError as error:
            raise self._error(marked, f"{name}: {error}") from error
        return Parameter(name, parameter.hint, value)

    def _spec(self, marked: Marked) -> Spec:
        if isinstance(marked.value, str):
            return self._node(marked.value, Marked({}, marked.line, marked.column), marked)
        if not isinstance(marked.value, dict) or len(marked.value) != 1:
            raise self._error(marked, "a node is a name, or one name with its parameters: Wall: {place: 0}")
        ((name, body),) = marked.value.items()
        if body.value is None:
            body = Marked({}, body.line, body.column)
        if not isinstance(body.value, dict):
            raise self._error(body, f"{name} takes its parameters by name: {name}: {{name: value}}")
        return self._sub_tree(body, marked) if name == "SubTree" else self._node(name, body, marked)

    def _sub_tree(self, body: Marked, marked: Marked) -> SubTree:
        at_node = Marked(body.value, marked.line, marked.column)
        parts = self._fields("SubTree", at_node, ("tree", "params"), needed=("tree",))
        params = self._optional_mapping(parts, "params")
        return SubTree(
            self._word(parts["tree"], "tree"),
            {name: self._value(part) for name, part in params.items()},
            line=marked.line,
            lines={name: part.line for name, part in params.items()},
        )

    def _node(self, name: str, body: Marked, marked: Marked) -> Node:
        try:
            kind = self.vocabulary.type(name)
        except ValueError as error:
            raise self._error(marked, str(error)) from error
        if kind is None:
            raise self._error(marked, unknown_type(name, self.vocabulary))
        node = Node(name, line=marked.line)
        for key, part in self._mapping(body, name).items():
            node.lines[key] = part.line
            if key == "name":
                node.name = self._word(part, "name")
            elif key in kind.branches:
                node.branches[key] = self._branch(kind, key, part)
            else:
                node.parameters[key] = self._value(part)
        return node

    def _branch(self, kind: NodeType, key: str, marked: Marked) -> Spec | list[Spec] | dict[str, Spec]:
        shape = kind.branches[key]
        if shape == "many":
            if not isinstance(marked.value, list):
                raise self._error(marked, f"{kind.name}: {key} is a list of nodes")
            return [self._spec(part) for part in marked.value]
        if shape == "cases":
            return {case: self._spec(part) for case, part in self._mapping(marked, key).items()}
        return self._spec(marked)

    def _value(self, marked: Marked) -> Value:
        value = marked.value
        if isinstance(value, list):
            return [self._value(part) for part in value]
        if isinstance(value, dict):
            return {key: self._value(part) for key, part in value.items()}
        if not isinstance(value, str) or not value.startswith("$"):
            return value
        if value.startswith("$$"):
            return value[1:]
        if not _IDENTIFIER.fullmatch(value[1:]):
            raise self._error(marked, f"{value!r} is not $name; write a text that begins with $ as $$")
        return Name(value[1:])

    def _plain(self, marked: Marked) -> Value:
        value = self._value(marked)
        if not is_written_out(value):
            raise self._error(marked, "a default depends on no other parameter")
        return value

    def _mapping(self, marked: Marked, what: str) -> dict[str, Marked]:
        if not isinstance(marked.value, dict):
            raise self._error(marked, f"{what} is a mapping")
        return marked.value

    def _optional_mapping(self, parts: dict[str, Marked], key: str) -> dict[str, Marked]:
        return self._mapping(parts[key], key) if key in parts else {}

    def _fields(
        self, what: str, marked: Marked, known: tuple[str, ...], needed: tuple[str, ...]
    ) -> dict[str, Marked]:
        parts = self._mapping(marked, what)
        for key, part in parts.items():
            if key not in known:
                raise self._error(part, f"{what} has no {key!r}; it has {', '.join(known)}")
        for key in needed:
            if key not in parts:
                raise self._error(marked, f"{what} needs {key!r}")
        return parts

    def _word(self, marked: Marked, what: str) -> str:
        value = marked.value
        if not isinstance(value, str) or not value.strip() or not value.isprintable():
            raise self._error(marked, f"{what} is a text on one line")
        return value

    def _error(self, marked: Marked, problem: str) -> TreeFileError:
        return TreeFileError(self.source, problem, line=marked.line)


def _tree_data(definition: Definition) -> dict[str, object]:
    data: dict[str, object] = {}
    if definition.description:
        data["description"] = definition.description
    if definition.parameters:
        data["params"] = {name: _parameter_data(entry) for name, entry in definition.parameters.items()}
    data["tree"] = _spec_data(definition.root)
    return data


def _parameter_data(parameter: Parameter) -> object:
    words = words_of(parameter.hint)
    if parameter.required:
        return {"type": words}
    default = _value_data(parameter.default)
    try:
        if words_of_default(parameter.default) == words:
            return default
    except ValueError:
        pass
    return {"type": words, "default": default}


def _spec_data(spec: Spec) -> object:
    if isinstance(spec, SubTree):
        if spec.autoremap or spec.label is not None:
            raise ValueError(f"the sub-tree {spec.tree!r} can only be written in XML; build the tree first")
        body: dict[str, object] = {"tree": spec.tree}
        if spec.parameters:
            body["params"] = {name: _value_data(value) for name, value in spec.parameters.items()}
        return {"SubTree": body}
    body = {} if spec.name is None else {"name": spec.name}
    body.update({name: _value_data(value) for name, value in spec.parameters.items()})
    for name, branch in spec.branches.items():
        if isinstance(branch, list):
            body[name] = [_spec_data(child) for child in branch]
        elif isinstance(branch, dict):
            body[name] = {case: _spec_data(child) for case, child in branch.items()}
        else:
            body[name] = _spec_data(branch)
    return {spec.type: body} if body else spec.type


def _value_data(value: Value) -> object:
    if isinstance(value, Text):
        raise ValueError(f"{value.text!r} has no type in XML; build the tree first")
    if isinstance(value, Name):
        return f"${value.name}"
    if isinstance(value, str):
        return f"${value}" if value.startswith("$") else value
    if isinstance(value, list):
        return [_value_data(part) for part in value]
    if isinstance(value, dict):
        return {key: _value_data(part) for key, part in value.items()}
    return value


_TREE_KEYS = ("description", "params", "tree")
_IDENTIFIER = re.compile(r"[^\W\d]\w*")
