"""Teams against each other, many times: entrants, pairings, the store of results, ratings and tests."""
