"""Memory for what can be computed again."""

from functools import cached_property


def let_go(*objects: object) -> None:
    """Drop what cached properties hold; they find it anew where they are asked."""
    for each in objects:
        for name, what in vars(type(each)).items():
            if isinstance(what, cached_property):
                each.__dict__.pop(name, None)
