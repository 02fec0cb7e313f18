"""The scenes that the suite ships, and what can be said about scenes in general."""
