"""Table 4 of the paper: get the ball and shoot, with hand-written and learned skills in every combination."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import hypot
from statistics import fmean

from robobt.experiments.table4_rows import PAPER, Comparison, Row, Share, Spread, Table4, Trial
from robobt.learning.envs.episodes import straight_line_time
from robobt.match.loop import Match, WorldFactory
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.skills.ball.go_to_ball import HANDOVER_DISTANCE
from robobt.statistics import corrected_resampled_t_test, mean_interval, wilson_interval
from robobt.world.state import Frame
from robobt.worlds import sim_world

TRIALS = ("1", "2")
"""The ball in the centre, and at (0, 1.5) m."""

COMBINATIONS: dict[str, dict[str, str | None]] = {
    "robobulls": {"style": "robobulls"},
    "geometric, kick": {"policy": "geometric", "shoot": "kick_to_target"},
    "geometric, kick, quick": {"policy": "geometric", "shoot": "kick_to_target", "pickup_speed": None},
    "geometric, shoot": {"policy": "geometric", "shoot": "geometric"},
    "geometric, ddpg": {"policy": "geometric", "shoot": "ddpg"},
    "ddpg, kick": {"policy": "ddpg", "shoot": "kick_to_target", "pickup_speed": None},
    "ddpg, shoot": {"policy": "ddpg", "shoot": "geometric", "pickup_speed": None},
    "ddpg, ddpg": {"policy": "ddpg", "shoot": "ddpg", "pickup_speed": None},
}
"""Parameters of the play go_to_ball_and_shoot, by who approaches and who shoots.

Hand-written shots are KickToTarget ("kick") and the geometric Shoot ("shoot").

The learned approach hands over at full speed and the pick-up goes on as fast as the
dribbler takes the ball; "quick" is the hand-written approach with that pick-up.
"""

LEARNED = "ddpg, ddpg"
HAND_WRITTEN = tuple(name for name in COMBINATIONS if "ddpg" not in name)

_SHOOTER, _GOAL = "blue 0", "goal_blue"


@dataclass(frozen=True, slots=True)
class Attempt:
    """One run.

    Attributes:
        approach: start until robot and ball are 0.2 m apart, between two frames by their straight line [s].
        to_ball: start until the ball first lies in the mouth, as the paper counts [s].
        shoot: from then until the kick [s].
        goal: whether it went in.

    Times are None for what never happened.
    """

    approach: float | None
    to_ball: float | None
    shoot: float | None
    goal: bool

    @property
    def pick_up(self) -> float | None:
        """From the end of the approach until the ball lies in the mouth [s]."""
        return None if self.approach is None or self.to_ball is None else self.to_ball - self.approach

    @property
    def total(self) -> float | None:
        """Start to kick [s]."""
        return None if self.to_ball is None or self.shoot is None else self.to_ball + self.shoot


def table4(
    runs: int = 25,
    seed: int | None = None,
    *,
    preset: str = "robobulls",
    realism: str | None = None,
    combinations: Sequence[str] = tuple(COMBINATIONS),
    trials: Sequence[str] = TRIALS,
    progress: Callable[[], object] = lambda: None,
    world: WorldFactory = sim_world,
) -> Table4:
    """Play both trials with every combination.

    Run n of every combination has the same seed, so that differences are paired.

    Args:
        runs: number of runs of each.
        seed: seed of all runs; the scenarios' own by default.
        preset: preset of the simulator.
        realism: level of noise, losses and delays; by default the scenarios' own little noise.
        combinations: some of :data:`COMBINATIONS`.
        trials: some of :data:`TRIALS`.
        progress: called after every run.
        world: where it is played.

    Raises:
        KeyError: no such preset, realism level or combination.
        ScenarioError: a play cannot be made, as where a model is missing.
    """
    found: dict[str, Trial] = {}
    for trial in trials:
        attempts: dict[str, list[Attempt]] = {}
        rows: dict[str, Row] = {}
        for name in combinations:
            scenario = table4_scenario(trial, COMBINATIONS[name], preset, realism)
            first = scenario.seed if seed is None else seed
            attempts[name] = []
            for run in range(runs):
                attempts[name].append(play_attempt(scenario, trial_seed(first, run), world))
                progress()
            rows[name] = _row_of(attempts[name], _optimum(scenario, name))
        best, test = _compared(attempts)
        found[trial] = {"paper": PAPER[trial], "rows": rows, "best_hand_written": best, "test": test}
    return {"runs": runs, "preset": preset, "realism": realism, "trials": found}


def table4_scenario(
    trial: str, params: Mapping[str, object], preset: str = "robobulls", realism: str | None = None
) -> Scenario:
    """Return a trial's bundled scenario with another play's parameters, simulator or noise."""
    scenario = load_scenario(f"table4_trial{trial}")
    simulator = {**scenario.simulator, "preset": preset}
    if realism is not None:
        simulator["realism"] = realism
    return scenario.model_copy(update={"simulator": simulator}).with_robot(_SHOOTER, params=dict(params))


def play_attempt(scenario: Scenario, seed: int, world: WorldFactory = sim_world) -> Attempt:
    """Play one run to its end."""
    approach: float | None = None
    with Match(scenario, seed, world) as match:
        before = match.world.truth()
        while match.tick():
            now = match.world.truth()
            if not now.own:
                # Over a network robots may be out of sight.
                continue
            if approach is None and _gap(now) <= HANDOVER_DISTANCE:
                way, left = _gap(before) - _gap(now), _gap(before) - HANDOVER_DISTANCE
                share = min(1.0, max(0.0, left / way)) if way > 0.0 else 1.0
                approach = before.time + share * (now.time - before.time)
            before = now
        result = match.result()
    figures = result.robots[_SHOOTER]
    return Attempt(approach, figures.go_to_ball, figures.shoot, result.outcome == _GOAL)


def _gap(frame: Frame) -> float:
    robot, ball = frame.own[0], frame.ball
    return hypot(ball.x - robot.x, ball.y - robot.y)


def _row_of(attempts: Sequence[Attempt], optimum: float) -> Row:
    approach = _spread(attempt.approach for attempt in attempts)
    return Row(
        approach=approach,
        pick_up=_spread(attempt.pick_up for attempt in attempts),
        to_ball=_spread(attempt.to_ball for attempt in attempts),
        shoot=_spread(attempt.shoot for attempt in attempts),
        total=_spread(attempt.total for attempt in attempts),
        goals=_share([attempt.goal for attempt in attempts]),
        reached=_share([attempt.to_ball is not None for attempt in attempts]),
        shots=_share([attempt.shoot is not None for attempt in attempts]),
        optimum=optimum,
        optimum_ratio=None if approach["mean"] is None else approach["mean"] / optimum,
    )


def _share(happened: Sequence[bool]) -> Share:
    low, high = wilson_interval(sum(happened), len(happened))
    return {"count": sum(happened), "rate": sum(happened) / len(happened), "low": low, "high": high}


def _spread(given: Iterable[float | None]) -> Spread:
    values = [value for value in given if value is not None]
    mean = fmean(values) if values else None
    low, high = mean_interval(values) if len(values) > 1 else (None, None)
    variance = None
    if mean is not None and len(values) > 1:
        variance = sum((value - mean) ** 2 for value in values) / (len(values) - 1)
    return {"n": len(values), "mean": mean, "variance": variance, "low": low, "high": high}


def _optimum(scenario: Scenario, name: str) -> float:
    """Return the straight line's time at what the approach may use; a model's top speed is on its card."""
    frame = sim_world(scenario)
    with Match(scenario, 0, lambda _: frame) as match:
        start = match.world.truth()
    limits = start.own[0].limits
    fastest = limits.max_speed
    if COMBINATIONS[name].get("policy") == "ddpg":
        fastest = min(fastest, _model_speed())
    elif "style" in COMBINATIONS[name]:
        from robobt.motion.pilot import ROBOBULLS_LIMITS

        limits, fastest = ROBOBULLS_LIMITS, ROBOBULLS_LIMITS.max_speed
    strongest = max(limits.acceleration, limits.lateral_acceleration)
    return float(straight_line_time(_gap(start) - HANDOVER_DISTANCE, fastest, strongest))


def _model_speed() -> float:
    from robobt.models.policy import load_policy
    from robobt.skills.ball.go_to_ball import SHIPPED

    action = load_policy(SHIPPED["ddpg"], skill="GoToBall").card.action
    assert action is not None
    return action.max_speed


def _compared(attempts: Mapping[str, Sequence[Attempt]]) -> tuple[str | None, Comparison | None]:
    """Test the learned combination against the hand-written one that is first at the ball."""
    times = {name: [attempt.to_ball for attempt in played] for name, played in attempts.items()}
    means = {
        name: fmean([time for time in times[name] if time is not None])
        for name in HAND_WRITTEN
        if name in times and any(time is not None for time in times[name])
    }
    best = min(means, key=lambda name: means[name]) if means else None
    if best is None or LEARNED not in times:
        return best, None
    pairs = zip(times[LEARNED], times[best], strict=True)
    differences = [ours - theirs for ours, theirs in pairs if ours is not None and theirs is not None]
    if len(differences) < 2:
        return best, None
    # A share of 0 to correct for leaves the plain paired t-test.
    mean, variance, t, degrees, p = corrected_resampled_t_test(differences, 0.0)
    return best, Comparison(mean=mean, variance=variance, t=t, degrees=degrees, p=p, n=len(differences))
