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
ompl-rrt               RRT              one-shot  it has a path, and that is simplified
ompl-rrtconnect        RRTConnect       one-shot  it has a path, and that is simplified
ompl-fmt               FMT              one-shot  it has a path, or has no samples left (a setting)
ompl-bfmt              BFMT             one-shot  it has a path, or has no samples left (a setting)
(left out)             KPIECE1
(left out)             BKPIECE1
(left out)             LBKPIECE1
=====================  ===============  ========  ==============================================

How a budget stops them. Once its checks are spent, every motion is refused. Besides, the RRT*
family, BIT*, AORRTC and the one-shot planners ask in each iteration whether the run is over
(``watched``, ``oneshot``). PRM and PRM* would hang for ever with a question in Python: they get a
timed condition, which the collision check ends by a call (``roadmap``). An exception ends the
simplifier (``simplification``).

Left out: the KPIECE planners keep the free part of a motion that collides, and OMPL 2.0.1 never
asks a ``MotionValidator`` written in Python for that part. They would be other algorithms.

Not bound in the wheel 2.0.1: AIT*, EIT*, ABIT*, RRT#, RRTX, LazyPRM, LazyPRM*, SPARS, CForest,
TRRT, LazyRRT, LBTRRT, EST, BiEST, SBL, STRIDE, PDST.
"""
