"""The presets of training settings as plain data: files that may extend each other."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robobt.config.errors import ConfigError, unknown_name
from robobt.config.yaml import read_yaml

_PRESETS = Path(__file__).parent / "presets"


class SettingsError(ConfigError):
    """Settings that cannot be used."""


def presets(task: str) -> list[str]:
    """Return the names of the presets that ship for a task."""
    return sorted({path.stem for folder in _folders(task) for path in folder.glob("*.yaml")})


def _folders(task: str) -> tuple[Path, ...]:
    return (_PRESETS / task, _PRESETS / "several_robots")


def read_preset(task: str, preset: str, seen: tuple[str, ...] = ()) -> tuple[dict[str, Any], str]:
    """Return the data of a preset or a YAML file, with what it extends, and the file's path.

    ``seen`` are the presets that extend it.

    Raises:
        SettingsError: there is none, it cannot be read, or it extends itself.
    """
    shipped = [folder / f"{preset}.yaml" for folder in _folders(task)]
    bundled = next((path for path in shipped if path.is_file()), None)
    path = bundled or Path(preset)
    if bundled is None and path.suffix not in (".yaml", ".yml"):
        known = presets(task)
        raise SettingsError("", f"no preset of {task} is called {preset!r}; {unknown_name(preset, known)}")
    data = read_yaml(path, SettingsError)
    base = data.pop("extends", None)
    if base is None:
        return data, str(path)
    if not isinstance(base, str) or base in seen:
        raise SettingsError(str(path), "must name another preset", "extends")
    return merged(read_preset(task, base, (*seen, preset, base))[0], data), str(path)


def merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return ``base`` with ``changes``, group by group."""
    result = dict(base)
    for key, value in changes.items():
        old = result.get(key)
        result[key] = merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return result


def assign(data: dict[str, Any], path: list[str], value: object, name: str) -> None:
    """Set one value in nested data.

    Raises:
        SettingsError: a part of ``path`` is not a group; the message names the field ``name``.
    """
    *groups, last = path
    for group in groups:
        inner = data.get(group, {})
        if not isinstance(inner, dict):
            raise SettingsError("", f"{group} holds a value, not settings", name)
        data[group] = inner = dict(inner)
        data = inner
    data[last] = value
