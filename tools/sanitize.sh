#!/usr/bin/env bash
# The same tests under AddressSanitizer and UndefinedBehaviorSanitizer; long ones shorten themselves. All that reads foreign
# bytes always runs: pads, reports, recordings, files, calibrations. Of the rest a third, which the commit chooses (slice.sh).
# Those that compile the sources themselves would run without sanitizers: left out by their label.
# By clang++: so both of Debian's compilers build all of it, and every test passes with either.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/tools/slice.sh"
bash "$root/tools/install.sh"
[ "${GAITPAD_ALL:-}" != 1 ] || bash "$root/tools/install.sh" locales # a whole run leaves no test out
bash "$root/tools/build.sh" "$root/build-asan" all -DCMAKE_CXX_COMPILER=clang++ \
  -DGAITPAD_SANITIZE=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
foreign='^(base|hid|drivers|pads|stick|files|config|check)\.|^tools\.(check|replay|calibrate|record|evemu|decode|map|main)'
if [ "${GAITPAD_ALL:-}" = 1 ]; then
  bash "$root/tools/ctest.sh" "$root/build-asan" -LE own_build
else
  bash "$root/tools/ctest.sh" "$root/build-asan" -LE own_build -R "$foreign"
  bash "$root/tools/ctest.sh" "$root/build-asan" -LE own_build -E "$foreign" -I $((GAITPAD_SLICE % 3 + 1)),,3
fi
