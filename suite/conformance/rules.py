"""The contract: all rules, in the order in which they are looked at."""

from collections.abc import Iterable, Iterator

from suite.conformance.finding import Finding, Kind, NotApplicable, NotTested, Result
from suite.conformance.rules_of import (
    budgets,
    declaration,
    other_processes,
    repeatability,
    replanners,
    runs,
    side_effects,
)
from suite.conformance.subject import Rule, Subject

FIRST: tuple[Rule, ...] = (declaration.is_a_planner, declaration.abilities_are_known, runs.warms_up)
"""Without these nothing can be run, and no other rule says anything."""

RULES: tuple[Rule, ...] = (
    *FIRST,
    declaration.name_is_well_formed,
    declaration.settings_are_frozen,
    declaration.settings_come_back,
    declaration.pickles,
    runs.runs_end_without_an_exception,
    runs.refuses_with_a_reason,
    runs.refuse_prepares_nothing,
    runs.returns_a_plan,
    runs.path_has_the_right_ends,
    runs.path_is_free,
    runs.solves_what_is_trivial,
    runs.says_that_there_is_no_path,
    runs.infeasible_is_true,
    runs.exact_is_exact,
    runs.improvements_agree_with_the_result,
    runs.anytime_reports,
    runs.claimed_cost_is_the_length,
    side_effects.leaves_the_scene_alone,
    side_effects.leaves_random_state_alone,
    side_effects.leaves_the_folder_alone,
    side_effects.leaves_the_environment_alone,
    side_effects.leaves_the_clock_alone,
    repeatability.same_seed_same_path,
    repeatability.another_seed_another_stream,
    repeatability.keeps_no_state,
    other_processes.same_path_in_another_process,
    budgets.keeps_generations,
    budgets.keeps_checks,
    budgets.keeps_wall_time,
    budgets.keeps_cpu_time,
    budgets.ends_or_refuses_whatever_the_budget,
    replanners.replans_end_with_a_plan,
    replanners.replans_suit_what_is_known,
    replanners.replans_keep_budgets,
    replanners.replans_repeat,
    replanners.replans_leave_things_alone,
)

WARNINGS: frozenset[Rule] = frozenset({runs.claimed_cost_is_the_length})
"""Rules that ask for a look: no result becomes wrong if they are broken."""


def rule_name(rule: Rule) -> str:
    """The name of a rule, as users see it.

    Examples
    --------
    >>> rule_name(RULES[0])
    'is-a-planner'
    """
    return rule.__name__.replace("_", "-")


def claim_of(rule: Rule) -> str:
    """What a rule asks, in one sentence."""
    return (rule.__doc__ or "").splitlines()[0]


def apply(rule: Rule, subject: Subject) -> Result:
    """What a rule says of a planner.

    Parameters
    ----------
    rule : one of RULES
    subject : Subject

    Returns
    -------
    Result
    """
    name, claim = rule_name(rule), claim_of(rule)
    hindrance = None if rule in FIRST else _hindrance(subject)
    subject.begin_rule()
    found = NotTested(f"mend {hindrance} first.") if hindrance else rule(subject)
    if found is None and subject.is_blank:
        found = NotTested(f"its runs on {_quoted(subject.missed)} end the process.")
    if isinstance(found, NotTested):
        return Result(name, claim, Kind.NOT_TESTED, reason=found.reason)
    if isinstance(found, NotApplicable):
        return Result(name, claim, Kind.NOT_APPLICABLE, reason=found.reason)
    if found is None:
        missed = f"not tested on {_quoted(subject.missed)}" if subject.missed else None
        return Result(name, claim, Kind.KEPT, reason=missed)
    return Result(name, claim, Kind.WARNING if rule in WARNINGS else Kind.BROKEN, found)


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in sorted(names))


def examine(subject: Subject) -> Iterator[Result]:
    """Apply all rules, one after the other, in this process."""
    return (apply(rule, subject) for rule in RULES)


def _hindrance(subject: Subject) -> str | None:
    """The first rule that is broken of those without which nothing can be run."""
    for rule in FIRST:
        if isinstance(rule(subject), Finding):
            return rule_name(rule)
    return None
