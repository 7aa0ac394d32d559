"""The command ``robobt``: thin over the rest, and where worlds, plays and matches are wired together.

Everything heavy is imported by the command that needs it, so that ``robobt --help`` is quick.
"""

from __future__ import annotations

import json
import logging
import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping
from functools import partial, wraps
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ParamSpec

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

if TYPE_CHECKING:
    from robobt.match import MatchResult, Run, Scenario, Summary
    from robobt.tree.parameters import Parameter

    _Entries = Mapping[str, tuple[str, list[Parameter], dict[str, list[str]]]]

_console = Console(highlight=False)
_errors = Console(stderr=True, highlight=False)

_RECORDING = ".robobt.jsonl.gz"
_PAGE = ".html"
_MAX_SEED = 2**53 - 1


_log = logging.getLogger("robobt")
P = ParamSpec("P")


def _one_line_errors(command: Callable[P, None]) -> Callable[P, None]:
    """Turns whatever goes wrong in a command into one line on stderr and exit code 1."""

    @wraps(command)
    def guarded(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            command(*args, **kwargs)
        except (typer.Exit, typer.Abort, typer.BadParameter, BrokenPipeError):
            raise
        except Exception as error:
            if _log.isEnabledFor(logging.DEBUG):
                raise
            _errors.print(f"[red]robobt:[/red] {escape(_say_error(error))}", soft_wrap=True)
            raise typer.Exit(1) from error

    return guarded


app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Behaviour trees for robot soccer: play scenarios, look at plays and skills, measure.",
)
bench = typer.Typer(no_args_is_help=True, help="Measure how fast things are, on one core.")
app.add_typer(bench, name="bench")

_Json = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of tables.")]


def _version(show: bool) -> None:
    if show:
        from robobt import __version__

        _console.print(f"robobt {__version__}")
        raise typer.Exit


@app.callback()
def _main(
    debug: Annotated[bool, typer.Option("--debug", hidden=True, help="Show tracebacks.")] = False,
    _shown: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    _log.setLevel(logging.DEBUG if debug else logging.ERROR)
    for stream in (sys.stdout, sys.stderr):
        # A terminal or file that lacks a sign is shown a question mark for it.
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")


@app.command()
@_one_line_errors
def match(
    scenario: Annotated[
        str, typer.Argument(help="A scenario file, or the name of a bundled one (see 'robobt scenarios').")
    ],
    trials: Annotated[
        int | None,
        typer.Option(
            "--trials", "-n", min=1, max=100_000, help="How often; by default what the scenario says."
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers", "-w", min=1, max=256, help="Processes; by default one a core, for 4 trials each."
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed",
            "-s",
            min=0,
            max=_MAX_SEED,
            help="What all randomness follows from; by default the scenario's.",
        ),
    ] = None,
    replay: Annotated[
        Path | None,
        typer.Option(
            "--replay",
            help="Record a trial to this file: a page for the browser (.html) or a recording for "
            f"'robobt replay' ({_RECORDING}).",
        ),
    ] = None,
    record: Annotated[
        int | None,
        typer.Option(
            "--record",
            min=0,
            help=f"Which trial to record, from 0; without --replay to SCENARIO-N{_RECORDING}.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            help="Append each trial's result to this file (JSON lines) as it finishes; "
            "a run that was stopped goes on from there.",
        ),
    ] = None,
    as_json: _Json = False,
) -> None:
    """Play a scenario, once or many times, and print what came out.

    Ctrl-C stops the run; the trials that are finished are kept and printed.

    Keys of --json: scenario, seed, trials (played), requested, interrupted;
    outcomes: for each outcome count, rate, low and high (95 % Wilson interval);
    goals: for blue and yellow total, and trials: in how many it scored (count, rate, low, high);
    time: seconds a trial; in_play: share of the time with the ball in play;
    robots: for each robot go_to_ball, shoot and total (seconds) and kicks, each
    with n, mean and variance, errors (ticks its tree failed) and first_error;
    real_time_factor: simulated over computing time, a core; trace: a hash that
    is equal for equal runs; replay: the file written, or null.
    """
    from robobt.match import load_scenario, run_trials, summarise
    from robobt.worlds import sim_world

    loaded = load_scenario(scenario)
    # The simulator's settings are checked before any worker is started.
    sim_world(loaded)
    count = loaded.trials if trials is None else trials
    recorded = 0 if record is None else record
    if recorded >= count:
        there = f"there is no trial {recorded}; they are 0 to {count - 1}"
        raise typer.BadParameter(there, param_hint="--record")
    if replay is None and record is not None:
        # The name is anybody's words: it may not lead to another folder.
        name = re.sub(r"[^\w.-]+", "_", loaded.name)
        replay = Path(f"{name}-{record}{_RECORDING}")
    if replay is not None:
        _check_replay(replay, out)
        # Now, not when an hour of trials has been played.
        replay.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        page = replay is not None and replay.suffix.lower() == _PAGE
        recording = Path(folder) / f"trial{_RECORDING}" if page else replay
        with _Progress(loaded.name, count) as progress:
            run = run_trials(
                loaded,
                sim_world,
                count,
                min(_cores(), -(-count // 4)) if workers is None else workers,
                seed,
                out,
                {} if recording is None else {recorded: recording},
                progress.show,
            )
        if not run.results:
            _errors.print("robobt: stopped before the first trial was finished")
            raise typer.Exit(130)
        written = replay if any(result.trial == recorded for result in run.results) else None
        if page and written is not None:
            from robobt.match.replay_html import write_html

            write_html(recording, written)  # type: ignore[arg-type]
    summary = summarise(run.results, loaded.seed if seed is None else seed)
    if as_json:
        extra = {
            "requested": count,
            "interrupted": run.interrupted,
            "replay": None if written is None else str(written),
        }
        _print_json({**summary.to_json(), **extra})
    else:
        _print_summary(summary, loaded, run, count)
        if written is not None:
            _say(f"Replay of trial {recorded}: {written}")
    if run.interrupted:
        raise typer.Exit(130)


@app.command()
@_one_line_errors
def replay(
    recording: Annotated[Path, typer.Argument(help=f"A recording (*{_RECORDING}, *.robobt.jsonl).")],
    html: Annotated[
        Path | None,
        typer.Option("--html", help="The page to write; by default beside the recording, named .html."),
    ] = None,
) -> None:
    """Make a recorded match a page that opens in any browser and needs no network."""
    from robobt.match.recording import load_recording
    from robobt.match.replay_html import write_html

    loaded = load_recording(recording)
    stem = recording.name.removesuffix(".gz").removesuffix(".jsonl").removesuffix(".robobt")
    page = recording.with_name(f"{stem}{_PAGE}") if html is None else html
    if page.exists() and page.samefile(recording):
        raise typer.BadParameter("is the recording itself; give another name", param_hint="--html")
    _say(f"Replay: {write_html(loaded, page)}")


@app.command()
@_one_line_errors
def scenarios(
    name: Annotated[
        str | None, typer.Argument(help="One scenario, bundled or a file, with all of it.")
    ] = None,
    as_json: _Json = False,
) -> None:
    """List the bundled scenarios, or show one.

    Keys of --json: scenarios, a list with name, description, file, field (length
    and width in metres), period and time_limit (seconds), trials, referee
    (whether there is one), ball (where it starts) and robots (robot, play,
    params, start: in the own team's view, own goal at -x).
    """
    from robobt.match import load_scenario
    from robobt.resources import bundled_scenarios

    loaded = [load_scenario(source) for source in (bundled_scenarios() if name is None else [name])]
    if as_json:
        _print_json({"scenarios": [_scenario_data(scenario) for scenario in loaded]})
        return
    if name is not None:
        _print_scenario(loaded[0])
        return
    table = Table("scenario", "robots", "trials", "what it is", box=None, padding=(0, 2, 0, 0))
    table.columns[0].no_wrap = True
    for scenario in loaded:
        size = f"{len(scenario.robots.blue)} v {len(scenario.robots.yellow)}"
        about = " ".join(scenario.description.split()).partition(". ")[0].removesuffix(".")
        table.add_row(escape(scenario.name), size, str(scenario.trials), escape(about))
    _console.print(table)


@app.command()
@_one_line_errors
def plays(
    name: Annotated[str | None, typer.Argument(help="One play, with its whole description.")] = None,
    as_json: _Json = False,
) -> None:
    """List the plays with their parameters.

    Keys of --json: plays, a list with name, description and parameters (name,
    type, required, default).
    """
    from robobt.plays import PLAYS
    from robobt.tree.parameters import parameters_of

    builders = {entry: PLAYS[entry] for entry in PLAYS if name in (None, entry)}
    if not builders:
        raise _unknown("play", name, PLAYS)
    entries: _Entries = {
        entry: (_doc(builder), parameters_of(builder), {}) for entry, builder in builders.items()
    }
    _list_things("plays", entries, whole=name is not None, as_json=as_json)


@app.command()
@_one_line_errors
def skills(
    name: Annotated[str | None, typer.Argument(help="One skill, with its whole description.")] = None,
    as_json: _Json = False,
) -> None:
    """List the skills and conditions: parameters, what they read and write in the robot's store.

    Keys of --json: skills, a list with name, description, parameters (name,
    type, required, default), reads and writes.
    """
    from robobt.skills import SKILLS
    from robobt.tree.parameters import parameters_of

    classes = {entry: SKILLS[entry] for entry in SKILLS if name in (None, entry)}
    if not classes:
        raise _unknown("skill", name, SKILLS)
    entries = {
        entry: (
            _doc(cls),
            [parameter for parameter in parameters_of(cls) if parameter.name != "name"],
            {"reads": list(cls.reads), "writes": list(cls.writes)},
        )
        for entry, cls in classes.items()
    }
    _list_things("skills", entries, whole=name is not None, as_json=as_json)


@app.command()
@_one_line_errors
def tree(
    play: Annotated[
        str, typer.Argument(help="Name of a play (see 'robobt plays'), or a tree file (.yaml, .xml).")
    ],
    param: Annotated[
        list[str] | None,
        typer.Option("--param", "-p", help="A parameter of the play as name=value; may be given often."),
    ] = None,
    svg: Annotated[Path | None, typer.Option("--svg", help="Write the tree as a picture.")] = None,
    dot: Annotated[Path | None, typer.Option("--dot", help="Write the tree for Graphviz.")] = None,
    yaml: Annotated[Path | None, typer.Option("--yaml", help="Write the tree as a play in YAML.")] = None,
    xml: Annotated[
        Path | None,
        typer.Option("--xml", help="Write the tree as XML that Groot2 opens (BehaviorTree.CPP 4)."),
    ] = None,
) -> None:
    """Show the tree of a play, or write it to a file."""
    from robobt.match.problems import naming
    from robobt.plays import PLAYS
    from robobt.plays.files import find_play, is_play_file, tree_xml, tree_yaml
    from robobt.tree.drawing import tree_dot, tree_svg, tree_text
    from robobt.tree.parameters import ParameterError, check_parameters

    if not is_play_file(play) and play not in PLAYS:
        raise _unknown("play", play, PLAYS)
    builder = find_play(play)
    try:
        root = builder(**check_parameters(play, builder, _parse_parameters(param or [])))
    except ParameterError as error:
        raise typer.BadParameter(f"{error.parameter}: {error}", param_hint="--param") from error
    name = Path(play).stem
    writers: list[tuple[Path | None, Callable[[], str]]] = [
        (svg, partial(tree_svg, root)),
        (dot, partial(tree_dot, root)),
        (yaml, partial(tree_yaml, root, name)),
        (xml, partial(tree_xml, root, name)),
    ]
    for path, write in writers:
        if path is not None:
            with naming(path):
                path.write_text(write(), encoding="utf-8")
            _say(f"Tree: {path}")
    if all(path is None for path, _ in writers):
        _say(tree_text(root))


@bench.command("sim")
@_one_line_errors
def bench_sim(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each case.")
    ] = 4.0,
    as_json: _Json = False,
) -> None:
    """Measure the simulator: control steps a second with frames and commands, 25 ms control.

    Keys of --json: one_v_one, six_v_six and eleven_v_eleven, each with
    steps_per_s, bare_steps_per_s (the same space stepped by pymunk alone),
    bare_ratio (time of a step over that of a bare one) and contacts_per_s
    (how often the ball meets robots, a simulated second).
    """
    from robobt.sim.bench import bench_sim as measure

    with _errors.status("measuring the simulator"):
        figures = measure(seconds=seconds)
    if as_json:
        _print_json(figures)
        return
    table = Table("case", "steps/s", "bare steps/s", "ratio to bare", box=None, padding=(0, 2, 0, 0))
    for case, figure in figures.items():
        table.add_row(
            case.replace("_", " "),
            f"{figure['steps_per_s']:,.0f}",
            f"{figure['bare_steps_per_s']:,.0f}",
            f"{figure['bare_ratio']:.2f}",
        )
    _console.print(table)


@bench.command("match")
@_one_line_errors
def bench_match(
    scenario: Annotated[
        str, typer.Argument(help="A scenario file or the name of a bundled one.")
    ] = "six_v_six",
    seconds: Annotated[
        float, typer.Option("--seconds", min=1, max=3600, help="Simulated time to play.")
    ] = 60.0,
    seed: Annotated[
        int | None, typer.Option("--seed", "-s", min=0, max=_MAX_SEED, help="By default the scenario's.")
    ] = None,
    as_json: _Json = False,
) -> None:
    """Measure a whole match on one core: every robot's tree, the physics and the recording.

    The match is played three times over in turns: recorded, unrecorded, and
    with the trees ticked by py_trees itself.

    Keys of --json: scenario, seed, robots (how many), period, simulated_s,
    wall_s (of the recorded match), real_time_factor (of it),
    real_time_factor_unrecorded, real_time_factor_py_trees (unrecorded),
    speedup_vs_py_trees, recording_share (of the recorded match's time), in_play
    (share of the time with the ball in play), ticks, errors (ticks a tree
    failed).
    """
    from robobt.match import load_scenario
    from robobt.match.bench import bench_match as measure
    from robobt.worlds import sim_world

    loaded = load_scenario(scenario)
    with _errors.status(f"playing {escape(loaded.name)}"):
        figures = measure(loaded, sim_world, seconds, seed)
    if as_json:
        _print_json(figures)
        return
    _say(
        f"{loaded.name}: {figures['simulated_s']:.1f} s of {figures['robots']} robots at "
        f"{1 / loaded.period:.0f} Hz in {figures['wall_s']:.2f} s: "
        f"{figures['real_time_factor']:.1f} times real time, of which recording takes "
        f"{figures['recording_share']:.1%}; ball in play {figures['in_play']:.0%} of the time. "
        f"With py_trees' own ticking {figures['real_time_factor_py_trees']:.1f} times real time."
    )


@bench.command("tree")
@_one_line_errors
def bench_tree(as_json: _Json = False) -> None:
    """Measure the trees: a tick of 30 nodes beside py_trees and beside plain classes.

    Keys of --json: speedup_vs_py_trees (against BehaviourTree.tick),
    ratio_to_plain_classes (time against a hand-written class tree with the same
    lifecycle), store_speedup_vs_blackboard (a read and a write of the store in
    every leaf, against the blackboard's), and the microseconds a tick that they
    come from. CPU time, medians.
    """
    from robobt.tree.bench import bench_tree as measure

    with _errors.status("measuring trees"):
        figures = measure()
    if as_json:
        _print_json(figures)
        return
    for name, figure in figures.items():
        _say(f"{name.replace('_', ' '):32} {figure:8.2f}")


def _check_replay(path: Path, out: Path | None) -> None:
    """Refuse a name that is more likely another file's: what is there is replaced."""
    ends = (_PAGE, _RECORDING, _RECORDING.removesuffix(".gz"))
    if not path.name.lower().endswith(ends):
        there = f"takes a name that ends in {', '.join(ends)}, not '{path}'"
        raise typer.BadParameter(there, param_hint="--replay")
    if out is not None and path.resolve() == out.resolve():
        raise typer.BadParameter("the replay and the results need a file each", param_hint="--replay")


class _Progress:
    """A bar on stderr; nothing where stderr is no terminal."""

    def __init__(self, name: str, total: int) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        self._progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=_errors,
            transient=True,
            disable=not _errors.is_terminal,
        )
        self._task = self._progress.add_task(escape(name), total=total)

    def __enter__(self) -> _Progress:
        self._progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()

    def show(self, _: MatchResult) -> None:
        self._progress.advance(self._task)


def _print_summary(summary: Summary, scenario: Scenario, run: Run, requested: int) -> None:
    played = f"{summary.trials} trial{'s' if summary.trials > 1 else ''}"
    stopped = f" of {requested} (stopped)" if run.interrupted else ""
    _console.print(f"[bold]{escape(summary.scenario)}[/bold]: {played}{stopped}, seed {summary.seed}")
    table = Table("outcome", "trials", "rate", "95 % interval", box=None, padding=(0, 2, 0, 0))
    for outcome, rate in summary.outcomes.items():
        table.add_row(
            outcome.replace("_", " "),
            str(rate.count),
            f"{rate.rate:.1%}",
            f"{rate.low:.1%} to {rate.high:.1%}",
        )
    _console.print(table)
    _console.print(_times(summary) if scenario.referee is None else _goals(summary))
    goals = ", ".join([f"{team} {count.total}" for team, count in summary.goals.items()])
    _say(
        f"Goals: {goals}. Mean time {summary.time.mean:.1f} s, ball in play {summary.in_play:.0%} of it. "
        f"{summary.real_time_factor:.0f} times real time a core. Trace {summary.trace}."
    )
    for name, robot in summary.robots.items():
        if robot.errors:
            _errors.print(
                f"[red]{name}: its tree failed in {robot.errors} ticks[/red]; "
                f"the first: {escape(str(robot.first_error))}",
                soft_wrap=True,
            )


def _times(summary: Summary) -> Table:
    table = Table("robot", "GoToBall, s", "Shoot, s", "total, s", "kicks", box=None, padding=(0, 2, 0, 0))
    for name, robot in summary.robots.items():
        if robot.go_to_ball.n:
            spreads = [robot.go_to_ball, robot.shoot, robot.total]
            kicks = robot.kicks.mean or 0.0
            table.add_row(name, *[_say_spread(spread) for spread in spreads], f"{kicks:.1f}")
    return table


def _goals(summary: Summary) -> Table:
    table = Table(
        "team", "goals a trial", "trials with a goal", "kicks a trial", box=None, padding=(0, 2, 0, 0)
    )
    for team, goals in summary.goals.items():
        own = [robot for name, robot in summary.robots.items() if name.startswith(team)]
        kicks = sum(robot.kicks.mean or 0.0 for robot in own)
        scored = f"{goals.trials.rate:.0%} ({goals.trials.low:.0%} to {goals.trials.high:.0%})"
        table.add_row(team, f"{goals.total / summary.trials:.2f}", scored, f"{kicks:.1f}")
    return table


def _say_spread(spread: Any) -> str:
    if spread.mean is None:
        return "-"
    return f"{spread.mean:.3f}" + ("" if spread.variance is None else f" (var. {spread.variance:.4f})")


def _print_scenario(scenario: Scenario) -> None:
    _console.print(f"[bold]{escape(scenario.name)}[/bold]  {escape(scenario.source)}", soft_wrap=True)
    _say(" ".join(scenario.description.split()))
    table = Table("", "play", "start, in the own team's view", box=None, padding=(0, 2, 0, 0))
    for robot, setup in scenario.robots:
        given = ", ".join([f"{key}={value}" for key, value in setup.params.items()])
        table.add_row(str(robot), escape(f"{setup.play}({given})"), escape(str(setup.start)))
    table.add_row("ball", "", escape(str(scenario.ball)))
    _console.print(table)
    ends = scenario.ends.model_dump(exclude_none=True)
    _say(f"Ends: {', '.join([f'{key} {value}' for key, value in ends.items()])}")
    referee = "with a referee" if scenario.referee is not None else "no referee"
    _say(f"Control every {scenario.period:g} s, {referee}, simulator {scenario.simulator}")


def _scenario_data(scenario: Scenario) -> dict[str, Any]:
    return {
        "name": scenario.name,
        "description": " ".join(scenario.description.split()),
        "file": scenario.source,
        "field": {"length": scenario.field.length, "width": scenario.field.width},
        "period": scenario.period,
        "trials": scenario.trials,
        "referee": scenario.referee is not None,
        "time_limit": scenario.ends.time_limit,
        "ball": str(scenario.ball),
        "robots": [
            {"robot": str(robot), "play": setup.play, "params": setup.params, "start": str(setup.start)}
            for robot, setup in scenario.robots
        ],
    }


def _list_things(
    kind: str,
    entries: _Entries,
    *,
    whole: bool,
    as_json: bool,
) -> None:
    if as_json:
        things = [
            {
                "name": name,
                "description": doc,
                "parameters": [
                    {
                        "name": parameter.name,
                        "type": parameter.kind,
                        "required": parameter.required,
                        "default": None if parameter.required else _plain(parameter.default),
                    }
                    for parameter in parameters
                ],
                **store,
            }
            for name, (doc, parameters, store) in entries.items()
        ]
        _print_json({kind: things})
        return
    for name, (doc, parameters, store) in entries.items():
        _console.print(f"[bold]{escape(name)}[/bold]")
        _console.print(
            f"  {escape(doc if whole else doc.partition(chr(10))[0])}".replace("\n", "\n  "), soft_wrap=True
        )
        for parameter in parameters:
            _console.print(f"    [cyan]{escape(str(parameter))}[/cyan]", soft_wrap=True)
        for verb, names in store.items():
            if names:
                _console.print(f"    {verb} {', '.join(names)}", style="dim")


def _doc(thing: object) -> str:
    import inspect

    return inspect.getdoc(thing) or ""


def _plain(value: object) -> Any:
    """A default as JSON has it."""
    try:
        return json.loads(json.dumps(value))
    except (TypeError, ValueError):
        return str(value)


def _parse_parameters(texts: list[str]) -> dict[str, Any]:
    from robobt.match.yaml_reader import YamlError, parse_yaml

    given: dict[str, Any] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name:
            raise typer.BadParameter(f"takes name=value, not {text!r}", param_hint="--param")
        try:
            given[name] = parse_yaml(value)
        except YamlError as error:
            raise typer.BadParameter(f"{name}: {error}", param_hint="--param") from error
    return given


def _unknown(kind: str, name: str | None, registry: Iterable[str]) -> typer.BadParameter:
    return typer.BadParameter(f"no {kind} is called {name!r}; there are {', '.join(registry)}")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _say(text: str) -> None:
    _console.print(escape(text), soft_wrap=True)


def _print_json(data: Mapping[str, Any]) -> None:
    sys.stdout.write(json.dumps(data, indent=2, allow_nan=False) + "\n")


def _say_error(error: Exception) -> str:
    from robobt.match.recording import RecordingError
    from robobt.match.results_file import ResultsFileError
    from robobt.match.runner import RunError
    from robobt.match.scenario import ScenarioError
    from robobt.tree.files import TreeFileError

    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    text = " ".join(str(error.args[0] if error.args else "").split())
    if isinstance(error, RecordingError | ResultsFileError | RunError | ScenarioError | TreeFileError):
        return text
    if isinstance(error, KeyError | ValueError) and text:
        return f"{text} (robobt --debug shows where)"
    return f"{type(error).__name__}: {text} (robobt --debug shows where)"


if __name__ == "__main__":
    app()
