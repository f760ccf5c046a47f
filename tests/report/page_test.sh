#!/bin/sh
# page_test.sh make CTUSIM FOLDER: a small sweep of two scenes in FOLDER, and its page.
# page_test.sh specs|browser REPORT_FOLDER FOLDER: the page's specifications without a browser, or the page in chromium.
# Exit code 77: something that it needs is not there.
set -eu
here=$(dirname "$0")
case $1 in
  make)
    rm -rf "$3"
    mkdir -p "$3"
    "$2" sweep "$here/space.toml" -o "$3" -j 2
    "$2" report "$3" --title "A small sweep"
    ;;
  specs | browser)
    command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
    [ -d "$2/node_modules/vega-embed" ] || { echo "skipped: run npm ci in $2"; exit 77; }
    if [ "$1" = specs ]; then exec node "$here/specs_test.mjs" "$2" "$3/report.html"; fi
    [ -d "$2/node_modules/playwright-core" ] || { echo "skipped: no playwright-core"; exit 77; }
    chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
      { echo "skipped: no chromium"; exit 77; }
    exec node "$here/browser_test.mjs" "$2" "$3/report.html" "$chromium" ${CTU_SCREENSHOTS:+"$CTU_SCREENSHOTS"}
    ;;
esac
