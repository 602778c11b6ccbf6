"""Effects that belong to tests and not to drivers: another program's prediction, another model's output."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping

from thermodata.errors import SpecError
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param
from thermodata.view.grid.dataset import TestData


class OfTests(ABC):
    """What a model file spells out by itself. One gain, 1 for the output as it is."""

    name = ""
    family = ""
    meaning = ""
    source = ""
    needs: tuple[Need, ...] = ()
    params: tuple[Param, ...] = ()
    gains: tuple[Gain, ...] = ()

    @abstractmethod
    def has(self, test: TestData) -> bool:
        """Whether there is an output for the test."""

    @abstractmethod
    def lacks(self, test: TestData) -> str:
        """Why there is none for a test that it does not have: behind 'T: no driver for X'."""

    @abstractmethod
    def column(self, test: TestData) -> Float2D:
        """shape (n, 1); NaN where there is no output."""

    def reads(self, test: TestData) -> tuple[str, ...]:
        """The channels that the output depends on."""
        return ()

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Raises SpecError: see `column`."""
        raise SpecError(
            f"a {self.name} belongs to tests, it has no drivers",
            hint="leave 'drivers' out of this effect",
        )
