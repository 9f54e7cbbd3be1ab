#!/usr/bin/env bash
# build.sh: builds the virtual pads into build/rig if they are older than their sources.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$root/build/rig"
exec 9>"$root/build/rig/lock"
flock 9
# build PROGRAM SOURCES: SOURCES is a pattern; headers that match it also count.
build() {
  local program=$root/build/rig/$1 newer
  newer=$(find "$root/tools/rig" -name "$2.[ch]" -newer "$program" 2>/dev/null || echo new)
  # shellcheck disable=SC2086 # the pattern is meant to be one
  [ -z "$newer" ] || gcc -std=gnu11 -O2 -Wall -Wextra -Werror -pthread -o "$program" "$root"/tools/rig/$2.c
}
build pad_gadget 'pad_*'
build hidp_link hidp_link
