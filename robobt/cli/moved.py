"""What old spellings of commands and options have become."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from difflib import get_close_matches

COMMANDS = {
    "bench": "python -m benchmarks",
    "collect shots": "robobt shots collect",
    "collect": "robobt shots collect",
    "demonstrations": "robobt record demonstrations",
    "identify": "robobt record identify",
    "live": "robobt match --live",
    "models": "robobt list models",
    "paper": "python -m paper",
    "plays": "robobt list plays",
    "policies": "robobt list policies",
    "raters": "robobt list raters",
    "rate": "robobt evaluate --round-robin",
    "replay": "robobt show",
    "results": "robobt tournament results",
    "scenarios": "robobt list scenarios",
    "shots goalkeepers": "python -m paper goalkeepers",
    "skills": "robobt list skills",
    "sweep": "robobt tournament sweep",
    "tree": "robobt show",
}
"""Old commands, and what does their work now."""

OPTIONS = {
    "evaluate": {"-n": "--starts"},
    "log": {"--referee": "--referee-address"},
    "match": {"--replay": "--record", "--speed": "--speed-factor"},
    "record demonstrations": {"-n": "--episodes"},
    "record export": {"--btlog": "--out FILE.btlog", "--mcap": "--out FILE.mcap"},
    "serve": {"--preset": "--simulator", "--speed": "--speed-factor", "--publish": "--referee-address"},
    "shots collect": {"-n": "--count", "--scenario": "--attack"},
    "shots map": {"--picture": "--out"},
    "shots train": {"--model": "--predictor"},
    "show": {
        "-p": "NAME:PARAMETER=VALUE",
        "--param": "NAME:PARAMETER=VALUE",
        **{
            f"--{ending}": f"--out FILE.{ending}"
            for ending in ("svg", "dot", "yaml", "xml", "html", "gif", "png")
        },
    },
    "tournament run": {"-n": "--rounds", "--record": "--recordings", "--speed": "--speed-factor"},
    "tournament sweep": {"-n": "--rounds", "--at-once": "--concurrent"},
    "train": {"-n": "--seeds", "-p": "--preset"},
}
"""Old options of commands, and what stands for them now."""

_SHOWN = ("models", "plays", "policies", "raters", "scenarios", "skills")
"""Old commands that listed things, or showed the one that was named."""

_TOURNAMENT = ("run", "results", "sweep")


def what_became(words: Sequence[str]) -> str | None:
    """Return what to type instead of a command line in an old spelling, None for one of today's.

    Args:
        words: the command line after the program's name.
    """
    words = [word for word in words if word != "--debug"]
    if words and words[0].startswith("--engine"):
        words = words[1 if "=" in words[0] else 2 :]
    first = words[0] if words else ""
    for old, now in COMMANDS.items():
        parts = old.split()
        if list(words[: len(parts)]) == parts:
            rest = words[len(parts) :]
            now = "robobt show" if first in _SHOWN and _names_something(rest) else now
            clone = "" if now.startswith("robobt") else ", in a clone of the repository"
            return f"'robobt {old}' is '{now}' now{clone}{_whole(now, rest)}"
    if first == "tournament" and len(words) > 1 and not _is_inner(words[1]):
        rest = words[1:]
        if rest[0].endswith((".sqlite", ".db")):
            return f"robobt tournament results {shlex.join(rest)} sums up what a store holds"
        return f"'robobt tournament' is 'robobt tournament run' now{_whole('robobt tournament run', rest)}"
    if first == "serve" and "--referee" in words and not {"own", "none"} & {*words}:
        return "robobt serve --referee takes own or none"
    for command in (" ".join(words[:2]), first):
        for word in words:
            if (became := _option(command, word)) is not None:
                return f"'robobt {command} {word.partition('=')[0]}' is '{became}' now"
    return None


def _option(command: str, word: str) -> str | None:
    """Return what an option of a command is now, None for a word that is no old option."""
    options = OPTIONS.get(command, {})
    letter = word[:2] if word[:1] == "-" and word[1:2] != "-" else ""
    return options.get(word.partition("=")[0], options.get(letter))


def _whole(now: str, rest: Sequence[str]) -> str:
    """Return the whole line to type, after a colon; nothing where old options do not become single ones."""
    command = " ".join([word for word in now.split()[1:] if not word.startswith("-")])
    renewed = [_option(command, word) or word for word in rest]
    if any(" " in new and new != old for old, new in zip(rest, renewed, strict=True)):
        return ""
    return f": {f'{now} {shlex.join(renewed)}'.rstrip()}"


def _names_something(rest: Sequence[str]) -> bool:
    """Return whether a word is neither an option nor the value of one."""
    values = {place + 1 for place, word in enumerate(rest) if word in ("--import", "--path")}
    return any(not word.startswith("-") and place not in values for place, word in enumerate(rest))


def _is_inner(word: str) -> bool:
    """Return whether a word is, or is meant to be, a command of the group or a question for help."""
    return word in ("-h", "--help") or bool(get_close_matches(word, _TOURNAMENT, 1, 0.75))
