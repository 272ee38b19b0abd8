"""Names of columns in the oracle's file."""

KNOWN = "known:"  # prefix of a class: its probability for an oracle that also knows the session of the flanges
