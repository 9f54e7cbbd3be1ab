#!/usr/bin/env bash
# Installs what is missing, builds, walks a character along the recorded stick of the bundled trace into out/; then, at
# a terminal with a display, opens the window. Options apply to both: tools/run.sh --style tired GAITPAD_BUILD names
# another folder to build in; a repository that cannot be written is built in the cache.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/tools/folders.sh"
bash "$root/tools/install.sh" --program
bash "$root/tools/build.sh" "$build" gaitpad -DCMAKE_BUILD_TYPE=Release
"$build/gaitpad" replay "$root/config/traces/round.hid" --out "$out" "$@"
if [ -t 0 ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec "$build/gaitpad" play "$@"
fi
echo "No terminal with a display, so no window: $build/gaitpad play opens it, --no-window walks without." >&2
