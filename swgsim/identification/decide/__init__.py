"""The decision: which candidates are accepted, which rivals remain, which regularities have no known cause."""
