"""A matrix: which scenes, planner variants and seeds are to be run, and its expansion into cells.

The file
--------
A TOML file::

    name = "walls"
    description = "What it is for."
    scenes = ["zigzag", "my_scene.geojson"]  # catalogue names, or paths relative to this file
    seeds = 20                               # 0 to 19; or a list of seeds

    [limits]                                 # optional; see Limits
    grace_s = 10

    [[planner]]
    name = "kbga-small"                      # of the variant; default: the planner's own
    planner = "kbga"
    settings = {population_size = 20}        # what is left out keeps its default
    budget = {generations = 200}             # fields of Budget; none: its own stop

Every query of every scene is run with every variant and every seed.

A scene may be modified, as in ``zigzag@turn=17`` (see :mod:`suite.scenes.modifiers`), and a range
of twins stands for as many scenes. With a table in place of its name, a scene has seeds of its own,
so that several twins need not make the matrix as many times as large::

    scenes = ["zigzag", { scene = "zigzag@twin=1..10", seeds = 5 }]

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

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from suite.errors import ContractError, MatrixError, PluginError, SceneError, did_you_mean
from suite.harness.toml_reader import Reader, read_toml
from suite.planner import Budget
from suite.plugins.discovery import PluginInfo, load_planner, planner_info, planner_names
from suite.plugins.settings import make_settings, settings_as_dict
from suite.scenes.catalogue import has_scene, load_scene
from suite.scenes.geojson import SUFFIXES
from suite.scenes.modifiers import MARK, expand_twins, split_modifiers
from suite.scenes.scene import Scene, scene_fingerprint
from suite.simulation.record import settings_as_data
from suite.simulation.settings import world_settings
from suite.store.record import Cell, World

FOLDER = Path(__file__).parent / "matrices"
PLANNER = "the name of a planner (see `kbga-bench list planners`)"
WORLD = "the world a name, for tables"
"""What a text that is missing would be."""

QUICK_SEEDS = 2
"""Enough to see that every cell works and to have a spread at all."""


@dataclass(frozen=True, slots=True)
class Limits:
    """When the harness ends a run that does not end by itself.

    factor, grace_s : ``plan`` may take ``factor`` times its wall budget, and ``grace_s`` more.
    cpu_stretch : with a budget of CPU time alone it may take so many times that of wall time, and
        ``grace_s`` more: on a busy machine a run gets a small share of a core.
    wall_s : what ``plan`` may take if it has no budget of time, seconds.
    warm_up_s : what loading and ``warm_up`` may take, compilation included, seconds.
    memory_mb : what the run with all its processes may hold at any time, resident, 10^6 bytes. The
        default is what computers have for each core at the least, and several times what a
        planner needs on the largest of our scenes.
    """

    factor: float = 1.5
    grace_s: float = 10.0
    cpu_stretch: float = 20.0
    wall_s: float = 300.0
    warm_up_s: float = 300.0
    memory_mb: float = 2000.0

    @property
    def memory_bytes(self) -> int:
        """The limit of memory in bytes."""
        return int(self.memory_mb * 1e6)

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not value > 0:
                raise ContractError(f"{field.name} is {value}. It must be above 0.")

    def plan_s(self, budget: Budget) -> float:
        """Seconds of wall time after which a run with this budget is killed."""
        if budget.wall_s is not None:
            return self.factor * budget.wall_s + self.grace_s
        if budget.cpu_s is not None:
            return self.cpu_stretch * budget.cpu_s + self.grace_s
        return self.wall_s

    def run_s(self, cell: Cell) -> float:
        """Seconds of wall time after which a run is killed; a simulated one plans many times."""
        return self.plan_s(cell.budget) if cell.world is None else self.wall_s


@dataclass(frozen=True, slots=True, eq=False)
class Variant:
    """A planner with its settings and budget, under a name of its own.

    plugin : where the planner comes from. The runs of one that can't be loaded become rows that
        say so: it stops nobody else.
    settings : all settings, defaults included; as written, if the plugin can't be loaded.
    cold : in a simulated run, plan afresh at every update.
    """

    name: str
    plugin: PluginInfo
    settings: Mapping[str, Any]
    budget: Budget
    cold: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Matrix:
    """What is to be run. Made by :func:`load_matrix`, which has checked all of it.

    sources : what :func:`suite.scenes.catalogue.load_scene` takes, one for each of ``scenes``.
    seeds : of the scenes that have none of their own.
    scene_seeds : of each of ``scenes``.
    worlds : (name, settings) of the worlds of each scene; none if its runs are not simulated.
    """

    name: str
    description: str
    scenes: tuple[Scene, ...]
    sources: tuple[str, ...]
    variants: tuple[Variant, ...]
    seeds: tuple[int, ...]
    scene_seeds: tuple[tuple[int, ...], ...]
    limits: Limits
    worlds: tuple[tuple[tuple[str, Mapping[str, Any]], ...], ...]

    def cells(self, *, quick: bool = False) -> list[Cell]:
        """All runs: scene by scene, query by query, world by world, variant by variant.

        Parameters
        ----------
        quick : bool
            Only the first two seeds of each scene.
        """
        wanted = [
            (scene, source, query, world, variant, seed, number < QUICK_SEEDS)
            for scene, source, worlds, seeds in zip(
                self.scenes, self.sources, self.worlds, self.scene_seeds, strict=True
            )
            for query in scene.queries
            for world in worlds or (None,)
            for variant in self.variants
            for number, seed in enumerate(seeds)
        ]
        return [
            Cell(
                scene=scene.name,
                scene_source=source,
                scene_hash=scene_fingerprint(scene, query),
                query=query.name,
                variant=variant.name,
                planner=variant.plugin.name,
                distribution=variant.plugin.distribution,
                version=variant.plugin.version,
                settings=variant.settings,
                budget=variant.budget,
                seed=seed,
                world=None if world is None else World(*world, cold=variant.cold),
                position=position,
            )
            for position, (scene, source, query, world, variant, seed, first) in enumerate(wanted)
            if first or not quick
        ]


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


def load_matrix(name_or_path: str | Path) -> Matrix:
    """Read a matrix and check all of it: every scene loads, every planner takes its settings.

    Parameters
    ----------
    name_or_path : str or Path
        One of :func:`matrix_names`, or a file in the format of this module.

    Returns
    -------
    Matrix

    Raises
    ------
    MatrixError
        If anything in it can't be run. The message says what, where, and how to mend it.
    """
    path = matrix_file(name_or_path)
    reader = Reader(path.name, read_toml(path))
    reader.allow("name", "description", "scenes", "seeds", "world", "planner", "limits")
    seeds = _seeds(reader)
    named = _named_scenes(reader, seeds)
    scenes, sources = _scenes(reader, [name for name, _ in named], path.parent)
    worlds = _worlds(reader, scenes)
    return Matrix(
        name=reader.text("name", path.stem),
        description=reader.text("description", ""),
        scenes=scenes,
        sources=sources,
        variants=_variants(reader, simulated=any(worlds)),
        seeds=seeds,
        scene_seeds=tuple(own for _, own in named),
        limits=_built(Limits, reader.table("limits")),
        worlds=worlds,
    )


def _named_scenes(reader: Reader, seeds: tuple[int, ...]) -> list[tuple[str, tuple[int, ...]]]:
    """The name or file of each scene as it is written, twins one by one, and its seeds."""
    how = "give a list of names, files, or tables { scene = ..., seeds = ... }"
    entries = reader.take("scenes", how)
    good = isinstance(entries, list) and all(isinstance(entry, str | dict) for entry in entries)
    if not good or not entries:
        raise reader.error(f"scenes is {entries!r}. {how.capitalize()}, at least one.")
    named = []
    for number, entry in enumerate(entries, 1):
        table = Reader(reader.file, {"scene": entry} if isinstance(entry, str) else entry)
        table = table.renamed(f"scene {number}")
        table.allow("scene", "seeds")
        name = table.text("scene", what="the name or the file of a scene")
        own = _seeds(table) if "seeds" in table.values else seeds
        try:
            named += [(twin, own) for twin in expand_twins(name)]
        except SceneError as error:
            raise reader.error(f"scenes: {error}") from error
    return named


def _scenes(
    reader: Reader, entries: Sequence[str], folder: Path
) -> tuple[tuple[Scene, ...], tuple[str, ...]]:
    sources = [_source(entry, folder) for entry in entries]
    scenes = []
    for entry, source in zip(entries, sources, strict=True):
        try:
            scenes.append(load_scene(source))
        except SceneError as error:
            raise reader.error(f"scenes: '{entry}': {error}") from error
    _refuse_twins(reader, "scenes", [scene.name for scene in scenes])
    return tuple(scenes), tuple(sources)


def _source(entry: str, folder: Path) -> str:
    if has_scene(entry):
        return entry
    if (folder / entry).exists():
        return str((folder / entry).resolve())
    base, modifiers = split_modifiers(entry)
    path = folder / base
    is_path = path.exists() or path.suffix.lower() in SUFFIXES or len(Path(base).parts) > 1
    # A word that is neither goes to the catalogue, which says what it has.
    if not is_path:
        return entry
    return f"{path.resolve()}{MARK}{modifiers}" if modifiers else str(path.resolve())


def _worlds(
    reader: Reader, scenes: Sequence[Scene]
) -> tuple[tuple[tuple[str, Mapping[str, Any]], ...], ...]:
    """(name, settings) of the worlds of each scene."""
    if "world" not in reader.values:
        return ((),) * len(scenes)
    tables = reader.tables("world")
    _refuse_twins(reader, "worlds", [table.text("name", what=WORLD) for table in tables])
    found: dict[str, list[tuple[str, Mapping[str, Any]]]] = {scene.name: [] for scene in scenes}
    for table in tables:
        name = table.text("name")
        table = table.renamed(f"world '{name}'")
        table.allow("name", "scenes", "settings")
        for scene in _scenes_of(table, scenes):
            found[scene.name].append((name, _world_settings(table, scene)))
    for name, worlds in found.items():
        if not worlds:
            raise reader.error(f"scenes: '{name}' is in none of the worlds. Name it in one.")
    return tuple(tuple(worlds) for worlds in found.values())


def _scenes_of(table: Reader, scenes: Sequence[Scene]) -> Sequence[Scene]:
    if "scenes" not in table.values:
        return scenes
    names = table.texts("scenes")
    known = [scene.name for scene in scenes]
    for name in names:
        if name not in known:
            hint = did_you_mean(name, known)
            raise table.error(f"scenes: '{name}' is no scene of this matrix.{hint}")
    return [scene for scene in scenes if scene.name in names]


def _world_settings(table: Reader, scene: Scene) -> Mapping[str, Any]:
    try:
        return settings_as_data(world_settings(scene, table.table("settings").values))
    except SceneError as error:
        raise table.error(f"settings: {error}") from error


def _seeds(reader: Reader) -> tuple[int, ...]:
    value = reader.take("seeds", "give a number of seeds, or a list of them")
    if isinstance(value, bool) or not isinstance(value, int | list):
        raise reader.error(f"seeds is {value!r}. Give a number of seeds, or a list of them.")
    if isinstance(value, int):
        if value < 1:
            raise reader.error(f"seeds is {value}. Give 1 or more.")
        return tuple(range(value))
    if not value:
        raise reader.error("seeds is empty. Give at least one.")
    for seed in value:
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            raise reader.error(f"seeds: {seed!r} is no seed. Give whole numbers of 0 or more.")
    _refuse_twins(reader, "seeds", value)
    return tuple(value)


def _variants(reader: Reader, *, simulated: bool) -> tuple[Variant, ...]:
    tables = reader.tables("planner")
    variants = [_variant(table, simulated=simulated) for table in tables]
    _refuse_twins(reader, "planners", [variant.name for variant in variants])
    return tuple(variants)


def _variant(table: Reader, *, simulated: bool) -> Variant:
    table.allow("name", "planner", "settings", "budget", *(["cold"] if simulated else []))
    planner = table.text("planner", what=PLANNER)
    table = table.renamed(f"planner '{table.values.get('name', planner)}'")
    known = planner_names()
    if planner not in known:
        hint = did_you_mean(planner, known)
        raise table.error(
            f"there is no planner '{planner}'. Installed: {', '.join(known)}; "
            f"or give its file with --plugin.{hint}"
        )
    # The others are not imported: they bring libraries of their own.
    plugin = planner_info(planner)
    settings = table.table("settings").values
    if plugin.available:
        try:
            planner_class = load_planner(planner)
            settings = settings_as_dict(make_settings(planner_class, settings))
        except PluginError as error:
            raise table.error(f"settings: {error}") from error
    return Variant(
        name=table.text("name", planner),
        plugin=plugin,
        settings=settings,
        budget=_built(Budget, table.table("budget")),
        cold=table.flag("cold"),
    )


def _built(kind: Any, table: Reader) -> Any:
    """A dataclass of numbers from a table, or an error that names the place."""
    wanted = {field.name: field.type for field in fields(kind)}
    table.allow(*wanted)
    for name, value in table.values.items():
        whole = "int" in str(wanted[name])
        good = isinstance(value, int) if whole else isinstance(value, int | float)
        if isinstance(value, bool) or not good:
            what = "a whole number" if whole else "a number"
            raise table.error(f"{name} is {value!r}. Give {what}.")
    try:
        return kind(**table.values)
    except ContractError as error:
        raise table.error(str(error).removeprefix("budget: ")) from error


def _refuse_twins(reader: Reader, what: str, names: Sequence[Any]) -> None:
    for twin in _twins(names):
        raise reader.error(f"two {what} are named '{twin}'. Give each a name of its own.")


def _twins(names: Iterable[Any]) -> list[Any]:
    names = list(names)
    return [name for i, name in enumerate(names) if name in names[:i]]
