"""The words for errors, each with one meaning on every page and in every command."""

from __future__ import annotations

_FROM_THE_OTHERS = (
    "foretold from the others: gains as they ask for them, effects free to act faster and slower than by one lag "
    "each, samples weighed by the noise that is left"
)

ERRORS = {
    "locked": "tests that no fit and no choice has seen; they are opened to confirm what is claimed or likely, "
    "and every look is counted; what a claim leaves there is foretold with one lag for each effect, and add tells it "
    "of the version that it makes",
    "left-out": f"each open test in turn, {_FROM_THE_OTHERS}; its level is free and all tests count alike, so a plain "
    "refit without it gives other figures",
    "verification": "tests that were kept out of the fit; once they helped to choose an effect they are fitted too, "
    "and say so, as do those that hold samples of a fitted test",
    "fitted": "calibration tests, which the model was fitted to: how well it bends to them, not how well it foretells",
}
"""From what a model has seen least to what it has seen most. The first that a page knows is its headline error."""

FITTED_TOO = "fitted too"
"""Beside a verification test that is none any more; in data and commands its role is 'verification (in-sample)'."""
IN_SAMPLE = "its verification tests helped to choose an effect, and are fitted too, or hold samples of a fitted test"
SEEN_SINCE = "beside a version that was not fitted to them, part of the change is that they are fitted now"
PARTS = f"parts of the open tests in turn, {_FROM_THE_OTHERS}"

_FIRST = "from its first samples (zero, 10 min unless the campaign says otherwise)"
LEVEL = f"level: the error of a calibration test is about a level fitted to it, that of any other counts {_FIRST}"
LEVEL_SENTENCE = f"{LEVEL[0].upper()}{LEVEL[1:]}."
PREDICTED_LEVEL = (
    f"level: the error of every test counts {_FIRST}; "
    "fit and compare take that of a calibration test about a level fitted to it"
)
HOW = (
    "Errors are root mean squares of measured minus model; the model runs freely, and each sample counts once. "
    f"{LEVEL_SENTENCE}"
)
NOISE = (
    "how far a mean of {length} scatters about its course by chance, which no model takes away; an error that keeps "
    "its sign for longer is no noise"
)


def explained(*words: str) -> str:
    """A line for each word, as commands print them below their tables."""
    return "\n".join(f"{word}: {ERRORS[word]}" for word in words)
