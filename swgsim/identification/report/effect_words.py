"""Effects in the words of a sentence: title, size with its 95 % interval, gauge, order and direction."""

from collections.abc import Mapping, Sequence

from swgsim.common.numbers import significant
from swgsim.common.style import words
from swgsim.effects.base import Effect
from swgsim.effects.library import LIBRARY, named
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.effects.text import path_of
from swgsim.identification.report.engineering_units import Estimate, interval_text, parameter_words, value_text

# Sentences that say more than name and value; {parameter} stands for the value with its unit.
PHRASES = {
    "eccentric_wave_generator": "{r} off centre, towards {theta} from gauge s1, in the sense of rotation",
    "rotating_eccentricity": "{e} off centre, turning with the wave generator, {phase} ahead of the major axis",
    "tilted_wave_generator": "{tilt}, the open end towards {theta} from gauge s1, in the sense of rotation",
    "tilting_moment": "{strain} towards {theta} from gauge s1, in the sense of rotation",
    "root_tooth_crack": "{stiffness_ratio} of the stiffness remain, {theta} from gauge s1, in the sense of rotation",
    "tip_tooth_crack": "{force_loss} of the tooth force are lost, {theta} from gauge s1, in the sense of rotation",
    "worn_wave_generator": "{loss} of the deflection are lost",
    "cam_form": "{n} lobes with an amplitude of {amplitude}",
    "out_of_round": "{n} lobes with an amplitude of {amplitude}",
    "motor_pickup": "{p} pole pairs, amplitude {amplitude}",
    "mains_hum": "{amplitude} at {frequency}",
}
# Parameters that a sentence names besides size, gauge and order.
HARMONICS = ("n", "k", "p", "j", "frequency")
# Titles that differ from the registered name.
TITLES = {
    "grease_temperature": "a dependence of the grease on temperature",
    "gauge_factor_temperature": "a dependence of the gauge factor on temperature",
    "out_of_round": "an out-of-round flex spline",
    "gauge_direction": "rotated grids",
    "gauge_position": "shifted grids",
    "sub_orders": "sub-harmonics",
    "load_sharing": "a dependence of load sharing on the load",
}
# Titles that take no article, by their last word.
UNCOUNTABLE = (
    "crosstalk", "creep", "damping", "debonding", "drift", "clipping", "friction", "gears", "grease", "growth",
    "heating", "hum", "hysteresis", "mismatch", "motion", "nonlinearity", "orders", "output", "pickup", "preload",
    "runout", "settling", "sharing", "skew", "stiffness", "teeth", "thrust", "unbalance", "wear", "deformation",
    "coning",
)  # fmt: skip


def titled(name: str) -> str:
    """The title of an effect with its article.

    >>> titled("eccentric_wave_generator"), titled("warm_grease")
    ('an eccentric wave generator', 'warm grease')
    """
    title = TITLES.get(name) or named(name).title()
    if name in TITLES or title.split()[-1] in UNCOUNTABLE:
        return title
    return f"{'an' if title[0] in 'aeiou' else 'a'} {title}"


def plain_title(name: str) -> str:
    """The title of an effect without article; of an effect from outside the library, its name in words.

    >>> plain_title("stribeck_friction"), plain_title("my_effect")
    ('Stribeck friction', 'my effect')
    """
    return LIBRARY[name].title() if name in LIBRARY else words(name)


def effect_name(name: str, parameters: Mapping[str, Estimate]) -> str:
    """An effect without its size: title, gauge and order.

    >>> effect_name("motor_torque_ripple", {"order": {"value": 6.0, "unit": "-"}})
    'a motor torque ripple of order 6'
    """
    of = [f" of {value_text(name, 'sensor', parameters['sensor'])}"] if "sensor" in parameters else []
    if "order" in parameters:
        of.append(f" of order {significant(parameters['order']['value'])}")
    return titled(name) + "".join(of)


def effect_text(name: str, parameters: Mapping[str, Estimate]) -> str:
    """An effect for a sentence: what it is, its size with the 95 % interval, and where it is.

    Parameters
    ----------
    name : str
        Registered name or import path.
    parameters : mapping
        Estimates by the names of the parameters, as in ``report.json``.

    >>> ripple = {"order": {"value": 6.0, "unit": "-"}, "amplitude": {"value": 0.02, "unit": "N m"}}
    >>> effect_text("motor_torque_ripple", ripple)
    'a motor torque ripple of order 6: amplitude 0.02 N m'
    """
    size = size_of(named(name))
    texts = {parameter: value_text(name, parameter, each) for parameter, each in parameters.items()}
    interval = interval_text(name, size, parameters[size])
    texts[size] += f" (95 %: {interval})" if interval else ""
    if name in PHRASES:
        phrase = PHRASES[name].format(**texts)
    else:
        named_too = [each for each in HARMONICS if each in texts]
        phrase = ", ".join(f"{parameter_words(name, each)} {texts[each]}" for each in (*named_too, size))
    return f"{effect_name(name, parameters)}: {phrase}"


def effect_in_words(effect: Effect) -> str:
    """An effect at its parameters, without intervals, for a sentence."""
    return effect_text(path_of(type(effect)), _values(effect))


def names_in_words(effects: Sequence[Effect]) -> str:
    """Effects without their sizes, for a sentence."""
    return " and ".join(effect_name(path_of(type(effect)), _values(effect)) for effect in effects)


def _values(effect: Effect) -> dict[str, Estimate]:
    return {
        parameter: {"value": float(getattr(effect, parameter)), "ci95": None, "unit": q.unit}
        for parameter, q in quantities(type(effect)).items()
        if q.role is not Role.RANDOM
    }
