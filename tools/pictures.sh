#!/usr/bin/env bash
# pictures.sh: draws the pictures of README and docs/ anew from the bundled traces, without a display.
# The same program and fonts draw the same.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh" fonts-inter
bash "$root/tools/build.sh" "$root/build" gaitpad -DCMAKE_BUILD_TYPE=Release
gaitpad=$root/build/gaitpad
trace=$root/config/traces/round.hid

"$gaitpad" play "$trace" --frames 420 --screenshot "$root/docs/window.png"
"$gaitpad" replay "$trace" --view --style limp_left --panels graphs --frames 330 \
  --screenshot "$root/docs/limp.png"
"$gaitpad" play "$trace" --panels graphs,solver --theme light --frames 600 \
  --screenshot "$root/docs/graphs.png"
"$gaitpad" calibrate --trace "$root/config/traces/worn.hid" --out - --plot "$root/docs/sticks.png" >/dev/null
/usr/bin/python3 "$root/tools/contact_sheet.py" "$gaitpad" "$root/docs/walk.png" --motions "" \
  --styles even,limp_left
