"""The matrix `plus` takes each difference between the two planners once each way."""

from dataclasses import fields

from kbga import KBGAPlusSettings, KBGASettings
from suite.harness.matrix import load_matrix


def test_the_matrix_plus_has_each_difference_both_ways_and_no_other_variant():
    paper, plus = KBGASettings(), KBGAPlusSettings()
    differs = [f.name for f in fields(paper) if getattr(paper, f.name) != getattr(plus, f.name)]
    wanted = {("kbga", "kbga", None, None), ("kbga-plus", "kbga-plus", None, None)}
    wanted |= {(f"kbga-with-{n}", "kbga", n, getattr(plus, n)) for n in differs}
    wanted |= {(f"kbga-plus-without-{n}", "kbga-plus", n, getattr(paper, n)) for n in differs}
    defaults = {"kbga": paper, "kbga-plus": plus}
    found = set()
    for variant in load_matrix("plus").variants:
        own = defaults[variant.plugin.name]
        changed = [(n, v) for n, v in variant.settings.items() if v != getattr(own, n)]
        assert len(changed) <= 1, variant.name
        found.add((variant.name, variant.plugin.name, *(changed[0] if changed else (None, None))))
    assert found == wanted
