"""Plain data, with its positions, from YAML 1.2 of unknown origin.

Only what JSON has comes out: null, booleans, numbers, strings, lists and mappings with string
keys, by the core schema of YAML 1.2 (``yes``, ``1:30`` and dates are strings, ``010`` is ten).
Tags, anchors, aliases, duplicate keys, other versions, bottomless nesting and large files are errors.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from io import StringIO
from math import inf, nan
from pathlib import Path
from typing import Any, TypeAlias, TypeVar, cast

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    CollectionStartEvent,
    DocumentStartEvent,
    Event,
    NodeEvent,
    ScalarEvent,
    SequenceStartEvent,
    StreamEndEvent,
)
from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.representer import SafeRepresenter

from robobt.config.errors import ConfigError

MAX_YAML_BYTES = 128 * 1024
"""Largest text that is read; the shipped scenarios have some 3 kB."""

MAX_YAML_DEPTH = 100
"""Deepest nesting that is read; a level of a tree takes three."""

Scalar: TypeAlias = bool | int | float | str | None
Plain: TypeAlias = "Scalar | list[Plain] | dict[str, Plain]"
Text = TypeVar("Text", bytes, str, bytes | str)


@dataclass(slots=True)
class Marked:
    """A value, with the line and column where it begins, counted from 1."""

    value: Scalar | list[Marked] | dict[str, Marked]
    line: int
    column: int

    def plain(self) -> Plain:
        """Return the data without positions."""
        if isinstance(self.value, dict):
            return {key: part.plain() for key, part in self.value.items()}
        return [part.plain() for part in self.value] if isinstance(self.value, list) else self.value


def read_yaml(path: Path, error: type[ConfigError] = ConfigError) -> dict[str, Any]:
    """Return the plain data of a file that holds one mapping of fields.

    Raises:
        ConfigError: the file cannot be read, is not plain YAML or not a mapping; it names the line.
    """
    content = read_limited(path, MAX_YAML_BYTES, error)
    data = _parsed(_kept_document, content, str(path), error).plain()
    if not isinstance(data, dict):
        raise error(str(path), "must hold a mapping of fields")
    return data


def read_limited(path: Path, limit: int, error: type[ConfigError] = ConfigError) -> bytes:
    """Return the content of a file of at most ``limit`` bytes."""
    try:
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except (OSError, ValueError) as cause:
        reason = cause.strerror if isinstance(cause, OSError) else None
        raise error(str(path), f"cannot be read: {reason or cause}") from cause
    if len(content) > limit:
        raise error(str(path), f"is larger than {limit // 1024} KiB")
    return content


def parse_marked(content: bytes | str, file: str, error: type[ConfigError] = ConfigError) -> Marked:
    """Return the data of one YAML document with its positions."""
    if len(content) > MAX_YAML_BYTES:
        raise error(file, f"is larger than {MAX_YAML_BYTES // 1024} KiB")
    return _parsed(_document, content, file, error)


def _parsed(document: Callable[[Text], Marked], content: Text, file: str, error: type[ConfigError]) -> Marked:
    try:
        return document(content)
    except MarkedYAMLError as cause:
        mark = cause.problem_mark or cause.context_mark
        line = None if mark is None else mark.line + 1
        raise error(file, str(cause.problem or cause.context), line=line) from cause
    except (YAMLError, ValueError, OverflowError) as cause:
        # Bytes that are not text, and escapes of characters that do not exist, carry no line.
        raise error(file, f"is not text: {str(cause).splitlines()[0]}") from cause


def write_yaml(data: object) -> str:
    """Return plain data as YAML that :func:`parse_marked` reads back; innermost collections on one line."""
    writer = YAML(typ="safe", pure=True)
    writer.Representer = _PlainRepresenter
    writer.default_flow_style = None
    writer.sort_base_mapping_type_on_output = False  # type: ignore[assignment]
    writer.width = MAX_YAML_BYTES  # ruamel.yaml loses spaces where it wraps plain text
    writer.indent(mapping=2, sequence=4, offset=2)
    text = StringIO()
    writer.dump(data, text)
    return text.getvalue().removesuffix("...\n")


@lru_cache(maxsize=32)
def _kept_document(content: bytes) -> Marked:
    """Return a file's document, parsed once: scenarios are read for each match."""
    return _document(content)


def _document(content: bytes | str) -> Marked:
    events: Iterator[Event] = YAML(typ="safe", pure=True).parse(content)
    next(events)
    start = next(events)
    if isinstance(start, StreamEndEvent):
        return Marked(None, 1, 1)
    assert isinstance(start, DocumentStartEvent)
    if start.version not in (None, (1, 2)):
        raise _problem(f"is YAML {'.'.join(map(str, start.version))}; write YAML 1.2", start)
    root = _node(events, next(events), 0)
    next(events)
    after = next(events)
    if not isinstance(after, StreamEndEvent):
        raise _problem("a second document begins here; only one is allowed", after)
    return root


def _node(events: Iterator[Event], event: Event, depth: int) -> Marked:
    if isinstance(event, AliasEvent):
        raise _problem("aliases (*name) are not allowed", event)
    assert isinstance(event, ScalarEvent | CollectionStartEvent)
    if event.anchor is not None:
        raise _problem("anchors (&name) are not allowed", event)
    if event.tag is not None:
        raise _problem(f"the tag {event.tag} is not allowed", event)
    if depth >= MAX_YAML_DEPTH:
        raise _problem(f"nested deeper than {MAX_YAML_DEPTH} levels", event)
    line, column = event.start_mark.line + 1, event.start_mark.column + 1
    if isinstance(event, ScalarEvent):
        return Marked(_scalar(event), line, column)
    if isinstance(event, SequenceStartEvent):
        return Marked([_node(events, part, depth + 1) for part in _parts(events)], line, column)
    found: dict[str, Marked] = {}
    for part in _parts(events):
        key = _scalar(part) if isinstance(part, ScalarEvent) and part.tag is part.anchor is None else None
        if not isinstance(key, str):
            raise _problem(f"the key {getattr(part, 'value', '')!r:.40} is not a name", part)
        if key in found:
            raise _problem(f"the key {key!r:.40} is given twice", part)
        found[key] = _node(events, next(events), depth + 1)
    return Marked(found, line, column)


def _parts(events: Iterator[Event]) -> Iterator[Event]:
    """Yield events up to the end of a collection; the caller consumes what belongs to each."""
    for event in events:
        if not isinstance(event, NodeEvent):
            return
        yield event


def _scalar(event: ScalarEvent) -> Scalar:
    try:
        return resolve(event.value) if event.implicit[0] else cast(str, event.value)
    except ValueError as error:
        raise _problem(f"{event.value!r:.40} has too many digits", event) from error


def resolve(text: str) -> Scalar:
    """Return the value of an unquoted scalar by YAML 1.2's core schema.

    Raises:
        ValueError: an integer has more digits than Python reads or writes.
    """
    if text in _YAML_WORDS:
        return _YAML_WORDS[text]
    if _INTEGER.fullmatch(text):
        value = int(text, 0 if text[:2] in ("0o", "0x") else 10)
        str(value)
        return value
    return float(text) if _FLOAT_PATTERN.fullmatch(text) else text


class _PlainRepresenter(SafeRepresenter):
    """Writes repeated objects each time, and quotes strings that would be read as something else."""

    def ignore_aliases(self, data: object) -> bool:  # noqa: ARG002
        return True

    def represent_str(self, data: str) -> ScalarNode:
        # ruamel.yaml leaves some texts that begin with punctuation bare and then cannot read them.
        ambiguous = not _BARE.match(data) or _INTEGER.fullmatch(data) or not isinstance(resolve(data), str)
        # The emitter takes rare line ends for spaces unless they are escaped.
        style = '"' if _RARE_LINE_ENDS.search(data) else "'" if ambiguous else None
        return self.represent_scalar("tag:yaml.org,2002:str", data, style=style)


_PlainRepresenter.add_representer(str, _PlainRepresenter.represent_str)


def _problem(problem: str, event: Event) -> MarkedYAMLError:
    return MarkedYAMLError(problem=problem, problem_mark=event.start_mark)


_INTEGER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT_PATTERN = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_YAML_WORDS: dict[str, bool | float | None] = {
    "": None,
    **{
        word: value
        for words, value in (
            ("~ null Null NULL", None),
            ("true True TRUE", True),
            ("false False FALSE", False),
            (".inf .Inf .INF +.inf +.Inf +.INF", inf),
            ("-.inf -.Inf -.INF", -inf),
            (".nan .NaN .NAN", nan),
        )
        for word in words.split()
    },
}
_BARE = re.compile(r"[\w$/(]")
_RARE_LINE_ENDS = re.compile("[\x85\u2028\u2029]")
