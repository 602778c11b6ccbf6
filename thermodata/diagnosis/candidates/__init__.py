"""What may be missing: the effects of the library on channels that they need, near to what is there or not.

Each as columns of a test at every point of a grid, made once and kept between rankings.
"""
