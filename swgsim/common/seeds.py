"""Seeds from the purpose of a draw, so that a new draw does not change the others."""

import hashlib

import numpy as np


def seed_hash(*purpose: object) -> int:
    """A 64-bit seed from the words of a purpose.

    >>> seed_hash("disturbance", 1, "healthy") == seed_hash("disturbance", 1, "healthy")
    True
    """
    words = "\x1f".join(str(word) for word in purpose)
    return int.from_bytes(hashlib.sha256(words.encode()).digest()[:8], "little")


def generator(*purpose: object) -> np.random.Generator:
    """The random generator of one purpose."""
    return np.random.default_rng(seed_hash(*purpose))
