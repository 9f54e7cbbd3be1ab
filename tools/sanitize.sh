#!/usr/bin/env bash
# The same tests under AddressSanitizer and UndefinedBehaviorSanitizer; long ones shorten themselves. Tests of code that
# reads foreign bytes (pads, reports, recordings, files, calibrations) always run; of the others a third, which the
# commit chooses (slice.sh). Tests that compile the sources themselves are left out by their label, because they would
# run without sanitizers. The compiler is clang++, so that both of Debian's compilers build everything and every test
# passes with either.
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
