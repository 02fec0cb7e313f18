"""Small scenes, each with one difficulty, that every planner is tried on."""

from collections.abc import Callable
from dataclasses import dataclass

import shapely

from suite.scenes.scattered import scattered
from suite.scenes.scene import Query, Scene, make_scene

ROOM = shapely.box(0, 0, 10, 10)
LEFT, RIGHT = (1.0, 5.0), (9.0, 5.0)
MANY = 500
MANY_SEED = 1


@dataclass(frozen=True, slots=True)
class SmallScene:
    """A scene of the kit.

    name : what is difficult in it.
    build : makes it; another object each time.
    has_path : whether there is a path.
    is_trivial : whether the straight line from start to goal is one.
    """

    name: str
    build: Callable[[], Scene]
    has_path: bool = True
    is_trivial: bool = False


def asked(scene: Scene) -> Query:
    """The query of a small scene that is asked: the last, so not always the scene's first."""
    return scene.queries[-1]


def small_scenes() -> tuple[SmallScene, ...]:
    """All scenes of the kit.

    Examples
    --------
    >>> [scene.name for scene in small_scenes() if not scene.has_path]
    ['enclosed goal', 'seam']
    """
    return (
        SmallScene("empty scene", _empty, is_trivial=True),
        SmallScene("start equals goal", _start_equals_goal, is_trivial=True),
        SmallScene("start sees goal", _start_sees_goal, is_trivial=True),
        SmallScene("one wall", _one_wall),
        SmallScene("two queries", _two_queries),
        SmallScene("narrow gap", _narrow_gap),
        SmallScene("touching obstacles", _touching_obstacles),
        SmallScene("start on an edge", _start_on_an_edge),
        SmallScene("enclosed goal", _enclosed_goal, has_path=False),
        SmallScene("seam", _seam, has_path=False),
        SmallScene(f"{MANY} obstacles", _many),
    )


def _empty() -> Scene:
    return make_scene("empty scene", ROOM, [], (LEFT, RIGHT))


def _start_equals_goal() -> Scene:
    return make_scene("start equals goal", ROOM, [shapely.box(4, 0, 6, 8)], (LEFT, LEFT))


def _start_sees_goal() -> Scene:
    return make_scene("start sees goal", ROOM, [shapely.box(4, 6, 6, 9)], (LEFT, RIGHT))


def _one_wall() -> Scene:
    return make_scene("one wall", ROOM, [shapely.box(4, 0, 6, 8)], (LEFT, RIGHT))


def _two_queries() -> Scene:
    queries = {"first": (LEFT, RIGHT), "second": ((1.1, 2.3), (9.3, 1.7))}
    return make_scene("two queries", ROOM, [shapely.box(4, 0, 6, 8)], queries)


def _narrow_gap() -> Scene:
    walls = [shapely.box(4, 0, 6, 7), shapely.box(4, 7.25, 6, 10)]
    return make_scene("narrow gap", ROOM, walls, (LEFT, RIGHT))


def _touching_obstacles() -> Scene:
    """Two share an edge, a third touches one of them in a point: no way between any of them."""
    walls = [shapely.box(4, 3, 6, 5), shapely.box(4, 5, 6, 7), shapely.box(6, 7, 7, 8)]
    return make_scene("touching obstacles", ROOM, walls, (LEFT, RIGHT))


def _start_on_an_edge() -> Scene:
    return make_scene("start on an edge", ROOM, [shapely.box(4, 2, 6, 8)], ((4.0, 4.0), RIGHT))


def _enclosed_goal() -> Scene:
    walls = shapely.Polygon(shapely.box(7, 3, 10, 7).exterior, [shapely.box(8, 4, 9.5, 6).exterior])
    return make_scene("enclosed goal", ROOM, [walls], (LEFT, RIGHT))


def _seam() -> Scene:
    walls = [shapely.box(4, 0, 6, 5), shapely.box(4, 5, 6, 10)]
    return make_scene("seam", ROOM, walls, (LEFT, RIGHT))


def _many() -> Scene:
    return scattered(MANY, MANY_SEED)
