import matplotlib.pyplot as plt
import pytest

from suite.report.figures.files import save
from suite.report.figures.studies import study_figures
from suite.report.tables.ablation import OPERATORS
from suite.report.tables.studies import STUDIES
from tests.suite.report.study_rows import run, runs_of

SCENES = ("unstructured", "maze", "zigzag", "double_u", "clustered")
WHOLE = {f"{operator}_probability": 0.9 for operator in OPERATORS}
PART = WHOLE | {"repair_probability": 0.0}


@pytest.fixture(scope="module")
def figures():
    records = []
    for scene in SCENES:
        for study in STUDIES:
            for planner in study.planners:
                for value in (study.reference, study.reference + 0.4):
                    settings = {study.setting: value, "of": study.name}
                    cost = None if planner == "plain-ga" and scene == "maze" else 110.0
                    name = f"{study.name}-{planner}-{value}"
                    records.append(run(name, settings, cost, planner=planner, scene=scene))
        for name, settings, cost in (("whole", WHOLE, 100.0), ("part", PART, None)):
            records.append(run(name, settings, cost, scene=scene))
    records += [run("kbga", {"rounds": 8}, 110.0, scene=f"obstacles_{n}") for n in (20, 30, 40)]
    records += [run("kbga", {"rounds": 8}, 110.0, scene=f"scattered_{n}") for n in (100, 3000)]
    made = study_figures(runs_of(*records))
    yield made
    for figure in made.values():
        plt.close(figure)


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_every_study_has_its_figure(figures):
    studies = {f"study-{study.name}" for study in STUDIES}
    assert set(figures) == studies | {"study-ablation", "study-obstacles"}


def test_runs_without_a_study_have_none():
    assert study_figures(runs_of(run("kbga", {"resolution": 100}, 110.0))) == {}


def test_where_no_run_found_a_path_the_picture_says_so(figures):
    panels = [axes for axes in figures["study-penalty"].axes if axes.get_visible()]
    assert len(panels) == 2 * len(SCENES)
    alone = [run(f"C{c}", {"penalty": c}, None, planner="plain-ga") for c in (10.0, 100.0)]
    figure = study_figures(runs_of(*alone))["study-penalty"]
    assert [texts(axes) for axes in figure.axes] == [[], ["no path"]]
    plt.close(figure)


def test_planners_are_told_apart_by_colour_line_and_marker(figures):
    lines = [line for line in figures["study-penalty"].axes[0].lines if len(line.get_xdata()) == 2]
    first, second = lines[:2]
    for look in ("get_color", "get_linestyle", "get_marker"):
        assert getattr(first, look)() != getattr(second, look)()


def test_the_paper_stands_in_the_pictures_of_time(figures):
    (legend,) = figures["study-resolution"].legends
    labels = [text.get_text() for text in legend.get_texts()]
    assert sorted(labels) == sorted([*SCENES, "paper, unstructured"])
    time = figures["study-obstacles"].axes[0]
    assert "paper" in [line.get_label() for line in time.lines]
    assert (time.get_xscale(), time.get_yscale()) == ("log", "log")
    assert "µs" in figures["study-obstacles"].axes[1].get_ylabel()


def test_the_ablation_writes_gaps_and_marks_where_no_run_found_a_path(figures):
    axes = figures["study-ablation"].axes[0]
    assert texts(axes).count("0.00") == len(SCENES)
    assert texts(axes).count("0/1") == len(SCENES)
    assert len([patch for patch in axes.patches if patch.get_hatch()]) == len(SCENES)
    assert [label.get_text() for label in axes.get_xticklabels()] == list(SCENES)


@pytest.mark.parametrize("name", ["study-penalty", "study-ablation"])
def test_figures_are_small_files(figures, tmp_path, name):
    save(figures[name], tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size < 150_000
