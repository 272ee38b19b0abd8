"""First drafts of column maps and sources, written by looking at the files; the reading itself never guesses."""

from swgsim.drafting.draft import draft_map
from swgsim.drafting.map_draft import MapDraft

__all__ = ["MapDraft", "draft_map"]
