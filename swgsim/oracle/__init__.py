"""The classifier that knows the gear, the faults and the statistics of the bench: the least error there can be."""
