"""What locked tests say of a claim: the error there without and with it, in two ways, and what that is worth."""

from __future__ import annotations

from dataclasses import dataclass

from thermodata.diagnosis.weigh.beyond_noise import fall_beyond

KEPT = 0.5  # share of what is added that must take away as much of the squared error as it is itself,
LEAST = 0.02  # and the least fall of the error;
MUCH = 0.25  # a fall of the error that is enough by itself,
PROBABLE = 0.5  # and so much log probability a sample: few slow tests can't tell a fall from half of it
# a fall of the error, in both ways, that no other mode of a known effect makes: in one of them these may act otherwise
OF_ITS_OWN = 0.75
# what is asked once others were refused: locked tests that are asked twice have to speak twice as loud
SECOND_LOOK = 0.5
# no claim makes the error of all locked tests so many times as large: it was 1.8 at most with the right ones of 330
# machines, and 23 where a wrong clock let samples count that are no measurement
SPOILS = 2.0
# what the fall of the error, as a share, adds to the odds' logarithm of a claim: by the known effects, free to act
# otherwise; by the model as it stands; and the level, so that less than causes mostly take away speaks against it
# (docs/method.md#confirming)
LOG_ODDS = (0.5, 1.9, -0.6)


@dataclass(frozen=True, slots=True)
class Foretold:
    """RMS on the locked tests that are asked, a free offset a test, in the response's unit. changed: of what the claims
    change. gained: log probability a sample that the claims add to these tests, given the open ones, in their noise.
    tests: the keys of those that are asked; None: all."""

    before: float
    after: float
    changed: float
    gained: float = 0.0
    tests: frozenset[tuple[str, str]] | None = None
    white: float = 0.0
    rows: int = 0

    @property
    def falls(self) -> bool:
        """Whether the error falls by as much as counts."""
        return self.after < (1 - LEAST) * self.before

    @property
    def fall(self) -> float:
        """Of the error, as a share; a rise to more than twice says no more than one to twice."""
        return max(fall_beyond(self.before, self.after, self.white, self.rows), -1.0)

    @property
    def holds(self) -> bool:
        """Whether the error falls by what a cause would take away. What a cause adds is not to be found in what is left
        afterwards, so the squared error falls by the square of what is added; a proxy's falls by less."""
        keeps = self.before**2 - self.after**2 >= KEPT * self.changed**2
        enough = keeps or self.after < (1 - MUCH) * self.before or self.gained >= PROBABLE
        return self.falls and enough

    def says(self, floor: float) -> bool:
        """Whether there is more to be foretold than what is left alone: else these tests excite nothing of it."""
        return max(self.before, self.after) > floor

    def spoils(self, floor: float) -> bool:
        """Whether the error becomes so much larger that something of what is added is none."""
        return self.says(floor) and self.after > SPOILS * self.before


@dataclass(frozen=True, slots=True)
class Looked:
    """The locked tests of one claim, beside all that is claimed with it, looked at in two ways. foretold: by the known
    effects, free to act otherwise as the noise has it. added: by the model as it stands, with the claim added; None
    where it can't predict them. floor: an error that is left alone. unit: of the response. together: all locked tests,
    whether anything acts there or not, by the model as it stands, without and with all that is asked, or with this one
    alone where one of them is enough to spoil them."""

    foretold: Foretold
    added: Foretold | None
    floor: float
    unit: str = "um"
    together: Foretold | None = None

    @property
    def saying(self) -> list[Foretold]:
        """Those of the two in which there is something to be foretold."""
        return [f for f in (self.foretold, self.added) if f is not None and f.says(self.floor)]

    @property
    def least(self) -> Foretold | None:
        """Of the ways that say something the one in which the error falls least; of all locked tests where it spoils
        these. None where nothing says anything."""
        return self.together if self.spoils else min(self.saying, key=lambda f: f.fall, default=None)

    @property
    def log_odds(self) -> float:
        """What they add to the odds' logarithm that the claim is the cause. Where one way says nothing, the other
        speaks for both; 0 where both say nothing."""
        said = self.saying
        if not said:
            return 0.0
        first, last = said[0], said[-1]
        by_foretold, by_added, level = LOG_ODDS
        return by_foretold * first.fall + by_added * last.fall + level

    @property
    def bears_out(self) -> bool:
        """Whether they speak for it, or say nothing."""
        return self.log_odds >= 0

    @property
    def of_its_own(self) -> bool:
        """Whether it takes away so much in both ways that it refines nothing of the model."""
        return len(self.saying) > 1 and all(f.fall >= OF_ITS_OWN for f in self.saying)

    @property
    def at_second_look(self) -> bool:
        """Whether they speak for it so loud, in each way that says anything, that it is no chance of a second look."""
        return bool(self.saying) and all(f.fall >= SECOND_LOOK for f in self.saying)

    @property
    def refuted(self) -> bool:
        """Whether the error falls in neither way, or that of all locked tests becomes twice as large."""
        return self.spoils or (bool(self.saying) and not any(f.falls for f in self.saying))

    @property
    def spoils(self) -> bool:
        """Whether all that is asked makes the locked tests so much worse that something of it is none."""
        return self.together is not None and self.together.spoils(self.floor)
