"""Seeds derived from what a draw is for, so that adding a draw never moves another one."""

import hashlib

import numpy as np


def seed_hash(*purpose: object) -> int:
    """A 64-bit seed from the words that say what the draw is for.

    >>> seed_hash("disturbance", 1, "healthy") == seed_hash("disturbance", 1, "healthy")
    True
    """
    words = "\x1f".join(str(word) for word in purpose)
    return int.from_bytes(hashlib.sha256(words.encode()).digest()[:8], "little")


def generator(*purpose: object) -> np.random.Generator:
    """A random generator of its own for one purpose."""
    return np.random.default_rng(seed_hash(*purpose))
