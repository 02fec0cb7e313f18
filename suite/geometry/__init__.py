"""Plane geometry: exact predicates, collision kernels, and the arrangement that feeds them."""
