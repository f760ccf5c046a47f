#!/usr/bin/env bash
# The same space by processes of this machine and by job arrays of Slurm: equal tables, byte for byte, even when a task
# of the array is lost. Skipped (77) where there is no Slurm.
#
#   slurm_test.sh CTUSIM SLURM_LOCAL
set -euo pipefail
self=$(realpath "$0") ctusim=$1 slurm_local=$2

fail() { echo "FAILED: $*" >&2; exit 1; }

# Within the cluster.
if [ "$slurm_local" = --inside ]; then
  # Submitted and held back: nobody else may work at the sweep.
  "$ctusim" sweep run space.toml -o cluster --engine slurm --chunk 3 --no-wait --sbatch=--hold >submitted.txt || fail "--no-wait"
  job=$(sed -n 's/^submitted job \([0-9]*\): 4 tasks$/\1/p' submitted.txt)
  [ -n "$job" ] || fail "no job in: $(cat submitted.txt)"
  code=0
  "$ctusim" sweep run space.toml -o cluster >/dev/null 2>refused.txt || code=$?
  [ "$code" = 2 ] || fail "a local run beside a job array ended with $code"
  grep -q "Slurm's job $job works at this sweep" refused.txt || fail "$(cat refused.txt)"
  # A task is lost: its points are submitted again.
  scancel "${job}_2"
  scontrol release "$job"
  timeout 120 "$ctusim" sweep run space.toml -o cluster --on slurm --chunk 2 >resumed.txt || fail "$(cat resumed.txt)"
  grep -q "^job $job is under way$" resumed.txt || fail "did not wait: $(cat resumed.txt)"
  grep -q '^submitted job [0-9]*: 2 tasks$' resumed.txt || fail "the three lost points make two tasks: $(cat resumed.txt)"
  grep -q '^12 points: 12 done$' resumed.txt || fail "$(cat resumed.txt)"
  exit 0
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >space.toml <<'SPACE'
[[record]]
scene = ["gen:tetra", "gen:hair-ball?strands=60&seed=7"]
rays = "diffuse"
size = "12x8"
[axes]
mask_test.design = ["none", "projection"]
node_cache.bytes = { log2 = [1024, 4096] }
SPACE

"$ctusim" sweep run space.toml -o planned --on slurm --dry-run --chunk 5 --at-once 2 --sbatch=--partition=main >planned.txt
grep -q -- '^sbatch .*--array=0-2%2 .*--partition=main ' planned.txt || fail "$(cat planned.txt)"
[ ! -e planned/slurm ] || fail "--dry-run left a job"

"$slurm_local" -- "$self" "$ctusim" --inside
"$ctusim" sweep run space.toml -o here -j 2
for table in results.jsonl results.csv results.sqlite columns.csv; do
  cmp "here/$table" "cluster/$table" || fail "$table differs"
done
[ "$(cat cluster/parts/slurm-*-?.jsonl | wc -l)" = 12 ] || fail "points were run twice"
echo "the tables are equal"
