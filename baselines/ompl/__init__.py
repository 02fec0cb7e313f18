"""OMPL's planners: one adapter, one exact collision check, one declaration per planner.

=====================  ===============  ========  ==============================================
plugin                 in the wheel     kind      ends with the budget, or when
=====================  ===============  ========  ==============================================
ompl-rrtstar           RRTstar          anytime   its path is the straight line
ompl-informedrrtstar   InformedRRTstar  anytime   its path is the straight line
ompl-sorrtstar         SORRTstar        anytime   its path is the straight line
ompl-bitstar           BITstar          anytime   its path is the straight line
ompl-aorrtc            AORRTC           anytime   its path is the straight line
ompl-prm               PRM              anytime
ompl-prmstar           PRMstar          anytime
ompl-shortcut          RRTConnect       anytime   its path is the straight line
ompl-rrt               RRT              one-shot  it has a path, and that is simplified
ompl-rrtconnect        RRTConnect       one-shot  it has a path, and that is simplified
ompl-fmt               FMT              one-shot  it has a path, or has no samples left (a setting)
ompl-bfmt              BFMT             one-shot  it has a path, or has no samples left (a setting)
(left out)             KPIECE1
(left out)             BKPIECE1
(left out)             LBKPIECE1
=====================  ===============  ========  ==============================================

How a budget stops them. OMPL looks at its own clock in each iteration, in compiled code. Checks and
CPU seconds are counted where Python is asked anyway, whether a motion is free: the answer ends
OMPL's condition by a call, and once the checks are spent, or the time is, every motion is refused
(``adapter``, ``collision``). An exception ends the simplifiers (``simplification``).

Python is asked for collisions only, and, by PRM and PRM*, for samples, so that growth can be paused
(``roadmap``). ``callback_share`` in a row is the share of its time that this took.

Rooms are scaled into the unit square without rounding (``units``). Settings are in metres.

Left out: the KPIECE planners keep the free part of a motion that collides, and OMPL 2.0.1 never
asks a ``MotionValidator`` written in Python for that part. They would be other algorithms.

Not bound in the wheel 2.0.1: AIT*, EIT*, ABIT*, RRT#, RRTX, LazyPRM, LazyPRM*, SPARS, CForest,
TRRT, LazyRRT, LBTRRT, EST, BiEST, SBL, STRIDE, PDST.
"""

from suite.errors import PluginError

try:
    import ompl  # noqa: F401
except ModuleNotFoundError as error:
    raise PluginError(
        "it needs the package ompl, which is made for Python 3.11 to 3.13. "
        "Install kbga-bench for one of these"
    ) from error
