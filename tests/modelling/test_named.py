"""Which model is meant where none is named, and where models of several campaigns have the name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from thermodata.cli.app import cli
from thermodata.errors import UsageError
from thermodata.modelling import run
from thermodata.modelling.add import add
from thermodata.modelling.named import fit_named, name_taken_over, newest_model, of_which_campaign, of_which_version
from thermodata.notebook.opened import OpenStore
from thermodata.notebook.stale import GuessedModelWarning
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.dataset import Dataset

from .conftest import Spec, Stored


def test_where_none_is_named_it_is_the_one_fitted_last(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    first, other = (run.fit(store, spec("ambient_frame", name=name)).model for name in ("first", "other"))
    assert newest_model(store) == other
    assert fit_named(store, first).model == first
    assert newest_model(store) == first
    path = tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("role: verification", "role: calibration"))
    assert set(ingest(store, path).stale) == {first, other}
    assert newest_model(store) == first, "what changed is no fit"
    assert of_which_campaign(store, "first") is None


def test_a_name_of_two_versions_alike_in_number_is_said_with_both(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path, fits=[spec("ambient_frame")])
    base = newest_model(store)
    one, other = (add(store, base, name, plain=True).model for name in ("spindle_bearing", "feed_screw"))
    line = f"'base': {other}, the newest of that name; {one} is version 2 too, with other effects"
    assert of_which_version(store, "base") == line
    assert of_which_version(store, other) is None
    assert of_which_version(store, other[:6]) is None
    assert line in CliRunner().invoke(cli, ["--store", str(store.path), "history", "base"]).stderr


def test_a_fit_that_takes_a_name_from_a_longer_chain_says_so(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    """After a change of the data the first version is fitted anew, and its name leaves out what was added."""
    store = stored(world, tmp_path, fits=[spec("ambient_frame")])
    base = newest_model(store)
    assert name_taken_over(store, base) is None
    added = add(store, base, "feed_screw", plain=True).model
    assert (name_taken_over(store, base), name_taken_over(store, added)) == (None, None)
    path = tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("role: verification", "role: calibration"))
    assert set(ingest(store, path).stale) == {base, added}
    said = CliRunner().invoke(cli, ["--store", str(store.path), "fit", base])
    again = newest_model(store)
    line = (
        f"'base' is {again} now, version 1, the newest of that name; the chain that was made of it before is left at "
        f"{added}, version 2 with feed_screw"
    )
    assert again not in {base, added}
    assert line in said.stderr
    assert name_taken_over(store, again) == line


def test_a_name_of_several_campaigns_is_said_with_the_campaign(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    path = tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("id: c\n", "id: d\n"))
    ingest(store, path)
    one, other = (run.fit(store, spec("ambient_frame", campaign=name)).model for name in ("c", "d"))
    line = f"'base' of d: {other}, the newest of that name; there are others, of c: {one}"
    for ref, told in (("base", 1), (other, 0), (one[:6], 0)):
        said = CliRunner().invoke(cli, ["--store", str(store.path), "history", ref])
        assert (said.exit_code, said.stderr.count(line)) == (0, told)
    assert f"fitted last: {other} (base, d)" in CliRunner().invoke(cli, ["--store", str(store.path), "history"]).stderr
    # what makes versions or looks at locked tests guesses none, and takes the campaign before the name
    for words in ("fit base", "add base 1", "remove base 1", "confirm base", "diagnose base"):
        said = CliRunner().invoke(cli, ["--store", str(store.path), *words.split()])
        assert f"one of them: d/base ({other}) or c/base ({one})" in str(said.exception), words
    assert newest_model(store) == other
    assert fit_named(store, "c/base").model == one
    assert find_model(store, "d/base").model == other
    with pytest.raises(UsageError, match="no model 'e/base'"):
        find_model(store, "e/base")
    opened = OpenStore(store.path)
    with pytest.warns(GuessedModelWarning, match="there are others, of "):
        assert opened.model("base").id == other
    asked: list[Callable[[], object]] = [
        lambda: opened.diagnose("base"),
        lambda: opened.fit("base"),
        lambda: opened.add(1, "base"),
        lambda: opened.remove("1", "base"),
    ]
    for ask in asked:
        with pytest.raises(UsageError, match="several campaigns are called 'base'"):
            ask()
    assert opened.model("c/base").id == one


def test_a_campaign_before_a_name_leads_to_the_model_of_it_alone(
    stored: Stored, world: Dataset, spec: Spec, tmp_path: Path
) -> None:
    store = stored(world, tmp_path)
    path = tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("id: c\n", "id: d\n"))
    ingest(store, path)
    alone = run.fit(store, spec("ambient_frame", campaign="c")).model
    both = run.fit(store, spec("ambient_frame", campaign=None, campaigns=["c", "d"])).model
    assert [find_model(store, f"{of}/base").model for of in ("c", "d", "c,d", "d, c")] == [alone, both, both, both]
