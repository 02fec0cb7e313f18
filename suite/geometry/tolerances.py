"""The few tolerances of the suite, each with its reason. Predicates have none: they are exact."""

GRID_DECIMALS = 9
GRID = 1e-9
"""Coordinates of scenes are snapped to multiples of this (metres), in rooms of a metre or more that
lie no further from the origin than 262 km; elsewhere suite.geometry.coordinates says to what.

Two obstacles drawn to touch seldom touch in floating point: a vertex computed on a slanted edge
lies about 1e-14 beside it. Snapping closes such slits, and is 10,000 times finer than anything
that a robot could use."""

LARGEST = 1e9
"""Largest coordinate that a scene may have (metres). The exact predicates need products of two
coordinates without overflow; a scene beyond this has its unit or its origin wrong."""

OPTIMUM_RELATIVE = 1e-5
"""Published optimal lengths are printed with five or six digits; agreement can't be closer."""

COST_CLAIM_RELATIVE = 1e-6
"""How far a planner's own cost may lie from the referee's before the row says that they differ."""

HIT_DEPTH = 1000.0
"""How deep a robot must be in an obstacle to be hit by it, in widths of the scene's grid: a
micrometre near the origin. A robot that stops on its way along a slanted wall can't stand exactly
on it, and a moved obstacle is rounded where it is drawn anew: both are a thousandth of this.
Nothing that a robot could notice is less deep."""
