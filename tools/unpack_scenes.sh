#!/usr/bin/env bash
# Unpacks the archives of a folder of scenes and links its single files, so that every scene has a folder to load from.
#
#   tools/unpack_scenes.sh SRC DST
#
# SRC/X/X.tar.zst becomes DST/X/; the other files of SRC/X are linked into DST/X. San Miguel, whose parts are loaded one
# after the other, gets DST/san-miguel/san-miguel.list. DST/index.txt names the file to load for each scene:
# "scene path", the path relative to DST. What is there already and no older than its archive is left alone.
set -euo pipefail

usage() { sed -n '4p' "$0" | sed 's/^# *//'; exit 2; }
[ $# -eq 2 ] || usage
[ -d "$1" ] || { echo "unpack_scenes: no folder $1" >&2; exit 2; }
src=$(cd "$1" && pwd)
mkdir -p "$2"
dst=$(cd "$2" && pwd)

# Tests that run side by side may all find the scenes missing; the first one unpacks.
if command -v flock > /dev/null; then
  exec 9> "$dst/.lock"
  flock 9
fi

unpack() {  # archive scene: to a side folder first, so that an interrupted run leaves no half scene
  local side="$dst/.unpacking-$2"
  rm -rf "$side"
  mkdir "$side"
  tar --zstd -xf "$1" -C "$side"
  chmod -R u+w "$side"
  rm -rf "${dst:?}/$2"
  mv "$side/$2" "$dst/$2"
  rmdir "$side"
  touch "$dst/$2/.unpacked"
}

link_files() {  # scene: everything but the archive, folders included
  local entry
  for entry in "$src/$1"/*; do
    case "$entry" in *.tar.zst) continue ;; esac
    [ -e "$dst/$1/${entry##*/}" ] || ln -s "$entry" "$dst/$1/${entry##*/}"
  done
}

san_miguel_list() {
  local part
  echo "# The parts of the San Miguel scene that are at hand, in the order of its own scene file."
  echo "camera sanmiguel.pbrt"
  for part in sanmiguel hojas_a2 hojas_a5 hojas_a6 hojas_a7 hojas_b3 macetas mesas_abajo; do
    echo "geometry/$part-geom.pbrt"
  done
}

main_file() {  # scene: the first that is there of the names a scene's own file can have
  local pattern file
  for pattern in '*.list' scene.pbrt "$1.pbrt" '*.pbrt' '*.scn' '*.gltf' '*.glb' \
    '*.obj*' '*.hair*' '*.tfx*' '*.nff*' '*.ply*'; do
    # shellcheck disable=SC2086
    for file in "$dst/$1"/$pattern; do
      [ -e "$file" ] && { echo "$1/${file##*/}"; return; }
    done
  done
}

for folder in "$src"/*/; do
  scene=$(basename "$folder")
  archive="$src/$scene/$scene.tar.zst"
  if [ -e "$archive" ]; then
    # -nt holds too if the stamp is not there.
    if [ "$archive" -nt "$dst/$scene/.unpacked" ]; then unpack "$archive" "$scene"; fi
  else
    mkdir -p "$dst/$scene"
  fi
  link_files "$scene"
  if [ "$scene" = san-miguel ] && [ ! -e "$dst/$scene/san-miguel.list" ]; then
    san_miguel_list > "$dst/$scene/san-miguel.list"
  fi
  path=$(main_file "$scene")
  if [ -n "$path" ]; then echo "$scene $path"; fi
done > "$dst/.index"
mv "$dst/.index" "$dst/index.txt"
