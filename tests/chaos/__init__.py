"""Work that is killed at random moments and started again: data sets and sweeps."""
