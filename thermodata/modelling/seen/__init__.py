"""A fitted model looked at, as a control engineer does: formulas, linear paths, profiles, and its residual."""
