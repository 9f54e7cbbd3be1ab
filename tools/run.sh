#!/usr/bin/env bash
# Installs what is missing, builds, and walks a character along the recorded stick of the bundled
# trace. More options go to the replay: tools/run.sh --style limp_left
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh"
bash "$root/tools/build.sh" "$root/build" gaitpad -DCMAKE_BUILD_TYPE=Release
"$root/build/gaitpad" replay "$root/config/traces/round.hid" --out "$root/out" "$@"
