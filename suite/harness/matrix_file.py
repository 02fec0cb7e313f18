"""The file of a matrix: its format, where the suite keeps its own, and how large each is.

The file
--------
A TOML file::

    name = "walls"
    description = "What it is for."
    scenes = ["zigzag", "my_scene.geojson"]  # catalogue names, or paths relative to this file
    seeds = 20                               # 0 to 19; or a list of seeds
    plugins = ["mine.py"]                    # optional; as --plugin takes them, from this folder

    [limits]                                 # optional; see Limits
    grace_s = 10

    [[planner]]
    name = "kbga-small"                      # of the variant; default: the planner's own
    planner = "kbga"
    settings = {population_size = 20}        # what is left out keeps its default
    budget = {generations = 200}             # fields of Budget; none: its own stop

Every query of every scene is run with every variant and every seed. Which queries, and how large
the robot is, may be said for all scenes, and for each by itself in its table::

    radius = 0.2                             # of the robot, metres: obstacles grow by it
    snap = true                              # ends that are not free move to the nearest free place
    queries = "all"                          # the scene's own; the default
    queries = ["main", "1,2:8.5,4"]          # by name, or by start and goal
    queries = { random = 100, seed = 1, min_distance = 5.0, connected = true }
    queries = { per_stratum = 2, seed = 1 }  # of the scene's own, so many of each of its strata

Random queries are drawn uniformly from free space: pairs at least ``min_distance`` metres apart (0
if left out) that a path joins (or any, with ``connected = false``). ``radius`` and ``snap`` are
short for modifiers behind the scene's name, ``my_map.yaml@radius=0.2,snap=yes``.

A scene may be modified, as in ``zigzag@turn=17`` (see :mod:`suite.scenes.modifiers`), and a range
of twins stands for as many scenes. With a table in place of its name, a scene has seeds of its own,
so that several twins need not make the matrix as many times as large::

    scenes = ["zigzag", { scene = "zigzag@twin=1..10", seeds = 5 }]

A folder stands for all maps in it: ``scenes = ["my_maps"]``. What folder may be left to the
command: ``kbga-bench run MATRIX --maps FOLDER`` adds it to the scenes, which then may be left out.

A matrix of simulated runs names worlds. Then every scene is driven through in each of its worlds,
and the budget is that of each single plan::

    [[world]]
    name = "fast robot"
    scenes = ["door"]                        # default: all
    settings = {speed = 5.0}                 # of WorldSettings; the rest as the scene wants it

    [[planner]]
    name = "kbga-cold"
    planner = "kbga"
    cold = true                              # plan afresh, though it could go on from what it knows
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from msgspec import Meta, Struct

from suite import seeds
from suite.errors import MatrixError, sentence
from suite.scenes.modifiers import expand_twins
from suite.typed import MisfitError, typed

FOLDER = Path(__file__).parent / "matrices"


class _Table(Struct, frozen=True, forbid_unknown_fields=True):
    """Base of the tables of a file: no other keys than these."""


_Name = Annotated[str, Meta(min_length=1)]
MOST_SEEDS = 10**6
"""How many a matrix may count: the cells of more would not fit into memory."""

_Seed = Annotated[int, Meta(ge=0, le=seeds.MOST, description=seeds.WHICH)]
_Seeds = Annotated[
    Annotated[int, Meta(ge=1, le=MOST_SEEDS)] | Annotated[list[_Seed], Meta(min_length=1)],
    Meta(description=f"a number of seeds, 1 to {MOST_SEEDS}, or a list of {seeds.WHICH}"),
]
_SceneName = Annotated[_Name, Meta(description="the name or the file of a scene")]


MOST_QUERIES = 100_000
"""That a matrix may draw in a scene: more is a mistake of typing."""

_Many = Annotated[
    int, Meta(ge=1, le=MOST_QUERIES, description=f"a whole number, 1 to {MOST_QUERIES}")
]


class QuerySample(_Table, frozen=True):
    """A sample of queries, of one of two kinds.

    random : so many pairs of places, drawn from free space.
    per_stratum : so many of each stratum of the scene's own.
    seed : of the random stream.
    min_distance : between start and goal of a random one, metres.
    connected : whether only random pairs are taken that a path joins.
    """

    random: _Many | None = None
    per_stratum: _Many | None = None
    seed: _Seed = 0
    min_distance: Annotated[float, Meta(ge=0.0, description="metres, of 0 or more")] | None = None
    connected: bool | None = None


_List = Annotated[list[_Name], Meta(min_length=1)]
Queries = Literal["all"] | _List | QuerySample
_Queries = Annotated[
    Queries,
    Meta(
        description='"all", a list of names or of x,y:x,y, or a table { random = 100, seed = 1, '
        "min_distance = 5.0, connected = true } or { per_stratum = 2, seed = 1 }"
    ),
]
_Radius = Annotated[float, Meta(ge=0.0, description="the robot's radius in metres, of 0 or more")]


class SceneEntry(_Table, frozen=True):
    """A scene, or a range of twins, that may have seeds, queries and a robot of its own."""

    scene: _SceneName
    seeds: _Seeds | None = None
    queries: _Queries | None = None
    radius: _Radius | None = None
    snap: bool | None = None


class WorldEntry(_Table, frozen=True):
    """A [[world]]: settings of a simulation, for some scenes or for all."""

    name: Annotated[_Name, Meta(description="the world a name, for tables")]
    scenes: Annotated[list[str], Meta(min_length=1, description="a list of scenes")] | None = None
    settings: dict[str, Any] = {}


class PlannerEntry(_Table, frozen=True):
    """A [[planner]]: a variant."""

    planner: Annotated[
        _Name, Meta(description="the name of a planner (see `kbga-bench list planners`)")
    ]
    name: _Name | None = None
    settings: dict[str, Any] = {}
    budget: dict[str, Any] = {}
    cold: bool = False


_Planners = Annotated[
    list[PlannerEntry], Meta(min_length=1, description="at least one [[planner]]")
]
_Worlds = Annotated[list[WorldEntry], Meta(min_length=1, description="at least one [[world]]")]


class MatrixFile(_Table, frozen=True):
    """The whole file."""

    seeds: _Seeds
    planner: _Planners
    scenes: Annotated[
        list[_SceneName | SceneEntry],
        Meta(
            description="a list of names, files, folders of maps, or tables { scene = ..., "
            "seeds = ..., queries = ..., radius = ..., snap = ... }"
        ),
    ] = []
    queries: _Queries | None = None
    radius: _Radius | None = None
    snap: bool = False
    world: _Worlds = []
    name: _Name | None = None
    description: str = ""
    plugins: Annotated[
        list[_Name],
        Meta(description='a list of planners\' files: "FILE.py", "FILE.py:CLASS", "MODULE:CLASS"'),
    ] = []
    limits: dict[str, Any] = {}


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """Where a matrix comes from, for errors.

    file : name of the file.
    document : what TOML holds there.
    """

    file: str
    document: dict[str, Any]

    def error(self, keys: Sequence[str | int], what: str) -> MatrixError:
        """An error that names the place that some keys lead to, by the names that stand there.

        Where nothing is written, the command may have said it: then the keys alone are named.
        """
        words: list[str] = []
        place: Any = self.document
        for key in keys:
            try:
                place = place[key]
            except (KeyError, IndexError, TypeError):
                place = None
            if isinstance(key, str):
                words.append(key)
            else:
                names = place if isinstance(place, dict) else {}
                name = names.get("name") or names.get("planner")
                words[-1] += f" '{name}'" if name else f" {key + 1}"
        return MatrixError(f"{', '.join([self.file, *words])}: {what}")


def matrix_names() -> list[str]:
    """Names of the matrices that ship with the suite.

    Examples
    --------
    >>> "paper-static" in matrix_names()
    True
    """
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def matrix_file(name_or_path: str | Path) -> Path:
    """The file of a matrix of the catalogue, or a file of one's own.

    Raises
    ------
    MatrixError
        If there is none.
    """
    path = Path(name_or_path)
    if str(name_or_path) in matrix_names():
        return FOLDER / f"{name_or_path}.toml"
    if path.exists():
        return path
    raise MatrixError(
        f"no matrix '{name_or_path}'. Give a file, or one of: {', '.join(matrix_names())}."
    )


def read_matrix_file(path: Path) -> tuple[Source, MatrixFile]:
    """Read a matrix as it is written. What it names is looked for by :mod:`suite.harness.matrix`.

    Raises
    ------
    MatrixError
        If the file can't be read, is not TOML, or holds anything of another form.
    """
    source = Source(path.name, _read_toml(path))
    try:
        return source, typed(source.document, MatrixFile)
    except MisfitError as error:
        # The value's own name is in the text of the error.
        named = error.keys and isinstance(error.keys[-1], str) and " is " in str(error)
        raise source.error(error.keys[:-1] if named else error.keys, str(error)) from error


def _read_toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise MatrixError(f"{path}: can't be read ({error.strerror}).") from error
    except UnicodeDecodeError as error:
        raise MatrixError(f"{path.name}: is not UTF-8 text (byte {error.start}).") from error
    except tomllib.TOMLDecodeError as error:
        raise MatrixError(f"{path.name}: not TOML: {sentence(error)}") from error
    except (ValueError, RecursionError) as error:  # numbers too long, or nested too deep
        raise MatrixError(f"{path.name}: can't be read as TOML ({error}).") from error


def outline(name: str) -> dict[str, Any]:
    """What a matrix of the catalogue is for, and its numbers of scenes, planners, seeds and runs.

    It is read from the file alone: to check a matrix is to draw all of its scenes and to import all
    of its planners. A scene whose queries are not counted there is taken to have one.

    Examples
    --------
    >>> outline("paper-static")["runs"]
    1440
    """
    _, file = read_matrix_file(matrix_file(name))
    entries = [SceneEntry(e) if isinstance(e, str) else e for e in file.scenes]
    each = {
        twin: _count(e.seeds or file.seeds) * _queries(e.queries or file.queries)
        for e in entries
        for twin in expand_twins(e.scene)
    }
    runs = sum(own * _worlds(file, scene) for scene, own in each.items())
    return {
        "description": file.description,
        "scenes": len(each),
        "planners": len(file.planner),
        "seeds": _count(file.seeds),
        "runs": runs * len(file.planner),
    }


def _count(own: int | list[int]) -> int:
    return own if isinstance(own, int) else len(own)


def _queries(wanted: Queries | None) -> int:
    if isinstance(wanted, list):
        return len(wanted)
    return wanted.random or 1 if isinstance(wanted, QuerySample) else 1


def _worlds(file: MatrixFile, scene: str) -> int:
    """How often a scene is run with one seed: once, or once in each of its worlds."""
    if not file.world:
        return 1
    return sum(world.scenes is None or scene in world.scenes for world in file.world)
