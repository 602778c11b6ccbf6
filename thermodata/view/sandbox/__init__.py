"""SQL of somebody whom nobody watches: in a process of its own, on a copy, with limits, and with no way to a file.

`ask` starts the process; what runs in it is `child`, on the connection that `enclosed` makes, once `parse` agreed.
"""
