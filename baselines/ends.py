"""What every planner must know of a query before it plans: whether its ends are free."""

import numpy as np

from suite.geometry.kernels import first_collision
from suite.scenes.scene import Query, Scene


def ends_are_free(scene: Scene, query: Query) -> bool:
    """Whether start and goal lie in free space; where they don't, there is no path at all.

    A scene's own queries are checked when it is loaded; what a robot meets on its way is not.

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> room, box = shapely.box(0, 0, 9, 9), shapely.box(4, 4, 6, 6)
    >>> scene = make_scene("box", room, [box], ((1, 1), (6, 6)))
    >>> inside = Query("inside", scene.query().start, np.array([5.0, 5.0]))
    >>> ends_are_free(scene, scene.query()), ends_are_free(scene, inside)
    (True, False)
    """
    points = (query.start, query.goal)
    return all(first_collision(np.array([point, point]), scene.arrays) < 0 for point in points)
