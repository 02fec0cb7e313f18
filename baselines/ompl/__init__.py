"""OMPL's planners: one adapter, one exact collision check, one declaration per planner."""
