"""What was concluded of a signal, with what it rests on and what is left to ask."""

from __future__ import annotations

from dataclasses import dataclass

from thermodata.draft.signals.values import Values

NO_READING = "no reading"  # begins what is said of a column that nobody need be asked about
NOTHING = "quantity and unit?"  # begins what is asked of a signal of which neither name nor values say anything
OF_NONE = "none of the quantities"  # ends what is said of a column that holds what no channel does
OF_SENSOR = "a sensor's 4..20 mA?"  # begins the question for what such a signal measures


@dataclass(frozen=True, slots=True)
class Guess:
    """A channel as it would stand in a campaign file. quantity None: no quantity fits, `why_not` says why. unit None:
    none, or the file's own; instead_of: the file's, where `unit` replaces it. sure: what was concluded leaves no
    doubt; basis: what it rests on ('name', 'unit', 'values'); questions: what a person has to say."""

    quantity: str | None
    unit: str | None = None
    at: str | None = None
    axis: str | None = None
    sure: bool = False
    basis: tuple[str, ...] = ()
    questions: tuple[str, ...] = ()
    why_not: str | None = None
    instead_of: str | None = None

    @property
    def is_no_reading(self) -> bool:
        """Whether it is known to hold what no channel does: a time stamp, a count."""
        why = self.why_not or ""
        return self.quantity is None and (why.startswith(NO_READING) or why.endswith(OF_NONE))

    def comment(self) -> str:
        """'sure: name and unit', 'guess: name only', or '? at: where on the machine?'."""
        if self.quantity is None:
            return str(self.why_not) if (self.why_not or "").startswith(NO_READING) else f"? {self.why_not}"
        rests = " and ".join(self.basis)
        if self.questions:
            return f"? {', '.join(self.questions)}" + (f" ({rests})" if rests else "")
        if self.sure:
            return f"sure: {rests}"
        return f"guess: {rests}" + (" only" if len(self.basis) == 1 else "")


def range_text(values: Values | None) -> str:
    """Between which values a signal lies, in words."""
    if values is None:
        return "no values seen"
    return f"always {values.span()}" if values.constant else f"values {values.span()}"
