"""A store in Python: what the commands do, as methods whose answers show themselves in a terminal and in a notebook.

`opened` is what `thermodata.open` gives; `fitted` a version of a model, `verdict` a diagnosis, `courses` and
`residuals` their answers, `figure` a plot. All that is computed is computed by the floors below; see docs/python.md.
"""
