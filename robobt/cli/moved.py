"""What old spellings of commands and options have become."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

COMMANDS = {
    "bench": "python -m benchmarks",
    "collect shots": "robobt shots collect",
    "collect": "robobt shots collect",
    "demonstrations": "robobt record demonstrations",
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
    if words[:1] == ["--engine"]:
        words = words[2:]
    first = words[0] if words else ""
    for old, now in COMMANDS.items():
        parts = old.split()
        if list(words[: len(parts)]) == parts:
            named = len(words) > 1 and not words[1].startswith("-")
            now = "robobt show" if first in _SHOWN and named else now
            clone = "" if now.startswith("robobt") else ", in a clone of the repository"
            rest = shlex.join(words[len(parts) :])
            return f"'robobt {old}' is '{now}' now{clone}: {f'{now} {rest}'.rstrip()}"
    if first == "tournament" and len(words) > 1 and words[1] not in (*_TOURNAMENT, "--help"):
        rest = shlex.join(words[1:])
        if words[1].endswith((".sqlite", ".db")):
            return f"robobt tournament results {rest} sums up what a store holds"
        return f"'robobt tournament' is 'robobt tournament run' now: robobt tournament run {rest}"
    if first == "serve" and "--referee" in words and not {"own", "none"} & {*words}:
        return "robobt serve --referee takes own or none"
    for command in (" ".join(words[:2]), first):
        for word in words:
            option = word.partition("=")[0]
            if option in OPTIONS.get(command, {}):
                return f"'robobt {command} {option}' is '{OPTIONS[command][option]}' now"
    return None
