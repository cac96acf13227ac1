"""`make judge`: a table, and an exit code that says whether a bound is broken."""

from io import StringIO

import pytest

pytest.importorskip('mujoco', reason='the extra physics is not installed')

from rich.console import Console

from wrist_control.studies import judge
from wrist_control.studies.judgement import Verdict
from wrist_control.wrists import WRISTS

GOOD = Verdict(50, 1e-8, 2e-8, 3e-9, 4e-9, 65432.1)
BAD = GOOD._replace(attitude=2e-6)


def shown(verdicts):
    console = Console(file=StringIO(), width=80)
    console.print(judge.table(verdicts, 0.0002))
    return console.file.getvalue()


def test_the_table_is_readable_in_80_columns():
    text = shown(dict.fromkeys(WRISTS, GOOD))
    assert '…' not in text
    for name in WRISTS:
        (row,) = (line for line in text.splitlines() if line.split()[:1] == [name])
        assert row.split() == [name, '50', '1e-08', '2e-08', '3e-09', '4e-09', '65432']
    assert 'steps of 0.2 ms' in text


@pytest.mark.parametrize('broken', [False, True])
def test_a_broken_bound_is_said_and_ends_it_with_an_error(broken, monkeypatch, capsys):
    asked = []

    def judged(wrist, poses, settings, seen):
        asked.append((poses, settings.step))
        seen()
        return BAD if broken and type(wrist).__name__ == 'Carpal' else GOOD

    monkeypatch.setattr(judge, 'judge', judged)
    assert judge.main(7, 0.001) is broken
    assert asked == [(7, 0.001)] * len(WRISTS)
    assert ('Beyond the bound: carpal.' in capsys.readouterr().out) is broken


def test_a_difference_that_is_no_number_is_beyond_the_bound():
    assert not GOOD._replace(attitude=float('nan')).worst <= judge.BOUND
    assert GOOD.worst == 2e-8
