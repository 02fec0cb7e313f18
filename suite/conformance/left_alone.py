"""Rules about what is not the planner's: it reads it, and leaves it as it was."""

from collections.abc import Callable

from suite.conformance.finding import Finding, NotApplicable
from suite.conformance.subject import Subject, Trial

Outcome = Finding | NotApplicable | None


def leaves_the_scene_alone(subject: Subject) -> Outcome:
    """A run writes to neither the scene nor the query."""
    return _first(
        subject,
        lambda trial: "the scene or the query was written to" if trial.scene_changed else "",
        "a scene and a query as they were: all runs of a matrix share them",
        "Copy what you change: np.array(query.start), scene.arrays.vertices.copy().",
    )


def leaves_random_state_alone(subject: Subject) -> Outcome:
    """A run neither draws from nor seeds the global generators of random and numpy."""
    return _first(
        subject,
        lambda trial: _told("used: ", trial.before.changed_generators(trial.after)),
        "global generators that nobody has touched",
        "Draw from the `rng` that plan is given; hand it, or a seed drawn from it, to libraries.",
    )


def leaves_the_folder_alone(subject: Subject) -> Outcome:
    """A run ends in the working directory in which it began."""

    def look(trial: Trial) -> str:
        before, after = trial.before.folder, trial.after.folder
        return "" if before == after else f"it ends in {after}, and began in {before}"

    mend = "Use whole paths, and tempfile.TemporaryDirectory, instead of os.chdir."
    return _first(subject, look, "the working directory in which it began", mend)


def leaves_the_environment_alone(subject: Subject) -> Outcome:
    """A run changes no environment variable."""
    return _first(
        subject,
        lambda trial: _told("changed: ", trial.before.changed_variables(trial.after)),
        "the variables as they were",
        "Hand values to a library by its arguments, or put the variables back.",
    )


def _told(what: str, names: list[str]) -> str:
    return what + ", ".join(names) if names else ""


def _first(
    subject: Subject, look: Callable[[Trial], str], expected: str, mend: str
) -> Finding | None:
    seen = ((trial, look(trial)) for trial in subject.trials)
    findings = (Finding(f"{trial.label}: {what}", expected, mend) for trial, what in seen if what)
    return next(findings, None)
