"""A second simulated machine: a slant-bed turning centre as rods and plates that conduct, convect and bend.

It shares no equation with the machine beside it nor with the library of effects: its causes are heat paths of its own
bodies, its sensors have other names, and its laboratory has habits (thin models, idle tests, coarse sensors).
`right_names` alone knows what the library calls a cause: it marks answers, and names what the model has.
"""
