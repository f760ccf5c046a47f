#!/usr/bin/env bash
# The tables of docs/results.md: intersections with each design relative to none, for every scene and kind of ray.
#   tools/results.sh PROGRAM SCENES_FOLDER [SIZE]
set -euo pipefail
program=$1
scenes=$2
size=${3:-240x135}

# Scenes without a camera in the file and with an inside worth seeing.
declare -A camera=(
  [sponza]="--eye -10,2,0 --target 10,4,0.5 --fov 60"
)

generated=("gen:hair-ball" "gen:curly-hair" "gen:straight-hair" "gen:tilted-quads" "gen:foliage" "gen:tetra")
failed=0
header=1

survey() {  # NAME SCENE
  local out
  # shellcheck disable=SC2086
  out=$("$program" culling "$2" --markdown --rays all --size "$size" --bounces 4 ${camera[$1]:-}) || {
    case $? in 1) failed=1 ;; *) return 0 ;; esac
  }
  if [ "$header" = 1 ]; then printf '%s\n' "$out"; else printf '%s\n' "$out" | tail -n +3; fi
  header=0
}

for scene in "${generated[@]}"; do survey "$scene" "$scene"; done
if [ -f "$scenes/index.txt" ]; then
  while read -r name path; do survey "$name" "$scenes/$path"; done <"$scenes/index.txt"
fi
exit "$failed"
