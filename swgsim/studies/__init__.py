"""Studies of the chain: convergence, benchmarks, claims C1 to C8 of the paper, the gallery of effects."""

from swgsim.studies.claims import chain_claims
from swgsim.studies.finding import Finding

__all__ = [
    "Finding",
    "chain_claims",
]
