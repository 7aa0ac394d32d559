"""Every option of every command, with its one meaning.

A command declares an option with :func:`option`, which puts the meaning first and lets the command add what
is its own. Whoever knows an option from one command knows it in all of them.
"""

from __future__ import annotations

from typing import Any

import typer

MEANINGS = {
    "--against": "The entrant that all others meet",
    "--alpha": "How often --sprt may call ELO0 better",
    "--attack": "How the attacker starts: in motion, still, or both in turn",
    "--base": "The preset that has everything else",
    "--beta": "How often --sprt may call ELO1 not better",
    "--at": "Moment of the match [s]",
    "--blue": "Play of the blue robots except the goalkeeper; ':NAME=VALUE' alone keeps the play",
    "--blue-port": "Port for the control of blue robots",
    "--blue-status-port": "Port for grSim's status of blue robots",
    "--by": "Who plays: skill (written by hand) or script (the simplest solution)",
    "--cameras": "How many cameras share the field",
    "--candidates": "How many sets of parameters to try",
    "--check": "Play each row again and compare the hashes",
    "--clock": "What timestamps count from: sim is the start, as in grSim; unix is 1970, as in real cameras",
    "--compare": "Compare two entrants: their own matches, and those against opponents that both met",
    "--concurrent": "How many candidates play at a time",
    "--confirm-rounds": "Rounds of the final test at most; 0 leaves it out",
    "--control-port": "Port for teleports and configuration",
    "--count": "How many shots to collect",
    "--data": "File or folder of recorded shots",
    "--debug": "Show the traceback of an error",
    "--engine": "Where worker processes run: local (this machine), ray, or ray://HOST:PORT",
    "--entrant": "Only matches of this entrant; given twice or more, only matches among these",
    "--episodes": "How many episodes to record",
    "--epochs": "How many epochs to train",
    "--every": "Time from one moment to the next [s]",
    "--field": "The field: division_a or division_b",
    "--force": "Replace what is there already",
    "--from": "Where to begin in the recording [s]",
    "--game-controller": "The official game controller's program",
    "--goalkeeper": "Kind of goalkeeper that the shots met; else each answer rests on the outcomes before it",
    "--goalkeepers": "Whom the attacker faces",
    "--grsim-port": "Port for grSim's commands and replacements",
    "--host": "Address to serve the page at",
    "--html": "Write a report, one page, to this file",
    "--identify": "Identify the field from the recorded match, and write it to this preset file",
    "--import": "A Python file of yours that registers plays, skills, raters or tasks; may be repeated",
    "--in-step": "Advance time only when clients ask for it",
    "--interface": "This machine's address on the network to use",
    "--json": "Print one JSON object instead of tables",
    "--kind": "What NAME is, where several things have that name",
    "--leave": "Robots follow the log until the ball is this far from its logged place [m]",
    "--lint": "Look for likely mistakes in the tree",
    "--live": "Show it in the browser",
    "--log": "Write everything that is sent to this league log",
    "--lost-by": "Only matches that this entrant lost",
    "--matches": "List the matches",
    "--merge": "Add the matches of another store of the same tournament; may be repeated",
    "--model": "A shipped model or a model file",
    "--moments": "How many moments to list",
    "--name": "Name of the model",
    "--on-error": "What an exception in a tree does",
    "--onnx": "Write an ONNX file as well",
    "--open": "Whether to open the page; by default where there is a desktop",
    "--opponents": "Largest number of opponents",
    "--out": "Where to write",
    "--outcome": "Only matches that ended like this",
    "--part": "Which part of the paper's shots",
    "--past": "How many earlier policies of each run take part",
    "--path": "Another folder of models, or a model file; may be repeated",
    "--paused": "Wait until the page starts the match",
    "--play": "A play that takes part; may be repeated",
    "--port": "Port to serve the page at; 0 takes a free one",
    "--predictor": "Which predictor to train",
    "--preset": "Training settings to start from: a preset's name or a YAML file",
    "--protocol": "Which shots to collect",
    "--publish": "Send vision, tracked frames and referee messages to other programs on this machine",
    "--real": "Folder of the paper's shots: those to train on say how strong real goalkeepers are, "
    "those to test on give figures for the model card",
    "--realism": "Noise and delays: none, friendly, rc2021 or realistic",
    "--record": "Record a match to this file",
    "--record-layers": "Record what skills draw in these layers too",
    "--record-trial": "Which trial to record, from 0",
    "--recordings": "Which recordings to keep",
    "--referee": "Who referees",
    "--referee-address": "Multicast address of the referee's messages",
    "--regenerate": "Play the matches again, record them in this folder and compare the hashes",
    "--resume": "Continue a run that was stopped",
    "--robot": "Which robot's tree, as in 'blue 0'",
    "--robots": "How many robots each team has",
    "--round-robin": "Let all meet each other, and rate them",
    "--rounds": "How many rounds to play, each of two matches with swapped sides and the same seed",
    "--scenario": "Scenario for field, starts and rules: a bundled one's name or a file",
    "--scan": "Look for the moments at which another decision would have been worth most",
    "--script": "A scripted player that takes part; may be repeated",
    "--seconds": "Stop after this many seconds",
    "--seed": "Seed of all randomness",
    "--seeds": "How many seeds to train",
    "--set": "Change a setting; may be repeated",
    "--simulator": "Preset of the simulator",
    "--spacing": "Distance between places [m]",
    "--speed-factor": "Simulated time over real time",
    "--sprt": "Test whether the entrant is stronger: worse than ELO0, or better than ELO1",
    "--stages": "Which stages to play; full: two halves of five minutes of playing time",
    "--starts": "How many fresh starts to play",
    "--statistics": "Play a trial of this scenario and count what the nodes of this play do",
    "--substitute": "Let nodes follow a script; may be repeated",
    "--tick": "Which tick, from 0",
    "--team": "Whose decisions: blue or yellow",
    "--to": "Where to end in the recording [s]",
    "--tracker": "Multicast address of tracked frames",
    "--trials": "How many trials to play",
    "--version": "Print the version",
    "--tracking": "What recordings are written as: arrows, parquet or mcap",
    "--vary": "A parameter and the values to try; may be repeated",
    "--vision": "Multicast address of the vision",
    "--workers": "How many processes work; by default one a core",
    "--world": "Where to play: sim, a field such as league://grsim, or a league log",
    "--yellow": "Play of the yellow robots except the goalkeeper; ':NAME=VALUE' alone keeps the play",
    "--yellow-port": "Port for the control of yellow robots",
    "--yellow-status-port": "Port for grSim's status of yellow robots",
}
"""What each option means, in every command that has it."""

LETTERS = {"--out": "-o", "--seed": "-s", "--trials": "-n", "--workers": "-w"}
"""The options that have a letter too."""

_VALUES = {
    "--against": "ENTRANT",
    "--blue": "PLAY[:NAME=VALUE,...]",
    "--yellow": "PLAY[:NAME=VALUE,...]",
    "--play": "PLAY[:NAME=VALUE,...]",
    "--entrant": "ENTRANT",
    "--lost-by": "ENTRANT",
    "--compare": "ENTRANT ENTRANT",
    "--sprt": "ELO0 ELO1",
    "--set": "NAME=VALUE",
    "--vary": "NAME=VALUES",
    "--regenerate": "FOLDER",
    "--substitute": "ROBOT:PATH=STATUS",
    "--record-layers": "NAMES",
    "--statistics": "SCENARIO",
    "--scenario": "SCENARIO",
    "--world": "WORLD",
    **dict.fromkeys(("--data", "--path"), "PATH"),
    **dict.fromkeys(
        ("--identify", "--import", "--record", "--html", "--log", "--merge", "--game-controller"), "FILE"
    ),
    **dict.fromkeys(("--from", "--to", "--seconds"), "SECONDS"),
    **dict.fromkeys(("--vision", "--tracker", "--referee-address"), "HOST:PORT"),
}
"""What stands for an option's value in help, where the type does not say it better."""


def option(name: str, more: str = "", **given: Any) -> Any:
    """Declare an option of a command, for ``Annotated``.

    Args:
        name: of :data:`MEANINGS`, as in ``--seed``.
        more: what this command adds to the meaning, with the punctuation before it.
        given: further arguments of ``typer.Option``.

    Returns:
        What Typer takes as the option.
    """
    names = [f"{name}/--no-{name[2:]}"] if name == "--open" else [name]
    names += [LETTERS[name]] if name in LETTERS else []
    given.setdefault("metavar", _VALUES.get(name))
    return typer.Option(*names, help=f"{MEANINGS[name]}{more}.", **given)
