"""The official game controller as the referee of a simulated match, in lock step with it."""
