"""Models beside each other: by phase and test, with intervals, on tests left out, and on other machines."""
