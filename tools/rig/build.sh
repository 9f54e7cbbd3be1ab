#!/usr/bin/env bash
# build.sh: builds the virtual pads into build/rig if they are older than their sources.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$root/build/rig"
exec 9>"$root/build/rig/lock"
flock 9
program=$root/build/rig/pad_gadget
newer=$(find "$root/tools/rig" -name 'pad_*.[ch]' -newer "$program" 2>/dev/null || echo new)
[ -z "$newer" ] || gcc -std=gnu11 -O2 -Wall -Wextra -Werror -pthread -o "$program" "$root"/tools/rig/pad_*.c
