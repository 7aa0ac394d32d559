"""``robobt what-if``: play moments of a logged match on with other decisions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import (
    MAX_SEED,
    Imports,
    Json,
    Progress,
    import_files,
    one_of,
    print_json,
    say,
)
from robobt.cli.match_summary import tell_failed
from robobt.cli.option_groups.scenario import Blue, Yellow, with_teams
from robobt.cli.options import option
from robobt.cli.outputs import PAGE, RECORDING, check_ending, make_folders
from robobt.cli.shown.what_if import print_decisions, print_moments
from robobt.config.extras import need
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.what_if import Branches, Found, LoggedMatch
    from robobt.world.game import Team


@dataclass(frozen=True)
class OtherPlays:
    """What plays otherwise."""

    blue: Blue = ""
    yellow: Yellow = ""
    imports: Imports = None


@dataclass(frozen=True)
class BranchOptions:
    """How branches are played."""

    seconds: Annotated[float, option("--seconds", " of a branch", min=0.1, max=60.0)] = 3.0
    leave: Annotated[float, option("--leave", min=0.0, max=20.0)] = 0.3
    simulator: Annotated[
        str | None, option("--simulator", "; by default the match's, for a league log 'default'")
    ] = None
    seed: Annotated[int, option("--seed", min=0, max=MAX_SEED)] = 0

    def branches(self, logged: LoggedMatch, plays: OtherPlays | None = None) -> Branches:
        """Return what plays branches, of the log's plays or of other ones."""
        from robobt.what_if import Branches

        scenario = logged.scenario
        if plays is not None:
            scenario = with_teams(scenario, plays.blue, plays.yellow)
        return Branches(logged, scenario, seconds=self.seconds, leave=self.leave)


@dataclass(frozen=True)
class Search:
    """How a whole match is searched."""

    scan: Annotated[bool, option("--scan")] = False
    every: Annotated[float, option("--every", ", with --scan", min=0.05, max=60.0)] = 0.5
    moments: Annotated[int, option("--moments", ", with --scan", min=1, max=1000)] = 5
    begin: Annotated[float, option("--from", ", with --scan", min=0.0)] = 0.0
    end: Annotated[float | None, option("--to", ", with --scan", min=0.0)] = None
    out: Annotated[
        Path | None, option("--out", " a replay of each moment, with --scan: a folder", metavar="FOLDER")
    ] = None


_WORTH = 0.005
"""Least change of expected goals for which a scan lists a moment: less is shown as +0.00."""


def _only_with(wanted: str, lacking: bool, given: Mapping[str, object]) -> None:
    """Refuse those of the options that are given where the one that they go with is lacking."""
    wrong = [name for name, value in given.items() if value]
    if lacking and wrong:
        raise typer.BadParameter(
            f"{'goes' if len(wrong) == 1 else 'go'} with {wanted}", param_hint=", ".join(wrong)
        )


def what_if(
    file: Annotated[
        Path,
        typer.Argument(metavar="LOG", help=f"A recording (*{RECORDING}), or a league log (*.log, *.log.gz)."),
    ],
    at: Annotated[float | None, option("--at", min=0.0)] = None,
    trials: Annotated[
        int, option("--trials", ": branches of each decision, with --scan of each moment listed", min=2)
    ] = 100,
    team: Annotated[
        str | None, option("--team", "; by default the one that decides otherwise, with --scan blue")
    ] = None,
    record: Annotated[
        Path | None, option("--record", ": the best decision's branch, with the log drawn beside it")
    ] = None,
    *,
    plays: OtherPlays,
    how: BranchOptions,
    search: Search,
    as_json: Json = False,
) -> None:
    """Play a moment of a logged match on, many times, with what was decided and with other decisions.

    With --blue or --yellow that team plays otherwise from --at on. Without them the robot that has the ball
    then decides otherwise: it shoots, passes to each team-mate, carries the ball on, kicks it upfield, or
    plays as team_player. The other team follows the log until the game has left it, then plays as it did or,
    in a league log, as robobt's team. --scan looks for the moments at which another decision would have been
    worth most.

    Branches differ by small errors of start and execution. A branch ends when play is stopped. Its expected
    goals are those of its shots, and the chance of the best shot at its end, minus the opponents'.

    Keys of --json: log, team, seconds, seed; with --at: at, decisions, each with name, trials, expected,
    goals, gain and goals_gain (mean, low, high: 95 %; null for "nothing changed"), followed (seconds in the
    log); really (expected and goals in the log), and record (the file, or null); with --scan: moments, each
    with time, robot, decision, replay, and unchanged and changed as decisions, and searched, the number of
    moments that were searched.

    Exit code 3 when a robot's tree failed in a branch.
    """
    need("record", "pyarrow")
    from robobt.what_if import load_logged

    if search.scan == (at is not None):
        raise typer.BadParameter("give either --at or --scan", param_hint="--at, --scan")
    _only_with("--at", search.scan, {"--blue": plays.blue, "--yellow": plays.yellow, "--record": record})
    if not search.scan and search.out is not None:
        raise typer.BadParameter("goes with --scan; --record is for --at", param_hint="--out")
    scanning: dict[str, object] = {"--from": search.begin, "--to": search.end is not None}
    scanning |= {"--every": search.every != Search.every, "--moments": search.moments != Search.moments}
    _only_with("--scan", not search.scan, scanning)
    if team is not None:
        one_of([team], ["blue", "yellow"], "--team")
    if record is not None:
        check_ending("--record", record, RECORDING, PAGE)
        if record.exists() and file.exists() and record.samefile(file):
            raise typer.BadParameter("would replace the log", param_hint="--record")
    if search.end is not None and search.end <= search.begin:
        raise typer.BadParameter("--to has to be later than --from", param_hint="--from, --to")
    import_files(plays.imports)
    logged = load_logged(file, how.simulator)
    make_folders({"--record": record})
    if search.scan:
        failure = _scan(logged, file, team, trials, how, search, as_json=as_json)
    else:
        assert at is not None
        failure = _at(logged, file, at, team, trials, plays, how, record, as_json=as_json)
    if failure is not None:
        tell_failed(failure)


def _at(
    logged: LoggedMatch,
    file: Path,
    at: float,
    team: str | None,
    trials: int,
    plays: OtherPlays,
    how: BranchOptions,
    record: Path | None,
    *,
    as_json: bool,
) -> str | None:
    from robobt.what_if import compare_decisions
    from robobt.what_if.compare import compared
    from robobt.what_if.decisions import decisions_of
    from robobt.what_if.moments import nobody_decides
    from robobt.world.game import Team

    tick = logged.tick(at)
    branches = how.branches(logged)
    branches.begin(tick)
    changed = [side for side in Team if getattr(plays, side.value)]
    holder = branches.holder()
    ours = _team(team, changed, holder and holder.team)
    decisions = []
    if not changed:
        if holder is None or holder.team is not ours:
            raise nobody_decides(logged, at, None if holder is None and team is None else ours)
        decisions = decisions_of(logged.recording.frame(tick), holder)
    # In a league log nobody knows what the teams play, so "nothing changed" follows the log.
    others = [side for side in Team if side not in (changed or [ours])]
    other = how.branches(logged, plays) if changed else None
    if other is not None:
        # Before the first branch is played: its play may be unknown.
        other.begin(tick)
    follow = others if logged.known else list(Team)
    with Progress("branches", trials * (1 + len(decisions) + bool(changed))) as progress:
        unchanged, found = compare_decisions(
            branches, decisions, ours, trials, how.seed, follow, progress.advance
        )
        if other is not None:
            name = ", ".join([text for text in (plays.blue, plays.yellow) if text])
            with_them = []
            for trial in range(trials):
                with_them.append(other.play(how.seed, trial, follow=others))
                progress.advance()
            found.append(compared(name, with_them, unchanged, ours))
    failure = branches.first_error or (None if other is None else other.first_error)
    really = branches.really()
    best = None
    if record is not None:
        best = max(found[1:], key=lambda one: one.gain.mean if one.gain else 0.0, default=None)
        title = f"{logged.scenario.name} at {at:g} s: {best.name if best else found[0].name}"
        played = how.branches(logged, plays if changed else None)
        played.begin(tick)
        decision = next((one for one in decisions if best is not None and one.name == best.name), None)
        # Trial 0 as in the figures.
        follow = others if changed else follow
        played.play(
            how.seed, 0, follow=follow, decision=decision, record=played.recording(str(record), title)
        )
    if as_json:
        said = {"log": str(file), "team": ours.value, "seconds": how.seconds, "seed": how.seed, "at": at}
        followed = {"expected": really.value(ours), "goals": really.lead(ours)}
        print_json(
            {
                **said,
                "really": followed,
                "decisions": [one.to_json() for one in found],
                "record": record and str(record),
            }
        )
        return failure
    if decisions:
        say(f"{holder} has the ball and decides otherwise.")
    say(
        f"{file} at {at:g} s: {ours.value}'s goals in the next {how.seconds:g} s, minus the opponents', "
        f"{trials} branches each"
    )
    print_decisions(found)
    say(f"In the log: {really.value(ours):+z.2f} expected goals, {really.lead(ours):+d} goals")
    if record is not None:
        say(f"Replay of '{best.name if best else found[0].name}', with the log drawn beside it: {record}")
    return failure


def _scan(
    logged: LoggedMatch,
    file: Path,
    team: str | None,
    trials: int,
    how: BranchOptions,
    search: Search,
    *,
    as_json: bool,
) -> str | None:
    from robobt.what_if import promising_moments, scan
    from robobt.world.game import Team

    ours = _team(team, [], Team.BLUE)
    times = logged.recording.times
    if not len(times) or search.begin > times[-1]:
        # Says what the log holds.
        logged.tick(search.begin)
    make_folders({"--out": search.out}, folders=True)
    branches = how.branches(logged)
    moments = promising_moments(logged, ours, search.every, search.begin, search.end)
    with Progress("branches", 1) as progress:
        found = scan(
            logged,
            ours,
            branches,
            moments,
            count=search.moments,
            trials=trials,
            seed=how.seed,
            on_branch=progress.reach,
        )
    searched = len(moments)
    found = [one for one in found if one.changed.gain is not None and one.changed.gain.mean >= _WORTH]
    replays = [_replay(branches, logged, one, ours, how.seed, search.out) for one in found]
    if as_json:
        listed = [
            {
                "time": one.time,
                "robot": str(one.decision.robot),
                "decision": one.decision.name,
                "replay": replay and str(replay),
                "unchanged": one.unchanged.to_json(),
                "changed": one.changed.to_json(),
            }
            for one, replay in zip(found, replays, strict=True)
        ]
        said = {"log": str(file), "team": ours.value, "seconds": how.seconds, "seed": how.seed}
        print_json({**said, "moments": listed, "searched": searched})
        return branches.first_error
    if not searched:
        say(f"{file}: no field player of {ours.value} has the ball in play.")
        return branches.first_error
    if not found:
        many = counted(searched, "moment")
        say(f"{file}: {many} searched; no other decision was worth {_WORTH:g} expected goals.")
        return branches.first_error
    say(f"{file}: moments at which another decision of {ours.value} would have been worth most")
    print_moments(found)
    say(f"Figures from {trials} branches each that the search has not seen.")
    if len(found) < search.moments:
        say(
            f"{searched - len(found)} of {searched} moments left out: "
            f"worth less than {_WORTH:g} expected goals, or within a second of one in the list."
        )
    if search.out is not None:
        say(f"Replays, with the log drawn beside them: {search.out}")
    return branches.first_error


def _replay(
    branches: Branches, logged: LoggedMatch, found: Found, team: Team, seed: int, folder: Path | None
) -> Path | None:
    """Record the branch that is nearest to the mean, and return where."""
    if folder is None:
        return None
    folder.mkdir(parents=True, exist_ok=True)
    name = found.decision.name.replace(" ", "_")
    robot = found.decision.robot
    path = folder / f"{found.time:07.2f}_{robot.team.value}_{robot.number}_{name}.html"
    title = f"{logged.scenario.name} at {found.time:.2f} s: {robot} {found.decision.name}"
    branches.begin(found.tick)
    follow = [team.other] if logged.known else list(type(team))
    branches.play(
        seed,
        found.typical,
        follow=follow,
        decision=found.decision,
        record=branches.recording(str(path), title),
    )
    return path


def _team(asked: str | None, changed: list[Team], holder: Team | None) -> Team:
    from robobt.world.game import Team

    if asked is not None:
        return Team(asked)
    if len(changed) == 1:
        return changed[0]
    return holder or Team.BLUE
