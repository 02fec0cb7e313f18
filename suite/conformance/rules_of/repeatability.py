"""Rules about runs that are repeated: the seed decides everything, and nothing else does."""

from functools import lru_cache
from itertools import combinations
from typing import Any

from suite.conformance.finding import Answer, Finding, NotApplicable
from suite.conformance.subject import SEED, Subject, Trial

VARIED = ("one wall", "narrow gap", "500 obstacles")
SEEDS = (1, 2, 3, 4)
SUBJECTS = 4
"""How many are kept in mind: rules that build on others ask for the same runs again."""

TIMED = NotApplicable("it keeps no budget but of time, and timed runs need not repeat.")
UNREPEATED = NotApplicable("two runs with the same seed differ already.")
UNPLANNED = NotApplicable("not all runs end with a plan.")


@lru_cache(maxsize=SUBJECTS)
def same_seed_same_path(subject: Subject) -> Answer:
    """The same seed and counted budget give the same run, to the last bit."""
    hindrance = _hindrance(subject)
    if hindrance is not None:
        return hindrance
    for scene in subject.on(*VARIED):
        one, other = subject.trial(scene), subject.trial(scene)
        if one.outcome != other.outcome:
            return Finding(
                f"{one.label}: two runs differ in {difference(one.outcome, other.outcome)}",
                "the same path, counts and reports",
                "Draw from the `rng` that plan is given and from nothing else; do not iterate "
                "over sets, and let no clock decide where the budget is counted.",
            )
    return None


def another_seed_another_stream(subject: Subject) -> Answer:
    """Another seed gives another run, unless the planner is called deterministic: then the same."""
    found = same_seed_same_path(subject)
    if found is not None:
        return found if isinstance(found, NotApplicable) else UNREPEATED
    runs = [[subject.trial(s, seed=seed) for seed in SEEDS] for s in subject.on(*VARIED)]
    differing = [r for r in runs if len({trial.outcome for trial in r}) > 1]
    alike = _alike(runs)
    drew = any(trial.drew for r in runs for trial in r)
    if subject.planner_class.abilities.deterministic:
        return _not_deterministic(differing[0]) if differing else None
    if not differing and drew and not any(trial.ends for r in runs for trial in r):
        return NotApplicable("no run found a path by which seeds could be told apart.")
    return _no_stream(alike or SEEDS, drew) if alike or not differing else None


def _alike(runs: list[list[Trial]]) -> tuple[int, ...]:
    """Seeds that give the same runs in all scenes, and a path in one; none if there are no two."""
    for one, other in combinations(range(len(SEEDS)), 2):
        same = all(trials[one].outcome == trials[other].outcome for trials in runs)
        if same and any(trials[one].ends for trials in runs):
            return SEEDS[one], SEEDS[other]
    return ()


def _not_deterministic(runs: list[Trial]) -> Finding:
    return Finding(
        f"{runs[0].label}: other seeds give other runs",
        "the same run for every seed, as abilities say that it is deterministic",
        "Leave `deterministic` out of abilities.",
    )


def _no_stream(seeds: tuple[int, ...], drew: bool) -> Finding:
    what = "" if drew else ", and nothing is drawn from rng"
    return Finding(
        f"the seeds {', '.join(map(str, seeds))} give the same run on each of {len(VARIED)} "
        f"scenes{what}",
        "runs that differ, or Abilities(deterministic=True)",
        "Draw from the `rng` that plan is given, not from a generator with a fixed seed, or with "
        "one of a few. A planner without randomness says so: Abilities(deterministic=True).",
    )


@lru_cache(maxsize=SUBJECTS)
def keeps_no_state(subject: Subject) -> Answer:
    """A planner that has run before, elsewhere, gives the same run as the very first one."""
    found = same_seed_same_path(subject)
    if found is not None:
        return found if isinstance(found, NotApplicable) else UNREPEATED
    used = subject.build()
    for scene in subject.on("enclosed goal", *VARIED):
        subject.trial(scene, seed=SEED + 1, planner=used)
    # What a module or a class keeps is met by every run but the first.
    first = {trial.scene.name: trial for trial in subject.ordinary_trials}
    for scene in subject.on(*VARIED):
        fresh, again = first[scene.name], subject.trial(scene, planner=used)
        if fresh.outcome != again.outcome:
            return Finding(
                f"{again.label}: a planner that had run before differs from a new one in "
                f"{difference(fresh.outcome, again.outcome)}",
                "the same path, counts and reports",
                "Keep what belongs to a run in local variables of plan, not in self, in the class "
                "or in the module.",
            )
    return None


def _hindrance(subject: Subject) -> NotApplicable | None:
    """Why repeated runs say nothing of this planner."""
    if subject.is_timed and not subject.planner_class.abilities.deterministic:
        return TIMED
    return UNPLANNED if any(trial.plan is None for trial in subject.ordinary_trials) else None


def difference(one: tuple[Any, ...], other: tuple[Any, ...]) -> str:
    """What two outcomes of :class:`Trial` differ in, in words."""
    names = ("status", "path", "generations", "checks", "computed checks", "reports")
    if len(one) != len(names) or len(other) != len(names):
        return "whether they end well"
    pairs = zip(names, one, other, strict=True)
    return ", ".join(name for name, mine, yours in pairs if mine != yours)
