"""What every command shares: its session, `--json`, tables as text, progress, Ctrl-C, completion after a Tab.

Imports no other room of the command line.
"""
