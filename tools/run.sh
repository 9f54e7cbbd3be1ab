#!/usr/bin/env bash
# Installs what is missing, builds, walks a character along the recorded stick of the bundled trace into
# out/; then, at a terminal with a display, opens the window. Options go to both: tools/run.sh --style tired
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh"
bash "$root/tools/build.sh" "$root/build" gaitpad -DCMAKE_BUILD_TYPE=Release
"$root/build/gaitpad" replay "$root/config/traces/round.hid" --out "$root/out" "$@"
if [ -t 0 ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec "$root/build/gaitpad" play "$@"
fi
