"""One module a rule or family of rules, on both sides of each threshold."""
