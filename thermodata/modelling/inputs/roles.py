"""Which tests a model is fitted to, checked on, and kept away from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from thermodata.errors import SpecError, unknown_name
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

Key = tuple[str, str]


@dataclass(frozen=True)
class Roles:
    """Keys (campaign, test) by what they are used for; a test has one role."""

    calibrate: tuple[Key, ...]
    verify: tuple[Key, ...]
    locked: tuple[Key, ...]

    def role(self, key: Key) -> str:
        for name, keys in (("calibration", self.calibrate), ("verification", self.verify), ("locked", self.locked)):
            if key in keys:
                return name
        return "none"


def in_full(keys: Iterable[Key]) -> list[str]:
    """Tests as a model file names them, whatever its campaigns."""
    return ["/".join(key) for key in keys]


def resolve_roles(spec: Model, data: Dataset) -> Roles:
    """Named tests, else by the tests' own roles. SpecError where nothing is left to calibrate on or roles overlap."""
    explicit = {
        name: None if names is None else find_tests(names, data, name)
        for name, names in (("calibrate_on", spec.calibrate_on), ("verify_on", spec.verify_on), ("locked", spec.locked))
    }
    taken: dict[Key, str] = {}
    for name, keys in explicit.items():
        for key in keys or ():
            if taken.setdefault(key, name) != name:
                raise SpecError(
                    f"test '{'/'.join(key)}' has two roles",
                    where=f"{name}, model '{spec.name}'",
                    expected=f"it in one of {taken[key]} and {name}",
                    got=f"{taken[key]} and {name}",
                    hint="a locked or verification test is not fitted to",
                )

    def default(role: str) -> tuple[Key, ...]:
        return tuple(t.key for t in data.tests if t.role == role and t.key not in taken)

    named = [
        default(role) if explicit[name] is None else explicit[name] or ()
        for name, role in (("calibrate_on", "calibration"), ("verify_on", "verification"), ("locked", "locked"))
    ]
    if not named[0]:
        raise SpecError(
            "no test to calibrate on",
            where=f"calibrate_on, model '{spec.name}'",
            expected="calibrate_on: [...], or tests with role: calibration",
            got=", ".join(f"{t.test} ({t.role})" for t in data.tests) or "no tests at all",
            hint="name tests under calibrate_on in the model file, or give one 'role: calibration' in "
            "the campaign file",
        )
    return Roles(*named)


def fitted_keys(spec: Model, roles: Roles) -> tuple[Key, ...]:
    """The tests that a model is fitted to: its calibration tests, and verification tests that took part in the choice
    of its effects."""
    if not spec.in_sample:
        return roles.calibrate
    chosen_on = spec.in_sample_on
    taking = [k for k in roles.verify if chosen_on is None or "/".join(k) in chosen_on]
    return (*roles.calibrate, *taking)


def opened(roles: Roles, data: Dataset) -> tuple[Key, ...]:
    """The tests that their campaign locks and the model is fitted to, or checked on in every choice."""
    used = {*roles.calibrate, *roles.verify}
    return tuple(t.key for t in data.tests if t.role == "locked" and t.key in used)


def find_tests(names: Sequence[str], data: Dataset, where: str) -> tuple[Key, ...]:
    """Each as 'test', or 'campaign/test' where several campaigns have it."""
    keys: list[Key] = []
    for name in names:
        hits = [t.key for t in data.tests if name in (t.test, f"{t.campaign}/{t.test}")]
        if not hits:
            raise unknown_name("test", name, _choices(name, data), where=where)
        if len(hits) > 1:
            raise SpecError(
                f"test '{name}' is in several campaigns",
                where=where,
                expected=" or ".join("/".join(h) for h in hits),
                hint="name it with its campaign: campaign/test",
            )
        keys.append(hits[0])
    return tuple(dict.fromkeys(keys))


def _choices(name: str, data: Dataset) -> list[str]:
    """What a test may be called in place of an unknown name, so that it finds one test: of the campaign that the name
    says, where there is that, else of all."""
    campaign = name.partition("/")[0] if "/" in name else None
    own = ["/".join(t.key) for t in data.tests if t.campaign == campaign]
    if own:
        return own
    often = Counter(t.test for t in data.tests)
    return [t.test if often[t.test] == 1 else "/".join(t.key) for t in data.tests]
