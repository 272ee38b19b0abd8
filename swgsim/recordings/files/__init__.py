"""Recordings in: a folder, a file, or the files of other makers, checked on the way."""
