"""Result of a test of one claim of the paper."""

from dataclasses import dataclass


def percent(share: float, sign: str = "") -> str:
    """A share in words, two digits; ``sign="+"`` always shows the sign.

    >>> percent(0.0123), percent(-0.68, "+")
    ('1.2 %', '-68 %')
    """
    return f"{100 * share:{sign}.2g} %" if abs(share) < 0.995 else f"{100 * share:{sign}.0f} %"


@dataclass(frozen=True)
class Finding:
    """A claim of the paper with our figure.

    Attributes
    ----------
    key : str
        C1 to C18, as numbered in the list of checkable claims.
    claim : str
        Statement of the paper.
    limit : str
        Condition under which the claim holds, with its reason.
    holds : bool
    figure : str
        Our figure, with its unit.
    note : str
        Physical cause of the figure, or reason why the claim does not hold.
    """

    key: str
    claim: str
    limit: str
    holds: bool
    figure: str
    note: str
