"""What packages offer before a module of theirs is read."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

import pytest

PACKAGES = ("chart", "modelling", "report", "store", "view", "virtual")


@pytest.mark.parametrize("name", PACKAGES)
def test_a_package_gives_all_that_it_names_and_nothing_else(name: str) -> None:
    package = import_module(f"thermodata.{name}")
    assert all(getattr(package, each) is not None for each in package.__all__)
    with pytest.raises(AttributeError, match=f"thermodata.{name}.*nothing_of_that_name"):
        _ = package.nothing_of_that_name


def test_a_package_alone_reads_none_of_its_modules() -> None:
    asked = "; ".join(f"import thermodata.{name}" for name in PACKAGES)
    shown = f"{asked}; import sys; print([m for m in sys.modules if m.count('.') == 2 and m.startswith('thermodata')])"
    assert subprocess.run([sys.executable, "-c", shown], capture_output=True, text=True, check=True).stdout == "[]\n"
