"""The ball placement challenge of 2023 for learners."""
