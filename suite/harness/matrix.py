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
    budget = {generations = 200}             # wall_s, generations, checks; none: its own stop

Every query of every scene is run with every variant and every seed.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from suite.errors import ContractError, MatrixError, PluginError, SceneError
from suite.harness.toml_reader import Reader, read_toml
from suite.planner import Budget
from suite.plugins import (
    PluginInfo,
    available_planners,
    load_planner,
    make_settings,
    planner_names,
    settings_as_dict,
)
from suite.record import Cell
from suite.scene import Scene, scene_fingerprint
from suite.scene_file import SUFFIXES
from suite.scenes.catalogue import has_scene, load_scene

FOLDER = Path(__file__).parent / "matrices"
QUICK_SEEDS = 2
"""Enough to see that every cell works and to have a spread at all."""


@dataclass(frozen=True, slots=True)
class Limits:
    """When the harness ends a run that does not end by itself.

    factor, grace_s : ``plan`` may take ``factor`` times its wall budget, and ``grace_s`` more.
    wall_s : what ``plan`` may take if it has no wall budget, seconds.
    warm_up_s : what loading and ``warm_up`` may take, compilation included, seconds.
    memory_mb : what the run with all its processes may hold at any time, resident, 10^6 bytes. The
        default is what computers have for each core at the least, and several times what a
        planner needs on the largest of our scenes.
    """

    factor: float = 1.5
    grace_s: float = 10.0
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
        if budget.wall_s is None:
            return self.wall_s
        return self.factor * budget.wall_s + self.grace_s


@dataclass(frozen=True, slots=True, eq=False)
class Variant:
    """A planner with its settings and budget, under a name of its own.

    plugin : where the planner comes from. The runs of one that can't be loaded become rows that
        say so: it stops nobody else.
    settings : all settings, defaults included; as written, if the plugin can't be loaded.
    """

    name: str
    plugin: PluginInfo
    settings: Mapping[str, Any]
    budget: Budget


@dataclass(frozen=True, slots=True, eq=False)
class Matrix:
    """What is to be run. Made by :func:`load_matrix`, which has checked all of it.

    sources : what :func:`suite.scenes.catalogue.load_scene` takes, one for each of ``scenes``.
    """

    name: str
    description: str
    scenes: tuple[Scene, ...]
    sources: tuple[str, ...]
    variants: tuple[Variant, ...]
    seeds: tuple[int, ...]
    limits: Limits

    def cells(self, *, quick: bool = False) -> list[Cell]:
        """All runs: scene by scene, query by query, variant by variant, seed by seed.

        Parameters
        ----------
        quick : bool
            Only the first two seeds.
        """
        wanted = (
            (scene, source, query, variant, seed)
            for scene, source in zip(self.scenes, self.sources, strict=True)
            for query in scene.queries
            for variant in self.variants
            for seed in self.seeds
        )
        cells = [
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
                position=position,
            )
            for position, (scene, source, query, variant, seed) in enumerate(wanted)
        ]
        first = self.seeds[:QUICK_SEEDS]
        return [cell for cell in cells if cell.seed in first] if quick else cells


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
    reader.allow("name", "description", "scenes", "seeds", "planner", "limits")
    scenes, sources = _scenes(reader, path.parent)
    return Matrix(
        name=reader.text("name", path.stem),
        description=reader.text("description", ""),
        scenes=scenes,
        sources=sources,
        variants=_variants(reader),
        seeds=_seeds(reader),
        limits=_built(Limits, reader.table("limits")),
    )


def _scenes(reader: Reader, folder: Path) -> tuple[tuple[Scene, ...], tuple[str, ...]]:
    entries = reader.texts("scenes")
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
    path = folder / entry
    is_path = path.exists() or Path(entry).suffix.lower() in SUFFIXES or len(Path(entry).parts) > 1
    # A word that is neither goes to the catalogue, which says what it has.
    return str(path.resolve()) if is_path else entry


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


def _variants(reader: Reader) -> tuple[Variant, ...]:
    tables = reader.tables("planner")
    plugins = {plugin.name: plugin for plugin in available_planners()}
    variants = [_variant(table, plugins) for table in tables]
    _refuse_twins(reader, "planners", [variant.name for variant in variants])
    return tuple(variants)


def _variant(table: Reader, plugins: Mapping[str, PluginInfo]) -> Variant:
    table.allow("name", "planner", "settings", "budget")
    planner = table.text("planner")
    table = table.renamed(f"planner '{table.values.get('name', planner)}'")
    if planner not in plugins:
        known = ", ".join(planner_names())
        hint = table.near(planner, plugins)
        raise table.error(f"there is no planner '{planner}'. Installed: {known}.{hint}")
    plugin = plugins[planner]
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
