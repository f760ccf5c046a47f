#!/usr/bin/env bash
# Makes the tables of docs/results.md, docs/numerics.md and docs/ladder.md between their marks, and the plots of docs/plots, from all scenes at hand.
#   tools/results.sh PROGRAM SCENES_FOLDER [--full] [SECTION...]
# Sections: those of `by_default`, or the ones named, of which some take too long to be made with the rest. --full is the
# setting of the papers, many hours long.
set -euo pipefail
program=$1
index=$2/index.txt
shift 2
full=0
if [ "${1:-}" = --full ]; then full=1; shift; fi
sections=("$@")
by_default=(culling auto paper packets raybox leaves together variants compression precision tables designs area numerics raydist tailor ladder)
by_name=(ladder_rtl ladder_long ladder_coverage)  # up to half an hour each, on a machine with nothing else to do
[ ${#sections[@]} -gt 0 ] || sections=("${by_default[@]}")

page=docs/results.md
plots=docs/plots
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
[ -f "$index" ] || index=/dev/null  # then only the generated scenes

# Puts the scratch file NAME between "<!-- begin: NAME -->" and "<!-- end: NAME -->".
put() {  # NAME
  awk -v begin="<!-- begin: $1 -->" -v end="<!-- end: $1 -->" -v file="$scratch/$1" '
    $0 == end { inside = 0 }
    !inside { print }
    $0 == begin { print ""; while ((getline line < file) > 0) print line; print ""; inside = 1; found = 1 }
    END { exit !found }' "$page" >"$scratch/page" || { echo "$page has no section $1" >&2; exit 2; }
  cp "$scratch/page" "$page"
}

# Runs a command into the scratch file NAME. A failed check (exit code 1) is remembered, all else ends the script.
keep() {  # NAME COMMAND...
  local name=$1 code=0
  shift
  "$@" >"$scratch/$name" || code=$?
  case $code in 0) ;; 1) failed=1 ;; *) exit "$code" ;; esac
}

culling() {
  keep culling "$program" culling --index "$index" --markdown --rays all --size 240x135 --bounces 4
  put culling
}

paper() {
  local quick=(--quick)
  [ "$full" = 0 ] || quick=()
  keep paper "$program" paper subspace --index "$index" "${quick[@]}" --out "$scratch/subspace"
  put paper
  mkdir -p "$plots"
  cp "$scratch"/subspace/*.svg "$plots"
}

raybox() {
  local quick=(--quick)
  [ "$full" = 0 ] || quick=()
  keep raybox "$program" paper raybox --index "$index" "${quick[@]}"
  put raybox
}

# One row: a scene made more like the paper's, or less, at R = 4 and 6; of $size pixels.
variant() {  # LABEL SCENE OPTION...
  local label=$1 r row cells="| $1 |"
  shift
  for r in 4 6; do
    keep row "$program" culling --index "$index" --size "$size" "$@" --r "$r" --markdown --designs ideal,mask-lut
    row=$(tail -1 "$scratch/row")
    [ "$r" = 6 ] || cells+=$(cut -d'|' -f5 <<<"$row")"|"
    cells+=$(cut -d'|' -f6,7 <<<"$row")"|"
  done
  echo "$cells"
}

# One row: what 256 entries cost a scene against uncompressed masks.
compressed_variant() {  # LABEL SCENE OPTION...
  local label=$1 r cells="| $1 |"
  shift
  for r in 4 6; do
    keep row "$program" compression --index "$index" "$@" --size 64x36 --r "$r" --markdown
    cells+=$(awk -F'|' 'NR == 3 { exact = $10 + 0 } NR > 3 { printf " %+.1f |", $10 - exact }' "$scratch/row")
  done
  echo "$cells"
}

packets() {
  keep packets "$program" paper packets --index "$index" --sample 2048
  put packets
}

# Whether the index has the scene.
listed() { grep -q "^$1 " "$index"; }

hair_variants() {
  local size=160x90 degrees segments
  if listed straight-hair; then
    for degrees in 0 5 10 12 15 20 30; do
      variant "straight-hair, turned by $degrees degrees about x and y" straight-hair --turn "$degrees,$degrees,0"
    done
    variant "... as filed, ribbons a fifth as wide" straight-hair --thickness 0.02
    variant "... as filed, one triangle a leaf" straight-hair --leaf 1
    variant "... as filed, seen from nearby (field of view 15 degrees)" straight-hair --fov 15
    variant "... as filed, tubes of three sides instead of ribbons" straight-hair --sides 3
    variant "... and a fifth as wide" straight-hair --sides 3 --thickness 0.02
  fi
  variant "gen:straight-hair as it is" gen:straight-hair
  variant "... ten times as wide" "gen:straight-hair?thickness=0.02"
  variant "... and tubes of three sides" "gen:straight-hair?thickness=0.02" --sides 3
  echo "| *paper: Straight Hair* | | 56.5 % | 61.4 % | 42.5 % | 49.3 % |"
  if listed ratboy-mohawk; then
    variant "ratboy-mohawk as filed" ratboy-mohawk
    variant "... seen from nearby (field of view 10 degrees)" ratboy-mohawk --fov 10
    variant "... and ribbons of 0.0001" ratboy-mohawk --fov 10 --thickness 0.0001
    variant "... and one triangle a leaf" ratboy-mohawk --fov 10 --thickness 0.0001 --leaf 1
  fi
  for segments in 31 8 2; do
    variant "gen:hair-ball, 2,228 strands of $segments segments, a quarter as wide" \
      "gen:hair-ball?strands=2228&segments=$segments&thickness=0.0005"
  done
  for segments in 8 4 2; do
    variant "gen:hair-ball, 20,000 strands of $segments segments" "gen:hair-ball?strands=20000&segments=$segments"
  done
  echo "| *paper: Hairball* | | 67.0 % | 71.5 % | 54.4 % | 61.1 % |"
  variant "gen:curly-hair as it is" gen:curly-hair
  variant "... 20,000 strands of 8 segments instead of 2,000 of 32" "gen:curly-hair?strands=20000&segments=8"
  variant "... and a quarter as wide" "gen:curly-hair?strands=20000&segments=8&thickness=0.0005"
  variant "... and one triangle a leaf" "gen:curly-hair?strands=20000&segments=8&thickness=0.0005" --leaf 1
  variant "... 100,000 strands of 8 segments, a twentieth as wide" \
    "gen:curly-hair?strands=100000&segments=8&thickness=0.0001"
  echo "| *paper: Curly Hair* | | 57.5 % | 62.5 % | 43.3 % | 50.6 % |"
}

# Other scenes without the parts, or with the paths, that a difference comes from.
other_variants() {
  local size=96x54
  local bath=mesh_00054.ply far=sanmiguel_00133.ply,sanmiguel_00234.ply  # the bath's mesh; lamp in the sky and ground
  if listed bathroom; then
    variant "bathroom as filed" bathroom
    variant "... paths of up to 8 bounces" bathroom --bounces 8
    variant "... without one mesh, \`$bath\` (porcelain)" bathroom --without "$bath"
  fi
  if listed breakfast; then
    variant "breakfast as filed" breakfast
    variant "... without the blinds (\`Plane_006*\`)" breakfast --without 'Plane_006*'
    variant "... without the legs of the chairs (\`Cylinder_*\`)" breakfast --without 'Cylinder_*'
  fi
  echo "| *paper: Bedroom* | | 89.3 % | 90.0 % | 83.8 % | 84.9 % |"
  if listed classroom; then
    variant "classroom as filed" classroom
    variant "... paths of up to 8 bounces" classroom --bounces 8
  fi
  echo "| *paper: Classroom* | | 87.4 % | 88.1 % | 83.5 % | 83.3 % |"
  if listed san-miguel; then
    variant "san-miguel as filed" san-miguel
    variant "... without ground plane and lamp, of two triangles each" san-miguel --without "$far"
    variant "... and one triangle a leaf" san-miguel --without "$far" --leaf 1
    variant "... and paths of one bounce" san-miguel --without "$far" --leaf 1 --bounces 1
  fi
  echo "| *paper: San Miguel* | | 79.3 % | 80.5 % | 67.9 % | 70.6 % |"
}

compressed_variants() {
  if listed straight-hair; then
    compressed_variant "straight-hair as filed" straight-hair
    compressed_variant "... turned by 12 degrees about x and y" straight-hair --turn 12,12,0
    compressed_variant "... and one triangle a leaf" straight-hair --turn 12,12,0 --leaf 1
    compressed_variant "... as filed, tubes of three sides" straight-hair --sides 3
    compressed_variant "... and a fifth as wide" straight-hair --sides 3 --thickness 0.02
  fi
  compressed_variant "gen:straight-hair as it is" gen:straight-hair
  compressed_variant "... ten times as wide, tubes of three sides" "gen:straight-hair?thickness=0.02" --sides 3
  echo "| *paper: Straight Hair* | +0.7 | | | +4.3 | | |"
  compressed_variant "gen:hair-ball as it is" gen:hair-ball
  compressed_variant "... 2,228 strands of 31 segments, a quarter as wide" \
    "gen:hair-ball?strands=2228&segments=31&thickness=0.0005"
  compressed_variant "... of 2 segments" "gen:hair-ball?strands=2228&segments=2&thickness=0.0005"
  compressed_variant "... and tubes of three sides" "gen:hair-ball?strands=2228&segments=2&thickness=0.0005" --sides 3
  compressed_variant "... 20,000 strands of 6 segments" "gen:hair-ball?strands=20000&segments=6"
  compressed_variant "... and tubes of three sides" "gen:hair-ball?strands=20000&segments=6" --sides 3
  echo "| *paper: Hairball* | +1.7 | | | +13.2 | | |"
  compressed_variant "gen:curly-hair as it is" gen:curly-hair
  compressed_variant "... 20,000 strands of 8 segments, a quarter as wide" \
    "gen:curly-hair?strands=20000&segments=8&thickness=0.0005"
  compressed_variant "... 100,000 strands of 8 segments, a twentieth as wide" \
    "gen:curly-hair?strands=100000&segments=8&thickness=0.0001"
  echo "| *paper: Curly Hair* | +3.8 | | | +9.8 | | |"
}

variants() {
  {
    echo "| scene | intersections/ray | R = 4: ideal | LUT, R_ray = R | R = 6: ideal | LUT, R_ray = R |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: |"
    hair_variants
    other_variants
    printf '\nWhat 256 entries cost against uncompressed masks, R_ray = R, in points:\n\n'
    echo "| scene | R = 4: importance per node | summed | our selection | R = 6: importance per node | summed | our selection |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    compressed_variants
  } >"$scratch/variants"
  put variants
}

# One row: large leaves with and without a box beside every primitive, in the unit. Columns of `compare --markdown`: scene,
# mask test, rays, intersections/ray, cycles/ray.
leaf_row() {  # LABEL SCENE LEAF
  local boxes
  for boxes in "" --primitive-boxes; do
    # shellcheck disable=SC2086
    keep log "$program" record "$2" -o "$scratch/leaf.ctut" --size 240x135 --rays diffuse --leaf "$3" --triangle-cost 0.1 \
      --designs mask-lut $boxes
    keep rows "$program" compare "$scratch/leaf.ctut" --designs projection --markdown
    tail -1 "$scratch/rows"
  done | awk -F' *[|] *' -v label="$1" -v leaf="$3" '
    NR == 1 { tests = $5; cycles = $6 }
    NR == 2 { printf "| %s | %s | %.2f | %.2f | %.2f | %.2f | %+.1f %% |\n", label, leaf, tests, $5, cycles, $6, 100 * ($6 / cycles - 1) }'
}

# Rows: a scene of large leaves, with a triangle tester that takes a primitive every so many cycles.
interval_rows() {  # LABEL SCENE
  local boxes interval cycles
  for boxes in "" --primitive-boxes; do
    # shellcheck disable=SC2086
    keep log "$program" record "$2" -o "$scratch/leaf$boxes.ctut" --size 120x68 --rays diffuse --leaf 15 --triangle-cost 0.1 \
      --designs mask-lut $boxes
  done
  for interval in 1 2 4 8; do
    cycles=
    for boxes in "" --primitive-boxes; do
      keep run "$program" run "$scratch/leaf$boxes.ctut" --set "triangle_test.interval=$interval"
      cycles+=" $(awk '/^cycles per ray / { print $4 }' "$scratch/run")"
    done
    awk -v label="$1" -v interval="$interval" '
      { printf "| %s | %d | %.2f | %.2f | %+.1f %% |\n", label, interval, $1, $2, 100 * ($2 / $1 - 1) }' <<<"$cycles"
  done
}

leaves() {
  local name path leaf kitchen
  {
    echo "| scene | primitives in a leaf, at most | intersections/ray | with ray boxes | cycles/ray | with ray boxes | change |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    for leaf in 4 8 15; do
      leaf_row gen:balls gen:balls "$leaf"
      leaf_row gen:hair-ball gen:hair-ball "$leaf"
      for name in killeroo buddha sponza straight-hair kitchen; do
        path=$(awk -v name="$name" '$1 == name { print $2 }' "$index")
        [ -z "$path" ] || leaf_row "$name" "$(dirname "$index")/$path" "$leaf"
      done
    done
  } >"$scratch/leaves"
  put leaves
  {
    echo "| scene | cycles between primitives | cycles/ray | with ray boxes | change |"
    echo "| --- | ---: | ---: | ---: | ---: |"
    interval_rows gen:balls gen:balls
    interval_rows gen:hair-ball gen:hair-ball
    kitchen=$(awk '$1 == "kitchen" { print $2 }' "$index")
    [ -z "$kitchen" ] || interval_rows kitchen "$(dirname "$index")/$kitchen"
  } >"$scratch/leaves-interval"
  put leaves-interval
}

# Rows of a scene with masks, ray boxes, packets and, for shadow rays, local trees at once, the hits those without any.
together_rows() {  # LABEL SCENE
  local rays
  for rays in "diffuse" "shadow --trees 4"; do
    # shellcheck disable=SC2086
    keep log "$program" record "$2" -o "$scratch/together.ctut" --size 96x54 --leaf 8 --triangle-cost 0.3 \
      --designs mask-lut --primitive-boxes --packets 16 --packet-forming origin --rays $rays
    keep run "$program" run "$scratch/together.ctut"
    awk -v label="$1, ${rays%% *}" '
      /^rays / { rays = $2 }
      /^wrong hits / { wrong = $3 }
      /^culled share / { boxes = $3 * $6 / 100 }
      /^saved by ray boxes / { tests = $5 }
      /^saved by packets / { nodes = $4 }
      /^saved by local trees / { trees = $5 }
      /^cycles per ray / { cycles = $4 }
      END { printf "| %s | %d | %d | %.2f | %.2f | %.2f | %.2f | %.2f |\n", label, rays, wrong, boxes / rays, tests / rays, nodes / rays, trees / rays, cycles }' \
      "$scratch/run"
  done
}

together() {
  local name path scene
  {
    echo "| scene and rays | rays | wrong hits | boxes culled by masks, a ray | primitive tests saved by ray boxes | box tests of four saved by packets | tests saved by local trees | cycles/ray |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for scene in hair-ball curly-hair straight-hair tilted-quads foliage tetra balls; do together_rows "gen:$scene" "gen:$scene"; done
    while read -r name path; do together_rows "$name" "$(dirname "$index")/$path"; done <"$index"
  } >"$scratch/together"
  put together
}

# One row: what decide says of all scenes for a unit, at a small size.
unit() {  # LABEL OPTION...
  local label=$1
  shift
  keep unit "$program" decide --index "$index" --markdown --size 120x68 --pilot 8192 "$@"
  awk -F'|' -v label="$label" '
    NR > 2 { choice = $8; gsub(/ /, "", choice); chosen[choice]++; scenes++
             to_off += log($11 / $9); to_on += log($11 / $10); if ($12 + 0 > worst) worst = $12 + 0 }
    END { printf "| %s | %d | %d | %d | %.1f %% | %.1f %% | %.2f %% |\n", label, chosen["off"], chosen["partial"], chosen["on"],
                 100 * exp(to_off / scenes), 100 * exp(to_on / scenes), worst }' "$scratch/unit"
}

auto() {
  keep auto "$program" decide --index "$index" --markdown --size 240x135
  put auto
  {
    echo "| unit and masks | off | partial | on | cycles, of off | of on | at most above the better |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    unit "256 compressed masks, \`bit-table\`, 116 bytes a node" --compress 256 --set mask_test.design=bit-table
    unit "128 contexts and 64 miss registers a cache" --set unit.contexts=128 --set node_cache.mshrs=64 \
      --set leaf_cache.mshrs=64
    unit "a mask test of 2 cycles instead of 12" --set cell_locate.latency=1 --set mask_test.latency=1
  } >"$scratch/auto-units"
  put auto-units
}

# Rows of one scene: every design that culls, computed by the unit, against what the reference recorded.
walk() {  # NAME SCENE
  keep log "$program" record "$2" -o "$scratch/trace.ctut" --size 96x54 --rays diffuse --compress 256 \
    --designs mask-lut,comparators
  keep rows "$program" compare "$scratch/trace.ctut" --source exec --markdown \
    --designs mask-lut,bit-table,dedup,projection,comparators
  sed -e 1,2d -e "s#^| [^|]* |#| $1 |#" "$scratch/rows"
}

designs() {
  local name path scene
  {
    echo "| scene | mask test | rays | intersections/ray | cycles/ray | culled | wrong hits | other visits |"
    echo "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    for scene in hair-ball curly-hair straight-hair tilted-quads foliage tetra; do walk "gen:$scene" "gen:$scene"; done
    while read -r name path; do
      walk "$name" "$(dirname "$index")/$path"
    done <"$index"
  } >"$scratch/designs"
  put designs
}

tables() {
  local sizes
  for sizes in "4 4" "4 8" "6 6" "6 12" "8 8"; do
    # shellcheck disable=SC2086
    "$program" tables --r ${sizes% *} --r-ray ${sizes#* } --entries 256 --markdown
    echo
  done >"$scratch/tables"
  put tables
}

compression() {
  local r
  for r in 4 6; do
    printf 'R = %s:\n\n' "$r"
    keep rows "$program" compression --index "$index" --r "$r" --size 96x54 --markdown
    cat "$scratch/rows"
    echo
  done >"$scratch/compression"
  put compression
}

# One row: area of the stages that boxes of so many bits change. Columns of `area --markdown` as below.
precision_area() {  # BITS
  keep row "$program" area --box-bits "$1" --stages box_test,node_fetch,context_file --markdown
  awk -F' *[|] *' -v bits="$1" '
    { ge[$2] = $6; ff[$2] = $5; mem[$2] = $7; depth[$2] = $8 }
    END { printf "| %d | %d | %d | %d | %d | %d | %d | %d | %d |\n", bits, ge["box_test"], ff["box_test"], depth["box_test"],
                 ge["node_fetch"], mem["node_fetch"], mem["context_file"], ge["all"], mem["all"] }' "$scratch/row"
}

precision() {
  local scenes=(gen:hair-ball gen:foliage) name bits
  for name in bunny straight-hair sponza kitchen; do if listed "$name"; then scenes+=("$name"); fi; done
  keep precision "$program" precision --index "$index" --markdown --size 160x90 --rays diffuse --out "$scratch/precision-plot" \
    "${scenes[@]}"
  put precision
  mkdir -p "$plots"
  cp "$scratch/precision-plot/precision.svg" "$plots"
  {
    echo "| bits | box_test: gate equivalents | flip-flops | depth | node_fetch: gate equivalents | memory bits | context files: memory bits | the three: gate equivalents | memory bits |"
    echo "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for bits in 32 16 12 8; do precision_area "$bits"; done
  } >"$scratch/precision-area"
  put precision-area
}

# Rows of one trace: cycles and area of each design. Columns of `area --markdown`: stage, instances, gates, flip-flops, gate
# equivalents, memory bits, depth.
area_rows() {  # MASKS DESIGNS ENTRIES
  local masks=$1 entries=$3 design cycles
  keep cycles "$program" compare "$scratch/area.ctut" --designs "$2" --markdown
  for design in ${2//,/ }; do
    cycles=$(awk -F' *[|] *' -v design="$design" '$3 == design { print $6 }' "$scratch/cycles")
    keep row "$program" area --set "mask_test.design=$design" --entries "$entries" --markdown
    awk -F' *[|] *' -v head="| $design | $masks | $cycles |" '
      $2 == "cell_locate" || $2 == "mask_test" { gates += $6; bits += $7; if ($8 > depth) depth = $8 }
      $2 == "all" { printf "%s %d | %d | %d | %d | %d | %d | %d |\n", head, gates, bits, depth, $6, $5, $7, $8 }' "$scratch/row"
  done
}

area() {
  local bunny
  bunny=$(awk '$1 == "bunny" { print $2 }' "$index")
  {
    echo "| mask test | masks | cycles/ray | cull: gate equivalents | memory bits | depth | unit: gate equivalents | flip-flops | memory bits | depth |"
    echo "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    keep log "$program" record "$(dirname "$index")/$bunny" -o "$scratch/area.ctut" --size 240x135
    area_rows "64 bits" none,mask-lut,dedup,projection,comparators 0
    keep log "$program" record "$(dirname "$index")/$bunny" -o "$scratch/area.ctut" --size 240x135 --compress 256
    area_rows "of 256" mask-lut,bit-table,dedup,projection,comparators 256
  } >"$scratch/area"
  put area
  keep stages "$program" area --markdown
  cp "$scratch/stages" "$scratch/area-stages"
  put area-stages
}

numerics() {
  keep numerics "$program" metamorph --index "$index" --markdown --size 32x18 --selection top-summed --compress 256
  local page=docs/numerics.md
  put numerics
}

raydist() {
  keep raydist "$program" paper raydist --index "$index"
  put raydist
}

# A unit for one scene: both units, what changed and why, what gates say. With a build of it in gates, which takes minutes.
tailored() {  # LABEL SCENE OPTION...
  local label=$1 scene=$2 file
  shift 2
  file=$(awk -v name="$scene" '$1 == name { print $2 }' "$index")
  echo "**$label** (\`record $scene${*:+ $*}\`)"
  echo
  keep log "$program" record "${file:+$(dirname "$index")/}${file:-$scene}" -o "$scratch/tailored.ctut" --rays diffuse --size 240x135 "$@"
  keep row "$program" tailor "$scratch/tailored.ctut" --slowdown 1% --build-rtl --rtl-rays 1000 --markdown -o "$scratch/unit.toml"
  cat "$scratch/row"
  echo
}

tailor() {
  {
    if listed straight-hair; then tailored "hair" straight-hair; else tailored "hair" gen:straight-hair; fi
    if listed sponza; then tailored "an interior" sponza --eye=-14,2,0 --target=10,4,0 --up 0,1,0; fi
  } >"$scratch/tailor"
  put tailor
}

# One row: error and price of the engines below `cycle`. Columns of `ladder --markdown`: engine, cycles, error, interval, rays, seconds,
# cycles/s, times faster.
ladder_row() {  # LABEL SCENE RAYS SIZE
  local label=$1 scene=$2 rays=$3 size=$4
  keep log "$program" record "$scene" -o "$scratch/ladder.ctut" --rays "$rays" --size "$size" --designs mask-lut
  keep rungs "$program" ladder "$scratch/ladder.ctut" --errors 2% --markdown
  awk -F' *[|] *' -v label="$label | $rays, $size" -v rays="$(awk '/^rays /{ print $2 }' <("$program" trace info "$scratch/ladder.ctut"))" '
    $2 == "estimate" { counting = $9 }
    $2 == "estimate again" { error = $4; faster = $9 }
    $2 ~ /^sampled/ { sample = $4 " | " $5 " | " $6 " | " $9; held = ($4 + 0 < 0 ? -$4 : $4 + 0) <= substr($5, 3) + 0 ? "yes" : "no" }
    $2 == "cycle" { cycles = $3; seconds = $7 }
    END { printf "| %s | %d | %d | %.2f | %s | %s | %s | %s | %s |\n", label, rays, cycles, seconds, error, counting, faster, sample, held }' \
    "$scratch/rungs"
}

ladder_head() {
  echo "| scene | rays | number | cycles | seconds | estimate: error | times faster, counting | ... counted before | sampled 2%: error | interval | rays simulated | times faster | holds |"
  echo "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |"
}

ladder() {
  local name path scene rays size=160x90 page=docs/ladder.md
  {
    ladder_head
    for rays in diffuse shadow; do
      for scene in hair-ball curly-hair straight-hair tilted-quads foliage tetra; do ladder_row "gen:$scene" "gen:$scene" "$rays" "$size"; done
      while read -r name path; do ladder_row "$name" "$(dirname "$index")/$path" "$rays" "$size"; done <"$index"
    done
  } >"$scratch/ladder"
  put ladder
}

# The same rays in gates: errors against them. Columns of `ladder --markdown` as above.
ladder_rtl_row() {  # LABEL SCENE RAYS SIZE
  keep log "$program" record "$2" -o "$scratch/ladder.ctut" --rays "$3" --size "$4" --designs mask-lut
  keep rungs "$program" ladder "$scratch/ladder.ctut" --errors 2% --markdown --rtl
  awk -F' *[|] *' -v label="$1 | $3" '
    $2 == "estimate again" { error = $4 }
    $2 ~ /^sampled/ { held = ($4 + 0 < 0 ? -$4 : $4 + 0) <= substr($5, 3) + 0 ? "yes" : "no" }
    $2 == "cycle" { cycles = $3; seconds = $7 }
    $2 == "rtl" { gates = $3; slower = $7 / seconds }
    END { printf "| %s | %s | %d | %s | %s | %s |\n", label, gates, cycles, error, held, gates + 0 ? int(slower) : "" }' \
    "$scratch/rungs"
}

ladder_rtl() {
  local name path rays page=docs/ladder.md
  {
    echo "| scene | rays | cycles in gates | cycles of \`cycle\` | estimate: error | sampled 2%: holds | times slower than \`cycle\` |"
    echo "| --- | --- | ---: | ---: | ---: | --- | ---: |"
    for rays in diffuse shadow; do
      while read -r name path; do ladder_rtl_row "$name" "$(dirname "$index")/$path" "$rays" 160x90; done <"$index"
    done
  } >"$scratch/ladder_rtl"
  put ladder_rtl
}

# The same of long traces, where samples pay.
ladder_long() {
  local name path rays page=docs/ladder.md
  {
    ladder_head
    for name in hair-ball foliage; do ladder_row "gen:$name" "gen:$name" diffuse 960x540; done
    while read -r name path; do ladder_row "$name" "$(dirname "$index")/$path" diffuse 960x540; done <"$index"
    ladder_listed killeroo shadow 960x540
    ladder_listed kitchen shadow 960x540
    for name in hair-ball foliage; do ladder_row "gen:$name" "gen:$name" diffuse 1920x1080; done
    for name in bunny sponza straight-hair classroom kitchen; do ladder_listed "$name" diffuse 1920x1080; done
    ladder_listed killeroo shadow 1920x1080
    ladder_listed kitchen shadow 1920x1080
  } >"$scratch/ladder_long"
  put ladder_long
}

ladder_listed() {  # NAME RAYS SIZE
  local path
  path=$(awk -v name="$1" '$1 == name { print $2 }' "$index")
  [ -z "$path" ] || ladder_row "$1" "$(dirname "$index")/$path" "$2" "$3"
}

# How often intervals hold: each sample 200 times.
ladder_coverage_row() {  # LABEL SCENE RAYS SIZE
  keep log "$program" record "$2" -o "$scratch/ladder.ctut" --rays "$3" --size "$4" --designs mask-lut
  keep rungs "$program" ladder "$scratch/ladder.ctut" --errors 2% --repetitions 200 --markdown
  awk -F' *[|] *' -v label="$1 | $3, $4" '
    $2 ~ /^2%, / { printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", label, $3, $4, $5, $6, $7, $8, $9, $10 }' "$scratch/rungs"
}

ladder_coverage() {
  local name rays size page=docs/ladder.md
  {
    echo "| scene | rays | repetitions | hold | run whole | bias | rms error | half the interval | rays simulated | times faster |"
    echo "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    ladder_coverage_row gen:hair-ball gen:hair-ball diffuse 960x540
    ladder_coverage_row gen:foliage gen:foliage diffuse 960x540
    while read -r name rays size; do
      if listed "$name"; then ladder_coverage_row "$name" "$(dirname "$index")/$(awk -v name="$name" '$1 == name { print $2 }' "$index")" "$rays" "$size"; fi
    done < <(printf '%s\n' "bunny diffuse 960x540" "sponza diffuse 960x540" "classroom diffuse 480x270" \
      "killeroo shadow 960x540" "kitchen shadow 960x540")
  } >"$scratch/ladder_coverage"
  put ladder_coverage
}

for section in "${sections[@]}"; do
  if [[ " ${by_default[*]} ${by_name[*]} " != *" $section "* ]]; then
    echo "no section $section: ${by_default[*]} ${by_name[*]}" >&2
    exit 2
  fi
  "$section"
done
exit "$failed"
