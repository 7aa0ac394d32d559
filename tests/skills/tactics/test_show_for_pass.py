from __future__ import annotations

from itertools import combinations

from robobt.skills.store import Pass
from robobt.skills.tactics.keeping import SHORTEST, KeepingPlaces
from robobt.skills.tactics.show_for_pass import ShowForPass
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world.game import Team
from robobt.world.geometry import distance
from tests.skills.fixed_world import Alone
from tests.skills.refereed import kickoff

HOLDER = robot(-2.0, 0.0, number=1, contact=True)
MATES = (robot(-1.0, 1.0, number=2), robot(-1.0, -1.0, number=3))


def test_mates_show_for_a_pass_apart_from_each_other_and_from_opponents() -> None:
    opponent = robot(-0.6, 0.0, number=5)
    alone = Alone(ShowForPass())
    alone.store.team.plan.players.update((1, 2, 3))
    view = frame(MATES[0], held(HOLDER), (HOLDER, MATES[1]), (opponent,), 0.0)
    assert alone.tick(view, 2) is Status.RUNNING
    places = alone.store.team.shared(KeepingPlaces).places
    assert set(places) == {2, 3}
    assert all(SHORTEST < distance(place, held(HOLDER)) < 4.0 for place in places.values())
    assert all(distance(one, other) > 0.8 for one, other in combinations(places.values(), 2))
    assert all(distance(place, opponent.position) > 0.5 for place in places.values())
    command = alone.store.command
    assert (command.vx, command.vy) != (0.0, 0.0)


def test_until_a_kick_off_is_taken_they_stay_in_their_own_half() -> None:
    alone = Alone(ShowForPass())
    alone.store.team.plan.players.update((1, 2))
    taker, mate = robot(-0.25, 0.0, number=1), robot(-0.8, 0.1, number=2)
    team = alone.store.team
    team.attacker, team.plan.next_pass = 1, Pass(2, (1.5, 0.1), 3.0, 1.0)
    game = kickoff(Team.BLUE, may_touch=True)
    alone.tick(frame(mate, (0.0, 0.0), (taker,), game=game), 2)
    assert alone.tree.feedback_message == "to (-0.1, 0.1)"
