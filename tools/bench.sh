#!/usr/bin/env bash
# Speeds: the unit in every mode, exec and replay; the builder and the closest hit beside Embree; object masks;
# recording a large scene.
#   tools/bench.sh BUILD_FOLDER SCRATCH_FOLDER
set -euo pipefail
build=$1
scratch=$2
bunny=/usr/share/glmark2/models/bunny.obj

echo "== the unit on diffuse bounces of the bunny"
"$build/ctusim" record "$bunny" -o "$scratch/bench.ctut" --size 320x320 --rays diffuse --designs mask-lut
"$build/ctusim" bench "$scratch/bench.ctut" --repeats 3

echo
echo "== tree and closest hit beside Embree, one thread"
"$build/tests/bench/ctu_bench_accel" "$bunny" --benchmark_repetitions=5 | grep "Embree's speed"

echo
echo "== object masks by L, and their refit"
"$build/tests/bench/ctu_bench_masks" "$bunny" --benchmark_filter='R=4/' | grep -E "triangles|R=4"

if [ -f build/scenes/kitchen/scene.pbrt ]; then
  echo
  echo "== recording one million rays of the kitchen"
  time "$build/ctusim" record build/scenes/kitchen/scene.pbrt -o "$scratch/kitchen.ctut" --size 480x448 --rays diffuse --bounces 4
fi
