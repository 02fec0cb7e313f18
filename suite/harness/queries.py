"""Which queries of a scene are run: all of its own, those that are named, or a sample."""

from collections import Counter

from suite.errors import SceneError
from suite.harness.matrix_file import Queries, QuerySample
from suite.scenes.samples import random_queries, stratified_queries
from suite.scenes.scene import Query, Scene

ALL = "all"


def chosen_queries(scene: Scene, wanted: Queries | None) -> tuple[Query, ...]:
    """The queries of a scene that a matrix asks for.

    Parameters
    ----------
    scene : Scene
    wanted : "all", list of names, or QuerySample
        None is all.

    Raises
    ------
    SceneError
        If there are none, or not those.
    """
    if isinstance(wanted, QuerySample):
        return _sample(scene, wanted)
    if isinstance(wanted, list):
        twice = [name for name, count in Counter(wanted).items() if count > 1]
        if twice:
            raise SceneError(f"{scene.name}: the query {twice[0]} is named twice. Name it once.")
        return tuple(scene.query(name) for name in wanted)
    if not scene.queries:
        raise SceneError(
            f"{scene.name}: is a map without queries. Write queries = {{ random = 100, seed = 1 }}"
            ', or name some by their two points, in metres: queries = ["1,2:8.5,4"].'
        )
    return scene.queries


def _sample(scene: Scene, wanted: QuerySample) -> tuple[Query, ...]:
    if wanted.per_stratum is not None:
        return stratified_queries(scene, wanted.per_stratum, seed=wanted.seed)
    if wanted.random is None:
        raise ValueError("a sample is of one kind; reading the file has seen to that.")
    return random_queries(
        scene,
        wanted.random,
        seed=wanted.seed,
        min_distance=wanted.min_distance or 0.0,
        connected=wanted.connected is not False,
    )
