"""Drivers, workers and nodes that are killed: all is done in the end, and nothing twice but what was in hand."""

import os
import random
import signal
import time

import psutil
import pytest
from conftest import DIAGNOSE, SHARDS, UNITS, Folder

KILLS = 20 if os.environ.get("SERVOID_LONG") else 3
#: Recordings that are in hand at a time.
WORKERS = 2


@pytest.mark.parametrize("engine", ["local", "ray"])
def test_of_drivers_that_are_killed(lot, diagnosed, tmp_path, drive, engine):
    seed = int(os.environ.get("SERVOID_SEED", time.time_ns() % 2**32))
    print(f"SERVOID_SEED={seed} makes the same draws again")
    draw = random.Random(seed)
    own = ["--tasks", SHARDS] if engine == "ray" else []
    left = KILLS
    rounds = 0
    while left > 0:
        rounds += 1
        folder = Folder(tmp_path / f"out {rounds}")
        command = [lot, folder.path, "--engine", engine, "--workers", WORKERS, *own, *DIAGNOSE]
        kills = 0
        while left > 0 and folder.rows() < UNITS:
            driver = drive(*command)
            if draw.random() < 0.2:
                time.sleep(draw.uniform(0.0, 4.0))
            else:
                have = folder.rows()
                rows = have + draw.randint(1, max(1, (UNITS - have) // min(left, 3)))
                driver.until(lambda rows=rows: folder.rows() >= min(rows, UNITS - 2 * WORKERS))
                time.sleep(draw.uniform(0.0, 0.3))
            driver.kill(group=draw.random() < 0.5)
            kills += 1
            left -= 1
            # Now and then the next one comes while workers of this one still die.
            if draw.random() < 0.5:
                driver.gone(folder)
        driver.gone(folder)
        kept = folder.rows()
        print(f"{engine}: {kills} kills, {kept} rows kept")
        done = drive(*command, "--table", tmp_path / "table.parquet").ended()
        assert [done[name] for name in ("recordings", "there", "made", "errors")] == [UNITS, kept, UNITS - kept, 0]
        assert (tmp_path / "table.parquet").read_bytes() == diagnosed
        assert UNITS <= len(folder.keys()) <= UNITS + WORKERS * kills


def test_of_a_run_that_goes_on_with_other_tasks(lot, diagnosed, tmp_path, drive):
    folder = Folder(tmp_path / "out")
    command = [lot, folder.path, "--engine", "ray", "--workers", WORKERS, *DIAGNOSE]
    driver = drive(*command, "--tasks", WORKERS)
    assert driver.until(lambda: folder.rows() >= 5)
    # With its workers, in the middle of their shards.
    driver.close()
    driver.gone(folder)
    kept = folder.rows()
    assert kept < UNITS and any(journal.stat().st_size for journal in folder.path.glob("journal-*.jsonl"))
    done = drive(*command, "--tasks", SHARDS - 1, "--table", tmp_path / "table.parquet").ended()
    assert [done[name] for name in ("recordings", "there", "made", "errors")] == [UNITS, kept, UNITS - kept, 0]
    assert (tmp_path / "table.parquet").read_bytes() == diagnosed
    # Only what was in hand, and left no row, was begun twice.
    assert len(folder.keys()) == UNITS


@pytest.mark.parametrize("engine", ["ray", "dask"])
def test_of_a_worker_that_is_killed(lot, diagnosed, tmp_path, drive, engine):
    folder = Folder(tmp_path / "out")
    own = ["--engine", engine, "--tasks", SHARDS, "--workers", WORKERS, "--table", tmp_path / "table.parquet"]
    driver = drive(lot, folder.path, *own, *DIAGNOSE)
    assert driver.until(lambda: folder.rows() >= 4 and len(folder.under_way()) > 0)
    victims = [one for one in driver.family() if one.pid in folder.under_way()]
    victims[0].send_signal(signal.SIGKILL)
    done = driver.ended()
    assert done["recordings"] == UNITS
    assert (tmp_path / "table.parquet").read_bytes() == diagnosed
    assert victims[0].pid in folder.under_way()
    assert UNITS <= len(folder.keys()) <= UNITS + WORKERS


def test_of_a_node_that_is_removed(lot, diagnosed, tmp_path, drive):
    from ray.cluster_utils import Cluster

    folder = Folder(tmp_path / "out")
    store = {"object_store_memory": 100_000_000}
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False, **store})
    try:
        nodes = [cluster.add_node(num_cpus=1, **store) for _ in range(2)]
        raylets = {node.all_processes["raylet"][0].process.pid: node for node in nodes}

        def at_work() -> list[int]:
            """Raylets of nodes whose worker has a shard in hand."""
            found = set()
            for pid in folder.under_way():
                if psutil.pid_exists(pid):
                    found |= {parent.pid for parent in psutil.Process(pid).parents()}
            return sorted(found & set(raylets))

        # Long shards, one a node, so that the node has one in hand when it goes.
        own = ["--engine", "ray", "--address", cluster.address, "--tasks", 3, "--table", tmp_path / "table.parquet"]
        driver = drive(lot, folder.path, *own, *DIAGNOSE)
        assert driver.until(lambda: folder.rows() >= 2 and bool(at_work()))
        cluster.remove_node(raylets[at_work()[0]], allow_graceful=False)
        assert folder.rows() < UNITS
        done = driver.ended()
        assert done["recordings"] == UNITS
    finally:
        cluster.shutdown()
    assert (tmp_path / "table.parquet").read_bytes() == diagnosed
    assert folder.under_way(), "the node had no shard in hand"
    assert UNITS <= len(folder.keys()) <= UNITS + 1


def test_of_two_drivers_that_share_a_folder(lot, diagnosed, tmp_path, drive):
    folder = Folder(tmp_path / "out")
    drivers = [
        drive(lot, folder.path, "--engine", engine, "--tasks", SHARDS, *DIAGNOSE, "--table", tmp_path / f"{engine}.parquet")
        for engine in ("ray", "dask")
    ]
    totals = [driver.ended() for driver in drivers]
    assert [done["recordings"] for done in totals] == [UNITS, UNITS]
    assert sum(done["made"] for done in totals) == UNITS == len(folder.keys())
    for engine in ("ray", "dask"):
        assert (tmp_path / f"{engine}.parquet").read_bytes() == diagnosed


def test_of_two_drivers_of_which_one_gives_up(lot, diagnosed, tmp_path, drive):
    folder = Folder(tmp_path / "out")
    command = [lot, folder.path, "--engine", "local", *DIAGNOSE, "--table", tmp_path / "table.parquet"]
    first = drive(*command)
    assert first.until(lambda: folder.rows() >= 1)
    second = drive(*command)
    assert second.ended(code=1) == {}
    assert "another servoid batch works on this part of the folder" in second.errors()
    assert "Traceback" not in second.errors()
    assert first.ended()["made"] == UNITS == len(folder.keys())
    assert (tmp_path / "table.parquet").read_bytes() == diagnosed
