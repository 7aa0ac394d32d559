"""``robobt bench``: measurements."""
