"""The same table, to the byte, whoever runs the work; and what a run says."""

import os
import random
import signal
import sys
import threading

import pandas
import pytest
import servoid as sv
from conftest import DIAGNOSE, FIT, SHARDS, UNITS, Folder
from servoid import fleet
from servoid.fleet._census import census, usual_tasks
from servoid.fleet._command import main
from servoid.fleet._task import Order, mark


def test_of_one_thread_and_of_all(lot, fitted, tmp_path):
    done = fleet.run(lot, tmp_path / "out", do="fit", effects=["coulomb"], table=tmp_path / "table.parquet")
    assert done == sv.Done(UNITS, 0, UNITS, 0, False)
    assert (tmp_path / "table.parquet").read_bytes() == fitted


@pytest.mark.parametrize("count", [7, UNITS + 3])
def test_of_shards_in_any_order(lot, fitted, tmp_path, count):
    order = list(range(1, count + 1))
    random.Random(count).shuffle(order)
    for index in order:
        sv.batch(lot, tmp_path / "out", do="fit", effects=["coulomb"], shard=f"{index}/{count}")
    assert fleet.run(lot, tmp_path / "out", do="fit", effects=["coulomb"], table=tmp_path / "table.parquet").made == 0
    assert (tmp_path / "table.parquet").read_bytes() == fitted


@pytest.mark.parametrize("engine", ["ray", "dask"])
def test_of_an_engine(lot, fitted, tmp_path, drive, monkeypatch, engine):
    # Paths are those of whoever asks, wherever tasks run.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "here.parquet").symlink_to(lot)
    command = ["here.parquet", "out", "--engine", engine, *FIT, "--table", "table.parquet"]
    driver = drive(*command)
    done = driver.ended()
    assert [done[name] for name in ("recordings", "there", "made", "errors")] == [UNITS, 0, UNITS, 0]
    assert (tmp_path / "table.parquet").read_bytes() == fitted
    # One line on stderr, where that is no terminal.
    said = driver.errors()
    assert said.startswith(f"fleet: {UNITS} of {UNITS} recordings in ") and said.count("\n") == 1, said
    done = drive(*command).ended()
    assert [done[name] for name in ("recordings", "there", "made", "errors")] == [UNITS, UNITS, 0, 0]


@pytest.mark.parametrize("engine", ["local", "ray", "dask"])
def test_ctrl_c_keeps_what_was_done(lot, diagnosed, tmp_path, drive, engine):
    folder = Folder(tmp_path / "out")
    command = [lot, folder.path, "--engine", engine, *DIAGNOSE]
    driver = drive(*command)
    assert driver.until(lambda: folder.rows() >= 3)
    driver.family()
    # As a terminal sends it: to all of the process group.
    os.killpg(driver.process.pid, signal.SIGINT)
    done = driver.ended(code=1, seconds=30.0)
    assert done.get("interrupted"), driver.errors()
    assert "stopped by the user" in driver.errors() and "Traceback" not in driver.errors(), driver.errors()
    driver.gone(folder)
    kept = folder.rows()
    assert 3 <= kept < UNITS
    local = sv.batch(lot, folder.path, do="diagnose", budget=20, table=tmp_path / "table.parquet")
    assert local.recordings == UNITS
    assert (tmp_path / "table.parquet").read_bytes() == diagnosed


def test_ctrl_c_leaves_the_session_of_the_caller(lot, diagnosed, tmp_path):
    # Here, as it reads its settings when it is imported.
    import ray

    folder = Folder(tmp_path / "out")
    ended = threading.Event()

    def press() -> None:
        while not ended.wait(0.02):
            if folder.rows() >= 3:
                os.kill(os.getpid(), signal.SIGINT)
                return

    ray.init(address="local", num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        pressed = threading.Thread(target=press)
        pressed.start()
        done = fleet.run(lot, folder.path, engine="ray", budget=20, tasks=SHARDS, progress=False)
        ended.set()
        pressed.join()
        assert done.interrupted
        # It is free again when the shards that had begun have ended, and the others never begin.
        assert ray.get(ray.remote(num_cpus=2)(lambda: True).remote(), timeout=60.0)
        assert 3 <= folder.rows() < UNITS
    finally:
        ray.shutdown()
    sv.batch(lot, folder.path, do="diagnose", budget=20, table=tmp_path / "table.parquet")
    assert (tmp_path / "table.parquet").read_bytes() == diagnosed


def test_a_missing_engine_says_how_to_get_it(lot, tmp_path, monkeypatch, capsys):
    for engine, module in (("ray", "ray"), ("dask", "distributed")):
        monkeypatch.setitem(sys.modules, module, None)
        assert main(["run", str(lot), str(tmp_path / "out"), "--engine", engine]) == 2
        said = capsys.readouterr().err
        assert f'engine {engine}: the package {module} is not installed; pip install "{module}>=' in said


def test_what_cannot_be_asked_for_is_usage(lot, tmp_path, capsys):
    for arguments, why in (
        (["--tasks", "3"], "tasks and address are for the engines"),
        (["--engine", "ray", "--address", "auto", "--workers", "2"], "workers is for this machine"),
        (["--do", "fit", "--with", "nothing"], "unknown effect"),
    ):
        assert main(["run", str(lot), str(tmp_path / "out"), *arguments]) == 2
        assert why in capsys.readouterr().err
    for arguments in (["--engine", "spark"], ["--workers", "0"], ["--retry", "all"]):
        with pytest.raises(SystemExit, match="2"):
            main(["run", str(lot), str(tmp_path / "out"), *arguments])
    assert main(["run", str(tmp_path / "nowhere"), str(tmp_path / "out")]) == 1
    assert "nowhere: there is no such file or folder" in capsys.readouterr().err


def test_errors_of_shards_are_one_message(tmp_path, drive):
    pandas.DataFrame({"time": [[0.0, 1.0]] * 4}).to_parquet(tmp_path / "other.parquet", row_group_size=1)
    driver = drive(tmp_path / "other.parquet", tmp_path / "out", "--engine", "dask", "--tasks", 4, "--quiet")
    assert driver.ended(code=1) == {}
    said = driver.errors()
    assert said.count("there is no column t_s") == 1 and said.startswith("servoid.fleet: "), said


def test_a_task_does_no_work_elsewhere(lot, tmp_path):
    order = Order(str(lot), str(tmp_path), mark(str(tmp_path)), sv.__version__, 0.0, {})
    assert mark(str(tmp_path)) == order.mark
    for other, why in (({"version": "0.0.0"}, "install one version"), ({"mark": "another"}, "another folder")):
        outcome = Order(**{**{name: getattr(order, name) for name in order.__slots__}, **other})("1/2")
        assert outcome.done is None and why in outcome.message
    assert not list(tmp_path.glob("lock-*"))


def test_how_many_tasks(lot, tmp_path):
    assert census(str(lot)) == (UNITS, SHARDS)
    assert usual_tasks(4, UNITS, SHARDS) == SHARDS
    assert usual_tasks(2, UNITS, SHARDS) == 8
    assert usual_tasks(5, UNITS, SHARDS) == 20
    assert usual_tasks(100, UNITS, None) == UNITS
    assert usual_tasks(2, None, None) == 8
    assert usual_tasks(2, 0, 0) == 1
    (tmp_path / "a.csv").write_text("")
    assert census(str(tmp_path)) == (1, None)
