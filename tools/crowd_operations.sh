#!/usr/bin/env bash
# crowd_operations.sh [CHARACTERS]: counts the instructions of a character's tick in a crowd, with valgrind, and shows
# the functions that take most of them. Valgrind does not support AVX-512, so registers hold four numbers.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
characters=${1:-128}
bash "$root/tools/install.sh" valgrind
bash "$root/tools/build.sh" "$root/build" gaitpad -DCMAKE_BUILD_TYPE=Release
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ticks=$("$root/build/gaitpad" replay "$root/config/traces/walk.hid" --json | /usr/bin/python3 -c 'import json, sys
print(json.load(sys.stdin)["ticks"])')
valgrind -q --tool=callgrind --callgrind-out-file="$work/counted" \
  --toggle-collect='gaitpad::Crowd::advance_block(int, double)' \
  "$root/build/gaitpad" replay "$root/config/traces/walk.hid" --crowd "$characters" >/dev/null
callgrind_annotate "$work/counted" | awk -v walks=$((characters * ticks)) '
  { sub(/^ +/, "") }
  /PROGRAM TOTALS/ { gsub(",", "", $1); printf "%.0f instructions a character and tick\n", $1 / walks }
  /gaitpad::/ && / \(/ { gsub(",", "", $1); count = $1; sub(/^[^:]*:/, ""); sub(/ \[.*/, "")
    if (count > 0 && shown++ < 12) printf "%7.0f  %s\n", count / walks, substr($0, 1, 90) }'
