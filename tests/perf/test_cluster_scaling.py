from types import SimpleNamespace

from tests.perf.cluster_scaling import _note, scaling_table


def test_each_row_has_the_time_at_which_it_came():
    times = []
    for done in (0, 0, 1, 3, 3):
        _note(SimpleNamespace(done=done), times)
    assert len(times) == 3
    assert times[1] == times[2] >= times[0]


def test_the_table_has_a_row_per_measurement():
    measured = {"executor": "dask", "workers": 2, "rows": 60, "rows per second": 3.9}
    table = scaling_table([measured, measured | {"executor": "local"}], load=12.3)
    assert table.frame["executor"].tolist() == ["dask", "local"]
    assert "0.5 s" in table.title
    assert "load average was 12.3 before" in table.note
