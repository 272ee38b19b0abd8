"""What the name and the unit of a column say."""

import re
import unicodedata
from collections.abc import Set
from dataclasses import dataclass

from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.units import quantity_of
from swgsim.drafting.vocabulary import CHANNEL, PARTS, SET, WORDS

# Derivatives are written behind or before the name of an angle.
DOT = re.compile(r"(theta|phi|q)_?(dot|d)$|^(dot|d)_?(theta|phi|q)$")
CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
OBJECT = re.compile(r"(?i)(?<![0-9a-z])(0x)?(60[0-9a-f]{2})h?(?![0-9a-z])")


@dataclass(frozen=True)
class Meaning:
    """What a name says.

    Attributes
    ----------
    quantity : str
        A key of :data:`swgsim.drafting.vocabulary.WORDS`, or empty.
    words : tuple of str
    index : int or None
        The number in it, such as 4 of ``q[4]``.
    why : str
    """

    quantity: str
    words: tuple[str, ...]
    index: int | None
    why: str

    def says(self, words: Set[str]) -> bool:
        """Whether one of some words is in it."""
        return any(word in words for word in self.words)

    @property
    def is_set_point(self) -> bool:
        """Whether it is a value that was asked for."""
        wanted = self.words[-2:] in (("q", "d"), ("qd", "d"), ("tau", "d"))
        return wanted or self.says(SET) or any(word.startswith("soll") for word in self.words)


def meaning_of(column: FileColumn) -> Meaning:
    """What the name and the unit of a column say."""
    words, index = words_of(column.name)
    by_unit = quantity_of(column.unit)
    by_word, word = _quantity(words)
    if not by_word and column.file:
        # A file of one signal may call its column "value": then the name of the file says what it is.
        words, index = words_of(f"{column.file} {column.name}")
        by_word, word = _quantity(words)
    if words[-1:] == ("s",) and index in range(5):
        by_word, word = "gauge", f"s{index}"
    # A unit is more certain than a word: "M1 [A]" is a current.
    if by_unit and by_unit != by_word:
        return Meaning(by_unit, words, index, f"unit {column.unit}")
    return Meaning(by_word, words, index, f"name: {word}" if by_word else "")


def words_of(name: str) -> tuple[tuple[str, ...], int | None]:
    """The words of a name in small letters, and its number.

    >>> words_of("actual_q_0"), words_of("Joint_state.q[4]"), words_of("A1 Istposition")
    ((('actual', 'q'), 0), (('joint', 'state', 'q'), 4), (('a', 'istposition'), 1))
    """
    objects = [each[1].lower() + "h" for each in OBJECT.findall(name)]
    plain = OBJECT.sub(" ", name).replace("ß", "ss")
    plain = unicodedata.normalize("NFKD", plain).encode("ascii", "ignore").decode()
    plain = CAMEL.sub("_", plain)
    numbers = re.findall(r"\d+", plain)
    words = [word.lower() for word in re.findall(r"[A-Za-z]+", plain)]
    return (*words, *objects), int(numbers[-1]) if numbers else None


def _quantity(words: tuple[str, ...]) -> tuple[str, str]:
    """The quantity of the last word that has one: names say the place first, and the quantity then."""
    whole = "_".join(words)
    if DOT.search(whole):
        return "speed", whole
    # Two words may be one, such as i_q.
    both = "_".join(words[-2:])
    for word in (both, *reversed(words)):
        if len(word) == 1 and CHANNEL & set(words):
            continue
        for quantity, known in WORDS.items():
            if word in known:
                return quantity, word
        for quantity, parts in PARTS.items():
            if word != both and any(part in word for part in parts):
                return quantity, word
    return "", ""
