"""Recordings of robot joints in: files of any maker through a column map, checked on the way."""
