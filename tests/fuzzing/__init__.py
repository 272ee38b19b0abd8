"""Hostile input for every reader: spoiled files, each read in a process of its own with limits."""
