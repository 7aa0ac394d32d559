"""The dribbling challenge of 2022 for learners."""
