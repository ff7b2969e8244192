"""Held-out errors of `servoid diagnose` beside those of the afternoon model, over the pairs of `pairs.toml`.

    python table.py DATA [--servoid PROGRAM] [--cache FILE]

DATA is the folder that holds the recordings. Prints a line a pair and the medians and worst of the ratios (below 1: servoid is
nearer); the afternoon model's results are kept in the cache, since they do not change with the program.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time
import tomllib

import afternoon

HERE = pathlib.Path(__file__).parent
WINDOW_S = 0.5


def baseline(pair, data, cache, window_s):
    """The afternoon model's errors, in windows of the same length as servoid's."""
    key = f"{pair['fitted']} > {pair.get('held_out', 'end')}" + ("" if window_s == WINDOW_S else f" {window_s} s")
    if key not in cache:
        fitted = data / pair["fitted"]
        held_out = data / pair["held_out"] if "held_out" in pair else None
        facts = afternoon.facts_of(fitted, pair.get("counts_per_rev"))
        cache[key] = afternoon.compare(fitted, held_out, window_s, facts)
    return cache[key]


def servoid(program, pair, data):
    """The windowed and whole-run error on what was held out, the names, and the seconds; or why there is none."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "diagnosis.json"
        command = [program, "diagnose", "--quiet", data / pair["fitted"], "--json", out]
        if "held_out" in pair:
            command += ["--validate", data / pair["held_out"]]
        for name in ("counts_per_rev", "supply_v", "drive"):
            if name in pair:
                command += ["--" + name.replace("_", "-"), str(pair[name])]
        if pair.get("drive") == "current":
            command += ["--column", "current=voltage_V", "--column", "angle=angle_rad_derived", "--unit", "angle=rad"]
        elif pair["fitted"].startswith(("bam", "un_")):
            command += ["--column", "angle=angle_rad", "--unit", "angle=rad"]
        began = time.monotonic()
        ended = subprocess.run(command, capture_output=True, text=True)
        seconds = time.monotonic() - began
        if ended.returncode != 0:
            return None, ended.stderr.strip().replace("\n", " ")[:300], seconds
        return json.loads(out.read_text()), None, seconds


def held_out_errors(result):
    """Windowed and whole-run error on what was held out; a run that was judged whole has no other."""
    last = result["steps"][-1] if result["steps"] else result["base"]
    if prediction := result.get("prediction"):
        return prediction["validate_windowed_rms_counts"], prediction["validate_whole_rms_counts"]
    windowed = last.get("windowed")
    return (windowed["validate_rms_counts"] if windowed else None), last["validate_rms_counts"]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("data", type=pathlib.Path)
    options.add_argument("--servoid", default="servoid")
    options.add_argument("--cache", type=pathlib.Path, default=pathlib.Path("afternoon.json"))
    given = options.parse_args()
    cache = json.loads(given.cache.read_text()) if given.cache.exists() else {}
    windowed, whole = [], []
    for pair in tomllib.loads((HERE / "pairs.toml").read_text())["pair"]:
        name = f"{pair['fitted']} > {pair.get('held_out', 'end')}"
        result, fault, seconds = servoid(given.servoid, pair, given.data)
        if fault:
            print(f"{name}: REFUSED after {seconds:.1f} s: {fault}", flush=True)
            continue
        in_windows, over_all = held_out_errors(result)
        window_s = (result.get("prediction") or {}).get("window_s", WINDOW_S)
        theirs = baseline(pair, given.data, cache, window_s)["held_out"]
        given.cache.write_text(json.dumps(cache, indent=1))
        names = "+".join(step["added"] for step in result["steps"]) or "nothing"
        if in_windows is not None:
            windowed.append(in_windows / theirs["windowed"])
        whole.append(over_all / theirs["whole"])
        shown = f"{in_windows:.1f}" if in_windows is not None else "-"
        print(
            f"{name}: windowed {shown} against {theirs['windowed']:.1f}; whole {over_all:.1f} against "
            f"{theirs['whole']:.1f}; {result['verdict']} {names}; {seconds:.1f} s",
            flush=True,
        )
    for what, ratios in (("windowed", windowed), ("whole run", whole)):
        if ratios:
            print(f"{what}: median ratio {statistics.median(ratios):.3f}, worst {max(ratios):.3f}, {len(ratios)} pairs")


if __name__ == "__main__":
    main()
