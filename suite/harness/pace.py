"""How fast runs end, and so how long the others will take, as far as that can be said yet."""

from dataclasses import dataclass

ENOUGH_RUNS = 10
ENOUGH_S = 30.0
"""A rate is told after so many runs, or after so long: a run may take an hour."""


@dataclass(slots=True)
class Pace:
    """The rate of the runs of a session, from the end of its first round on.

    What comes before is left out: compiling and loading would be taken for the rate. A round is as
    many runs as go on side by side. They began together, so they may end one right after the other:
    it takes a whole round more to see how long one takes.

    begin : seconds on the caller's clock, when the first round had ended; None before that.
    before : runs that had ended then.
    ran : runs that have ended by now.
    seconds : since ``begin``.
    round : the most runs that went on side by side.
    """

    begin: float | None = None
    before: int = 0
    ran: int = 0
    seconds: float = 0.0
    round: int = 1

    def see(self, ran: int, at_a_time: int, now: float) -> None:
        """Take note of how many runs of this session have ended by now, and go on side by side."""
        self.round = max(self.round, at_a_time)
        if self.begin is None and ran >= self.round:
            self.begin, self.before = now, ran
        if self.begin is not None:
            self.ran, self.seconds = ran, now - self.begin

    def rate(self) -> float | None:
        """Runs per second; None while it would mean nothing."""
        more = self.ran - self.before
        if more < self.round or not self.seconds > 0.0:
            return None
        is_enough = more >= ENOUGH_RUNS or self.seconds >= ENOUGH_S
        return more / self.seconds if is_enough else None
