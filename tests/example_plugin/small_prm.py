"""A roadmap of random points that grows batch by batch, after Kavraki et al. (1996)."""

from dataclasses import dataclass

import numpy as np

from suite.geometry.kernels import first_collision
from suite.planner import Abilities, Plan, Planner, PlanStatus
from suite.scenes.scene import make_scene


@dataclass(frozen=True)
class SmallPRMSettings:
    batches: int = 8
    batch_size: int = 20


class SmallPRM(Planner):
    name = "small-prm"
    Settings = SmallPRMSettings
    abilities = Abilities(anytime=True, budgets=frozenset({"generations"}))
    interface = 1

    def plan(self, scene, query, budget, rng, recorder):
        best, cost, found = None, np.inf, None
        points = np.array([query.start, query.goal])
        low, high = np.reshape(scene.bounds, (2, 2))
        batches = budget.generations or self.settings.batches
        for batch in range(batches):
            path, length = shortest(points, scene)
            if length < cost:
                best, cost, found = path, length, batch
                recorder.improved(cost, generation=batch)
            points = np.vstack([points, rng.uniform(low, high, (self.settings.batch_size, 2))])
        if best is None:
            return Plan(PlanStatus.EXHAUSTED, generations=batches)
        return Plan(PlanStatus.SOLVED, best, cost, batches, found)

    def warm_up(self):
        room = make_scene("room", [(0, 0), (1, 0), (1, 1), (0, 1)], [], ((0, 0), (1, 1)))
        shortest(np.eye(2), room)  # compiles, or loads, the collision check


def shortest(points, scene):
    """Dijkstra's path from the first point to the second, over segments that are free."""
    cost = np.append(0.0, np.full(len(points) - 1, np.inf))
    before, waiting = {}, set(range(len(points)))
    while (here := min(waiting, key=cost.__getitem__)) != 1 and cost[here] < np.inf:
        waiting.remove(here)
        reach = cost[here] + np.hypot(*(points - points[here]).T)
        for there in sorted(waiting):
            segment = points[[here, there]]
            if reach[there] < cost[there] and first_collision(segment, scene.arrays) < 0:
                cost[there], before[there] = reach[there], here
    way = [1]
    while way[-1] in before:
        way.append(before[way[-1]])
    return points[way[::-1]], cost[1]
