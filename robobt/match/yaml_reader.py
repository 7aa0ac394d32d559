"""Plain data out of a YAML file that anybody may have written.

Only what JSON has comes out: null, booleans, numbers, strings, lists and
mappings with string keys. Everything that makes YAML dangerous or surprising
(tags, aliases, dates, keys given twice, bottomless nesting) is an error that
names the line.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

MAX_BYTES = 64 * 1024
"""Largest file that is read; the shipped scenarios have some 3 kB."""

MAX_DEPTH = 20
"""Deepest nesting that is followed."""


class YamlError(ValueError):
    """What is wrong with the file, in one line."""


def read_yaml(path: Path) -> Any:
    """The data of the one document in the file.

    Raises:
        YamlError: the file cannot be read or is not plain YAML.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise YamlError(f"cannot be read: {error.strerror or error}") from error
    if len(content) > MAX_BYTES:
        raise YamlError(f"is larger than {MAX_BYTES // 1024} KiB")
    return parse_yaml(content)


def parse_yaml(content: bytes | str) -> Any:
    """The data of one YAML document.

    Raises:
        YamlError: it is not plain YAML; the message names the line.
    """
    try:
        loader = _PlainLoader(content)
        return loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}: " if mark is not None else ""
        raise YamlError(f"{where}{error.problem or error.context}") from error
    except yaml.YAMLError as error:
        # The reader's errors (bytes that are no text) carry a position instead of a line.
        raise YamlError(f"is not text: {str(error).splitlines()[0]}") from error
    except RecursionError as error:
        raise YamlError(f"is nested deeper than {MAX_DEPTH} levels") from error


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

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        if node.tag not in _PLAIN_TAGS:
            raise _problem(f"the tag {node.tag} is not allowed", node.start_mark)
        if isinstance(node, yaml.MappingNode):
            _check_keys(node)
        try:
            return super().construct_object(node, deep)
        except (ValueError, OverflowError) as error:
            if isinstance(error, yaml.YAMLError):
                raise
            raise _problem(str(error), node.start_mark) from error


def _problem(problem: str, mark: Any) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=mark)


def _check_keys(node: yaml.MappingNode) -> None:
    seen: set[str] = set()
    for key, _ in node.value:
        if key.tag != "tag:yaml.org,2002:str":
            raise _problem(f"the key {getattr(key, 'value', '')!r:.40} is not a name", key.start_mark)
        if key.value in seen:
            raise _problem(f"the key {key.value!r:.40} is given twice", key.start_mark)
        seen.add(key.value)


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
