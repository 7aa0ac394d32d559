"""Addresses of the league's worlds: what they hold, and one clear error when they are wrong."""

from __future__ import annotations

import pytest

from robobt.league.factory import AddressError, LeagueFactory, parse_address
from robobt.league.serve.publishing import PublishingFactory
from robobt.match import Scenario, load_scenario
from robobt.sim import SimSettings, preset
from robobt.world.game import Team
from robobt.worlds import scenario_settings, sim_world, world_from


def test_the_simulator_is_a_world_by_its_name() -> None:
    assert world_from("sim") is sim_world


@pytest.mark.parametrize(
    ("address", "problem"),
    [
        ("grsim", "is league://SIMULATOR"),
        ("league://webots", "simulator: input should be 'grsim', 'protocol', 'steps' or 'observer'"),
        ("league://grsim?port=1", "there is no option 'port'"),
        ("league://grsim?vision=here", "'here' is not an address like 224.5.23.2:10006"),
        ("league://grsim?vision=224.5.23.2:99999", "is not an address"),
        ("league://grsim?grsim=99999", "grsim: input should be less than or equal to 65535"),
        ("league://grsim?host=robots", "host: 'robots' is not an IPv4 address like 192.168.1.5"),
        ("league://grsim?interface=lo", "interface: 'lo' is not an IPv4 address"),
        ("league://grsim?physics=moon", "no preset is called 'moon'"),
        ("league://grsim?speed=nan", "speed: input should be a finite number"),
        ("league://grsim?place=false&place=true", "place: is given twice"),
        ("league://grsim?teams=red", "teams: is blue, yellow or both, not 'red'"),
    ],
)
def test_a_wrong_address_is_one_plain_error(address: str, problem: str) -> None:
    with pytest.raises(AddressError) as raised:
        parse_address(address)
    assert problem in str(raised.value)
    assert "\n" not in str(raised.value)


def test_an_address_says_all_of_a_connection() -> None:
    connection, physics = parse_address(
        "league://protocol?host=192.0.2.9&interface=192.0.2.2&teams=yellow&speed=2"
        "&vision=224.5.23.2:10006&control=1&blue_on_positive_half=true&physics=erforce"
    )
    assert (connection.simulator, connection.host, connection.interface) == (
        "protocol",
        "192.0.2.9",
        "192.0.2.2",
    )
    assert (connection.teams, connection.speed, connection.blue_on_positive_half) == (
        (Team.YELLOW,),
        2.0,
        True,
    )
    assert (str(connection.endpoints.vision), connection.endpoints.control) == ("224.5.23.2:10006", 1)
    assert physics == "erforce"


@pytest.mark.parametrize(
    ("address", "name"),
    [
        ("league://grsim", "grsim"),
        ("league://grsim?physics=erforce", "erforce"),
        ("league://protocol", "default"),
        ("league://protocol?physics=erforce", "erforce"),
    ],
)
def test_the_physics_to_expect_is_that_of_the_simulator_there(address: str, name: str) -> None:
    class AskedError(Exception):
        pass

    def settings(scenario: Scenario, physics: str | None) -> SimSettings:
        raise AskedError(scenario_settings(scenario, physics))

    scenario = load_scenario("striker_vs_goalkeeper")
    with pytest.raises(AskedError) as asked:
        LeagueFactory(address, settings)(scenario)
    assert asked.value.args == (preset(name),)


def test_another_physics_keeps_what_the_scenario_changes() -> None:
    scenario = load_scenario("table4_trial1_ddpg")
    settings = scenario_settings(scenario, "erforce")
    assert settings.limits == preset("erforce").limits
    assert settings.kicker.max_speed == 7.5


def test_factories_know_their_address() -> None:
    factory = LeagueFactory("league://grsim?speed=2", scenario_settings)
    assert factory.address == "league://grsim?speed=2"
    assert PublishingFactory(factory).address == factory.address
