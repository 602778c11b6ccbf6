"""Both YAML parsers, in C and in Python, give the same document, the same lines and the same refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.errors import SpecError
from thermodata.schema.strict import lines

HERE = Path(__file__).parent
scalars = (
    st.integers()
    | st.floats(allow_nan=False)
    | st.booleans()
    | st.none()
    | st.text(max_size=20)
    | st.sampled_from(["2026-03-01", "1e5", "yes", "0x1f", "12:30", "Grd \u00b0C", "\u6e29\u5ea6", "~", "on"])
)
documents = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(min_size=1, max_size=8), inner, max_size=4),
    max_leaves=20,
)

assert lines.FastLoader is not None, "PyYAML without its C parser: the tests below would compare nothing"


def outcome(text: str) -> Any:
    try:
        found = lines.parse_document(text, Path("x.yaml"))
    except SpecError as error:
        return str(error)
    return found.data, found.line


def both(text: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Any, Any]:
    fast = outcome(text)
    with monkeypatch.context() as patch:
        patch.setattr(lines, "FastLoader", None)
        return fast, outcome(text)


@settings(max_examples=200, deadline=None)
@given(
    data=st.dictionaries(st.text(min_size=1, max_size=8), documents, min_size=1, max_size=4),
    flow=st.sampled_from([True, False, None]),
)
def test_any_document_is_the_same_to_both(data: dict[str, Any], flow: bool | None) -> None:
    text = yaml.safe_dump(data, default_flow_style=flow, allow_unicode=True)
    with pytest.MonkeyPatch.context() as monkeypatch:
        fast, slow = both(text, monkeypatch)
    assert fast == slow


@settings(max_examples=300, deadline=None)
@given(st.text(alphabet="ab:-[]{},&*!|>'\"#%@?\t \n0.\u00e9\ufeff", max_size=40))
def test_any_text_is_the_same_to_both(text: str) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        fast, slow = both("k: 1\n" + text, monkeypatch)
    assert fast == slow


@pytest.mark.parametrize(
    "text",
    [
        (HERE / "campaign.yaml").read_text(encoding="utf-8"),
        "a: 1\nb: 2\na: 3\n",
        "a: [1, 2\nb: 3\n",
        "a: &x [1]\nb: *x\n",
        "a: &x [*x]\n",
        "a: *nowhere\n",
        "a: !!python/object:os.system x\n",
        "a: 1\n---\nb: 2\n",
        "a:\n\t- 1\n",
        "- 1\n",
        "",
        "a: " + "[" * 70 + "]" * 70,
        "a: \x07\n",
        "\n".join(
            ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
            + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 9)]
        ),
    ],
)
def test_each_odd_text_is_the_same_to_both(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    fast, slow = both(text, monkeypatch)
    assert fast == slow


def test_brackets_without_end_are_refused_and_end_no_process() -> None:
    assert "nests too deep" in outcome("a: " + "[" * 200_000)
    assert isinstance(outcome("a: " + "- " * 100_000 + "x"), str)


@pytest.mark.parametrize(
    ("value", "hint"), [("%", 'put what begins with % in quotes, as "%"'), ("[", "the bracket that opens in line 2")]
)
def test_a_sign_that_needs_quotes_is_said_to(value: str, hint: str) -> None:
    with pytest.raises(SpecError, match=r"not valid YAML") as told:
        lines.parse_document(f"channels:\n  load: {{unit: {value}, at: axis.y}}\n", Path("c.yaml"))
    assert hint in (told.value.hint or "")
