"""Plain data, with lines, out of YAML that anybody may have written.

Only what JSON has comes out: null, booleans, numbers, strings, lists and
mappings with string keys. Everything that makes YAML dangerous or surprising
(tags, aliases, dates, 010 for 8, 1:30 for 90, keys given twice, bottomless nesting) is an error.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any

import yaml

MAX_BYTES = 128 * 1024
"""Largest text that is read."""

MAX_DEPTH = 100
"""Deepest nesting that is followed; a level of a tree takes three."""


class YamlError(ValueError):
    """What is wrong with a text.

    Attributes:
        line: where, counted from 1; None when unknown.
    """

    def __init__(self, line: int | None, problem: str) -> None:
        super().__init__(problem)
        self.line = line


@dataclass(slots=True)
class Marked:
    """A value and where it stands.

    Attributes:
        value: None, a bool, number or string, or a list or a dict of Marked.
        line: where it begins, counted from 1.
    """

    value: Any
    line: int


def read_marked(content: bytes | str) -> Marked:
    """The data of one YAML document.

    Raises:
        YamlError: it is not plain YAML.
    """
    if len(content) > MAX_BYTES:
        raise YamlError(None, f"is larger than {MAX_BYTES // 1024} KiB")
    try:
        loader = _PlainLoader(content)
        root = loader.get_single_node()
        return Marked(None, 1) if root is None else loader.marked(root)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = None if mark is None else mark.line + 1
        raise YamlError(line, str(error.problem or error.context)) from error
    except (yaml.YAMLError, UnicodeError) as error:
        # The reader's errors (bytes that are no text) carry a position instead of a line.
        raise YamlError(None, f"is not text: {str(error).splitlines()[0]}") from error
    except RecursionError as error:
        raise YamlError(None, f"is nested deeper than {MAX_DEPTH} levels") from error


def write_plain(data: Any) -> str:
    """YAML that :func:`read_marked` reads as this data; the innermost lists and mappings on one line."""
    return yaml.dump(
        data,
        Dumper=_PlainDumper,
        default_flow_style=None,
        sort_keys=False,
        # PyYAML takes the rare line ends for spaces unless it escapes everything.
        allow_unicode=not _RARE_LINE_ENDS.search(json.dumps(data, ensure_ascii=False)),
        width=110,
    )


class _PlainLoader(yaml.SafeLoader):
    """A safe loader that also refuses what the module's docstring lists."""

    depth = 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        event = self.peek_event()  # type: ignore[no-untyped-call]
        if isinstance(event, yaml.AliasEvent):
            raise _problem("aliases (*name) are not allowed", event.start_mark)
        if self.depth >= MAX_DEPTH:
            raise _problem(f"nested deeper than {MAX_DEPTH} levels", event.start_mark)
        self.depth += 1
        try:
            return super().compose_node(parent, index)
        finally:
            self.depth -= 1

    def marked(self, node: yaml.Node) -> Marked:
        """A composed node as data."""
        line = node.start_mark.line + 1
        if node.tag not in _PLAIN_TAGS:
            raise _problem(f"the tag {node.tag} is not allowed", node.start_mark)
        if isinstance(node, yaml.MappingNode):
            return Marked(self._mapping(node), line)
        if isinstance(node, yaml.SequenceNode):
            return Marked([self.marked(part) for part in node.value], line)
        try:
            value = self.construct_object(node)
            if _AMBIGUOUS.match(node.value) and isinstance(value, int | float):
                raise _problem(f"write {value}, not {node.value!r:.40}, as a number", node.start_mark)
            if isinstance(value, int):
                # In base 16 a number can have more digits than can be said, or written as JSON.
                str(value)
            return Marked(value, line)
        except (ValueError, OverflowError, IndexError, KeyError) as error:
            raise _problem(
                f"{node.value!r:.40} is no {node.tag.rpartition(':')[2]}", node.start_mark
            ) from error

    def _mapping(self, node: yaml.MappingNode) -> dict[str, Marked]:
        found: dict[str, Marked] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode) or key.tag != "tag:yaml.org,2002:str":
                raise _problem(f"the key {getattr(key, 'value', '')!r:.40} is not a name", key.start_mark)
            if key.value in found:
                raise _problem(f"the key {key.value!r:.40} is given twice", key.start_mark)
            found[key.value] = self.marked(value)
        return found


class _PlainDumper(yaml.SafeDumper):
    """Indents the lists within mappings."""

    def increase_indent(self, flow: bool = False, indentless: bool = False) -> None:  # noqa: ARG002
        super().increase_indent(flow, False)


def _problem(problem: str, mark: Any) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


_AMBIGUOUS = re.compile(r"[-+]?0[0-7_]+$|.*:")
"""Numbers of YAML 1.1 that nobody means: 010 is 8 and 1:30 is 90; in YAML 1.2 they are 10 and a text."""

_RARE_LINE_ENDS = re.compile("[\x85\u2028\u2029]")

_PLAIN_TAGS = frozenset(
    f"tag:yaml.org,2002:{kind}" for kind in ("null", "bool", "int", "float", "str", "seq", "map")
)

_UNPLAIN = ("tag:yaml.org,2002:timestamp", "tag:yaml.org,2002:merge", "tag:yaml.org,2002:value")
_PlainLoader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag not in _UNPLAIN]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
# YAML 1.1 takes 1e-3 for a string; everybody who writes it means the number.
_PlainLoader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$"), list("-+0123456789")
)
_PlainDumper.yaml_implicit_resolvers = _PlainLoader.yaml_implicit_resolvers
