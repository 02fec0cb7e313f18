"""A matrix: what is to be run, checked, and its expansion into cells."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from suite.errors import ContractError, PluginError, SceneError, did_you_mean
from suite.harness.matrix_file import (
    MatrixFile,
    PlannerEntry,
    Queries,
    QuerySample,
    SceneEntry,
    Source,
    WorldEntry,
    matrix_file,
    read_matrix_file,
)
from suite.harness.queries import chosen_queries
from suite.planner import Budget
from suite.plugins.discovery import PluginInfo, planner_info
from suite.plugins.from_file import add_plugins
from suite.plugins.settings import make_settings
from suite.scenes.catalogue import has_scene, load_scene
from suite.scenes.frozen import refuse_moving
from suite.scenes.maps.folder import maps_in
from suite.scenes.modifiers import MARK, PATHS, expand_twins, split_modifiers, with_modifiers
from suite.scenes.scene import Query, Scene, scene_fingerprint
from suite.simulation.settings import world_settings
from suite.store.record import Cell, World
from suite.typed import MisfitError, T, dataclass_of, plain

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
    queries : of each of ``scenes``, those that are run.
    worlds : (name, settings) of the worlds of each scene; none if its runs are not simulated.
    """

    name: str
    description: str
    scenes: tuple[Scene, ...]
    sources: tuple[str, ...]
    variants: tuple[Variant, ...]
    seeds: tuple[int, ...]
    scene_seeds: tuple[tuple[int, ...], ...]
    queries: tuple[tuple[Query, ...], ...]
    limits: Limits
    worlds: tuple[tuple[tuple[str, Mapping[str, Any]], ...], ...]

    @property
    def blocked(self) -> dict[tuple[str, str], str]:
        """By source and name, why queries can't be asked whose ends are not free."""
        return {
            (source, query.name): query.blocked
            for source, queries in zip(self.sources, self.queries, strict=True)
            for query in queries
            if query.blocked is not None
        }

    def cells(self, *, quick: bool = False) -> list[Cell]:
        """All runs: scene by scene, query by query, world by world, variant by variant.

        Parameters
        ----------
        quick : bool
            Only the first two seeds of each scene.
        """
        wanted = [
            (scene, source, query, fingerprint, world, variant, seed, number < QUICK_SEEDS)
            for scene, source, queries, worlds, seeds in zip(
                self.scenes, self.sources, self.queries, self.worlds, self.scene_seeds, strict=True
            )
            for query in queries
            for fingerprint in [scene_fingerprint(scene, query)]
            for world in worlds or (None,)
            for variant in self.variants
            for number, seed in enumerate(seeds)
        ]
        return [
            Cell(
                scene=scene.name,
                scene_source=source,
                scene_hash=fingerprint,
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
            for position, (
                scene,
                source,
                query,
                fingerprint,
                world,
                variant,
                seed,
                first,
            ) in enumerate(wanted)
            if first or not quick
        ]


def load_matrix(name_or_path: str | Path, *, maps: Sequence[Path] = ()) -> Matrix:
    """Read a matrix and check all of it: every scene loads, every planner takes its settings.

    Planners of the files that it names are known to this process from then on, and to those that it
    starts.

    Parameters
    ----------
    name_or_path : str or Path
        One of the catalogue, or a file in the format of :mod:`suite.harness.matrix_file`.
    maps : sequence of Path
        Folders, whose maps are scenes beside those that it names.

    Returns
    -------
    Matrix

    Raises
    ------
    MatrixError
        If anything in it can't be run. The message says what, where, and how to mend it.
    """
    path = matrix_file(name_or_path)
    source, file = read_matrix_file(path)
    seeds = _seeds(source, (), file.seeds)
    named = _named_scenes(source, file, path.parent, _added(source, maps), seeds)
    scenes, sources = _scenes(source, [entry.name for entry in named], path.parent)
    _name_plugins(source, file, path.parent)
    worlds = _worlds(source, file, scenes)
    if not file.world:
        for scene, entry in zip(scenes, named, strict=True):
            _refuse_moving(source, scene, entry.name)
    return Matrix(
        name=file.name or path.stem,
        description=file.description,
        scenes=scenes,
        sources=sources,
        variants=_variants(source, file),
        seeds=seeds,
        scene_seeds=tuple(entry.seeds for entry in named),
        queries=tuple(
            _queries(source, scene, entry) for scene, entry in zip(scenes, named, strict=True)
        ),
        limits=_built(Limits, file.limits, source, ("limits",)),
        worlds=worlds,
    )


@dataclass(frozen=True, slots=True)
class _Named:
    """A scene of a matrix.

    name : of it or its file as it is written, but for twins, which are named one by one, and with
        the robot's radius and the snapping of ends as modifiers.
    seeds, queries : its own, or those of the whole matrix.
    keys : where the queries are written.
    """

    name: str
    seeds: tuple[int, ...]
    queries: Queries | None
    keys: tuple[str | int, ...]


def _named_scenes(
    source: Source,
    file: MatrixFile,
    folder: Path,
    maps: Sequence[str],
    seeds: tuple[int, ...],
) -> list[_Named]:
    if not (file.scenes or maps):
        what = "it names none. Name some, or a folder of maps with --maps."
        raise source.error(("scenes",), what)
    named = []
    for number, entry in enumerate([*file.scenes, *maps]):
        scene = SceneEntry(entry) if isinstance(entry, str) else entry
        keys = ("scenes", number)
        own = seeds if scene.seeds is None else _seeds(source, keys, scene.seeds)
        queries = file.queries if scene.queries is None else scene.queries
        where = ("queries",) if scene.queries is None else (*keys, "queries")
        radius = file.radius if scene.radius is None else scene.radius
        snap = file.snap if scene.snap is None else scene.snap
        try:
            named += [
                _Named(with_modifiers(twin, radius=radius, snap=snap), own, queries, where)
                for name in _maps_of(scene.scene, folder)
                for twin in expand_twins(name)
            ]
        except SceneError as error:
            raise source.error(("scenes",), str(error)) from error
    return named


def _added(source: Source, folders: Sequence[Path]) -> list[str]:
    """The maps of the folders that the command names."""
    try:
        return [str(path) for folder in folders for path in maps_in(folder.resolve())]
    except SceneError as error:
        raise source.error(("--maps",), str(error)) from error


def _maps_of(name: str, folder: Path) -> list[str]:
    """The maps of a folder that is named as a scene, with the same modifiers; any other name."""
    base, modifiers = split_modifiers(name)
    if not (folder / base).is_dir() or has_scene(name):
        return [name]
    behind = f"{MARK}{modifiers}" if modifiers else ""
    return [f"{path}{behind}" for path in maps_in(folder / base)]


def _queries(source: Source, scene: Scene, entry: _Named) -> tuple[Query, ...]:
    if isinstance(entry.queries, QuerySample):
        _check_sample(source, entry.queries, entry.keys)
    keys = entry.keys if entry.queries is not None else ("scenes",)
    try:
        return chosen_queries(scene, entry.queries)
    except SceneError as error:
        raise source.error(keys, str(error)) from error


def _check_sample(source: Source, sample: QuerySample, keys: Sequence[str | int]) -> None:
    """Refuse a sample that is of no kind, or says what its kind does not heed."""
    if (sample.random is None) == (sample.per_stratum is None):
        what = "give either random = 100 or per_stratum = 2, beside a seed if you like."
        raise source.error(keys, what)
    for key in ("min_distance", "connected"):
        if sample.random is None and getattr(sample, key) is not None:
            raise source.error(keys, f"{key} is for random queries. Leave it out.")


def _refuse_moving(source: Source, scene: Scene, name: str) -> None:
    try:
        refuse_moving(
            scene,
            "Give the matrix a [[world]], in which a robot drives through it, or name the scene as "
            f"it is at a time, standing still: {with_modifiers(name, at=0.0)}.",
        )
    except SceneError as error:
        raise source.error(("scenes",), str(error)) from error


def _scenes(
    source: Source, entries: Sequence[str], folder: Path
) -> tuple[tuple[Scene, ...], tuple[str, ...]]:
    sources = [_scene_source(entry, folder) for entry in entries]
    scenes = []
    for entry, found in zip(entries, sources, strict=True):
        try:
            scenes.append(load_scene(found))
        except SceneError as error:
            raise source.error(("scenes",), f"'{entry}': {error}") from error
    _refuse_twins(source, "scenes", [scene.name for scene in scenes])
    return tuple(scenes), tuple(sources)


def _scene_source(entry: str, folder: Path) -> str:
    if has_scene(entry):
        return entry
    if (folder / entry).exists():
        return str((folder / entry).resolve())
    base, modifiers = split_modifiers(entry)
    path = folder / base
    is_path = path.exists() or path.suffix.lower() in PATHS or len(Path(base).parts) > 1
    # A word that is neither goes to the catalogue, which says what it has.
    if not is_path:
        return entry
    return f"{path.resolve()}{MARK}{modifiers}" if modifiers else str(path.resolve())


def _worlds(
    source: Source, file: MatrixFile, scenes: Sequence[Scene]
) -> tuple[tuple[tuple[str, Mapping[str, Any]], ...], ...]:
    """(name, settings) of the worlds of each scene."""
    if not file.world:
        return ((),) * len(scenes)
    _refuse_twins(source, "worlds", [world.name for world in file.world])
    found: dict[str, list[tuple[str, Mapping[str, Any]]]] = {scene.name: [] for scene in scenes}
    for number, world in enumerate(file.world):
        keys = ("world", number)
        for scene in _scenes_of(world, scenes, source, keys):
            try:
                settings = plain(world_settings(scene, world.settings))
            except SceneError as error:
                raise source.error((*keys, "settings"), str(error)) from error
            found[scene.name].append((world.name, settings))
    for name, worlds in found.items():
        if not worlds:
            raise source.error(("scenes",), f"'{name}' is in none of the worlds. Name it in one.")
    return tuple(tuple(worlds) for worlds in found.values())


def _scenes_of(
    world: WorldEntry, scenes: Sequence[Scene], source: Source, keys: Sequence[str | int]
) -> Sequence[Scene]:
    if world.scenes is None:
        return scenes
    known = [scene.name for scene in scenes]
    for name in world.scenes:
        if name not in known:
            hint = did_you_mean(name, known)
            what = f"'{name}' is no scene of this matrix.{hint}"
            raise source.error((*keys, "scenes"), what)
    return [scene for scene in scenes if scene.name in world.scenes]


def _seeds(
    source: Source, keys: Sequence[str | int], seeds: int | Sequence[int]
) -> tuple[int, ...]:
    if isinstance(seeds, int):
        return tuple(range(seeds))
    _refuse_twins(source, "seeds", seeds, keys)
    return tuple(seeds)


def _name_plugins(source: Source, file: MatrixFile, folder: Path) -> None:
    """Make the planners of a matrix's own files known, beside those of ``--plugin``."""
    for number, reference in enumerate(file.plugins):
        try:
            add_plugins([reference], folder.resolve())
        except PluginError as error:
            raise source.error(("plugins", number), str(error)) from error


def _variants(source: Source, file: MatrixFile) -> tuple[Variant, ...]:
    variants = [
        _variant(entry, source, ("planner", number)) for number, entry in enumerate(file.planner)
    ]
    _refuse_twins(source, "planners", [variant.name for variant in variants])
    for number, variant in enumerate(variants):
        if variant.cold and not file.world:
            what = "cold is for simulated runs. Leave it out, or give the matrix a [[world]]."
            raise source.error(("planner", number), what)
    return tuple(variants)


def _variant(entry: PlannerEntry, source: Source, keys: tuple[str | int, ...]) -> Variant:
    try:
        # The others are not imported: they bring libraries of their own.
        plugin = planner_info(entry.planner)
    except PluginError as error:
        raise source.error(keys, str(error)) from error
    settings: Mapping[str, Any] = entry.settings
    if plugin.planner is not None:
        try:
            settings = plain(make_settings(plugin.planner, settings))
        except PluginError as error:
            raise source.error((*keys, "settings"), str(error)) from error
    return Variant(
        name=entry.name or entry.planner,
        plugin=plugin,
        settings=settings,
        budget=_built(Budget, entry.budget, source, (*keys, "budget")),
        cold=entry.cold,
    )


def _built(
    kind: type[T], values: Mapping[str, Any], source: Source, keys: Sequence[str | int]
) -> T:
    """Budget or limits, from the table that some keys lead to."""
    try:
        return dataclass_of(values, kind)
    except MisfitError as error:
        raise source.error(keys, str(error)) from error
    except ContractError as error:
        raise source.error(keys, str(error).removeprefix("budget: ")) from error


def _refuse_twins(
    source: Source, what: str, names: Sequence[Any], keys: Sequence[str | int] = ()
) -> None:
    twins = [name for i, name in enumerate(names) if name in names[:i]]
    if twins:
        raise source.error(keys, f"two {what} are named '{twins[0]}'. Give each a name of its own.")
