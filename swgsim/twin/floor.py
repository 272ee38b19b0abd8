"""The floor of a method that has references only: it knows the gear, but the level of its friction from references.

An oracle knows the level of the efficiency. A method with references has it as the torque flanges show it, each with
the bias of the session of the references.
"""

from swgsim.gear.gear import Gear
from swgsim.identification.data.model import Model, predict
from swgsim.oracle.model import Expectation
from swgsim.twin.fitted_gear import fit_gear
from swgsim.twin.knowledge import Knowledge
from swgsim.twin.parameters import parameters_of
from swgsim.twin.references import References
from swgsim.twin.revolution_features import RevolutionFeatures
from swgsim.twin.twin import Twin


def floor_of(knowledge: Knowledge, true: Model, references: References, expected: list[Expectation]) -> Twin:
    """The twin that has all of the true gear but b1 and further parameters, which it fits to the references.

    Parameters
    ----------
    knowledge : Knowledge
    true : Model
        The gear with its imperfections.
    references : References
        Of this gear.
    expected : list of Expectation
        Of the true gear; what faults change hardly depends on the level of its friction.
    """
    gear: Gear = true.gear
    start = Model(gear.with_transmission(b3=0.0), (*true.effects, *knowledge.plan.effects))
    of_unit = parameters_of(gear, knowledge.bench, further=knowledge.further)
    friction = {name: of_unit[name] for name in ("b1", *knowledge.further)}
    fitted = fit_gear(knowledge, references, start, friction, turns=1)
    layout = RevolutionFeatures(N=gear.transmission.N)
    was, found = predict([start, fitted.model], knowledge.situations, layout, knowledge.plan.sectors)
    moved = [
        Expectation(each.point, each.healthy + by, each.faults) for each, by in zip(expected, found - was, strict=True)
    ]
    return Twin.of(knowledge, fitted, moved)
