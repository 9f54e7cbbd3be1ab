#!/usr/bin/env bash
# pictures.sh [FOLDER]: draws the documentation's pictures from the bundled recordings, without a display and
# identically each time. FOLDER is docs by default. One picture needs captured motions, which are not in this
# repository.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh" ffmpeg
bash "$root/tools/build.sh" "$root/build" gaitpad -DCMAKE_BUILD_TYPE=Release
folder=${1:-$root/docs}
gaitpad=$root/build/gaitpad
mkdir -p "$folder"
unset SDL_VIDEODRIVER XDG_CONFIG_HOME GAITPAD_CONFIG GAITPAD_FONT

# The paper's four on the same stick, 7.5 s into the recording: a curve to the right.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 450 --theme dark \
  --style even --style stiff_hip --style stiff_knee --style limp_left \
  --screenshot "$folder/window.png"

# The window, moving: four seconds of it, in 96 colours.
films=$(mktemp -d)
trap 'rm -rf "$films"' EXIT
"$gaitpad" replay "$root/config/traces/walk.hid" --view --frames 460 --theme dark \
  --style even --style stiff_hip --style stiff_knee --style limp_left --video "$films/window.mp4"
ffmpeg -loglevel error -y -ss 3.6 -t 4 -i "$films/window.mp4" -vf \
  "fps=10,scale=880:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=none" \
  "$folder/window.gif"

# An injured left leg beside a sound walk, alone in the window.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 330 --theme light --panels none \
  --style even --style limp_left --screenshot "$folder/limp.png"

# Up the stairs, with the risers in view.
"$gaitpad" replay "$root/config/traces/walk.hid" --view --frames 330 --theme light --clean \
  --terrain stairs --style even --screenshot "$folder/stairs.png"

# Why it limps: joint angles, heights, stages; what the solver needs.
"$gaitpad" replay "$root/config/traces/round.hid" --view --frames 420 --theme dark \
  --panels graphs,solver --style even --style limp_left --screenshot "$folder/graphs.png"

# A worn stick, measured.
"$gaitpad" calibrate --trace "$root/config/traces/worn.hid" --out - --plot "$folder/sticks.png" \
  >/dev/null

# Both walks as strips of stick figures, with their knees.
/usr/bin/python3 "$root/tools/contact_sheet.py" "$gaitpad" "$folder/walk.png" --motions "" \
  --styles even,limp_left >/dev/null

# A stop, every 0.1 s.
/usr/bin/python3 "$root/tools/transition_sheet.py" "$gaitpad" "$folder" --changes stop >/dev/null

# Figure 5a of the paper, in 64 colours.
figures=$films/figures
"$gaitpad" figures --out "$figures" >/dev/null
/usr/bin/python3 -c 'import sys; from PIL import Image
Image.open(sys.argv[1]).convert("RGB").quantize(64).save(sys.argv[2], optimize=True)' \
  "$figures/figure5a.png" "$folder/figure5a.png"

# Three captured walks and gaitpad's walks from them. With status 1 a bound is broken, but the picture exists.
clips=$root/../shared/data/mocap
if [ -d "$clips" ]; then
  /usr/bin/python3 "$root/tests/session/fidelity.py" "$gaitpad" "$clips/cmu_m21_walk.bvh" \
    "$clips/bvhtoolbox_walk01.bvh" "$clips/cmu_006_01_iclone.bvh" --picture "$folder/kept.png" \
    >/dev/null || [ $? = 1 ]
fi
