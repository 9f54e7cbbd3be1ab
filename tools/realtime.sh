#!/usr/bin/env bash
# realtime.sh [SECONDS] [OPTION of gaitpad play ...]: measures whether the loop keeps its time while the window
# draws as fast as it can. Four characters walk for SECONDS (300) along the stick of config/traces/round.hid,
# repeatedly. Fewer than 1 in 1000 ticks may begin more than one period late, and none may be skipped or run
# twice. The result is judged if the thread runs under SCHED_FIFO (as root, or if limits.d allows it) and
# /proc/stat counted no `steal`; otherwise the numbers are printed with that reason. For comparison the script
# also prints how often threads that only sleep (tools/realtime_control.py) were late on this machine.
#   tools/realtime.sh 60 --no-window
#   tools/realtime.sh 60 --no-window --stream osc://127.0.0.1:39539   beside a stream of poses
# REALTIME_BUILD names another build folder than build; it is then not rebuilt.
# Exit status: 0 if it passed or was not judged, 1 if it failed.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
seconds=300
if [[ ${1:-} =~ ^[0-9]+$ ]]; then
  seconds=$1
  shift
fi
build=${REALTIME_BUILD:-$root/build}
if [ -z "${REALTIME_BUILD:-}" ]; then
  bash "$root/tools/install.sh"
  bash "$root/tools/build.sh" "$build" gaitpad -DCMAKE_BUILD_TYPE=Release
fi
results=$build/realtime
mkdir -p "$results"

# One drawing thread leaves one core to the loop. Without a display SDL draws into memory.
export LP_NUM_THREADS=1
if [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}${SDL_VIDEODRIVER:-}" ]; then
  export SDL_VIDEODRIVER=offscreen
fi

# Longer than the session, because a session ends with its pad.
/usr/bin/python3 "$root/tools/long_trace.py" "$root/config/traces/round.hid" \
  "$results/long.hid" $((seconds + 60))
steal() { awk '$1 == "cpu" { print $9 }' /proc/stat; }
styles=(--style even --style stiff_hip --style stiff_knee --style limp_left)
/usr/bin/python3 "$root/tools/realtime_control.py" 240 >"$results/control.json" &
control=$!
trap 'kill $control 2>/dev/null || true' EXIT
before=$(steal)
"$build/gaitpad" play "$results/long.hid" --seconds "$seconds" "${styles[@]}" --json "$@" \
  >"$results/summary.json"
after=$(steal)
kill $control
wait $control || true

/usr/bin/python3 "$root/tools/realtime_judge.py" "$results/summary.json" "$results/control.json" \
  --steal $((after - before)) --seconds "$seconds"
