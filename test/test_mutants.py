"""The lists that `make mutants` goes by are true: every text and every file is still there."""

from pathlib import Path

import mutants


def test_every_chosen_fault_can_be_made():
    assert len(mutants.chosen()) >= 37


def test_every_fault_that_is_none_would_be_made_if_it_were_not_left_out():
    for one in mutants.EQUIVALENT:
        source = (mutants.PACKAGE / one.file).read_bytes()
        lines = [line.strip() for line in source.decode().splitlines()]
        made = [fault for place in mutants.points(one.file, source) for fault in place]
        assert one[1:4] in {(lines[x.line - 1], x.before, x.after) for x in made}, one


def test_every_module_has_tests_that_matter_and_all_of_them_are_there():
    for folder in mutants.FOLDERS:
        for path in (mutants.PACKAGE / folder).glob('*.py'):
            tests = mutants.tests_of(f'{folder}/{path.name}')
            # One that a change of names has lost would be left with what all are tested by.
            assert len(tests) > 1 or path.name == '__init__.py', path.name
            assert [test for test in tests if not Path(test).is_file()] == []
