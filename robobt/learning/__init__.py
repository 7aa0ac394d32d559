"""Learning: environments, learners, shot data, predictors, export. Torch lives here."""
