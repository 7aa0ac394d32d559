"""Tree files in YAML, the native form."""

from __future__ import annotations

import re
from typing import Any

from robobt.config import yaml
from robobt.config.yaml import Marked, parse_marked
from robobt.tree.interop.formula import formula_names
from robobt.tree.interop.kinds import choices_hint, choices_of, hint_of, kind_of, say_kind
from robobt.tree.interop.model import (
    Choice,
    Definition,
    Formula,
    Name,
    Node,
    Spec,
    SubTree,
    Text,
    TreeFile,
    TreeFileError,
    Value,
)
from robobt.tree.interop.verify import is_written_out, unknown_type, verify
from robobt.tree.interop.vocabulary import NodeType, Vocabulary
from robobt.tree.parameters import Parameter, ParameterError


def parse_yaml(text: bytes | str, vocabulary: Vocabulary, source: str = "tree") -> TreeFile:
    """The trees of a YAML text.

    Args:
        source: what messages call it.

    Raises:
        TreeFileError: the first thing that is wrong.
    """
    try:
        file = _Reader(vocabulary, source).file(parse_marked(text, source, TreeFileError))
    except RecursionError as error:
        raise TreeFileError(source, "it is nested too deeply") from error
    verify(file, vocabulary)
    return file


def write_yaml(file: TreeFile) -> str:
    """The YAML text of a file.

    Raises:
        ValueError: it has been read from XML and holds what YAML cannot say; build
            its tree and describe that.
    """
    main = file.trees[file.main]
    data: dict[str, Any] = {"play": main.name}
    others = {name: _tree_data(tree) for name, tree in file.trees.items() if name != file.main}
    tree = _tree_data(main)
    root = tree.pop("tree")
    data.update(tree)
    if others:
        data["trees"] = others
    data["tree"] = root
    return yaml.write_yaml(data)


class _Reader:
    def __init__(self, vocabulary: Vocabulary, source: str) -> None:
        self.vocabulary, self.source = vocabulary, source

    def file(self, marked: Marked) -> TreeFile:
        parts = self._mapping(marked, "a tree file")
        self._keys("a tree file", marked, ("play", *_TREE_KEYS, "trees"), needed=("play", "tree"))
        main = self._tree(self._word(parts["play"], "play"), marked, ("play", "trees"))
        trees = {main.name: main}
        for name, part in self._mapping(parts.get("trees", Marked({}, 1, 1)), "trees").items():
            if name in trees:
                raise self._error(part, f"the tree {name!r} is there twice")
            trees[name] = self._tree(name, part, ())
        return TreeFile(self.source, main.name, trees, "yaml")

    def _tree(self, name: str, marked: Marked, besides: tuple[str, ...]) -> Definition:
        parts = self._mapping(marked, f"the tree {name!r}")
        self._keys(f"the tree {name!r}", marked, (*_TREE_KEYS, *besides), needed=("tree",))
        definition = Definition(name, self._spec(parts["tree"]), line=marked.line)
        if "description" in parts:
            description = parts["description"]
            if not isinstance(description.value, str):
                raise self._error(description, "the description is text")
            definition.description = description.value
        for parameter, part in self._mapping(parts.get("params", Marked({}, 1, 1)), "params").items():
            self._check_identifier(parameter, part)
            definition.parameters[parameter] = self._parameter(parameter, part)
        for value, part in self._mapping(parts.get("let", Marked({}, 1, 1)), "let").items():
            self._check_identifier(value, part)
            if value in definition.parameters:
                raise self._error(part, f"{value!r} is a parameter already")
            definition.let[value] = self._value(part)
        return definition

    def _parameter(self, name: str, marked: Marked) -> Parameter:
        try:
            if not isinstance(marked.value, dict):
                default = self._plain(marked)
                return self._with_default(Parameter(name, hint_of(kind_of(default))), default, marked)
            self._keys(f"the parameter {name!r}", marked, ("type", "choices", "default"), needed=())
            hint = self._hint(marked)
        except ValueError as error:
            if isinstance(error, TreeFileError):
                raise
            raise self._error(marked, f"{name}: {error}") from error
        if "default" not in marked.value:
            return Parameter(name, hint)
        part = marked.value["default"]
        return self._with_default(Parameter(name, hint), self._plain(part), part)

    def _hint(self, marked: Marked) -> Any:
        parts: dict[str, Marked] = marked.value
        if "choices" in parts:
            if "type" in parts:
                raise self._error(parts["type"], "a parameter has choices or a type")
            choices = self._plain(parts["choices"])
            words = isinstance(choices, list) and choices and all(isinstance(word, str) for word in choices)
            if not words:
                raise self._error(parts["choices"], "choices is a list of words")
            return choices_hint(choices)
        if "type" in parts:
            return hint_of(self._word(parts["type"], "type"))
        if "default" not in parts:
            raise ValueError("it needs a type, choices or a default")
        return hint_of(kind_of(self._plain(parts["default"])))

    def _with_default(self, parameter: Parameter, default: Any, marked: Marked) -> Parameter:
        try:
            parameter.convert(default)
        except ParameterError as error:
            raise self._error(marked, f"{error.parameter}: {error}") from error
        return Parameter(parameter.name, parameter.hint, default)

    def _spec(self, marked: Marked) -> Spec:
        if isinstance(marked.value, str):
            return self._node(marked.value, Marked({}, marked.line, marked.column), marked)
        if self._is_choice(marked):
            return self._choice(marked, self._spec)
        if not isinstance(marked.value, dict) or len(marked.value) != 1:
            raise self._error(marked, "a node is a name, or one name with its parameters: Wall: {place: 0}")
        ((name, body),) = marked.value.items()
        if body.value is None:
            body = Marked({}, body.line, body.column)
        if not isinstance(body.value, dict):
            raise self._error(body, f"{name} takes its parameters by name: {name}: {{name: value}}")
        return self._sub_tree(body, marked) if name == "SubTree" else self._node(name, body, marked)

    def _sub_tree(self, body: Marked, marked: Marked) -> SubTree:
        self._keys(
            "SubTree", Marked(body.value, marked.line, marked.column), ("tree", "params"), needed=("tree",)
        )
        params = self._mapping(body.value.get("params", Marked({}, body.line, body.column)), "params")
        return SubTree(
            self._word(body.value["tree"], "tree"),
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
        for key, part in body.value.items():
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
        if isinstance(value, str) and value.startswith("$"):
            return self._reference(value, marked)
        if isinstance(value, list):
            return [self._value(part) for part in value]
        if self._is_choice(marked):
            return self._choice(marked, self._value)
        if isinstance(value, dict):
            return {key: self._value(part) for key, part in value.items()}
        return value

    def _reference(self, text: str, marked: Marked) -> Value:
        if text.startswith("$$"):
            return text[1:]
        if text.startswith("$(") and text.endswith(")"):
            try:
                formula_names(text[2:-1])
            except ValueError as error:
                raise self._error(marked, str(error)) from error
            return Formula(text[2:-1])
        if not _IDENTIFIER.fullmatch(text[1:]):
            raise self._error(
                marked, f"{text!r} is neither $name nor $(formula); a text that begins with $ is written $$"
            )
        return Name(text[1:])

    def _is_choice(self, marked: Marked) -> bool:
        return isinstance(marked.value, dict) and "choose" in marked.value

    def _choice(self, marked: Marked, read: Any) -> Choice:
        self._keys("choose", marked, ("choose", "cases"), needed=("choose", "cases"))
        cases = self._mapping(marked.value["cases"], "cases")
        if not cases:
            raise self._error(marked, "choose: there are no cases")
        by = self._value(marked.value["choose"])
        if not isinstance(by, Name):
            raise self._error(marked, "choose takes the name of a parameter: $name")
        return Choice(by, {case: read(part) for case, part in cases.items()}, marked.line)

    def _plain(self, marked: Marked) -> Any:
        value = self._value(marked)
        if not is_written_out(value):
            raise self._error(marked, "a default hangs on no other parameter")
        return value

    def _mapping(self, marked: Marked, what: str) -> dict[str, Marked]:
        if not isinstance(marked.value, dict):
            raise self._error(marked, f"{what} is a mapping")
        return marked.value

    def _keys(self, what: str, marked: Marked, known: tuple[str, ...], needed: tuple[str, ...]) -> None:
        for key, part in marked.value.items():
            if key not in known:
                raise self._error(part, f"{what} has no {key!r}; it has {', '.join(known)}")
        for key in needed:
            if key not in marked.value:
                raise self._error(marked, f"{what} needs {key!r}")

    def _word(self, marked: Marked, what: str) -> str:
        value = marked.value
        if not isinstance(value, str) or not value.strip() or not value.isprintable():
            raise self._error(marked, f"{what} is a text on one line")
        return value

    def _check_identifier(self, name: str, marked: Marked) -> None:
        if not _IDENTIFIER.fullmatch(name):
            raise self._error(marked, f"{name!r} is no name of a parameter")

    def _error(self, marked: Marked, problem: str) -> TreeFileError:
        return TreeFileError(self.source, problem, line=marked.line)


def _tree_data(definition: Definition) -> dict[str, Any]:
    data: dict[str, Any] = {}
    if definition.description:
        data["description"] = definition.description
    if definition.parameters:
        data["params"] = {name: _parameter_data(entry) for name, entry in definition.parameters.items()}
    if definition.let:
        data["let"] = {name: _value_data(value) for name, value in definition.let.items()}
    data["tree"] = _spec_data(definition.root)
    return data


def _parameter_data(parameter: Parameter) -> Any:
    default = {} if parameter.required else {"default": _value_data(parameter.default)}
    choices = choices_of(parameter.hint)
    if choices is not None:
        return {"choices": choices, **default}
    try:
        if not parameter.required and hint_of(kind_of(parameter.default)) == parameter.hint:
            return default["default"]
    except ValueError:
        pass
    return {"type": say_kind(parameter.hint), **default}


def _spec_data(spec: Spec) -> Any:
    if isinstance(spec, Choice):
        return _choice_data(spec, _spec_data)
    if isinstance(spec, SubTree):
        if spec.autoremap or spec.label is not None:
            raise ValueError(f"the sub-tree {spec.tree!r} is one of XML; build the tree first")
        body: dict[str, Any] = {"tree": spec.tree}
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


def _value_data(value: Value) -> Any:
    if isinstance(value, Text):
        raise ValueError(f"{value.text!r} has no type in XML; build the tree first")
    if isinstance(value, Name):
        return f"${value.name}"
    if isinstance(value, Formula):
        return f"$({value.text})"
    if isinstance(value, Choice):
        return _choice_data(value, _value_data)
    if isinstance(value, str):
        return f"${value}" if value.startswith("$") else value
    if isinstance(value, list):
        return [_value_data(part) for part in value]
    if isinstance(value, dict):
        return {key: _value_data(part) for key, part in value.items()}
    return value


def _choice_data(choice: Choice, write: Any) -> Any:
    cases = {case: write(part) for case, part in choice.cases.items()}
    return {"choose": _value_data(choice.by), "cases": cases}


_TREE_KEYS = ("description", "params", "let", "tree")
_IDENTIFIER = re.compile(r"[^\W\d]\w*")
