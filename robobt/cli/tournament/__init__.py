"""Teams against each other: play tournaments, look at their results."""
