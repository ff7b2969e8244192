"""The same proof, whoever does its cases."""

import json
import subprocess

import pytest
import servoid as sv
from servoid import fleet

CASES = 5
COVERED = ("--effect", "coulomb", "--seed", "5")
ARGUMENTS = ("--hidden", "none", "--seed", "5")


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    """Parts of two cases: three of them."""
    monkeypatch.setattr("servoid.fleet._proof.CASES", 2)


@pytest.fixture(scope="module")
def alone(program, tmp_path_factory):
    """The coverage of the program alone."""
    path = tmp_path_factory.mktemp("alone") / "coverage.json"
    command = [program, "prove", "--coverage", "--cases", str(CASES), *COVERED, "--json", path, "-q"]
    subprocess.run(command, check=True, capture_output=True)
    return json.loads(path.read_text())


def numbers(value):
    """All numbers of a document, in their order."""
    if isinstance(value, dict | list):
        for one in value.values() if isinstance(value, dict) else value:
            yield from numbers(one)
    elif isinstance(value, int | float):
        yield value


@pytest.mark.parametrize("engine", ["local", "ray", "dask"])
def test_coverage_is_the_same_with_any_engine(program, alone, tmp_path, engine):
    def prove():
        return fleet.prove(tmp_path / "out", COVERED, cases=CASES, coverage=True, engine=engine, program=program)

    proven = prove()
    # The errors are those of the same cases, a part's after the other's.
    assert sorted(numbers(proven.to_dict())) == pytest.approx(sorted(numbers(alone)), rel=1e-6)
    parts = sorted((tmp_path / "out").glob("coverage-*.json"))
    assert len(parts) == 3
    # One part is lost: it alone is done again.
    kept = [part.stat().st_mtime_ns for part in parts[1:]]
    parts[0].unlink()
    assert prove().json == proven.json
    assert [part.stat().st_mtime_ns for part in parts[1:]] == kept


def test_a_proof_that_was_cut_goes_on(program, tmp_path):
    proven = fleet.prove(tmp_path / "out", ARGUMENTS, cases=2, program=program)
    (part,) = (tmp_path / "out").glob("prove-*.jsonl")
    whole = part.read_bytes()
    part.rename(f"{part}.begun").write_bytes(whole[: len(whole) // 2])
    again = fleet.prove(tmp_path / "out", ARGUMENTS, cases=2, program=program)
    # But for how long it took.
    found = [[group["shares"] for group in one.to_dict()["groups"]] for one in (proven, again)]
    assert found[0] == found[1]


@pytest.mark.parametrize("argument", ["--cases", "--out=x", "--shard"])
def test_what_the_proof_sets_itself_is_refused(program, tmp_path, argument):
    with pytest.raises(sv.UsageError, match="leave it out"):
        fleet.prove(tmp_path / "out", [argument], program=program)


def test_what_the_program_refuses_is_told(program, tmp_path):
    with pytest.raises(sv.UsageError):
        fleet.prove(tmp_path / "out", ["--hidden", "three"], cases=2, program=program)
    with pytest.raises(sv.UsageError, match="no such program"):
        fleet.prove(tmp_path / "out", cases=2, program="no-such-servoid")
