"""Registry of adaptations by their names in ``conf/adaptation``."""

from collections.abc import Callable, Mapping

from learn.adaptation.adversarial import DomainAdversarial
from learn.adaptation.alignment import BatchNormAdaptation, Coral
from learn.adaptation.fine_tuning import L2SP, FineTuning, LinearProbe, ProbeThenFineTuning, Replay
from learn.adaptation.forest_transfer import AddedTrees, LeafRelabelling, StructureTransfer
from learn.adaptation.prototypes import Prototypes
from learn.adaptation.retraining import FromScratch
from learn.adaptation.rezero import Rezero
from learn.adaptation.transfer import Adaptation


def probe_then_fine_tuning(
    probe_steps: int = 100, strength: float = 1e-3, steps: int = 100, rate: float = 1e-3
) -> ProbeThenFineTuning:
    """:class:`ProbeThenFineTuning` with flat options."""
    return ProbeThenFineTuning(LinearProbe(probe_steps, strength=strength), FineTuning(steps, rate=rate))


ADAPTATIONS: Mapping[str, Callable[..., Adaptation | Rezero]] = {
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
    "rezero": Rezero,
    "structure_transfer": StructureTransfer,
}
