"""Drafts a campaign file from a folder that was never seen before: groups, guesses, and marked questions.

Each room stands on those above it:

- `words`: what words say, in the languages of labs: names taken apart, places, axes, roles, and the names of files;
- `signals`: what a signal is: its quantity, unit and place, by name, unit and values;
- `files`: one file: who reads it, what it leaves open, a sample of its values;
- `folder`: files together: into sources and tests, copies and parts, and the tables beside them;
- `times`: when tests were: dates and clocks; `probes`: jump tests, and which way a displacement points;
- `courses`: what recordings show of a test: its kind, what moved, when it measures;
- `campaign`: the draft as plain data, with what is asked;
- `writing`: the lines of the campaign file, answers put into them, a first model; `known`: logs of a known machine.

`make` writes the files of a folder with them; `look` is what `preview` adds to one file.
"""
