"""A dynamic scene that stands still, as it is at a time."""

from suite.errors import SceneError
from suite.scenes.scene import Scene, make_scene, scene_at


def frozen(scene: Scene, time: float, *, inflate: float = 0.0) -> Scene:
    """The static scene that a dynamic one is at a time, all of its obstacles known.

    Parameters
    ----------
    scene : Scene
        Dynamic.
    time : float
        Seconds.
    inflate : float
        Radius of the robot, metres; see :func:`suite.scenes.scene.make_scene`.

    Returns
    -------
    Scene
        Of the same name, without the optima that its file states. Queries whose ends are not free
        at that time are blocked.

    Raises
    ------
    SceneError
        If the scene is static.

    Examples
    --------
    >>> from suite.scenes.catalogue import load_scene
    >>> frozen(load_scene("door"), 3.0).is_dynamic
    False
    """
    if not scene.is_dynamic:
        raise SceneError(f"{scene.name}: stands still at all times. Leave at={time:g} out.")
    return make_scene(
        scene.name,
        scene.workspace,
        scene_at(scene, time).obstacles,
        {query.name: (query.start, query.goal) for query in scene.queries},
        properties={k: v for k, v in scene.properties.items() if k != "optimum"},
        path=scene.path,
        inflate=inflate,
        strata={q.name: q.stratum for q in scene.queries if q.stratum is not None},
        keep_blocked=True,
        grown_by=scene.radius,
    )


def refuse_moving(scene: Scene, instead: str) -> None:
    """Refuse a dynamic scene where it would be planned in as if it stood still.

    Parameters
    ----------
    scene : Scene
    instead : str
        What to do: the end of the error's text.

    Raises
    ------
    SceneError

    Examples
    --------
    >>> from suite.scenes.catalogue import load_scene
    >>> refuse_moving(load_scene("maze"), "Simulate it.")
    """
    if scene.is_dynamic:
        raise SceneError(f"{scene.name}: its obstacles move, hide or vanish. {instead}")
