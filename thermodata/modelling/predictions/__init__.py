"""Free-run predictions, on the tests of a fit or on other logs: as tables, with bands, and how well they do."""
