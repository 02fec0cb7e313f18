"""What a planner could change behind everybody's back, looked at before and after each run."""

import hashlib
import os
import random
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from suite.conformance.environment import set_by_imports, writes
from suite.scenes.scene import Query, Scene


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """The state of this process that is not the planner's.

    folder : current working directory.
    environment : the variables.
    random_state : of the global generators of ``random`` and of numpy, as text.
    """

    folder: str
    environment: dict[str, str]
    random_state: tuple[str, str]
    _writes: int
    _python: Any
    _numpy: Any

    @classmethod
    def now(cls) -> "Surroundings":
        """Look at them."""
        python: Any = random.getstate()
        legacy: Any = np.random.get_state()  # noqa: NPY002
        # The state's array is shortened by repr, so it goes in as a list.
        texts = (_digest(repr(python)), _digest(repr((*legacy[2:], legacy[1].tolist()))))
        return cls(str(Path.cwd()), dict(os.environ), texts, writes(), python, legacy)

    def restore(self) -> None:
        """Put back what has changed, so that it disturbs nothing else."""
        os.chdir(self.folder)
        if dict(os.environ) != self.environment:
            os.environ.clear()
            os.environ.update(self.environment)
        random.setstate(self._python)
        np.random.set_state(self._numpy)  # noqa: NPY002

    def changed_variables(self, after: "Surroundings") -> list[str]:
        """Names of the variables that are others afterwards, and not by the import of a library."""
        mine, others = self.environment, after.environment
        changed = {k for k in mine.keys() | others.keys() if mine.get(k) != others.get(k)}
        return sorted(changed - set_by_imports(self._writes, after._writes))

    def changed_generators(self, after: "Surroundings") -> list[str]:
        """Names of the global generators that were drawn from or seeded."""
        pairs = zip(("random", "numpy.random"), self.random_state, after.random_state, strict=True)
        return [name for name, before, now in pairs if before != now]


def fingerprint(scene: Scene, query: Query) -> str:
    """Hash of all that a planner is given of a scene; another one if any of it was written to."""
    shapes = [scene.workspace.wkb, *(obstacle.polygon.wkb for obstacle in scene.obstacles)]
    tables = [table.tobytes() for table in scene.arrays]
    ends = [query.start.tobytes(), query.goal.tobytes()]
    texts = [repr((scene.name, query.name, len(scene.queries), dict(scene.properties))).encode()]
    return hashlib.sha256(b"".join([*shapes, *tables, *ends, *texts])).hexdigest()


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
