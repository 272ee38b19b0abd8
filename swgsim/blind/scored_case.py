"""A case with its answer and its truth: correct and false names, and the cause of an error."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from swgsim.blind.families import family
from swgsim.blind.sealed import Sealed
from swgsim.blind.strata import NULLS, OUTSIDE_STRATA, PAIR, SINGLE, UNTESTABLE
from swgsim.common.outcome import NOTHING, UNKNOWN
from swgsim.effects.base import Effect
from swgsim.effects.quantity import beyond_nothing
from swgsim.effects.regularity import PATTERNS
from swgsim.identification.interharmonics.named_interharmonics import is_random

# Weights of patterns whose direction is the same differ by less than this.
SAME_DIRECTION = 1e-9
# An effect outside the library looks like one inside if that reproduces this share of its projected signature.
LOOK_ALIKE = 0.9
# An error that grew to no more than this many times itself is no worse: less would matter to nobody (an estimate).
WORSE = 1.05
RIGHT = "right"


@dataclass(frozen=True)
class ScoredCase:
    """One case.

    Attributes
    ----------
    case : Sealed
    answer : mapping
        As :func:`swgsim.blind.attempt.attempt` returns it.
    """

    case: Sealed
    answer: Mapping[str, Any]

    @property
    def failed(self) -> bool:
        """Whether there is no answer."""
        return "failure" in self.answer

    @property
    def null(self) -> bool:
        """Whether nothing is hidden."""
        return self.case.stratum in NULLS

    @property
    def known(self) -> bool:
        """Whether effects of the library are hidden that can be found."""
        return self.case.stratum in (SINGLE, PAIR) and self.case.detectable

    @property
    def outside(self) -> bool:
        """Whether something is hidden that the library lacks and that can be found."""
        return self.case.stratum in OUTSIDE_STRATA and self.case.detectable

    @property
    def look_alike(self) -> bool:
        """Whether a known effect reproduces nearly all that can be seen of the hidden one."""
        return self.case.likeness >= LOOK_ALIKE

    @cached_property
    def named(self) -> list[str]:
        """Effects of the answer, in order."""
        return [] if self.failed else [*self.answer["accepted"], *self.answer["lines"]]

    @cached_property
    def in_set(self) -> set[str]:
        """Effects of all answers of the credible set."""
        others = [] if self.failed else self.answer["alternatives"]
        return {*self.named, *(name for each in others for name in each["effects"])}

    @property
    def set_size(self) -> int:
        """Number of answers in the credible set."""
        return len(self.answer["alternatives"])

    @property
    def right(self) -> bool:
        """Whether the answer as a whole is correct: all that is hidden, and nothing else."""
        if self.failed:
            return False
        if self.case.stratum in OUTSIDE_STRATA:
            return self.none_of_the_above
        if self.first == "nothing":
            return not self.case.effects or self.case.stratum == UNTESTABLE
        return bool(self.named) and set(self.named) == set(self.case.names)

    @property
    def first(self) -> str:
        """The first named effect."""
        if self.failed:
            return "failure"
        return self.named[0] if self.named else "unknown" if self.answer["verdict"] == UNKNOWN else "nothing"

    @property
    def right_first(self) -> bool:
        """Whether the effect named first is hidden."""
        return self.first in self.case.names

    @property
    def right_family_first(self) -> bool:
        """Whether the effect named first is of the family of a hidden one."""
        return family(self.first) in {family(name) for name in self.case.names}

    @property
    def false(self) -> bool:
        """Whether something is named that is not hidden."""
        return not set(self.named) <= set(self.case.names)

    @property
    def right_in_set(self) -> bool:
        """Whether all that is hidden is in the set."""
        return set(self.case.names) <= self.in_set

    @property
    def none_of_the_above(self) -> bool:
        """Whether the answer is that something is missing that is in no library."""
        return self.first == "unknown"

    @property
    def reported_untestable(self) -> bool:
        """Whether the answer reports the hidden effects as absorbed or as below their detection limits."""
        return all(
            type(effect).name() in self.answer["absorbed"] or abs(beyond_nothing(effect)) < self._seen_from(effect)
            for effect in self.case.effects
        )

    def _seen_from(self, effect: Effect) -> float:
        """The reported detection limit of an effect; 0 if the answer has none, infinite if no size is detectable."""
        size = self.answer["seen_from"].get(type(effect).name(), 0.0)
        return np.inf if size is None else float(size)

    @property
    def nearest(self) -> str:
        """The first effect of the most probable answer with one, if only regularities were found."""
        return "" if self.failed else next(iter(self.answer["nearest"]), "")

    @property
    def described(self) -> tuple[bool, bool, bool]:
        """Whether order, pattern and law of the unknown effect are correct."""
        truth = self.case.described
        if truth is None or self.failed or not self.answer["unknown"]:
            return False, False, False
        order, pattern, law = self.answer["unknown"][0]
        return order == truth[0], _same(pattern, truth[1], truth[0]), law == truth[2]

    def over(self, first: str, second: str) -> float:
        """Ratio of two errors at unseen points."""
        return float(self.answer["error"][first] / self.answer["error"][second])

    @property
    def worse(self) -> bool:
        """Whether the identification increased the error at unseen points."""
        return self.over("after", "before") > WORSE

    @property
    def worse_with_truth(self) -> bool:
        """Whether the model with the true effects increased it too."""
        return self.over("oracle", "before") > WORSE

    @property
    def worse_where_recorded(self) -> bool | None:
        """Whether the reported error at left-out operating points increased; None with one operating point."""
        before, after = self.answer["heldout"]["before"], self.answer["heldout"]["after"]
        return None if before is None else after > WORSE * before

    @property
    def cause(self) -> str:
        """The cause of an error, or RIGHT."""
        if self.failed:
            return "no answer"
        if self.null or self.case.stratum == UNTESTABLE:
            return self._where_nothing_can_be_said()
        if self.case.stratum in OUTSIDE_STRATA:
            return self._outside()
        return self._inside()

    def _where_nothing_can_be_said(self) -> str:
        if self.answer["lines"] and not self.answer["accepted"]:
            return "false line between the orders"
        if self.named:
            return RIGHT if self.right_in_set and not self.false else "false effect"
        return RIGHT if self.answer["verdict"] == NOTHING else "false alarm: something unknown"

    def _outside(self) -> str:
        if self.none_of_the_above:
            return RIGHT
        if not self.named:
            return "unknown effect missed" if self.case.detectable else "unknown effect too weak"
        return "look-alike named for an unknown effect" if self.look_alike else "known effect named for an unknown one"

    def _inside(self) -> str:
        if self.right_first:
            if not self.right_in_set:
                return "second effect missed"
            return RIGHT if not self.false else "right, with a false extra effect"
        if self.first == "nothing":
            return "missed" if self.case.detectable else "too weak"
        if self.first == "unknown":
            near = "the right one" if self.nearest in self.case.names else self.nearest or "no effect"
            return f"called unknown, {near} nearest"
        return "right one is a rival" if self.right_in_set else "wrong effect named"

    @property
    def why(self) -> str:
        """The cause with the evidence for it."""
        hidden = " and ".join(
            f"{n} (strength {s:.3g})" for n, s in zip(self.case.names, self.case.strengths, strict=True)
        )
        about = f"{self.case.stratum}, {self.case.design}, {'' if self.case.commissioned else 'not '}commissioned"
        if self.failed:
            return f"{about}: {hidden or 'nothing'} hidden; no answer: {self.answer['failure']}"
        scores = ", ".join(f"{name} {gain:.3g}" for name, gain, _ in self.answer["scores"][:3])
        others = ", ".join(
            f"{' + '.join(each['effects']) or 'no effect'} {each['probability']:.2g}"
            for each in self.answer["alternatives"][:3]
        )
        parts = [f"named {', '.join(self.named) or self.first}", self._gains, f"scores {scores}", f"of {others}"]
        return f"{about}, {self.case.form}: {hidden or 'nothing'} hidden; {'; '.join(part for part in parts if part)}"

    @property
    def _gains(self) -> str:
        """Gain in log-likelihood by the answer, and by the fit with the true effects in their library form."""
        if not self.case.effects or any(is_random(type(effect)) for effect in self.case.effects):
            return ""  # effects with random phases are in neither fit
        of = self.answer["log_likelihood"]
        after, oracle = (of[name] - of["before"] for name in ("after", "oracle"))
        return f"log-likelihood {after:+,.1f}, with the true model {oracle:+,.1f}"


def _same(one: str, other: str, order: int) -> bool:
    """Whether two patterns have the same weights; a mean has their real parts only, so that some have two names.

    >>> _same("opposite in s1 and s3", "opposite in s1 and s3", 0), _same("in s1 alone", "in s2 alone", 0)
    (True, False)
    """
    if not {one, other} <= set(PATTERNS):
        return one == other
    a, b = ({name: complex(w) if order else complex(w).real for name, w in PATTERNS[p].items()} for p in (one, other))
    return all(abs(a.get(name, 0) - b.get(name, 0)) < SAME_DIRECTION for name in {*a, *b})
