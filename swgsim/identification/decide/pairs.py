"""Two effects that hide one another, or together look like a third."""

from collections.abc import Sequence

from swgsim.common.seeds import generator
from swgsim.effects.base import Effect
from swgsim.identification.covariance.low_rank_covariance import as_squares
from swgsim.identification.decide.candidate import OWN, Trial, gain, open_to_much, tried
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import unbent
from swgsim.identification.search.refining import zoom
from swgsim.identification.search.shortlist import LEADERS, NEARLY, leaders, screened

# Log-likelihood that a pair must gain over the best effect alone; effects that are tried beside the leaders as they
# lead behind the first.
PAIR_GAIN, BEHIND = 15.0, 2


def paired(
    now: Fitted, start: Fitted, trials: Sequence[Trial], kinds: Sequence[type[Effect]], seed: int
) -> tuple[Trial, ...]:
    """Pairs with the best trial, or with the runner-up; the best pair first.

    With the runner-up where the best trial is not sound, and no pair with it is worth it: two effects at once may look
    like a third one.

    Parameters
    ----------
    now : Fitted
        The model without them.
    start : Fitted
        The same where fits begin.
    trials : sequence of Trial
        Single effects, the best one first.
    kinds : sequence of effect classes
        The library.
    seed : int
    """
    best = trials[0]
    pairs = _with(best, now, start, trials, kinds, seed)
    if best.sound or worth_it(pairs, best, now):
        return pairs
    second = _runner_up(trials)
    return _with(second, now, start, trials[1:], kinds, seed) if second else pairs


def _runner_up(trials: Sequence[Trial]) -> Trial | None:
    """The best of the others that are sound, if it is hardly worse than the very best."""
    return next((t for t in trials[1:] if t.sound and t.merit > (1 - NEARLY) * trials[0].merit), None)


def _with(
    first: Trial, now: Fitted, start: Fitted, trials: Sequence[Trial], kinds: Sequence[type[Effect]], seed: int
) -> tuple[Trial, ...]:
    """Pairs of one trial with the leading ones, and with what leads behind it."""
    beside = unbent(first.fitted)
    behind = leaders(screened(beside, kinds, generator("screen behind", seed)))[:BEHIND]
    leading = [trial for trial in trials if trial is not first][: LEADERS - 1]
    others = {type(effect): effect for trial in leading for effect in trial.effects}
    # What leads behind the first shows where it is only beside it.
    others |= {type(effect): effect for effect in (zoom(score, beside) for score in behind)}
    pairs = (
        tried(now, first.score, (*first.effects, effect), start)
        for kind, effect in others.items()
        if kind is not first.score.hypothesis.kind
    )
    return tuple(sorted(pairs, key=lambda pair: -pair.merit))


def worth_it(pairs: Sequence[Trial], alone: Trial, now: Fitted) -> Trial | None:
    """The best pair, if both of its members are sound together and it gains more than the best effect alone, enough of
    it as what its second member is.
    """
    best = pairs[0] if pairs else None
    asked = 2 * PAIR_GAIN  # of points left out and of all recordings: merit is the sum of both
    if best is None or not best.sound or best.merit <= alone.credit + asked:
        return None
    if not open_to_much(best.fitted, best.effects[1:]):
        return best
    own = best.explained(now) - gain(now, best.signature[:, :1])
    return best if own >= OWN * as_squares(best.evidence - alone.evidence) else None


def of_doubles(
    accepted: Trial, now: Fitted, start: Fitted, trials: Sequence[Trial], pairs: Sequence[Trial]
) -> tuple[Trial, ...]:
    """Pairs that were not tried: of what is as good as the first of one, with what adds as much as its second.

    Parameters
    ----------
    accepted : Trial
        One of the pairs.
    now : Fitted
    start : Fitted
    trials : sequence of Trial
        Single effects.
    pairs : sequence of Trial
        All with the same first effect.
    """
    one, other = map(type, accepted.effects)
    first = next(trial for trial in trials if type(trial.effects[0]) is one)
    doubles = (t for t in trials if t.pays and abs(t.merit - first.credit) < NEARLY * first.credit)
    near = NEARLY * (accepted.merit - first.credit)
    seconds = [pair.effects[1] for pair in pairs if pair.sound and accepted.merit - pair.merit < near]
    left = {
        frozenset((type(double.effects[0]), type(second))): (double, second)
        for double in doubles
        for second in seconds
        if type(double.effects[0]) not in (one, other, type(second))
    }
    return tuple(tried(now, double.score, (*double.effects, second), start) for double, second in left.values())
