"""A model on its data: effects bound to channels, and the frozen values that fitting makes of them.

`bound` is before the fit, `fitted_response` and `fitted` after it. They predict; nothing here searches.
"""
