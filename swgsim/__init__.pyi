from . import effects
from .api import MapDraft, SimulatedRun, draft_map, generate, identify, record, simulate
from .chain import Run, simulate_runs
from .common.version import __version__
from .gear import Conditions, Gear, KinematicError, OperatingPoint, Population, Transmission, WaveGenerator, Window
from .identification import Identification, Unit, commission
from .joint import JointAnswer, JointRecordings, recordings_of
from .recordings import Recording, RecordingSet, read_recordings, write_folder
from .twin import Diagnosis, diagnose

__all__ = [
    "Conditions",
    "Diagnosis",
    "Gear",
    "Identification",
    "JointAnswer",
    "JointRecordings",
    "KinematicError",
    "MapDraft",
    "OperatingPoint",
    "Population",
    "Recording",
    "RecordingSet",
    "Run",
    "SimulatedRun",
    "Transmission",
    "Unit",
    "WaveGenerator",
    "Window",
    "__version__",
    "commission",
    "diagnose",
    "draft_map",
    "effects",
    "generate",
    "identify",
    "read_recordings",
    "record",
    "recordings_of",
    "simulate",
    "simulate_runs",
    "write_folder",
]
