"""The page on a phone, in the dark, by keyboard alone, and how well it can be read."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from robobt.skills import KickToTarget, SelectShot
from robobt.tree import Sequence, tree_svg
from tests.live.chromium import Page
from tests.live.playing import Session, playing
from tests.waiting import soon

pytestmark = pytest.mark.integration

LOW_CONTRAST = """
const rgb = text => (text.match(/[\\d.]+/g) || [0, 0, 0]).map(Number);
const light = ([r, g, b]) => [r, g, b].map(v => v / 255).map(v => v <= .04045 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4)
  .reduce((sum, v, i) => sum + v * [.2126, .7152, .0722][i], 0);
const ground = element => {
  for (let each = element; each; each = each.parentElement) {
    const [r, g, b, a = 1] = rgb(getComputedStyle(each).backgroundColor);
    if (a > .5) return [r, g, b];
  }
  return rgb(getComputedStyle(document.body).backgroundColor);
};
const low = [];
for (const element of document.querySelectorAll("body *")) {
  const own = [...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim());
  const box = element.getBoundingClientRect(), style = getComputedStyle(element);
  if (!own || !box.width || style.visibility === "hidden" || element.disabled || element.closest(".pick,.count")) continue;
  const [a, b] = [light(rgb(style.color)), light(ground(element))], ratio = (Math.max(a, b) + .05) / (Math.min(a, b) + .05);
  if (ratio < (parseFloat(style.fontSize) >= 24 ? 3 : 4.5)) low.push(`${element.className} ${element.textContent.slice(0, 20)} ${ratio.toFixed(2)}`);
}
return low;
"""  # noqa: E501


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    with playing("three_v_three") as session:
        yield session


@pytest.fixture
def live(page: Page, session: Session) -> Page:
    page.steer(session.server.url)
    page.wait("return window.robobt.match.frames > 2")
    return page


@pytest.mark.parametrize("dark", [False, True])
def test_every_text_has_the_contrast_of_wcag_aa(live: Page, dark: bool) -> None:
    live.dark(dark)
    live.button("Edit play").click()
    live.wait("return document.querySelector('.forms input') !== null")
    assert live.js(LOW_CONTRAST) == []


def test_a_phones_screen_shows_all_without_scrolling_sideways(live: Page) -> None:
    live.size(390, 844, phone=True)
    live.driver.refresh()
    live.wait("return window.robobt && window.robobt.match.frames > 2")
    assert live.js("return document.documentElement.scrollWidth") <= 390
    field = live.js(
        "const box = document.querySelector('#field').getBoundingClientRect(); return [box.x, box.right]"
    )
    assert field[0] >= 0
    assert 300 < field[1] <= 390
    small = """return [...document.querySelectorAll(".keys button, .steering button")].filter(button => {
      const { width, height } = button.getBoundingClientRect();
      return width && (height < 24 || width < 24);
    }).length"""
    assert live.js(small) == 0


def test_it_is_used_by_the_keyboard_alone(live: Page, session: Session) -> None:
    wanted = {"Play or pause", "Next seed", "Drive", "Halt", "Save recording", "Edit play"}
    seen: list[str] = []
    reached = "const e = document.activeElement; return e.getAttribute('aria-label') || e.textContent;"
    for _ in range(120):
        ActionChains(live.driver).send_keys(Keys.TAB).perform()
        seen.append(live.js(reached))
        if wanted <= set(seen):
            break
    assert wanted <= set(seen)
    live.js("document.querySelector('#picker .pick').focus()")
    ActionChains(live.driver).send_keys(Keys.TAB, Keys.ENTER).perform()
    assert (
        live.js("return document.querySelectorAll('#picker .pick')[1].getAttribute('aria-pressed')") == "true"
    )
    matches = len(session.matches)
    live.js("[...document.querySelectorAll('.live button')].find(b => b.textContent === 'Again').focus()")
    ActionChains(live.driver).send_keys(Keys.ENTER).perform()
    soon(lambda: len(session.matches) > matches)


def test_texts_stay_in_the_boxes_of_a_trees_picture(page: Page, tmp_path: Path) -> None:
    shot = SelectShot(keep=0.123456, min_score=0.12345, max_distance=3.4567)
    kick = KickToTarget(name="with the widest letters: WWWWMMMM", target=(4.123456789, -0.123456789))
    (tmp_path / "tree.svg").write_text(tree_svg(Sequence("both", memory=False, children=[shot, kick])))
    page.open((tmp_path / "tree.svg").as_uri())
    over = """return [...document.querySelectorAll("g")].map(node => {
      const end = element => element.getBBox().x + element.getBBox().width;
      return Math.max(...[...node.querySelectorAll("text")].map(end)) - end(node.querySelector("rect"));
    })"""
    beyond = page.js(over)
    assert len(beyond) == 3
    assert max(beyond) < 0.0
