"""The errors that a user can meet. Each message says what, where, and how to mend it."""


class KbgaBenchError(Exception):
    """Base of every error that the suite raises on purpose."""


class SceneError(KbgaBenchError):
    """A scene file or a scene's geometry can't be used."""


class PluginError(KbgaBenchError):
    """A planner can't be found, imported, or built with the given settings."""


class ContractError(KbgaBenchError):
    """A planner broke the plugin contract of ``suite.planner``."""


class MatrixError(KbgaBenchError):
    """A matrix file can't be used."""


class StoreError(KbgaBenchError):
    """A result store can't be opened, read or written."""


class HarnessError(KbgaBenchError):
    """The harness can't go on with a matrix."""
