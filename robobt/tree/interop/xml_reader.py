"""Reads tree files in the XML of BehaviorTree.CPP 4, as Groot2 writes it."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, TypeAlias

from robobt.tree.interop.btcpp import (
    METADATA,
    NODE_TAGS,
    OTHER_TAGS,
    SCRIPT_ATTRIBUTES,
    TAGS,
    UNKNOWN_HERE,
    VERSION_3_ATTRIBUTES,
    VERSION_3_TAGS,
    Attribute,
    Tag,
    long_tags,
    tags_of,
)
from robobt.tree.interop.hints import hint_of
from robobt.tree.interop.model import Definition, Name, Node, Spec, SubTree, Text, TreeFile, TreeFileError
from robobt.tree.interop.node_types import NodeType
from robobt.tree.interop.verify import sub_trees, unknown_type, verify
from robobt.tree.interop.vocabulary import Vocabulary, is_pointer
from robobt.tree.interop.xml_elements import Element, ElementChecker, read_element
from robobt.tree.parameters import Parameter, ParameterError

Include: TypeAlias = Callable[[str], tuple[str, bytes]]
"""Returns the name, for messages, and the text of a file that a project includes."""


def parse_xml(
    text: bytes | str, vocabulary: Vocabulary, source: str = "tree", include: Include | None = None
) -> TreeFile:
    """Return the trees of an XML text, and of the files that it includes where ``include`` reads them.

    The main tree is what ``main_tree_to_execute`` names, else the only tree, else
    the one that is not a sub-tree of another.
    """
    try:
        file = _XmlTreeReader(vocabulary, source, include).file(read_element(text, source))
        verify(file, vocabulary)
    except RecursionError as error:
        raise TreeFileError(source, "it is nested too deeply") from error
    return file


class _XmlTreeReader(ElementChecker):
    def __init__(self, vocabulary: Vocabulary, source: str, include: Include | None = None) -> None:
        super().__init__(source)
        self.vocabulary, self.include = vocabulary, include
        self.trees: dict[str, Definition] = {}
        self.models: list[tuple[_XmlTreeReader, Element]] = []

    def file(self, root: Element) -> TreeFile:
        self._parts(root)
        if not self.trees:
            lacking = "there is no <BehaviorTree>" if self.include is None else "the project includes no tree"
            raise self.error(root, lacking)
        for reader, model in self.models:
            reader._model(model, self.trees)
        return TreeFile(self.source, self._main(root, self.trees), self.trees, "xml")

    def _parts(self, root: Element) -> None:
        """Read the trees and find the models, of this file and of those that it includes."""
        if root.tag != "root":
            raise self.error(root, f"the outermost tag is <root>, not <{root.tag}>")
        self.attributes(root, ("BTCPP_format", "main_tree_to_execute", "project_name"), ())
        version = root.attributes.get("BTCPP_format")
        if version != "4":
            said = "<root> has no BTCPP_format" if version is None else f'BTCPP_format="{version}"'
            convert = 'robobt reads version 4: convert it, then set BTCPP_format="4"'
            raise self.error(root, f"this file is for BehaviorTree.CPP {version or 3} ({said}); {convert}")
        self.no_text(root)
        own = False
        for part in root.children:
            if part.tag == "BehaviorTree":
                definition = self._tree(part, only=len(root.children) == 1)
                if definition.name in self.trees:
                    raise self.error(part, f"the tree {definition.name!r} is there twice")
                self.trees[definition.name] = definition
            elif part.tag == "TreeNodesModel" and not own:
                own = True
                self.models.append((self, part))
            elif part.tag == "TreeNodesModel":
                raise self.error(part, "there are two <TreeNodesModel>")
            elif part.tag == "include":
                self._include(part)
            else:
                raise self.error(part, f"<root> has <BehaviorTree> and <TreeNodesModel>, no <{part.tag}>")

    def _include(self, part: Element) -> None:
        if self.include is None:
            raise self.error(part, "<include> is not supported; put the trees into one file")
        self.attributes(part, ("path",), ("path",))
        try:
            source, text = self.include(self.word(part, "path"))
        except TreeFileError as error:
            raise self.error(part, f"<include>: {error}") from error
        included = _XmlTreeReader(self.vocabulary, source)
        included.trees, included.models = self.trees, self.models
        included._parts(read_element(text, source))

    def _main(self, root: Element, trees: dict[str, Definition]) -> str:
        named = root.attributes.get("main_tree_to_execute")
        if named is not None:
            if named not in trees:
                raise self.error(root, f"there is no tree {named!r}; there are {', '.join(trees)}")
            return named
        inner = {
            spec.tree for tree in trees.values() for spec in sub_trees(tree.root) if spec.tree != tree.name
        }
        outer = [name for name in trees if name not in inner]
        if len(outer) != 1:
            which = "every tree is a sub-tree of another"
            if outer:
                each = "both" if len(outer) == 2 else "all"
                which = f"{', '.join(outer[:-1])} and {outer[-1]} could {each} be the main tree"
            raise self.error(root, f"{which}; name one in main_tree_to_execute")
        return outer[0]

    def _tree(self, element: Element, only: bool) -> Definition:
        self.attributes(element, ("ID", *METADATA), () if only else ("ID",))
        self.no_text(element)
        if len(element.children) != 1:
            raise self.error(element, f"<BehaviorTree> has one child, not {len(element.children)}")
        name = self.word(element, "ID") if "ID" in element.attributes else "BehaviorTree"
        return Definition(name, self._spec(element.children[0]), line=element.line, source=self.source)

    def _spec(self, element: Element) -> Spec:
        self.no_text(element)
        self._check_version(element)
        for name in element.attributes:
            if name in SCRIPT_ATTRIBUTES:
                raise self.error(element, f"{name}: robobt has no scripts; write a condition")
            if name.startswith("_") and name not in METADATA and element.tag != "SubTree":
                raise self.error(element, f"<{element.tag}> has no attribute {name}")
        return self._sub_tree(element) if element.tag == "SubTree" else self._node(element)

    def _check_version(self, element: Element) -> None:
        """Check that there is nothing of version 3 of BehaviorTree.CPP."""
        long_form = element.tag in NODE_TAGS
        shown = element.attributes.get("ID", "") if long_form else element.tag
        if shown in VERSION_3_TAGS and shown not in self.vocabulary:
            now = f"<{shown}> is a tag of BehaviorTree.CPP 3; in version 4 {VERSION_3_TAGS[shown]}"
            raise self.error(element, f"no node is called {shown!r}; {now}")
        for name, now in VERSION_3_ATTRIBUTES.get(shown, {}).items():
            if name in element.attributes:
                now = f"it is one of BehaviorTree.CPP 3; in version 4 {now}"
                raise self.error(element, f"<{shown}> has no attribute {name}; {now}")

    def _sub_tree(self, element: Element) -> SubTree:
        if element.children:
            raise self.error(element, "<SubTree> has no children")
        if "ID" not in element.attributes:
            raise self.error(element, "<SubTree> needs the attribute ID")
        spec = SubTree(self.word(element, "ID"), line=element.line)
        for name, text in element.attributes.items():
            if name == "_autoremap":
                if text.lower() not in _BOOLEAN_WORDS:
                    raise self.error(element, f"_autoremap is true or false, not {text!r}")
                spec.autoremap = _BOOLEAN_WORDS[text.lower()]
            elif name == "name":
                spec.label = self.word(element, "name")
            elif name.startswith("_") and name not in METADATA:
                raise self.error(element, f"<SubTree> has no attribute {name}")
            elif name != "ID" and name not in METADATA:
                spec.parameters[name] = self._pointer(element, name, text) if is_pointer(text) else Text(text)
        return spec

    def _node(self, element: Element) -> Node:
        shown, tag, kind = self._type(element)
        node = Node(kind.name, line=element.line)
        if "name" in element.attributes:
            node.name = self.word(element, "name")
        elif not kind.leaf:
            node.name = shown
        node.parameters.update(tag.fixed)
        given = {
            name: text
            for name, text in element.attributes.items()
            if name not in ("name", *METADATA) and not (name == "ID" and element.tag in NODE_TAGS)
        }
        cases = next((name for name, shape in kind.branches.items() if shape == "cases"), None)
        self._branches(element, node, kind, given.pop(cases, None) if cases is not None else None)
        for name, attribute in tag.attributes.items():
            if name not in given and attribute.default is None:
                raise self.error(element, f"<{shown}> needs the attribute {name}")
            given.setdefault(name, attribute.default or "")
        for name, text in given.items():
            self._parameter(element, node, shown, tag, kind, name, text)
        for attribute in tag.attributes.values():
            if attribute.endless is not None and node.parameters.get(attribute.parameter) == -1:
                node.type = attribute.endless
                del node.parameters[attribute.parameter]
        return node

    def _parameter(
        self, element: Element, node: Node, shown: str, tag: Tag, kind: NodeType, name: str, text: str
    ) -> None:
        attribute = tag.attributes.get(name)
        key = name if attribute is None else attribute.parameter
        parameter = kind.parameters.get(key)
        entries = (*kind.reads, *kind.writes)
        hidden = attribute is None and (shown in TAGS or key in tag.fixed)
        if hidden or (parameter is None and name not in entries):
            there = list(tag.attributes) if shown in TAGS else [*kind.parameters, *entries]
            has = f"it has {', '.join(there)}" if there else "it has none besides its name"
            raise self.error(element, f"<{shown}> has no attribute {name}; {has}")
        if is_pointer(text):
            if attribute is not None and attribute.milliseconds:
                raise self.error(element, f"{name} of <{shown}> is a number, not {text}")
            node.parameters[key] = self._pointer(element, name, text)
        elif parameter is None:
            raise self.error(
                element, f"{name} of <{shown}> is an entry that it uses: {{{name}}}, not {text!r}"
            )
        else:
            try:
                node.parameters[key] = self._plain(attribute, parameter, text)
            except ParameterError as error:
                # Where the value is a structure, at this place in it.
                place = f"{name}{error.parameter.removeprefix(parameter.name)}"
                raise self.error(element, f"{place} of <{shown}>: {error}") from error

    def _plain(self, attribute: Attribute | None, parameter: Parameter, text: str) -> object:
        if attribute is None:
            return self.vocabulary.from_text(parameter, text)
        number = self.vocabulary.from_text(Parameter(parameter.name, int), text)
        assert isinstance(number, int)
        if attribute.milliseconds:
            if number < 0:
                raise ParameterError(parameter.name, f"{number} is negative")
            return number / 1000.0
        if attribute.count and number < 1 and number != -1:
            raise ParameterError(parameter.name, f"{number} is neither 1 or more nor -1, without end")
        return number

    def _type(self, element: Element) -> tuple[str, Tag, NodeType]:
        """Return the element's name in messages, the tag it stands for, and the node's type."""
        long_form = element.tag in NODE_TAGS
        if long_form and "ID" not in element.attributes:
            raise self.error(element, f"<{element.tag}> needs the attribute ID")
        shown = self.word(element, "ID") if long_form else element.tag
        tag = TAGS.get(shown) or Tag(OTHER_TAGS.get(shown, shown))
        try:
            kind = self.vocabulary.type(tag.type)
        except ValueError as error:
            raise self.error(element, str(error)) from error
        if kind is None and shown in UNKNOWN_HERE:
            raise self.error(element, f"<{shown}>: {UNKNOWN_HERE[shown]}")
        if kind is None:
            raise self.error(element, unknown_type(shown, self.vocabulary, TAGS))
        if shown not in TAGS and shown not in OTHER_TAGS and tags_of(kind.name):
            raise self.error(element, f"<{shown}> is written {' or '.join(tags_of(kind.name))} in XML")
        if long_form and element.tag not in long_tags(kind):
            raise self.error(element, f"{shown} is not a <{element.tag}> but a <{long_tags(kind)[0]}>")
        return shown, tag, kind

    def _branches(self, element: Element, node: Node, kind: NodeType, cases: str | None) -> None:
        children = [self._spec(child) for child in element.children]
        count = len(children)
        if kind.leaf:
            if count:
                raise self.error(element, f"<{element.tag}> has no children")
            return
        (branch, shape), *rest = kind.branches.items()
        if shape == "many":
            if not count:
                raise self.error(element, f"<{element.tag}> needs a child")
            node.branches[branch] = children
        elif shape == "cases":
            names = cases.split(";") if cases else []
            others = count - len(names)
            if cases is None or others not in (0, len(rest)) or len(set(names)) != len(names):
                raise self.error(element, f'<{element.tag}> names the cases of its children: cases="a;b"')
            node.branches[branch] = dict(zip(names, children, strict=False))
            if others:
                node.branches[rest[0][0]] = children[-1]
        else:
            if count != 1:
                raise self.error(element, f"<{element.tag}> has one child, not {count}")
            node.branches[branch] = children[0]

    def _model(self, model: Element, trees: dict[str, Definition]) -> None:
        """Check the palette and take over the ports it gives to sub-trees."""
        self.attributes(model, (), ())
        self.no_text(model)
        for part in model.children:
            if part.tag not in (*NODE_TAGS, "SubTree"):
                raise self.error(part, f"<TreeNodesModel> has no <{part.tag}>")
            self.attributes(part, ("ID", "editable"), ("ID",))
            self.no_text(part)
            for port in part.children:
                if port.tag == "MetadataFields":
                    continue
                if port.tag not in ("input_port", "output_port", "inout_port"):
                    raise self.error(port, f"a model has ports, no <{port.tag}>")
                self.attributes(port, ("name", "type", "default", "description"), ("name",))
                if port.children:
                    raise self.error(port, f"<{port.tag}> has no children")
                if part.tag == "SubTree" and part.attributes["ID"] in trees:
                    definition = trees[part.attributes["ID"]]
                    name = self.word(port, "name")
                    if name in definition.parameters:
                        raise self.error(port, f"the port {name!r} is there twice")
                    definition.parameters[name] = self._port(port, name)

    def _port(self, port: Element, name: str) -> Parameter:
        text = port.attributes.get("default")
        try:
            hint = hint_of(port.attributes.get("type", ""), self.vocabulary.words)
        except ValueError:
            # A C++ type; what it means shows where the port is used.
            hint = Any
        parameter = Parameter(name, hint)
        if text is None:
            return parameter
        if is_pointer(text):
            return Parameter(name, hint, self._pointer(port, name, text))
        if hint is Any:
            return Parameter(name, hint, Text(text))
        try:
            return Parameter(name, hint, self.vocabulary.from_text(parameter, text))
        except ParameterError as error:
            raise self.error(port, f"default of {name}: {error}") from error

    def _pointer(self, element: Element, attribute: str, text: str) -> Name:
        name = attribute if text == "{=}" else text[1:-1].strip()
        if not _POINTER.fullmatch(name):
            raise self.error(element, f"{attribute}: {text} is not the name of an entry")
        return Name(name)


_BOOLEAN_WORDS = {"true": True, "false": False, "1": True, "0": False}
_POINTER = re.compile(r"@?[^\W\d]\w*")
