"""Measured recordings: readers of folders and files, maps of foreign columns, and checks for defects of a bench."""

from swgsim.recordings.checks.defect import Defect, Severity
from swgsim.recordings.files.folder import write_folder
from swgsim.recordings.files.recording_file import write_file
from swgsim.recordings.read import read_recordings
from swgsim.recordings.recording import CHANNELS, Recording
from swgsim.recordings.recording_set import RecordingSet
from swgsim.tables.file_defect import FileDefect

__all__ = [
    "CHANNELS",
    "Defect",
    "FileDefect",
    "Recording",
    "RecordingSet",
    "Severity",
    "read_recordings",
    "write_file",
    "write_folder",
]
