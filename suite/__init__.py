"""The common ground of kbga-bench and the harness above it.

Planners arrive by entry point: nothing in this package imports ``kbga`` or ``baselines``.
"""

from suite.jit import use_cache_of_these_sources

use_cache_of_these_sources()
