"""Plain data out of a YAML file that anybody may have written; what is plain, the tree files say."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robobt.tree.interop import plain_yaml

MAX_BYTES = 64 * 1024
"""Largest file that is read; the shipped scenarios have some 3 kB."""


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
        return _unmarked(plain_yaml.read_marked(content))
    except plain_yaml.YamlError as error:
        where = "" if error.line is None else f"line {error.line}: "
        raise YamlError(f"{where}{error}") from error


def _unmarked(marked: plain_yaml.Marked) -> Any:
    value = marked.value
    if isinstance(value, dict):
        return {key: _unmarked(part) for key, part in value.items()}
    return [_unmarked(part) for part in value] if isinstance(value, list) else value
