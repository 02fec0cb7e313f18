"""A new planner's distribution to start from: it runs, and keeps the contract, as it is."""

import keyword
import sys
from importlib.util import find_spec
from pathlib import Path
from string import Template

from suite.errors import PluginError
from suite.planner import INTERFACE
from suite.plugins.discovery import planner_names
from suite.plugins.validation import NAME

TEMPLATES = Path(__file__).parent / "template"


def write_new_planner(name: str, folder: Path | None = None) -> list[Path]:
    """Write a distribution with one planner, its settings and its test.

    Parameters
    ----------
    name : str
        Of the planner and of the distribution: lower-case letters, digits and single hyphens.
    folder : Path, optional
        Where to; it must be empty, or not be there. Default: a folder of that name.

    Returns
    -------
    list of Path
        The files: module, pyproject.toml, test.

    Raises
    ------
    PluginError
        If the name can't be used, or there is something in the folder. Nothing is written then.
    """
    module = _module_name(name)
    target = Path(name) if folder is None else folder
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise PluginError(f"{target} is there already. Give another --output, or empty it.")
    words = {
        "name": name,
        "module": module,
        "class_name": "".join(part.capitalize() for part in name.split("-")),
        "interface": INTERFACE,
    }
    files = {
        f"{module}.py": "planner.py.txt",
        "pyproject.toml": "pyproject.toml.txt",
        f"test_{module}.py": "test_planner.py.txt",
    }
    target.mkdir(parents=True, exist_ok=True)
    for file, template in files.items():
        text = Template((TEMPLATES / template).read_text(encoding="utf-8")).substitute(words)
        (target / file).write_text(text, encoding="utf-8")
    return [target / file for file in files]


def _module_name(name: str) -> str:
    """The module of a planner's name, if both are free."""
    if not NAME.fullmatch(name):
        raise PluginError(
            f"'{name}' is no name for a planner. Use lower-case letters, digits and single "
            "hyphens, and begin with a letter: my-planner."
        )
    if name in planner_names():
        raise PluginError(f"there is a planner '{name}' already. Give yours another name.")
    module = name.replace("-", "_")
    taken = module in sys.stdlib_module_names or keyword.iskeyword(module)
    if taken or find_spec(module) is not None:
        raise PluginError(
            f"'{name}' would be the module {module}, which Python has already. Give another name."
        )
    return module
