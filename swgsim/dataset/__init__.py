"""Labelled data sets: the fault variants (Table V), the grid of cases, and the file that they become."""

from swgsim.dataset.dataset import disturb, generate, usage
from swgsim.dataset.faults import FAULTS, Variant, Variants
from swgsim.dataset.grid import Case, Grid
from swgsim.dataset.plan import Plan

__all__ = [
    "FAULTS",
    "Case",
    "Grid",
    "Plan",
    "Variant",
    "Variants",
    "disturb",
    "generate",
    "usage",
]
