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
future work of V. A row with a section is what the paper says. "silent": the paper is, and both
planners have this choice. "kbga": a choice of the paper's algorithm as we read it, and found by the
search in results/readings. "plus": what only kbga-plus does, our own.

=======  ============================================  ============================================
paper    what it says                                  what carries it out
=======  ============================================  ============================================
II-A     the world is a continuous plane; an obstacle  suite.scenes.scene.make_scene
         is given by its vertices
II-A     obstacles hold the safety distance and the    suite.scenes.scene.make_scene
         size of the robot, which so is a point
II-A     grids numbered in sequence lie over the       kbga.encoding.make_lattice
         workspace, as fine as is wanted (Fig. 1)      KBGASettings.resolution
silent   a node is a crossing of grid lines, so that   kbga.encoding.node_x
         it can lie on the border and on walls         kbga.encoding.node_y
silent   where the workspace is no upright square: a   kbga.encoding.make_lattice
         unit is a square, and as many make up its     kbga.problem.node_at
         area; nodes outside it do not exist
II-A     the grids touch neither obstacles nor start   suite.geometry.arrangement.arrange
         nor goal, and do not bind movement to cells   kbga.encoding.START
                                                       kbga.encoding.GOAL
II-A     a path: segments from the start over the      kbga.encoding.path_of
         nodes to the goal
II-A     a gene is a whole number, that of its node;   kbga.encoding.NODE
         start and goal keep their coordinates (Fig.
         2)
II-A     a path is feasible if no node lies on an      kbga.evaluation.is_free_segment
         obstacle and no segment intersects one
silent   touching is free; a passage without width is  suite.geometry.kernels.segment_enters_part
         closed, and no node lies in a pinch point:    suite.geometry.kernels.segment_slips_through
         so every path found has paths with clearance  kbga.problem.is_usable
         beside it
II-A     chromosomes have from 2 to N_max nodes        kbga.encoding.Population
                                                       KBGASettings.max_nodes
silent   N_max: ample for the catalogue's most         KBGASettings.max_nodes
         winding optimum
II-B     the cost tells feasible from infeasible, and  kbga.evaluation.sum_up
         good from bad among either
II-B     Eq. (1): the sum over the segments of length  kbga.evaluation.sum_up
         and C times depth of collision
kbga     C: a reading, see results/readings            KBGASettings.penalty
plus     C: 100; it comes out alike over two decades   KBGAPlusSettings.penalty
II-B     Eq. (2): the depth is 0 for a feasible        kbga.evaluation.evaluate_segment
         segment, else the sum over the obstacles
         that it intersects
II-B     Fig. 3(a): the depth in an obstacle is the    kbga.evaluation.escape_distance
         shortest shift that frees the segment
silent   the shift is square to the segment; one       kbga.evaluation.escape_distance
         without length leaves the group's box by the
         nearest side
II-B     Fig. 3(b): a shorter shift that is not        kbga.evaluation.escape_distance
         enough to get away does not count
II-B     Fig. 3(c): where the obstacle is joined to    kbga.evaluation.escape_distance
         the wall is a dead end; only the other side
         counts
silent   a joint ahead of the segment or behind it is  kbga.evaluation.escape_distance
         no dead end
silent   dead ends on both sides: both ways together,  kbga.evaluation.escape_distance
         deeper than either
II-B     Fig. 3(d): the depths in several obstacles    kbga.evaluation.evaluate_segment
         add up
II-B     a segment against a convex obstacle: a        suite.geometry.kernels.segment_enters_part
         simple test (the paper cites Pavlidis)
silent   separating axes with exact orientation:       suite.geometry.predicates.orientation
         decided without tolerance
II-B     any other obstacle is a group of convex       suite.geometry.arrangement.arrange
         ones, with what connects them
silent   Delaunay triangles are merged while they      suite.geometry.arrangement.arrange
         stay convex; obstacles that touch are one
         group
II-B     each group has a min-max box (MMG), each      suite.geometry.kernels.ObstacleArrays
         convex obstacle in it another (MMO)
II-B     no MMG met: free; else it hits a group if     suite.geometry.kernels.next_entry
         and only if it hits a convex obstacle of it,
         MMO first
silent   the boxes hang in a tree: time grows slowly   suite.geometry.kernels.next_entry
         with the number of obstacles
II-B     the depth is found with the group's vertices  kbga.evaluation.escape_distance
         and connections
II-B     infeasible paths are penalised, but stay in   kbga.selection.tournament
         the population
II-B     by C, costs of feasible and infeasible paths  KBGASettings.penalty
         may overlap
II-B     evaluation records feasibility, the number    kbga.encoding.NODE
         of infeasible segments, and which obstacles   kbga.encoding.CHROMOSOME
         each of them intersects
silent   a few obstacles are noted for each segment:   kbga.encoding.MAX_HITS
         a repair needs one, and all count for the
         depth
II-B     operators use these records without           kbga.encoding.copy_chromosome
         computing them again                          kbga.encoding.open_column
                                                       kbga.encoding.close_columns
silent   segments tried and left are remembered too,   kbga.memory
         so that none is computed twice; asking again  kbga.counter
         is a check all the same
II-C     five operators with knowledge of the          kbga.operators
         problem, some with a small local search
         (Fig. 4)
II-C     crossover: a random node of either parent;    kbga.operators.crossover.crossover
         the parts after them change places
II-C     ... the part between two equal nodes of a     kbga.operators.crossover.crossover
         child is deleted
II-C     ... the sites differ, so lengths vary         kbga.operators.crossover.crossover
silent   only intermediate nodes are chosen; no        kbga.operators.crossover.crossover
         crossover where a child would exceed N_max
II-C     mutation: a random node gives way to one      kbga.operators.mutation.mutate
         that is not in the path; it may get worse
II-C     repair: a node is inserted into an            kbga.operators.repair.repair
         infeasible segment
II-C     ... the best one, by a local search in the    kbga.operators.repair.repair
         grids neighbouring the intersected obstacle   kbga.operators.detour
kbga     the free nodes next to its corners, or all    kbga.problem.near_count
         within reach of its boundary; so many of      KBGASettings.repair_reach
         them are tried; whether a repair that costs   KBGASettings.repair_candidates
         more is kept; of several obstacles hit, a     KBGASettings.repair_must_help
         random one
plus     all of them are tried, 200 at the most        KBGAPlusSettings.repair_candidates
plus     a repair makes a path longer: one that is     KBGAPlusSettings.repair_limit
         too long already is left as it is             KBGASettings.repair_limit
II-C     deletion: for feasible and infeasible paths;  kbga.operators.deletion.delete
         a random node and its two neighbours
II-C     ... deleted if that is beneficial: the path   kbga.operators.deletion.delete
         gets feasible or costs less
silent   a feasible path stays feasible, though a cut  kbga.operators.deletion.delete
         through an obstacle may cost less
plus     a node found needed is not drawn again until  KBGASettings.remembers
         a neighbour changes                           kbga.encoding.NEEDED_IF_FEASIBLE
                                                       kbga.encoding.NEEDED
II-C     improvement: for feasible paths; a random     kbga.operators.improvement.improve
         node moves to a better place, by a local
         search in the neighbouring grids
kbga     the best of the eight neighbours, one step    kbga.operators.improvement.improve
         or as far as it helps                         KBGASettings.improvement_radius
plus     the search goes on from each better place,    KBGAPlusSettings.improvement_radius
         its steps doubled or halved up to a longest   KBGAPlusSettings.remembers
         one; a node at rest is not drawn again until
         a neighbour changes
II-C     operators fire by probability and by          kbga.evolution.next_children
         heuristic knowledge
II-D     the first population is random, and           kbga.evolution.first_population
         evaluated by Eq. (1) (Fig. 5)
kbga     the number of nodes is random too, up to      KBGASettings.initial_nodes
         eight
plus     up to four                                    KBGAPlusSettings.initial_nodes
II-D     its best is the best so far, which each       KBGA.lowest_cost
         generation updates                            KBGA.step
silent   beside it the best feasible path, which       KBGA.best_path
         alone is returned: a robot can use no other   KBGA.best_cost
II-D     parents are selected by tournament            kbga.selection.tournament
kbga     of five                                       KBGASettings.tournament_size
plus     of two                                        KBGAPlusSettings.tournament_size
II-D     of two parents, one or more operators make    kbga.evolution.next_children
         two children; so for the whole population
kbga     crossover, mutation, then two rounds of the   kbga.evolution.next_children
         specialised operators that suit the child     KBGASettings.one_operator
                                                       KBGASettings.rounds
plus     eight rounds of repair, deletion and          KBGAPlusSettings.rounds
         improvement, so that a child on a new route
         lives until it is repaired
II-D     children replace parents; the best parent     kbga.selection.keep_elite
         takes the place of the worst child
II-D     the end: a number of generations is over, or  KBGA.run
         the best has not changed for so many; the     KBGA.stagnant
         best so far is the solution                   KBGASettings.max_generations
                                                       KBGASettings.stagnation
silent   both numbers; and the best counts as          KBGASettings.max_generations
         unchanged only once it is feasible: before,   KBGASettings.stagnation
         more generations are all that helps
II-D     a dynamic environment: what is sensed is      kbga.plugin.KBGAReplanner
         checked after a period                        suite.planner.Replanner.update
II-D     if the environment changed, the population    KBGA.go_on
         is kept and evaluated again in the new one    kbga.dynamic.restart
II-D     ... and mutated with a high rate, against     kbga.dynamic.disturb
         its low diversity                             KBGASettings.change_mutation_probability
silent   at the rate of the other operators, once;     KBGASettings.change_mutation_probability
         the best is spared, so that a change          kbga.dynamic.disturb
         elsewhere leaves its path as it is
II-D     from then on it evolves for the new           KBGA.run
         environment
silent   until the same stop criteria, counted from    KBGA.go_on
         the change; the best feasible path is put
         first, as cheaper infeasible ones may have
         driven it out
III      population size 50                            KBGASettings.population_size
III      mutation with probability 0.2 per chromosome  KBGASettings.mutation_probability
III      0.9 for all the other operators               KBGASettings.crossover_probability
                                                       KBGASettings.repair_probability
                                                       KBGASettings.deletion_probability
                                                       KBGASettings.improvement_probability
silent   crossover per pair of parents, the others     kbga.evolution.next_children
         per child and round
III      tournament selection and elitism              kbga.selection
III      grids of 100 x 100 units                      KBGASettings.resolution
III      "generations needed"                          KBGA.generation_of_best
kbga     the generation in which the final best was    KBGASettings.generations_counted
         found first, or the last one                  KBGA.generation_of_best
III      a moving robot: its place is the new start,   KBGA.go_on
         and the path is adjusted to it (III-D)        kbga.dynamic.restart
silent   nodes that it has passed are dropped: those   kbga.dynamic.restart
         before the place where it is nearest to a
         path
V        future work: a first population built with    KBGASettings.informed_share
         knowledge of the domain                       kbga.evolution.first_population
V        future work: probabilities of the operators   KBGASettings.adaptation_rate
         tuned on-line                                 kbga.tuning.tuned
plus     sharp corners of obstacles are nodes too      KBGASettings.corner_nodes
                                                       kbga.problem.near_count
plus     feasible paths are pulled taut, and leave     KBGASettings.taut
         the lattice for corners                       kbga.taut.pull_taut
plus     new random chromosomes, while nothing better  KBGASettings.immigrants
         is found
plus     the lattice lies over what can be reached,    KBGASettings.lattice_over
         and is a finer one                            KBGASettings.resolution
                                                       suite.scenes.reach.reachable_bounds
plus     that there is no way is told at once          KBGASettings.proves
                                                       suite.scenes.reach.no_way
=======  ============================================  ============================================
"""

from kbga.algorithm import KBGA
from kbga.measures import GenerationReport
from kbga.settings import KBGAPlusSettings, KBGASettings
from suite.scenes.scene import make_scene

__all__ = ["KBGA", "GenerationReport", "KBGAPlusSettings", "KBGASettings", "make_scene"]
