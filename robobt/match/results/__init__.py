"""Results of trials and what they add up to."""
