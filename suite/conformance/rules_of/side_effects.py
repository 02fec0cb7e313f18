"""Rules about what is not the planner's: it reads it, and leaves it as it was."""

from collections.abc import Callable

from suite.conformance.finding import Answer, Finding
from suite.conformance.subject import Subject, Trial
from suite.conformance.surroundings import Surroundings


def leaves_the_scene_alone(subject: Subject) -> Answer:
    """A run writes to neither the scene nor the query."""
    return _first(
        subject,
        lambda trial: "the scene or the query was written to" if trial.scene_changed else "",
        "a scene and a query as they were: all runs of a matrix share them",
        "Copy what you change: np.array(query.start), scene.arrays.vertices.copy().",
    )


def leaves_random_state_alone(subject: Subject) -> Answer:
    """A run neither draws from nor seeds the global generators of random and numpy."""
    return _around(
        subject,
        lambda before, after: _told("used: ", before.changed_generators(after)),
        "global generators that nobody has touched",
        "Draw from the `rng` that plan is given; hand it, or a seed drawn from it, to libraries.",
    )


def leaves_the_folder_alone(subject: Subject) -> Answer:
    """A run ends in the working directory in which it began."""

    def look(before: Surroundings, after: Surroundings) -> str:
        same = before.folder == after.folder
        return "" if same else f"it ends in {after.folder}, and began in {before.folder}"

    mend = "Use whole paths, and tempfile.TemporaryDirectory, instead of os.chdir."
    return _around(subject, look, "the working directory in which it began", mend)


def leaves_the_environment_alone(subject: Subject) -> Answer:
    """A run changes no environment variable, but by the import of a library."""
    return _around(
        subject,
        lambda before, after: _told("changed: ", before.changed_variables(after)),
        "the variables as they were",
        "Hand values to a library by its arguments, or put the variables back.",
    )


def leaves_the_clock_alone(subject: Subject) -> Answer:
    """A run does not set the recorder's clock to zero again."""
    return _first(
        subject,
        lambda trial: "plan called recorder.start_clock" if trial.run.restarted else "",
        "a clock that was started by the harness, immediately before plan",
        "Leave the call out: all that plan does is its time; what can be done before is warm_up.",
    )


def _told(what: str, names: list[str]) -> str:
    return what + ", ".join(names) if names else ""


def _first(
    subject: Subject, look: Callable[[Trial], str], expected: str, mend: str
) -> Finding | None:
    seen = ((trial, look(trial)) for trial in subject.trials)
    findings = (Finding(f"{trial.label}: {what}", expected, mend) for trial, what in seen if what)
    return next(findings, None)


def _around(
    subject: Subject, look: Callable[[Surroundings, Surroundings], str], expected: str, mend: str
) -> Finding | None:
    """The first finding around the first warm-up, which others of a matrix meet, or around runs."""
    warm_up = subject.warm_up
    what = look(warm_up.before, warm_up.after)
    if what:
        return Finding(f"while it warms up: {what}", expected, mend)
    return _first(subject, lambda trial: look(trial.before, trial.after), expected, mend)
