"""A virtual test bench: scatter of units and sessions, instruments, disturbance (eq. 10), and a sealed truth."""

from swgsim.bench.disturbance import Disturbance
from swgsim.bench.scatter import Bench, Session, Shaft
from swgsim.bench.truth import truth_of, write_sealed
from swgsim.bench.virtual_bench import Instruments, Sessions, record_sessions

__all__ = [
    "Bench",
    "Disturbance",
    "Instruments",
    "Session",
    "Sessions",
    "Shaft",
    "record_sessions",
    "truth_of",
    "write_sealed",
]
