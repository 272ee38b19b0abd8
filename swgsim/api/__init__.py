"""The public interface: the functions of ``import swgsim as swg``, for one gear or one folder at a time."""

from swgsim.api.data_set import generate, record
from swgsim.api.identify import identify
from swgsim.api.simulate import SimulatedRun, simulate
from swgsim.drafting import MapDraft, draft_map

__all__ = ["MapDraft", "SimulatedRun", "draft_map", "generate", "identify", "record", "simulate"]
