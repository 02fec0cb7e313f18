"""The contract: all rules, in the order in which they are looked at."""

from collections.abc import Callable, Iterator

from suite.conformance import budgets, declared, elsewhere, left_alone, planned, repeated, replanned
from suite.conformance.finding import Finding, Kind, NotApplicable, Result
from suite.conformance.subject import Subject

Rule = Callable[[Subject], Finding | NotApplicable | None]

FIRST: tuple[Rule, ...] = (declared.is_a_planner, declared.abilities_are_known, planned.warms_up)
"""Without these nothing can be run, and no other rule says anything."""

RULES: tuple[Rule, ...] = (
    *FIRST,
    declared.name_is_well_formed,
    declared.settings_are_frozen,
    declared.settings_come_back,
    declared.pickles,
    planned.runs_end_without_an_exception,
    planned.refuses_with_a_reason,
    planned.refuse_prepares_nothing,
    planned.returns_a_plan,
    planned.path_has_the_right_ends,
    planned.path_is_free,
    planned.solves_what_is_trivial,
    planned.says_that_there_is_no_path,
    planned.infeasible_is_true,
    planned.exact_is_exact,
    planned.improvements_agree_with_the_result,
    planned.anytime_reports,
    planned.claimed_cost_is_the_length,
    left_alone.leaves_the_scene_alone,
    left_alone.leaves_random_state_alone,
    left_alone.leaves_the_folder_alone,
    left_alone.leaves_the_environment_alone,
    left_alone.leaves_the_clock_alone,
    repeated.same_seed_same_path,
    repeated.another_seed_another_stream,
    repeated.keeps_no_state,
    elsewhere.same_path_in_another_process,
    budgets.keeps_generations,
    budgets.keeps_checks,
    budgets.keeps_wall_time,
    budgets.keeps_cpu_time,
    budgets.ends_or_refuses_whatever_the_budget,
    replanned.replans_end_with_a_plan,
    replanned.replans_suit_what_is_known,
    replanned.replans_keep_budgets,
    replanned.replans_repeat,
    replanned.replans_leave_things_alone,
)

WARNINGS: frozenset[Rule] = frozenset({planned.claimed_cost_is_the_length})
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
    found = NotApplicable(f"mend {hindrance} first.") if hindrance else rule(subject)
    if isinstance(found, NotApplicable):
        return Result(name, claim, Kind.NOT_APPLICABLE, reason=found.reason)
    if found is None:
        return Result(name, claim, Kind.KEPT)
    return Result(name, claim, Kind.WARNING if rule in WARNINGS else Kind.BROKEN, found)


def examine(subject: Subject) -> Iterator[Result]:
    """Apply all rules, one after the other, in this process."""
    return (apply(rule, subject) for rule in RULES)


def _hindrance(subject: Subject) -> str | None:
    """The first rule that is broken of those without which nothing can be run."""
    for rule in FIRST:
        if isinstance(rule(subject), Finding):
            return rule_name(rule)
    return None
