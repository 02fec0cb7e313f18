"""The knowledge-based genetic algorithm of Hu and Yang for robot path planning.

As a library, with obstacles as shapely polygons or as arrays of vertices, in metres::

    from kbga import KBGA, make_scene

    scene = make_scene("one wall", room, [wall], (start, goal))
    path = KBGA(scene, rng=1).run()

:class:`KBGA` shows how to set parameters, follow the generations, and get a table of them.

The paper, sentence by sentence
-------------------------------
Y. Hu and S. X. Yang, "A Novel Knowledge-Based Genetic Algorithm for Robot Path Planning in Complex
Environments", sections II-A to II-D, the parameters and the dynamic environments of III, and the
future work of V. Rows marked "ours" are choices where the paper is silent.

=====  ===============================================  ============================================
paper  what it says                                     what carries it out
=====  ===============================================  ============================================
II-A   the world is a continuous plane; an obstacle is  suite.scene.make_scene
       given by its vertices
II-A   obstacles hold the safety distance and the size  suite.scene.make_scene
       of the robot, which so is a point
II-A   grids numbered in sequence lie over the          kbga.encoding.make_lattice
       workspace, as fine as is wanted (Fig. 1)         KBGASettings.resolution
ours   a node is a crossing of grid lines, so that it   kbga.encoding.node_x
       can lie on the border and on walls               kbga.encoding.node_y
II-A   the grids touch neither obstacles nor start nor  suite.geometry.arrangement.arrange
       goal, and do not bind movement to cells          kbga.encoding.START
                                                        kbga.encoding.GOAL
II-A   a path: segments from the start over the nodes   kbga.encoding.path_of
       to the goal
II-A   a gene is a whole number, that of its node;      kbga.encoding.NODE
       start and goal keep their coordinates (Fig. 2)
II-A   a path is feasible if no node lies on an         kbga.evaluation.is_free_segment
       obstacle and no segment intersects one
ours   touching is free; a passage without width is     suite.geometry.kernels.segment_enters_part
       closed, and no node lies in a pinch point: so    suite.geometry.kernels.segment_slips_through
       every path found has paths with clearance        kbga.problem.is_usable
       beside it
II-A   chromosomes have from 2 to N_max nodes           kbga.encoding.Population
                                                        KBGASettings.max_nodes
ours   N_max: ample for the catalogue's most winding    KBGASettings.max_nodes
       optimum
II-B   the cost tells feasible from infeasible, and     kbga.evaluation.sum_up
       good from bad among either
II-B   Eq. (1): the sum over the segments of length     kbga.evaluation.sum_up
       and C times depth of collision
ours   C: KBGA comes out alike over two decades; the    KBGASettings.penalty
       plain GA wants it large
II-B   Eq. (2): the depth is 0 for a feasible segment,  kbga.evaluation.evaluate_segment
       else the sum over the obstacles that it
       intersects
II-B   Fig. 3(a): the depth in an obstacle is the       kbga.evaluation.escape_distance
       shortest shift that frees the segment
ours   the shift is square to the segment; one without  kbga.evaluation.escape_distance
       length leaves the group's box by the nearest
       side
II-B   Fig. 3(b): a shorter shift that is not enough    kbga.evaluation.escape_distance
       to get away does not count
II-B   Fig. 3(c): where the obstacle is joined to the   kbga.evaluation.escape_distance
       wall is a dead end; only the other side counts
ours   a joint ahead of the segment or behind it is     kbga.evaluation.escape_distance
       no dead end
ours   dead ends on both sides: both ways together,     kbga.evaluation.escape_distance
       deeper than either
II-B   Fig. 3(d): the depths in several obstacles add   kbga.evaluation.evaluate_segment
       up
II-B   a segment against a convex obstacle: a simple    suite.geometry.kernels.segment_enters_part
       test (the paper cites Pavlidis)
ours   separating axes with exact orientation: decided  suite.geometry.predicates.orientation
       without tolerance
II-B   any other obstacle is a group of convex ones,    suite.geometry.arrangement.arrange
       with what connects them
ours   Delaunay triangles are merged while they stay    suite.geometry.arrangement.arrange
       convex; obstacles that touch are one group
II-B   each group has a min-max box (MMG), each convex  suite.geometry.kernels.ObstacleArrays
       obstacle in it another (MMO)
II-B   no MMG met: free; else it hits a group if and    suite.geometry.kernels.next_entry
       only if it hits a convex obstacle of it, MMO
       first
ours   the boxes hang in a tree: time grows slowly      suite.geometry.kernels.next_entry
       with the number of obstacles
II-B   the depth is found with the group's vertices     kbga.evaluation.escape_distance
       and connections
II-B   infeasible paths are penalised, but stay in the  kbga.selection.tournament
       population
II-B   by C, costs of feasible and infeasible paths     KBGASettings.penalty
       may overlap
II-B   evaluation records feasibility, the number of    kbga.encoding.NODE
       infeasible segments, and which obstacles each    kbga.encoding.CHROMOSOME
       of them intersects
ours   a few obstacles are noted for each segment: a    kbga.encoding.MAX_HITS
       repair needs one, and all count for the depth
II-B   operators use these records without computing    kbga.encoding.copy_chromosome
       them again                                       kbga.encoding.open_column
                                                        kbga.encoding.close_columns
ours   segments tried and left are remembered too, so   kbga.memory
       that none is checked twice
II-C   five operators with knowledge of the problem,    kbga.operators
       some with a small local search (Fig. 4)
II-C   crossover: a random node of either parent; the   kbga.operators.crossover.crossover
       parts after them change places
II-C   ... the part between two equal nodes of a child  kbga.operators.crossover.crossover
       is deleted
II-C   ... the sites differ, so lengths vary            kbga.operators.crossover.crossover
ours   only intermediate nodes are chosen; no           kbga.operators.crossover.crossover
       crossover where a child would exceed N_max
II-C   mutation: a random node gives way to one that    kbga.operators.mutation.mutate
       is not in the path; it may get worse
II-C   repair: a node is inserted into an infeasible    kbga.operators.repair.repair
       segment
II-C   ... the best one, by a local search in the       kbga.operators.repair.repair
       grids neighbouring the intersected obstacle      kbga.operators.detour
ours   those next to its corners, where shortest paths  kbga.problem.make_problem
       bend; so many of them are tried; of several      KBGASettings.repair_candidates
       obstacles hit, a random one; the best is taken
       though it cost more than before
ours   a repair makes a path longer: one that is too    KBGASettings.repair_limit
       long already is left as it is
II-C   deletion: for feasible and infeasible paths; a   kbga.operators.deletion.delete
       random node and its two neighbours
II-C   ... deleted if that is beneficial: the path      kbga.operators.deletion.delete
       gets feasible or costs less
ours   a feasible path stays feasible, though a cut     kbga.operators.deletion.delete
       through an obstacle may cost less; a node found  kbga.encoding.NEEDED_IF_FEASIBLE
       needed is not drawn again until a neighbour      kbga.encoding.NEEDED
       changes
II-C   improvement: for feasible paths; a random node   kbga.operators.improvement.improve
       moves to a better place, by a local search in
       the neighbouring grids
ours   the search goes on from each better place, its   kbga.operators.improvement.improve
       steps doubled or halved up to a longest one, to  KBGASettings.improvement_radius
       get far in few checks; a node at rest is not
       drawn again until a neighbour changes
II-C   operators fire by probability and by heuristic   kbga.evolution.next_children
       knowledge
II-D   the first population is random, and evaluated    kbga.evolution.first_population
       by Eq. (1) (Fig. 5)
ours   the number of nodes is random too, up to a       KBGASettings.initial_nodes
       most: few, as each may make a collision
II-D   its best is the best so far, which each          KBGA.lowest_cost
       generation updates                               KBGA.step
ours   beside it the best feasible path, which alone    KBGA.best_path
       is returned: a robot can use no other            KBGA.best_cost
II-D   parents are selected by tournament               kbga.selection.tournament
ours   of two, the smallest there is                    KBGASettings.tournament_size
II-D   of two parents, one or more operators make two   kbga.evolution.next_children
       children; so for the whole population
ours   crossover, mutation, then rounds of repair,      kbga.evolution.next_children
       deletion and improvement, so that a child on a   KBGASettings.rounds
       new route lives until it is repaired
II-D   children replace parents; the best parent takes  kbga.selection.keep_elite
       the place of the worst child
II-D   the end: a number of generations is over, or     KBGA.run
       the best has not changed for so many; the best   KBGA.stagnant
       so far is the solution                           KBGASettings.max_generations
                                                        KBGASettings.stagnation
ours   both numbers; and the best counts as unchanged   KBGASettings.max_generations
       only once it is feasible: before, more           KBGASettings.stagnation
       generations are all that helps
II-D   a dynamic environment: what is sensed is         kbga.plugin.KBGAReplanner
       checked after a period                           suite.planner.Replanner.update
II-D   if the environment changed, the population is    KBGA.go_on
       kept and evaluated again in the new one          kbga.dynamic.restart
II-D   ... and mutated with a high rate, against its    kbga.dynamic.disturb
       low diversity                                    KBGASettings.change_mutation_probability
ours   at the rate of the other operators, once; the    KBGASettings.change_mutation_probability
       best is spared, so that a change elsewhere       kbga.dynamic.disturb
       leaves its path as it is
II-D   from then on it evolves for the new environment  KBGA.run
ours   until the same stop criteria, counted from the   KBGA.go_on
       change; the best feasible path is put first, as  kbga.dynamic.put_path
       cheaper infeasible ones may have driven it out
III    population size 50                               KBGASettings.population_size
III    mutation with probability 0.2 per chromosome     KBGASettings.mutation_probability
III    0.9 for all the other operators                  KBGASettings.crossover_probability
                                                        KBGASettings.repair_probability
                                                        KBGASettings.deletion_probability
                                                        KBGASettings.improvement_probability
ours   crossover per pair of parents, the others per    kbga.evolution.next_children
       child and round
III    tournament selection and elitism                 kbga.selection
III    grids of 100 x 100 units                         KBGASettings.resolution
III    "generations needed"                             KBGA.generation_of_best
ours   the generation in which the final best was       KBGA.generation_of_best
       found first
III    a moving robot: its place is the new start,      KBGA.go_on
       and the path is adjusted to it (III-D)           kbga.dynamic.restart
ours   nodes that it has passed are dropped: those      kbga.dynamic.restart
       before the place where it is nearest to a path
V      future work: a first population built with       KBGASettings.informed_share
       knowledge of the domain                          kbga.evolution.first_population
V      future work: probabilities of the operators      KBGASettings.adaptation_rate
       tuned on-line                                    kbga.tuning.tuned
=====  ===============================================  ============================================
"""

from kbga.algorithm import KBGA
from kbga.measures import GenerationReport
from kbga.settings import KBGAPlusSettings, KBGASettings
from suite.scene import make_scene

__all__ = ["KBGA", "GenerationReport", "KBGAPlusSettings", "KBGASettings", "make_scene"]
