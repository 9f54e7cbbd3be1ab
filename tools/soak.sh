#!/usr/bin/env bash
# soak.sh [--hours N | SECONDS]: runs the window for that long (default: ten minutes) while a pad is plugged in and out,
# and styles, panels and themes change. At the end, the recorded session must replay to the same hash, its memory must
# not have grown, and every late tick must be the machine's fault. In parallel, another window loads motions repeatedly,
# for a tenth of that time also under the sanitizers and ThreadSanitizer. `tools/measured.py soak` puts the table into
# docs/measured.md.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
seconds=${1:-600}
if [ "$seconds" = --hours ]; then
  seconds=$(awk -v hours="${2:-}" 'BEGIN { print int(3600 * hours) }')
  [ "$seconds" -gt 0 ] || { echo "soak.sh: --hours needs a number above 0" >&2; exit 2; }
fi
bash "$root/tools/install.sh"
export SDL_VIDEODRIVER=${SDL_VIDEODRIVER:-offscreen} XDG_CONFIG_HOME
XDG_CONFIG_HOME=$(mktemp -d)
trap 'rm -rf "$XDG_CONFIG_HOME"' EXIT

bash "$root/tools/build.sh" "$root/build" all -DCMAKE_BUILD_TYPE=Release
bash "$root/tools/build.sh" "$root/build" soak
motions=()
for character in adult child; do
  "$root/build/gaitpad" replay "$root/config/traces/round.hid" --character $character --fps 60 \
    --out "$XDG_CONFIG_HOME/$character" >/dev/null
  motions+=("$XDG_CONFIG_HOME/$character/pose.bvh")
done
"$root/build/tools/soak/soak" "$seconds" "${motions[@]}" >"$root/build/soak_loading.txt" &
loading=$!
"$root/build/tools/soak/soak" "$seconds" --record "$XDG_CONFIG_HOME/soak.hid" | tee "$root/build/soak.txt"
wait $loading || { cat "$root/build/soak_loading.txt"; exit 1; }

short=$((seconds / 10 > 30 ? seconds / 10 : 30))
bash "$root/tools/build.sh" "$root/build-asan" soak -DCMAKE_CXX_COMPILER=clang++ \
  -DGAITPAD_SANITIZE=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
echo "under AddressSanitizer and UndefinedBehaviorSanitizer:"
"$root/build-asan/tools/soak/soak" $short "${motions[@]}"
bash "$root/tools/build.sh" "$root/build-tsan" soak -DGAITPAD_TSAN=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
echo "under ThreadSanitizer:"
# Mesa's and LLVM's threads are not built for ThreadSanitizer, so it must not report them.
TSAN_OPTIONS="suppressions=$root/tools/soak/tsan.supp exitcode=66 ${TSAN_OPTIONS:-}" \
  "$root/build-tsan/tools/soak/soak" $short "${motions[@]}"
