"""Writes two small datasets with pyarrow, after the layout that LeRobot documents.

LeRobot itself brings PyTorch and is not needed for tables of numbers.

    pip install pyarrow && python make_lerobot.py
"""

import json
import shutil
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

HERE = Path(__file__).parent / "fixtures" / "lerobot"
JOINTS = ["shoulder_pan.pos", "elbow.pos", "gripper.pos"]
LENGTHS = [6, 4, 5]
FPS = 30


def features(names: object) -> dict:
    def scalar(dtype: str) -> dict:
        return {"dtype": dtype, "shape": [1], "names": None}

    return {
        "observation.state": {"dtype": "float32", "shape": [3], "names": names},
        "action": {"dtype": "float32", "shape": [3], "names": None},
        "observation.images.front": {
            "dtype": "video",
            "shape": [480, 640, 3],
            "names": ["height", "width", "channels"],
        },
        "next.done": scalar("bool"),
        "timestamp": scalar("float32"),
        "frame_index": scalar("int64"),
        "episode_index": scalar("int64"),
        "index": scalar("int64"),
        "task_index": scalar("int64"),
    }


def rows(episode: int, first: int, fixed: bool) -> pa.Table:
    length = LENGTHS[episode]
    k = range(length)
    vector = pa.list_(pa.float32(), 3) if fixed else pa.list_(pa.float32())
    return pa.table(
        {
            "observation.state": pa.array(
                [[100.0 * episode + i + 0.25 * j for j in range(3)] for i in k], vector
            ),
            "action": pa.array([[-1.0 * i - j for j in range(3)] for i in k], vector),
            "next.done": [i == length - 1 for i in k],
            "timestamp": pa.array([i / FPS for i in k], pa.float32()),
            "frame_index": pa.array(list(k), pa.int64()),
            "episode_index": pa.array([episode] * length, pa.int64()),
            "index": pa.array([first + i for i in k], pa.int64()),
            "task_index": pa.array([0] * length, pa.int64()),
        }
    )


def info(version: str, data_path: str, names: object) -> dict:
    return {
        "codebase_version": version,
        "robot_type": "so101_follower",
        "total_episodes": len(LENGTHS),
        "total_frames": sum(LENGTHS),
        "total_tasks": 1,
        "chunks_size": 1000,
        "fps": FPS,
        "splits": {"train": f"0:{len(LENGTHS)}"},
        "data_path": data_path,
        "video_path": None,
        "features": features(names),
    }


def version_3() -> None:
    root = HERE / "v3"
    data = root / "data" / "chunk-000"
    meta = root / "meta"
    data.mkdir(parents=True)
    (meta / "episodes" / "chunk-000").mkdir(parents=True)
    path = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
    (meta / "info.json").write_text(json.dumps(info("v3.0", path, JOINTS), indent=4))
    first, episodes = 0, []
    files = [[0, 1], [2]]
    for number, members in enumerate(files):
        writer = None
        for episode in members:
            table = rows(episode, first, fixed=True)
            target = data / f"file-{number:03d}.parquet"
            writer = writer or pq.ParquetWriter(target, table.schema, compression="snappy")
            writer.write_table(table)
            episodes.append(
                {
                    "episode_index": episode,
                    "tasks": ["wave"],
                    "length": LENGTHS[episode],
                    "data/chunk_index": 0,
                    "data/file_index": number,
                    "dataset_from_index": first,
                    "dataset_to_index": first + LENGTHS[episode],
                    "meta/episodes/chunk_index": 0,
                    "meta/episodes/file_index": 0,
                }
            )
            first += LENGTHS[episode]
        writer.close()
    target = meta / "episodes" / "chunk-000" / "file-000.parquet"
    pq.write_table(pa.Table.from_pylist(episodes), target, compression="snappy")


def version_2() -> None:
    root = HERE / "v21"
    data = root / "data" / "chunk-000"
    data.mkdir(parents=True)
    (root / "meta").mkdir()
    path = "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet"
    described = info("v2.1", path, {"motors": JOINTS})
    (root / "meta" / "info.json").write_text(json.dumps(described, indent=4))
    first, lines = 0, []
    for episode, length in enumerate(LENGTHS):
        table = rows(episode, first, fixed=False)
        pq.write_table(table, data / f"episode_{episode:06d}.parquet", compression="snappy")
        lines.append({"episode_index": episode, "tasks": ["wave"], "length": length})
        first += length
    text = "".join(json.dumps(line) + "\n" for line in lines)
    (root / "meta" / "episodes.jsonl").write_text(text)


shutil.rmtree(HERE, ignore_errors=True)
version_3()
version_2()
