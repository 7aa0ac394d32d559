"""YAML 1.2 from anybody: what comes out, where it stands, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.config.errors import ConfigError
from robobt.config.yaml import MAX_YAML_BYTES, MAX_YAML_DEPTH, parse_marked, read_yaml, write_yaml

plain = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(min_size=1), inner, max_size=4),
    max_leaves=12,
)


def read(text: str | bytes) -> object:
    return parse_marked(text, "file").plain()


@pytest.mark.integration
@given(plain)
@settings(max_examples=60)
def test_plain_data_written_and_read_is_the_same_and_of_the_same_types(data: object) -> None:
    assert repr(read(write_yaml(data))) == repr(data)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("", None),
        ("~", None),
        ("a:", {"a": None}),
        ("true", True),
        ("yes", "yes"),
        ("off", "off"),
        ("010", 10),
        ("0o17", 15),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("2001-12-14", "2001-12-14"),
        ("1e-3", 0.001),
        (".5", 0.5),
        ("-.inf", float("-inf")),
        ("'1'", "1"),
        ("{<<: a, =: b}", {"<<": "a", "=": "b"}),
        ("|\n  a\n  b\n", "a\nb\n"),
        ("%YAML 1.2\n---\na", "a"),
    ],
)
def test_scalars_follow_the_core_schema_of_yaml_1_2(text: str, value: object) -> None:
    assert repr(read(text)) == repr(value)


@pytest.mark.parametrize(
    "text", ["010", "1e5", ".5e3", "null", "yes", "", ":0", "?a", "- a", "a: b", "\x85", "a\u2028b"]
)
def test_a_string_that_looks_like_something_else_stays_a_string(text: str) -> None:
    assert read(write_yaml({"key": [text]})) == {"key": [text]}


def test_every_value_knows_its_line_and_column() -> None:
    root = parse_marked("name: wall\nparts:\n  - {size: 2}\n  - 3\n", "file")
    parts = root.value["parts"]
    size = parts.value[0].value["size"]
    assert [(part.line, part.column) for part in (root, parts, size, parts.value[1])] == [
        (1, 1),
        (3, 3),
        (3, 12),
        (4, 5),
    ]


@pytest.mark.integration
@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("a: &x 1", "file:1: anchors"),
        ("a: 1\nb: *x", "file:2: aliases"),
        ("a: !!python/object:os.system x", "file:1: the tag .* is not allowed"),
        ("a: !mine x", "file:1: the tag !mine is not allowed"),
        ("a: 1\nb: 2\na: 3", "file:3: the key 'a' is given twice"),
        ("1: a", "file:1: the key '1' is not a name"),
        ("a\n---\nb", "file:2: a second document"),
        ("%YAML 1.1\n---\nyes", "file:2: is YAML 1.1; write YAML 1.2"),
        ("9" * 5000, "file:1: .* too many digits"),
        ("[" * (MAX_YAML_DEPTH + 1), f"file:1: nested deeper than {MAX_YAML_DEPTH} levels"),
        ("[" * 20_000, f"file:1: nested deeper than {MAX_YAML_DEPTH} levels"),
        ("a: [1", "file:1: "),
        (b"a: \xff", "file: is not text: "),
        ("a: \x00", "file: is not text: "),
        (" " * (MAX_YAML_BYTES + 1), "file: is larger than 128 KiB"),
    ],
)
def test_whatever_is_not_plain_is_one_line_with_file_and_line(text: str | bytes, problem: str) -> None:
    with pytest.raises(ConfigError, match=problem) as caught:
        read(text)
    assert "\n" not in str(caught.value)


def test_a_file_holds_a_mapping_of_fields(tmp_path: Path) -> None:
    path = tmp_path / "file.yaml"
    path.write_text("a: 1")
    assert read_yaml(path) == {"a": 1}
    path.write_text("[a]")
    with pytest.raises(ConfigError, match=r"file.yaml: must hold a mapping of fields"):
        read_yaml(path)
    with pytest.raises(ConfigError, match=r"none.yaml: cannot be read: No such file"):
        read_yaml(tmp_path / "none.yaml")
