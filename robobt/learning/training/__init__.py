"""Training runs: the loop, its settings, its folder, its evaluation."""
