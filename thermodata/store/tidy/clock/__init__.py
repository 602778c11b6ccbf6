"""The clocks of a test's sources on one time line, by what they declare, and by what each other's times say.

Imports `plan` and `rows`; no values: offsets that these tell are estimated in `clock_offsets`.
"""
