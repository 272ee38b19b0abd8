"""The simulation chain (Fig. 2): equations of motion (eq. 1 to 7), influence maps of the structure, gauge signals."""

from swgsim.chain.chain import SECTORS, Run, Simulation, channels_of, simulate_turns
from swgsim.chain.chain import simulate as simulate_runs
from swgsim.chain.direct import DirectSolver
from swgsim.chain.dynamics import Drive
from swgsim.chain.influence import InfluenceMap, influence_map
from swgsim.chain.motion import Motion, NoSteadyState
from swgsim.chain.settling import steady_state

__all__ = [
    "SECTORS",
    "DirectSolver",
    "Drive",
    "InfluenceMap",
    "Motion",
    "NoSteadyState",
    "Run",
    "Simulation",
    "channels_of",
    "influence_map",
    "simulate_runs",
    "simulate_turns",
    "steady_state",
]
