#!/usr/bin/env python3
"""The long campaign of `ctusim check`: a billion hard cases in the reference, ten million in the timed unit, one
million in gates; in parts of one seed each, so that a campaign which was interrupted goes on where it stopped.

    tools/campaign.py BUILD_FOLDER RESULT_FOLDER [reference|cycle|rtl]...
    tools/campaign.py --show RESULT_FOLDER

Every part leaves RESULT_FOLDER/ENGINE-SEED.json and, if a case fails, its replayable trace in
RESULT_FOLDER/failures-ENGINE-SEED. Ends with the sums as a table, and with exit code 1 if anything was lost, invented
or different, or a part did not end.
"""
import json
import pathlib
import subprocess
import sys

# engine: parts and the cases of each
PLAN = {"reference": (20, 50_000_000), "cycle": (10, 1_000_000), "rtl": (10, 100_000)}
SUMS = ["scenes", "cases", "exact_hits", "hits_kept", "declined_by_triangle_test", "misplaced_by_triangle_test",
        "near_misses", "hits_lost", "cells_lost", "invented_hits", "differences_from_reference", "seconds"]
FAULTS = ["hits_lost", "cells_lost", "invented_hits", "differences_from_reference", "failed_rays"]


def part_file(results, engine, seed):
    return results / f"{engine}-{seed}.json"


def run_part(build, results, engine, seed, cases):
    """One part, unless its result is there. Written under another name and renamed when the program has ended by
    itself: what an interrupted part leaves is no result, and the part is asked again."""
    result = part_file(results, engine, seed)
    if result.exists():
        return
    unfinished = result.with_suffix(".part")
    command = [str(build / "ctusim"), "check", "--engine", engine, "--budget", str(cases), "--seed", str(seed),
               "--json", str(unfinished), "--failures", str(results / f"failures-{engine}-{seed}")]
    print(" ".join(command), flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    print("\n".join(done.stdout.splitlines()[-2:]), flush=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{engine}, seed {seed}: ctusim check ended with {done.returncode}")
    unfinished.rename(result)


def show(results):
    """The table of sums over all parts there are; true if every planned case was asked and nothing was found."""
    clean = True
    print("| engine | seeds | " + " | ".join(SUMS) + " |")
    print("| --- | --- |" + " ---: |" * len(SUMS))
    for engine, (parts, cases) in PLAN.items():
        found = [json.loads(part_file(results, engine, seed).read_text())
                 for seed in range(1, parts + 1) if part_file(results, engine, seed).exists()]
        if not found:
            continue
        total = {name: sum(part[name] for part in found) for name in SUMS + FAULTS}
        clean &= len(found) == parts and total["cases"] >= parts * cases and not any(total[name] for name in FAULTS)
        seeds = ", ".join(str(part["seed"]) for part in found) if len(found) < parts else f"1 to {parts}"
        print(f"| {engine} | {seeds} | " + " | ".join(f"{total[name]:,.0f}" for name in SUMS) + " |")
    return clean


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--show":
        return 0 if show(pathlib.Path(arguments[1])) else 1
    unknown = [name for name in arguments[2:] if name not in PLAN]
    if len(arguments) < 2 or unknown:
        print(__doc__, file=sys.stderr)
        return 2
    build, results = pathlib.Path(arguments[0]), pathlib.Path(arguments[1])
    results.mkdir(parents=True, exist_ok=True)
    for engine in arguments[2:] or PLAN:
        parts, cases = PLAN[engine]
        for seed in range(1, parts + 1):
            run_part(build, results, engine, seed, cases)
    return 0 if show(results) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
