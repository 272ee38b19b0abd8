"""All adaptations by their names in ``conf/adaptation``."""

from collections.abc import Callable, Mapping

from learn.adversarial import DomainAdversarial
from learn.alignment import BatchNormAdaptation, Coral
from learn.fine_tuning import L2SP, FineTuning, LinearProbe, ProbeThenFineTuning
from learn.forest_transfer import AddedTrees, LeafRelabelling, StructureTransfer
from learn.prototypes import Prototypes
from learn.retraining import FromScratch, PooledRetraining
from learn.transfer import Adaptation


def probe_then_fine_tuning(
    probe_steps: int = 100, strength: float = 1e-3, steps: int = 100, rate: float = 1e-3
) -> ProbeThenFineTuning:
    """LP-FT with flat options."""
    return ProbeThenFineTuning(LinearProbe(probe_steps, strength=strength), FineTuning(steps, rate=rate))


def replay(steps: int = 100, rate: float = 1e-3) -> FineTuning:
    """Fine-tuning with as many rows of the source gears in every batch."""
    return FineTuning(steps, rate=rate, replay=True)


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
    "pooled_retraining": PooledRetraining,
    "probe_then_fine_tuning": probe_then_fine_tuning,
    "prototypes": Prototypes,
    "replay": replay,
    "structure_transfer": StructureTransfer,
}
