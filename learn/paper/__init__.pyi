from .published_tables import paper_table

__all__ = [
    "paper_table",
]
