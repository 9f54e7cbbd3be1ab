#!/usr/bin/env bash
# pictures.sh [FOLDER]: draws the documentation's pictures of the window and of the calibration from the bundled
# recordings, without a display and the same each time. FOLDER is docs by default.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh" fonts-inter
bash "$root/tools/build.sh" "$root/build" gaitpad -DCMAKE_BUILD_TYPE=Release
folder=${1:-$root/docs}
gaitpad=$root/build/gaitpad
mkdir -p "$folder"
unset SDL_VIDEODRIVER XDG_CONFIG_HOME GAITPAD_CONFIG

# The paper's four on the same stick, 7.5 s into the recording: a curve to the right.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 450 --theme dark \
  --style even --style stiff_hip --style stiff_knee --style limp_left \
  --screenshot "$folder/window.png"

# An injured left leg beside a sound walk, alone in the window.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 330 --theme light --panels none \
  --style even --style limp_left --screenshot "$folder/limp.png"

# Up the stairs, side by side.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 300 --theme dark --panels none \
  --terrain stairs --hide source --style even --style stiff_hip --style stiff_knee --style limp_left \
  --screenshot "$folder/stairs.png"

# Why it limps: joint angles, heights, stages; what the solver needs.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 420 --theme dark \
  --panels graphs,solver --style even --style limp_left --screenshot "$folder/graphs.png"

# A worn stick, measured.
"$gaitpad" calibrate --trace "$root/config/traces/worn.hid" --out - --plot "$folder/sticks.png" \
  >/dev/null

# Both walks as strips of stick figures, with their knees.
/usr/bin/python3 "$root/tools/contact_sheet.py" "$gaitpad" "$folder/walk.png" --motions "" \
  --styles even,limp_left >/dev/null
