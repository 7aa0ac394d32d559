import numpy as np
import pytest

from paper.goalkeeper_fit import START, chances, fit_population
from paper.goalkeeper_race import race_inputs
from robobt.shots.predict.validation import judge
from tests.shots.made_up import made_up_table


@pytest.mark.slow
@pytest.mark.integration
def test_a_fit_finds_the_goalkeepers_that_the_outcomes_came_from():
    shots = race_inputs(made_up_table(240))
    truth = START.model_copy(update={"max_speed": 0.5, "delay": 0.2})
    likely = chances(truth, shots)
    scored = (np.random.default_rng(0).random(len(likely)) < likely).astype(np.int64)
    found = fit_population(shots, scored)
    fresh = race_inputs(made_up_table(400, seed=1))
    expected = chances(truth, fresh)
    off, off_at_start = (np.abs(chances(who, fresh) - expected).mean() for who in (found, START))
    assert off < 0.5 * off_at_start
    assert judge(chances(found, shots), scored).log_loss < judge(chances(START, shots), scored).log_loss
