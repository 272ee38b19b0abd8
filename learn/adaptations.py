"""All adaptations by their names in ``conf/adaptation``."""

from collections.abc import Callable, Mapping

from learn.adversarial import DomainAdversarial
from learn.alignment import BatchNormAdaptation, Coral
from learn.fine_tuning import L2SP, FineTuning, LinearProbe, ProbeThenFineTuning, Replay
from learn.forest_transfer import AddedTrees, LeafRelabelling, StructureTransfer
from learn.prototypes import Prototypes
from learn.retraining import FromScratch
from learn.transfer import Adaptation


def probe_then_fine_tuning(
    probe_steps: int = 100, strength: float = 1e-3, steps: int = 100, rate: float = 1e-3
) -> ProbeThenFineTuning:
    """LP-FT with flat options."""
    return ProbeThenFineTuning(LinearProbe(probe_steps, strength=strength), FineTuning(steps, rate=rate))


ADAPTATIONS: Mapping[str, Callable[..., Adaptation]] = {
    "added_trees": AddedTrees,
    "batch_norm": BatchNormAdaptation,
    "coral": Coral,
    "domain_adversarial": DomainAdversarial,
    "fine_tuning": FineTuning,
    "from_scratch": FromScratch,
    "l2_sp": L2SP,
    "leaf_relabelling": LeafRelabelling,
    "linear_probe": LinearProbe,
    "probe_then_fine_tuning": probe_then_fine_tuning,
    "prototypes": Prototypes,
    "replay": Replay,
    "structure_transfer": StructureTransfer,
}
