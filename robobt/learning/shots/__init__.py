"""Shot data: the table, who fills it, and the predictors that learn from it."""
