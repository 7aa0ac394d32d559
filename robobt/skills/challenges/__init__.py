"""Skills for the league's technical challenges."""
