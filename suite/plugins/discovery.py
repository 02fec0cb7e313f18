"""Discovery of planners by entry point.

A planner is declared in the metadata of any installed distribution::

    [project.entry-points."kbga_bench.planners"]
    straight-line = "my_package.straight:StraightLine"

Listing names reads metadata and imports nothing. A plugin that can't be imported is a row that
says so; it stops nobody else. Planners that a user names on the spot
(:mod:`suite.plugins.from_file`) stand beside the declared ones.
"""

import dataclasses
from collections import defaultdict
from collections.abc import Iterable, Sequence
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

from suite.errors import PluginError, did_you_mean
from suite.planner import Abilities, Planner
from suite.plugins.code_hash import OURS, code_hash, files_of_entry_point, module_of
from suite.plugins.from_file import NamedPlugin, named_plugins
from suite.plugins.validation import flaw
from suite.plugins.version_files import present_version_files, refuse_unread, version_files

GROUP = "kbga_bench.planners"

Source = EntryPoint | NamedPlugin


@dataclasses.dataclass(frozen=True, slots=True)
class PluginInfo:
    """One line of the list of installed planners.

    name : the word under which users ask for the planner.
    distribution, version : of the package that declares it, with a hash of its code unless it is
        kbga-bench; or the file and a hash of its code; several, with commas, if it is ambiguous.
    available : whether it can be loaded.
    reason : "unavailable: ..." and why; None if it is available.
    abilities : what it can do; None if it is not available.
    planner : its class; None if it is not available.
    """

    name: str
    distribution: str
    version: str
    available: bool
    reason: str | None = None
    abilities: Abilities | None = None
    planner: type[Planner] | None = dataclasses.field(default=None, repr=False)


def planner_names() -> list[str]:
    """Names of all declared planners, sorted. Imports none of them.

    Examples
    --------
    >>> "visibility-graph" in planner_names()
    True
    """
    return sorted(_declared())


def load_planner(name: str) -> type[Planner]:
    """Import the planner of that name.

    Parameters
    ----------
    name : str
        As in :func:`planner_names`.

    Returns
    -------
    type[Planner]

    Raises
    ------
    PluginError
        If no planner, or more than one, has that name; if it can't be imported; if what is
        imported is not a planner of that name.
    """
    declared = _declared()
    if name not in declared:
        raise _unknown(name, declared)
    try:
        return _load(name, declared[name])
    except PluginError as error:
        raise PluginError(f"planner '{name}' is unavailable: {error}") from error.__cause__


def available_planners() -> list[PluginInfo]:
    """Import every declared planner and say of each what came of it, sorted by name."""
    return [_describe(name, points) for name, points in sorted(_declared().items())]


def planner_info(name: str) -> PluginInfo:
    """Import one planner, and no other, and say what came of it.

    Raises
    ------
    PluginError
        If no planner has that name.
    """
    declared = _declared()
    if name not in declared:
        raise _unknown(name, declared)
    return _describe(name, declared[name])


def planner_version(name: str) -> str | None:
    """Version of the distribution that declares a planner; None if there is no such planner.

    Nothing is imported; several versions, with commas, if the name is ambiguous.
    """
    points = _declared().get(name)
    return None if points is None else ", ".join(_distribution(point)[1] for point in points)


def _declared() -> dict[str, list[Source]]:
    declared: dict[str, list[Source]] = defaultdict(list)
    for source in (*entry_points(group=GROUP), *named_plugins()):
        declared[source.name].append(source)
    return dict(declared)


def _unknown(name: str, declared: Iterable[str]) -> PluginError:
    installed = ", ".join(sorted(declared)) or "none"
    return PluginError(
        f"no planner '{name}'. Installed: {installed}; or give its file with --plugin, "
        f"or in the `plugins` of a matrix.{did_you_mean(name, declared)}"
    )


def _distribution(source: Source) -> tuple[str, str]:
    if isinstance(source, NamedPlugin):
        return source.distribution, source.version
    if source.dist is None:
        return "unknown", "unknown"
    name, version = source.dist.name, source.dist.version
    if module_of(source).split(".")[0] in OURS:
        return name, version
    # Whoever works on a plugin installs it again and again with one version.
    code = files_of_entry_point(source)
    return name, f"{version} {code_hash(code | present_version_files(code))}"


def _load(name: str, sources: Sequence[Source]) -> type[Planner]:
    """Load the one source of a name; PluginError holds the bare reason why it can't be."""
    if len(sources) > 1:
        owners = " and ".join(_distribution(source)[0] for source in sources)
        raise PluginError(f"{owners} both declare it. {_one_of(sources)}")
    place = _place(sources[0])
    code = _code_to_read(sources[0])
    version_files(code)  # raises, if one is missing, before the planner itself meets that
    try:
        # Other people's code: whatever its import raises must not end the listing.
        found = sources[0].load()
    except PluginError:
        raise  # the plugin's own sentence, such as how to install what it needs
    except (Exception, SystemExit) as error:
        raise PluginError(f"{type(error).__name__}: {error}") from error
    wrong = flaw(found)
    if wrong is not None:
        raise PluginError(f"{place} {wrong}")
    if getattr(found, "name", None) != name:
        raise PluginError(
            f"{place} calls itself {getattr(found, 'name', None)!r}. "
            "The entry point and the attribute `name` must be the same."
        )
    if code:
        refuse_unread(found, code)
    planner: type[Planner] = found
    return planner


def _code_to_read(source: Source) -> set[Path]:
    """The code that may name data files; a file of --plugin has been read when it was named."""
    if isinstance(source, NamedPlugin) or module_of(source).split(".")[0] in OURS:
        return set()
    return files_of_entry_point(source)


def _place(source: Source) -> str:
    return source.reference if isinstance(source, NamedPlugin) else source.value


def _one_of(sources: Sequence[Source]) -> str:
    if any(isinstance(source, NamedPlugin) for source in sources):
        return "Give the one that is named by its file another name, or leave it out."
    return "Uninstall one of them."


def _describe(name: str, sources: Sequence[Source]) -> PluginInfo:
    owners, versions = zip(*(_distribution(source) for source in sources), strict=True)
    distribution, version = ", ".join(owners), ", ".join(versions)
    try:
        planner = _load(name, sources)
    except PluginError as error:
        return PluginInfo(name, distribution, version, False, f"unavailable: {error}")
    return PluginInfo(name, distribution, version, True, None, planner.abilities, planner)
