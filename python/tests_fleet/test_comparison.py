"""The same comparison of search methods, whoever does its runs."""

import json
import re
import shutil
import subprocess

import pytest
import servoid as sv
from servoid import fleet

SEEDS, FIRST, BUDGET = 5, 11, 60
ARGUMENTS = ("--algorithm", "lm,pso,random", "--window", "0.5")


@pytest.fixture(autouse=True)
def small_parts(monkeypatch):
    """Parts of two seeds: three of them."""
    monkeypatch.setattr("servoid.fleet._comparison.SEEDS", 2)


@pytest.fixture(scope="module")
def recording(program, tmp_path_factory):
    """A recording, with its motor.toml."""
    path = tmp_path_factory.mktemp("recorded") / "rec.csv"
    subprocess.run([program, "simulate", "--seconds", "1", "--out", path], check=True, capture_output=True)
    return path


def alone(program, recording, *arguments):
    """The program alone: table and JSON."""
    path = recording.with_name("alone.json")
    command = [program, "compare", recording, *arguments, "--json", path, "-q"]
    text = subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout
    return untimed(fleet.Joint(text, path.read_text()))


def untimed(joint):
    """Table and JSON to the byte, without computing times."""
    return [line[:72] for line in joint.text.splitlines()], untimed_json(joint.json)


def untimed_json(text):
    return re.sub(r'"wall_s": ?[-+.e0-9]+', "", text)


def kept(out):
    """The parts, and when they were written."""
    return {part: part.stat().st_mtime_ns for part in out.glob("compare-*.json")}


@pytest.mark.parametrize("engine", ["local", "ray", "dask"])
def test_a_table_is_the_programs_own_with_any_engine(program, recording, tmp_path, engine):
    def compare():
        (found,) = fleet.compare(
            tmp_path / "out", [recording], ARGUMENTS, seeds=SEEDS, seed=FIRST, budget=BUDGET, engine=engine, program=program
        )
        return untimed(found)

    own = ["--seeds", SEEDS, "--seed", FIRST, "--budget", BUDGET]
    assert compare() == alone(program, recording, *ARGUMENTS, *own)
    parts = sorted((tmp_path / "out").glob("compare-*.json"))
    assert len(parts) == 3
    # One part is lost: it alone is done again, and is the same.
    whole, before = untimed_json(parts[0].read_text()), kept(tmp_path / "out")
    parts[0].unlink()
    assert compare() == alone(program, recording, *ARGUMENTS, *own)
    after = kept(tmp_path / "out")
    assert [part for part in parts if after[part] != before[part]] == parts[:1]
    assert untimed_json(parts[0].read_text()) == whole


@pytest.mark.parametrize("engine", ["local", "ray"])
def test_a_comparison_that_was_killed_goes_on(program, recording, tmp_path, drive, engine):
    # Parts of 20 seeds: the process is another one.
    parts = 12
    own = ["--algorithm", "lm,pso", "--seeds", 20 * parts, "--budget", 1000]
    out = tmp_path / "out"
    command = [out, recording, "--engine", engine, "--workers", 2, "--program", program, *own]
    driver = drive(*command, verb="compare")
    assert driver.until(lambda: len(kept(out)) >= 3)
    driver.close()
    assert driver.process.returncode != 0
    before = kept(out)
    assert 3 <= len(before) < parts
    found = drive(*command, verb="compare").ended()
    after = kept(out)
    assert len(after) == parts
    assert before.items() <= after.items()
    assert untimed_json(json.dumps(found)) == untimed_json(json.dumps(json.loads(by_program(program, recording, own))))


def by_program(program, recording, own):
    command = [program, "compare", recording, *own, "--json", "-", "-q"]
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def test_more_seeds_are_further_parts(program, recording, tmp_path):
    def compare(seeds):
        return fleet.compare(tmp_path / "out", [recording], ARGUMENTS, seeds=seeds, budget=BUDGET, program=program)

    compare(4)
    before = kept(tmp_path / "out")
    compare(7)
    after = kept(tmp_path / "out")
    assert (len(before), len(after)) == (2, 4)
    assert before.items() <= after.items()


def test_another_recording_motor_or_option_is_another_part(program, recording, tmp_path):
    own = tmp_path / "rec.csv"
    motor = tmp_path / "motor.toml"
    shutil.copy(recording, own)
    shutil.copy(recording.with_name("motor.toml"), motor)

    def compare(*arguments, **options):
        fleet.compare(tmp_path / "out", [own], arguments, seeds=2, budget=10, program=program, **options)
        return len(kept(tmp_path / "out"))

    assert compare("--algorithm", "lm") == 1
    assert compare("--algorithm", "pso") == 2
    assert compare("--algorithm", "pso", motor=motor) == 2
    assert compare("--algorithm", "pso", seed=2) == 3
    lines = own.read_text().splitlines(keepends=True)
    own.write_text("".join(lines[:-1]))
    assert compare("--algorithm", "pso") == 4
    motor.write_text(motor.read_text() + "# Another one.\n")
    assert compare("--algorithm", "pso") == 5


def test_several_recordings_have_a_table_each(program, recording, tmp_path, drive):
    other = tmp_path / "other.csv"
    subprocess.run([program, "simulate", "--seconds", "1", "--seed", "2", "--out", other], check=True, capture_output=True)
    out, own = tmp_path / "out", ["--seeds", 3, "--budget", 20, "--algorithm", "lm"]
    found = drive(out, recording, other, "--program", program, *own, verb="compare").ended()
    assert found["schema"] == "servoid.fleet_compare/1"
    assert [one["recording"] for one in found["recordings"]] == [str(recording), str(other)]
    for one in found["recordings"]:
        plain = json.loads(by_program(program, one["recording"], own))
        assert untimed_json(json.dumps(one["compare"])) == untimed_json(json.dumps(plain))


@pytest.mark.parametrize("argument", ["--seeds", "--out=x", "--merge", "--write-motor", "--motor=x"])
def test_what_the_comparison_sets_itself_is_refused(program, recording, tmp_path, argument):
    with pytest.raises(sv.UsageError, match="leave it out"):
        fleet.compare(tmp_path / "out", [recording], [argument], program=program)


def test_what_the_program_refuses_is_told(program, recording, tmp_path):
    with pytest.raises(sv.UsageError, match="psoo"):
        fleet.compare(tmp_path / "out", [recording], ["--algorithm", "psoo"], seeds=2, program=program)
    with pytest.raises(sv.Error, match="no such file"):
        fleet.compare(tmp_path / "out", [tmp_path / "none.csv"], program=program)
    with pytest.raises(sv.UsageError, match="seeds are from"):
        fleet.compare(tmp_path / "out", [recording], seed=2**64, program=program)
