#!/usr/bin/env bash
# soak.sh [SECONDS]: the window for ten minutes (600) while a pad comes and goes, styles change and motions
# are loaded again: is its memory flat? Then a tenth of that under the sanitizers and ThreadSanitizer.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
seconds=${1:-600}
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
"$root/build/tools/soak/soak" "$seconds" "${motions[@]}"

short=$((seconds / 10 > 30 ? seconds / 10 : 30))
bash "$root/tools/build.sh" "$root/build-asan" soak -DGAITPAD_SANITIZE=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
echo "under AddressSanitizer and UndefinedBehaviorSanitizer:"
"$root/build-asan/tools/soak/soak" $short "${motions[@]}"
bash "$root/tools/build.sh" "$root/build-tsan" soak -DGAITPAD_TSAN=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
echo "under ThreadSanitizer:"
# Mesa's and LLVM's own threads are not built for it: what happens within them is not reported.
TSAN_OPTIONS="suppressions=$root/tools/soak/tsan.supp exitcode=66 ${TSAN_OPTIONS:-}" \
  "$root/build-tsan/tools/soak/soak" $short "${motions[@]}"
