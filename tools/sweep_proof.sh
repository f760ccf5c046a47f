#!/usr/bin/env bash
# A sweep that is killed at random moments on its way and goes on, beside one by Slurm on a cluster of this machine:
# nothing lost, nothing run twice, equal tables byte for byte. Prints the figures of docs/sweeps.md.
#
#   tools/sweep_proof.sh CTUSIM SPACE.toml DIR [KILLS [SEED]]     # DIR is the local sweep, DIR-slurm the other
set -euo pipefail
ctusim=$1 space=$2 dir=$3 kills=${4:-2} seed=${5:-$RANDOM}
here=$(dirname "$(realpath "$0")")
RANDOM=$seed
rows() { cat "$dir"/parts/local.jsonl 2>/dev/null | wc -l; }

echo "seed $seed"
started=$SECONDS
total=$("$ctusim" sweep plan "$space" | awk '$1 == "points" { print $2 }')
for kill in $(seq "$kills"); do
  # Somewhere in the part of the way that this kill has for itself, and then at any moment of half a second.
  target=$((total * (kill - 1) / kills + (RANDOM % (total / kills)) + 1))
  "$ctusim" sweep run "$space" -o "$dir" -j 2 >/dev/null &
  process=$!
  while [ "$(rows)" -lt "$target" ] && kill -0 "$process" 2>/dev/null; do sleep 0.1; done
  sleep "0.$((RANDOM % 5))$((RANDOM % 10))"
  kill -KILL "$process" 2>/dev/null || true
  wait "$process" 2>/dev/null || true
  echo "killed with $(rows) of $total rows there"
done
"$ctusim" sweep run "$space" -o "$dir" -j 2 | tail -n 1
echo "local: $((SECONDS - started)) s of wall time in all"
started=$SECONDS
"$here/slurm_local.sh" -- "$ctusim" sweep run "$space" -o "$dir-slurm" --on slurm --chunk 40 | tail -n 1
echo "Slurm: $((SECONDS - started)) s of wall time, the cluster's start included"

python3 - "$dir" "$dir-slurm" <<'PYTHON'
import collections, glob, json, pathlib, sys

failed = False
for folder in map(pathlib.Path, sys.argv[1:]):
    ids = collections.Counter(json.loads(line)["id"]
                              for part in folder.glob("parts/*.jsonl") if part.name.count(".") == 1
                              for line in part.read_text().splitlines())
    points = [json.loads(line)["id"] for line in (folder / "points.jsonl").read_text().splitlines()]
    lost, twice = sum(ids[p] == 0 for p in points), sum(n > 1 for n in ids.values())
    seconds = sum(json.loads(line)["point_seconds"] for part in folder.glob("parts/*.timings.jsonl")
                  for line in part.read_text().splitlines() if line.endswith("}"))
    print(f"{folder.name}: {len(points)} points, {lost} lost, {twice} run twice; {seconds:.0f} s of processes")
    failed |= lost + twice != 0
for table in ("results.jsonl", "results.csv", "results.sqlite", "columns.csv"):
    a, b = (pathlib.Path(folder, table).read_bytes() for folder in sys.argv[1:])
    print(f"{table}: {len(a)} bytes, {'equal' if a == b else 'DIFFERENT'}")
    failed |= a != b
sys.exit(failed)
PYTHON
