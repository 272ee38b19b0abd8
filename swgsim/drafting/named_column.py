"""A column with what its name says."""

from dataclasses import dataclass

from swgsim.drafting.file_column import FileColumn
from swgsim.drafting.vocabulary import COMMON, MOTOR, OUTPUT, WORDS
from swgsim.drafting.words import Meaning

# Objects of drives (CiA 402) of the drive's own encoder.
OF_DRIVE = frozenset({"6064h", "606ch"})


@dataclass(frozen=True, eq=False)
class NamedColumn:
    """A column with what its name says."""

    column: FileColumn
    meaning: Meaning

    @property
    def index(self) -> int | None:
        """The number in the name."""
        return self.meaning.index

    @property
    def words(self) -> tuple[str, ...]:
        """The words that tell its joint from others, such as shoulder."""
        known = (COMMON, MOTOR, OUTPUT, *WORDS.values())
        return tuple(word for word in self.meaning.words if not any(word in words for words in known))

    @property
    def joint(self) -> int | tuple[str, ...]:
        """What its name says of its joint: a number, else words."""
        return self.words if self.index is None else self.index

    @property
    def at_motor(self) -> bool:
        """Whether it is on the motor's side of the gear by its name."""
        return self.meaning.says(MOTOR) or self.meaning.says(OF_DRIVE)
