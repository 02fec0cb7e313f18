"""What a scene holds, in numbers for a reader who has just brought it in."""

from dataclasses import dataclass

from suite.scenes.scene import Scene


@dataclass(frozen=True, slots=True)
class Summary:
    """A scene in numbers.

    obstacles, vertices : that it was drawn with.
    width, height : of the workspace, metres.
    queries, blocked : their number, and how many of them can't be asked.
    free_share : of the workspace's area, at time 0.
    free_regions : pieces of free space that no path joins, at time 0.
    """

    obstacles: int
    vertices: int
    width: float
    height: float
    queries: int
    blocked: int
    free_share: float
    free_regions: int


def summary_of(scene: Scene) -> Summary:
    """Count what a scene holds.

    Examples
    --------
    >>> import shapely
    >>> from suite.scenes.scene import make_scene
    >>> wall = shapely.box(4, 0, 5, 6)
    >>> found = summary_of(make_scene("two rooms", shapely.box(0, 0, 10, 6), [wall], {}))
    >>> found.free_regions, found.free_share
    (2, 0.9)
    """
    xmin, ymin, xmax, ymax = scene.bounds
    free = scene.at_first.regions
    return Summary(
        len(scene.obstacles),
        scene.vertex_count,
        xmax - xmin,
        ymax - ymin,
        len(scene.queries),
        sum(query.blocked is not None for query in scene.queries),
        float(free.area / scene.workspace.area),
        len(free.geoms),
    )


def summary_text(found: Summary) -> str:
    """The numbers as a few words.

    Examples
    --------
    >>> print(summary_text(Summary(1, 4, 10.0, 6.0, 0, 0, 0.9, 2)))
    1 obstacle of 4 vertices in 10 x 6 m, 90.0 % free in 2 regions that no path joins; no queries
    """
    regions = f" in {found.free_regions} regions that no path joins"
    return (
        f"{_count(found.obstacles, 'obstacle', 'obstacles')} of {found.vertices} vertices in "
        f"{found.width:.6g} x {found.height:.6g} m, {100.0 * found.free_share:.1f} % free"
        f"{regions if found.free_regions > 1 else ''}; "
        f"{_count(found.queries, 'query', 'queries')}"
        f"{f', {found.blocked} of them blocked' if found.blocked else ''}"
    )


def _count(number: int, one: str, several: str) -> str:
    return f"{number or 'no'} {one if number == 1 else several}"
