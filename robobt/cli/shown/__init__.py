"""What ``robobt list`` and ``robobt show`` print and write, by the kind of thing."""
