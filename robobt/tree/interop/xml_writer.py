"""Writes trees in the XML of BehaviorTree.CPP 4, with the models of all leaves for Groot2's palette."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from math import isfinite
from typing import Any
from xml.sax.saxutils import escape, quoteattr

from robobt.tree.interop.btcpp import OTHER_TAGS, TAGS, Attribute, Tag, long_tags, tags_of
from robobt.tree.interop.hints import words_of
from robobt.tree.interop.model import Name, Node, Spec, SubTree, Text, TreeFile, Value
from robobt.tree.interop.node_types import NodeType
from robobt.tree.interop.verify import is_written_out
from robobt.tree.interop.vocabulary import Vocabulary, takes_entry
from robobt.tree.parameters import Parameter, ParameterError
from robobt.tree.signatures import meanings_of


def write_xml(file: TreeFile, vocabulary: Vocabulary) -> str:
    """Return the XML text of a file, with the models of all leaves for Groot2's palette.

    Raises:
        ValueError: the file was read from YAML and holds what XML cannot express
            (names within values); build its tree and describe that.
    """
    return _Writer(vocabulary).file(file)


class _Writer:
    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary
        self.in_main = True

    def file(self, file: TreeFile) -> str:
        main = file.trees[file.main]
        used: set[str] = set()
        lines = ['<?xml version="1.0" encoding="UTF-8"?>']
        lines.append(f'<root BTCPP_format="4" main_tree_to_execute={quoteattr(main.name)}>')
        for definition in file.trees.values():
            self.in_main = definition is main
            lines.append(f"  <BehaviorTree ID={quoteattr(definition.name)}>")
            lines += self._spec(definition.root, "    ", used)
            lines += ["  </BehaviorTree>", ""]
        lines.append("  <!-- Description of Node Models (used by Groot) -->")
        lines.append("  <TreeNodesModel>")
        for name in self.vocabulary:
            kind = self.vocabulary.type(name)
            assert kind is not None
            if not tags_of(name) and (name in used or kind.leaf or kind.cls in self.vocabulary.controls):
                lines += _model_lines(long_tags(kind)[0], _tag_name(kind), self._ports(kind))
        for definition in file.trees.values():
            if definition.parameters:
                ports = [("input_port", self._tree_port(entry)) for entry in definition.parameters.values()]
                lines += _model_lines("SubTree", definition.name, ports)
        lines += ["  </TreeNodesModel>", "</root>", ""]
        return "\n".join(lines)

    def _spec(self, spec: Spec, indent: str, used: set[str]) -> list[str]:
        if isinstance(spec, SubTree):
            attributes = {"ID": spec.tree}
            if spec.label is not None:
                attributes["name"] = spec.label
            if spec.autoremap:
                attributes["_autoremap"] = "true"
            attributes.update({name: self._text(None, value) for name, value in spec.parameters.items()})
            return [f"{indent}<SubTree{_attributes(attributes)}/>"]
        kind = self.vocabulary.type(spec.type)
        assert kind is not None
        used.add(kind.name)
        tag, attributes, children = self._node(spec, kind)
        if not children:
            return [f"{indent}<{tag}{_attributes(attributes)}/>"]
        inner = [line for child in children for line in self._spec(child, indent + "  ", used)]
        return [f"{indent}<{tag}{_attributes(attributes)}>", *inner, f"{indent}</{tag}>"]

    def _node(self, spec: Node, kind: NodeType) -> tuple[str, dict[str, str], list[Spec]]:
        endless = _ENDLESS.get(kind.name)
        name, tag = (endless[0], Tag(kind.name)) if endless is not None else _tag_for(spec, kind)
        attributes = {}
        if spec.name is not None and spec.name != name:
            attributes["name"] = spec.name
        if endless is not None:
            attributes[endless[1]] = "-1"
        renamed = {entry.parameter: (shown, entry) for shown, entry in tag.attributes.items()}
        for key, value in spec.parameters.items():
            if key in tag.fixed:
                continue
            shown, attribute = renamed.get(key, (key, None))
            attributes[shown] = self._attribute(attribute, kind.parameters.get(key), value)
        for shown, attribute in tag.attributes.items():
            # Groot2 shows what is written; its own defaults are not to be relied on.
            if attribute.default is not None and attribute.parameter not in spec.parameters:
                attributes[shown] = attribute.default
        for branch, children in spec.branches.items():
            if isinstance(children, dict):
                attributes[branch] = ";".join(children)
        return name, attributes, list(spec.children())

    def _attribute(self, attribute: Attribute | None, parameter: Parameter | None, value: Value) -> str:
        if attribute is not None and attribute.milliseconds and isinstance(value, int | float):
            milliseconds = value * 1000.0
            if not isfinite(milliseconds) or round(milliseconds) / 1000.0 != value:
                raise ValueError(f"{value} s is not a whole number of milliseconds, which XML needs")
            return str(round(milliseconds))
        return self._text(parameter, value)

    def _text(self, parameter: Parameter | None, value: Value) -> str:
        if isinstance(value, Name):
            return f"{{{value.name}}}"
        if isinstance(value, Text):
            return value.text
        if (
            parameter is not None
            and takes_entry(parameter)
            and isinstance(value, dict)
            and set(value) == {"entry"}
        ):
            # A sub-tree sees only what it is given, and what the outermost tree sees.
            return f"{{{value['entry']}}}" if self.in_main else f"{{@{value['entry']}}}"
        if not is_written_out(value):
            raise ValueError("XML has no names within values; build the tree first")
        return self.vocabulary.to_text(parameter, value)

    def _ports(self, kind: NodeType) -> Iterator[tuple[str, dict[str, str]]]:
        meanings = meanings_of(kind.cls)
        for parameter in kind.parameters.values():
            port = {"name": parameter.name, "type": parameter.kind}
            if parameter.name in kind.reads and parameter.default is None:
                port["default"] = f"{{{parameter.name}}}"
            elif not parameter.required and parameter.default is not None:
                try:
                    default = parameter.plain(parameter.default)
                    port["default"] = self.vocabulary.to_text(parameter, default)
                except ParameterError:
                    # A default that only Python can say; Groot2 leaves it out and so it holds.
                    pass
            if parameter.name in meanings:
                port[""] = meanings[parameter.name]
            yield "input_port", port
        for entry in dict.fromkeys((*kind.reads, *kind.writes)):
            if entry not in kind.parameters:
                both = entry in kind.reads and entry in kind.writes
                direction = "inout_port" if both else "input_port" if entry in kind.reads else "output_port"
                yield direction, {"name": entry, "default": f"{{{entry}}}"}

    def _tree_port(self, parameter: Parameter) -> dict[str, str]:
        port = {"name": parameter.name}
        if parameter.hint is not Any:
            port["type"] = words_of(parameter.hint)
        if not parameter.required:
            known = None if parameter.hint is Any else parameter
            port["default"] = self._text(known, parameter.default)
        return port


def _tag_for(spec: Node, kind: NodeType) -> tuple[str, Tag]:
    for name, tag in TAGS.items():
        fits = all(spec.parameters.get(key) is value for key, value in tag.fixed.items())
        if tag.type == kind.name and fits:
            return name, tag
    if tags_of(kind.name):
        raise ValueError(f"{kind.name} with {spec.parameters} is nothing XML can say; build the tree first")
    return _tag_name(kind), Tag(kind.name)


def _tag_name(kind: NodeType) -> str:
    return next((tag for tag, name in OTHER_TAGS.items() if name == kind.name), kind.name)


def _model_lines(tag: str, name: str, ports: Iterable[tuple[str, dict[str, str]]]) -> list[str]:
    inner = [f"      {_port(direction, port)}" for direction, port in ports]
    start = f"    <{tag} ID={quoteattr(name)}"
    return [f"{start}>", *inner, f"    </{tag}>"] if inner else [f"{start}/>"]


def _port(direction: str, port: dict[str, str]) -> str:
    """Return a port's element; what it means is under "" and becomes its text, as Groot2 has it."""
    attributes = _attributes({name: value for name, value in port.items() if name})
    return (
        f"<{direction}{attributes}>{escape(port[''])}</{direction}>"
        if "" in port
        else f"<{direction}{attributes}/>"
    )


def _attributes(attributes: dict[str, str]) -> str:
    for value in attributes.values():
        if _UNWRITABLE.search(value):
            raise ValueError(f"XML cannot hold the characters of {value!r}")
    return "".join([f" {name}={quoteattr(value, _ENTITIES)}" for name, value in attributes.items()])


_ENDLESS = {
    attribute.endless: (tag, name)
    for tag, entry in TAGS.items()
    for name, attribute in entry.attributes.items()
    if attribute.endless is not None
}
"""Types that are written as another tag with -1: the tag and the attribute."""

_UNWRITABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
# Attribute values lose their line ends unless they are written as references.
_ENTITIES = {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}
