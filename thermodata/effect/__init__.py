"""Physical effects: where they are found, what they can be bound to, and the lag that most of them share.

An effect is a plugin (entry points of group `thermodata.effect`); see `thermodata.plugin.Effect`.
"""

from __future__ import annotations

from thermodata.effect.registry import all_effects, effect, effects, failed_effects

__all__ = ["all_effects", "effect", "effects", "failed_effects"]
