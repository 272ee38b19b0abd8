"""A chain that is linear in the sizes of effects, for tests of the decision with fabricated Gaussian numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from loop_fixtures import Bump

from swgsim.effects import Effect
from swgsim.effects.regularity import Regularity
from swgsim.identification.data import model
from swgsim.identification.decide import decision, option
from swgsim.identification.fit import form_error, map_fit, shape_marginal
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import at_plausible_parameters
from swgsim.identification.fit.map_fit import calibrate
from swgsim.identification.fit.priors import of_effects
from swgsim.identification.search.regularities import Atom, columns


@dataclass(frozen=True)
class Dip(Bump):
    """Another effect."""


@dataclass(frozen=True)
class Mimic(Bump):
    """An effect that looks like a bump."""


@dataclass(frozen=True)
class Step(Bump):
    """One more effect."""


KINDS = (Bump, Dip, Mimic, Step)


def signatures_of(null: Fitted, rng: np.random.Generator) -> dict[type[Effect], np.ndarray]:
    """Change by every effect of size 1 (situation, feature), as large as the noise; a mimic is mostly a bump."""
    shape = (len(null.measured.situations), len(null.measured.layout))
    found: dict[type[Effect], np.ndarray] = {kind: rng.standard_normal(shape) for kind in KINDS}
    found[Mimic] = 0.95 * found[Bump] + 0.3 * found[Mimic]
    return found


def patch_chain(patch, null: Fitted, changes: Mapping[type[Effect], np.ndarray]) -> None:
    """Put a linear chain in the place of the real one. The null must have one recording of each operating point."""

    def change(effect: Effect) -> np.ndarray:
        if isinstance(effect, Regularity):
            C = columns(Atom(effect.order, effect.pattern, effect.law), null)
            cosine_sine = np.array([np.cos(effect.phase), -np.sin(effect.phase)])[: C.shape[1]]
            return effect.amplitude * (C @ cosine_sine).reshape(null.measured.values.shape)
        return effect.height * changes[type(effect)]

    def predict(models, situations, layout, *_, **__):
        nothing = np.zeros(null.measured.values.shape)
        return np.stack([sum(map(change, model.effects), start=nothing) for model in models])

    def extended(now: Fitted, added: Sequence[Effect]) -> Fitted:
        start, measured = now.unit.model.plus(*now.added, *added), now.measured
        parameters = of_effects(start)
        calibrated = calibrate(
            start, parameters, measured.values, now.of_nuisances, measured.situations, measured.of_recording,
            measured.layout,
        )  # fmt: skip
        return replace(now, parameters=parameters, calibrated=calibrated)

    for module in (model, map_fit, form_error, shape_marginal):
        patch.setattr(module, "predict", predict)
    for module in (option, decision):
        patch.setattr(module, "extended", extended)
    patch.setattr(decision, "fit", lambda measured, unit: replace(null, measured=measured))
    assert at_plausible_parameters(null) is null  # nothing of the unit is fitted
