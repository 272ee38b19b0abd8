"""The verdict on a joint, and the sentence that says it; both follow the errors on held-out recordings."""

from collections.abc import Iterable, Sequence

from swgsim.common.numbers import significant
from swgsim.common.outcome import FOUND, NOTHING, UNKNOWN
from swgsim.joint.naming import enumerated, listed
from swgsim.joint.recording import SIGNALS
from swgsim.joint.regression import Fit
from swgsim.joint.shared import OfFriction
from swgsim.joint.term import Term
from swgsim.joint.textbook import unphysical
from swgsim.joint.validation import Validation

# Verdicts for effects that do not lower the error on the held-out recordings, and for a model that does not describe
# these.
NOT_CONFIRMED, FAILS = "not_confirmed", "textbook_fails"
# Share of the variance of the held-out signal that a model explains at least: it leaves less than it explains. Errors
# above the frequency SLOW are ignored, as they are not the textbook's.
LEAST_EXPLAINED = 0.5
# Sessions that a sentence names.
NAMED_SESSIONS = 4


def verdict(validation: Validation, remaining: Sequence[str]) -> str:
    """The verdict as one word."""
    if fails(validation):
        return FAILS
    if validation.ladder.steps:
        return FOUND if validation.helps else NOT_CONFIRMED
    return UNKNOWN if remaining else NOTHING


def fails(validation: Validation) -> bool:
    """Whether the model leaves more of the held-out signal than it explains, without and with effects; is certainly
    worse than a constant; or is beaten by one that no joint can have.
    """
    fits = validation.ladder.textbook, validation.ladder.top
    slow, whole = [validation.explained(fit, slowly=True) for fit in fits], [validation.explained(fit) for fit in fits]
    return (
        all(share.value < LEAST_EXPLAINED for share in slow)
        or all(share.value + share.half < 0 for share in whole)
        or all(_impossible(validation, fit) for fit in fits)
    )


def _impossible(validation: Validation, fit: Fit) -> bool:
    """Whether negative friction or inertia, or friction where none is, explains more of what a model leaves of the
    held-out signal than it leaves itself.
    """
    left, then = (1 - validation.explained(each, slowly=True).value for each in (fit, unphysical(fit)))
    return then < (1 - LEAST_EXPLAINED) * left


def sentence(validation: Validation, remaining: Sequence[str]) -> str:
    """The verdict in one sentence."""
    first, of = validation.table.recordings[0], SIGNALS[validation.table.of]
    where = f"{first.robot}, {first.joint.replace('_', ' ')}, {of.meaning}"
    more = "one regularity of the residual remains" if len(remaining) == 1 else f"{len(remaining)} regularities remain"
    rest = f"; {more} unexplained" if remaining else ""
    unsearched = [term for term in validation.ladder.unsearched if isinstance(term, OfFriction)]
    rest += f"; not searched, needs T_rigid: {_named(validation, unsearched)}" if unsearched else ""
    found = [step.term for step in validation.ladder.steps]
    before, after = validation.before.heldout, validation.after.heldout
    if fails(validation):
        more = f", and with {_named(validation, found)} {significant(after)} {of.unit}" if found else ""
        return (
            f"{where}: the textbook model does not describe these recordings; its error on recordings not seen is "
            f"{significant(before)} {of.unit}{more}, where the signal has a standard deviation of "
            f"{significant(validation.scatter)} {of.unit}{rest}."
        )
    if not found:
        return f"{where}: no effect of the library is accepted; the textbook model explains {_share(validation)}{rest}."
    change = changed(before, after, of.unit)
    them = "them" if found[1:] else "it"
    if not validation.helps:
        those = "the recordings that judge contradict" if after > before else "the recordings that judge do not confirm"
        return (
            f"{where}: {_named(validation, found)} {'fit' if found[1:] else 'fits'} the recordings of "
            f"{_sessions(validation)}, but {those} {them}: with {them} the error on recordings not seen {change}{rest}."
        )
    good, bad = ([step.term for step in steps] for steps in (validation.confirmed, validation.contradicted))
    against = ""
    if bad:
        were, raise_ = ("were", "raise") if bad[1:] else ("was", "raises")
        against = f"; {_named(validation, bad)} {were} found too, but {raise_} it"
        them = "all effects found"
    return (
        f"{where}: the textbook model lacks {_named(validation, good)}; with {them} the error on recordings not seen "
        f"{change}{against}{rest}."
    )


def changed(before: float, after: float, unit: str) -> str:
    """A change of an error in words, with as many digits as it needs."""
    if before == after:
        return f"stays at {significant(before)} {unit}"
    first, last = next(
        pair
        for digits in range(3, 18)
        if len(set(pair := (significant(before, digits), significant(after, digits)))) > 1
    )
    return f"{'falls' if after < before else 'rises'} from {first} to {last} {unit}"


def explained(validation: Validation) -> str:
    """What both models explain, in words."""
    share, more = validation.explained(validation.ladder.textbook), validation.explained(validation.ladder.top)
    effects = f", with the effects found {percent(more.value)}" if validation.ladder.steps else ""
    return f"{percent(share.value)} ± {percent(share.half)} of the variance of recordings not seen{effects}"


def percent(share: float) -> str:
    """A share in percent, with a digit more near 1.

    >>> percent(0.42), percent(0.9963), percent(-19.8)
    ('42 %', '99.6 %', '-1980 %')
    """
    return f"{100 * share:.1f} %" if 0.95 < share < 1 or 0 < share < 0.01 else f"{100 * share:.0f} %"


def _share(validation: Validation) -> str:
    return f"{percent(validation.explained(validation.ladder.textbook).value)} of the variance of recordings not seen"


def _named(validation: Validation, terms: Iterable[Term]) -> str:
    return listed(terms, validation.table.recordings[0].gear_ratio)


def _sessions(validation: Validation) -> str:
    """Sessions of the fitted recordings."""
    sessions = list(dict.fromkeys(each.session for each in validation.table.recordings))
    return f"{len(sessions)} sessions" if len(sessions) > NAMED_SESSIONS else enumerated(sessions)
