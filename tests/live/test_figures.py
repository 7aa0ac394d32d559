"""How soon a tick is painted and a key is sent, and how many frames are painted, in a real browser."""

import pytest
from selenium.webdriver.common.action_chains import ActionChains

from tests.live.chromium import Page
from tests.live.playing import playing

pytestmark = pytest.mark.slow

FIGURES = """const { measured } = window.robobt, at = (values, share) => [...values].sort((a, b) => a - b)[
  Math.floor(share * values.length)];
return { frames: measured.frames, painted: [at(measured.painted, .5), at(measured.painted, .95)],
  sent: [at(measured.delays, .5), at(measured.delays, .95)] };"""


def test_eleven_a_side_are_painted_at_once(page: Page) -> None:
    with playing("eleven_v_eleven") as session:
        page.steer(session.server.url)
        page.wait("return window.robobt.match.frames > 120")
        # Beside those of a recording, which are shown anyway.
        page.js("document.querySelectorAll('.choices input:not(:checked)').forEach(box => box.click())")
        assert {"paths", "targets", "goal line"} <= {*page.js("return [...window.robobt.state.layers]")}
        page.js("window.robobt.measured.painted.length = 0; window.robobt.measured.frames = 0")
        page.js("window.begun = performance.now()")
        page.wait("return performance.now() > window.begun + 20000")
        rate = page.js("return 1000 * window.robobt.measured.frames / (performance.now() - window.begun)")
        page.button("Drive").click()
        page.wait("return document.querySelector('.driving button').textContent === 'Let go'")
        for key in "wasd" * 10:
            ActionChains(page.driver).key_down(key).key_up(key).perform()
        figures = page.js(FIGURES)
    print(
        f"{rate:.0f} frames a second; from tick to painted frame, median and 95 %: {figures['painted']} ms; "
        f"from key to command {figures['sent']} ms"
    )
    assert rate >= 30.0
    assert figures["painted"][1] <= 100.0
    assert figures["sent"][1] <= 50.0
