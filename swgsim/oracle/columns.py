"""Columns of what the oracle says; for those who read it and need none of the chain."""

KNOWN = "known:"  # before a class: its probability for an oracle that knows the session of the flanges as well
