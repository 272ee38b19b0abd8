"""What names of columns mean: words of the field in English and German, and those of common recorders and drives."""

import re
import unicodedata
from dataclasses import dataclass

from swgsim.drafting.seen import SeenColumn
from swgsim.drafting.units import quantity_of

# Words of a name, in small letters without accents. Whole words first, then beginnings and parts of compound words.
WORDS = {
    "time": "t time zeit timestamp stamp zeitstempel clock secs nsecs sec nanosec nsec elapsed uhrzeit datum date "
            "datetime x_value ts tijd",
    "angle": "q pos position angle winkel phi theta qm thetam encoder drehgeber lage istposition winkelposition joint_pos 6064h "
             "6064 6064hex positions pos_actual rotation drehwinkel angles",
    "speed": "qd dq qdot dqdt vel velocity speed omega wm dqm qdm omegam drehzahl geschwindigkeit n rpm w 606ch 606c velocities thetadot "
             "phidot istgeschwindigkeit winkelgeschwindigkeit nist speeds rate thetad",
    "torque": "torque tau drehmoment moment effort m md mom momente torques efforts nm kraftmoment",
    "current": "current strom i im iq amps cur motorstrom i_q 6078h 6078 6077h 6077 currents ampere",
    "gauge": "strain dehnung dms bridge brucke bruecke gauge sg dehnungsmessstreifen",
    "temperature": "temp temperature temperatur motortemperatur",
    "acceleration": "acc accel acceleration beschleunigung qdd ddq qddot",
    "voltage": "voltage spannung volt udc",
    "counter": "seq sample samples index count counter nr no number row id idx cycle messwert",
    "status": "status mode state error flag trigger frame name comment bemerkung fehler",
}  # fmt: skip
PARTS = {
    "time": ("zeit",),
    "angle": ("position", "winkel", "angle"),
    "speed": ("geschwindigkeit", "drehzahl", "velocity", "speed"),
    "torque": ("moment", "torque"),
    "current": ("strom", "current"),
    "gauge": ("strain", "dehnung", "brucke", "bridge"),
    "temperature": ("temperatur",),
    "acceleration": ("beschleunigung", "accel"),
}
# A value that was asked for, or the difference to it, not one that was measured.
SET = set(
    "target soll desired des cmd command commanded ref reference setpoint demand demanded set sollwert goal "
    "following error 607ah 607a 60ffh 60ff 6071h 6071 6062h 606bh".split()
)
MODEL = set("model rigid dynamics idyn gravity feedforward ff modell target".split())
MOTOR = set("motor mot motorseitig rotor qm thetam wm dqm qdm omegam im".split())
INPUT = set("in input antrieb eingang drive motor wg an wavegenerator fast mot ein".split())
OUTPUT = set("out output abtrieb ausgang load link last flange ab aus arm abtriebs joint".split())
# Behind these words stands the place of a channel, such as A, and no quantity.
CHANNEL = {"channel", "kanal", "ch", "chan", "input"}
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
        A key of :data:`WORDS`, or empty.
    words : tuple of str
    index : int or None
        The number in it, such as 4 of ``q[4]``.
    why : str
    """

    quantity: str
    words: tuple[str, ...]
    index: int | None
    why: str

    def says(self, words: set[str]) -> bool:
        """Whether one of some words is in it."""
        return bool(words & set(self.words))

    @property
    def is_set_point(self) -> bool:
        """Whether it is a value that was asked for."""
        wanted = self.words[-2:] in (("q", "d"), ("qd", "d"), ("tau", "d"))
        return wanted or self.says(SET) or any(word.startswith("soll") for word in self.words)


def meaning_of(column: SeenColumn) -> Meaning:
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
    for word in ("_".join(words[-2:]), *reversed(words)):
        if len(word) == 1 and CHANNEL & set(words):
            continue
        for quantity, known in WORDS.items():
            if word in known.split():
                return quantity, word
        for quantity, parts in PARTS.items():
            if any(part in word for part in parts):
                return quantity, word
    return "", ""
