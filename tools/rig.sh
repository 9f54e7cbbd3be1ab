#!/usr/bin/env bash
# rig.sh [--long] [--kernel 6.12] [--only NAME] [--without NAME]: builds, boots a Debian kernel in QEMU and runs the
# tests that need hardware (tools/rig/test_*.py) with virtual pads. Logs and tables are in build/rig/results-KERNEL.
# GAITPAD_SLICE chooses a part of the tables of pads and drivers; GAITPAD_ALL=1 or --long runs all of them. --long: also
# the long floods and counts, on 6.1 and 6.12. Without QEMU or an available kernel it tests nothing, says so and exits
# with 0. RIG_BUILD names another build folder than build (one with sanitizers).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath -m "${RIG_BUILD:-$root/build}")
long=0 only= without= kernels=()
while [ $# -gt 0 ]; do
  case $1 in
    --long) long=1 ;;
    --kernel) kernels=("$2"); shift ;;
    --only) only=$2; shift ;;
    --without) without=$2; shift ;;
    *) echo "rig.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift
done
if [ ${#kernels[@]} -eq 0 ]; then
  kernels=(6.1)
  [ $long -eq 0 ] || kernels+=(6.12)
fi

skip() {
  echo "########################################################################"
  echo "## THE RIG WAS SKIPPED: $1."
  echo "## Nothing was proved on a real kernel: no driver, no hot-plug, no rumble."
  echo "########################################################################"
  exit 0
}

bash "$root/tools/install.sh"
bash "$root/tools/build.sh" "$build" rig -DCMAKE_BUILD_TYPE=Release
bash "$root/tools/rig/install.sh" || skip "QEMU or what it needs cannot be installed here"

# shellcheck source=tools/slice.sh
. "$root/tools/slice.sh"
# Work without a kernel is done on the host. The guest sees the results, because its root is the host's.
export XDG_CACHE_HOME=$build/rig/cache
"$build/gaitpad" replay "$root/config/traces/round.hid" --json >/dev/null                 # solves the strides
/usr/bin/python3 -m pytest --collect-only -q -p no:cacheprovider "$root/tools/rig" >/dev/null  # compiles the tests
seconds=3600
[ $long -eq 0 ] || seconds=14400
status=0
for kernel in "${kernels[@]}"; do
  fetched=0
  bash "$root/tools/rig/kernel.sh" "$kernel" >/dev/null || fetched=$?
  [ $fetched -ne 3 ] || skip "no Debian kernel $kernel can be had"
  [ $fetched -eq 0 ] || exit 1
  results=$build/rig/results-$kernel
  rm -rf "$results"
  bash "$root/tools/rig/guest.sh" --kernel "$kernel" --memory 1536 --timeout $seconds --results "$results" -- \
    env RIG_LONG=$long RIG_BUILD="$build" XDG_CACHE_HOME="$XDG_CACHE_HOME" \
    GAITPAD_SLICE="$GAITPAD_SLICE" GAITPAD_ALL="${GAITPAD_ALL:-}" PYTEST_DISABLE_PLUGIN_AUTOLOAD=1 \
    /usr/bin/python3 -m pytest -s --tb=short -p no:cacheprovider "$root/tools/rig" \
    --only="$only" --without="$without" || status=1  # the path first, or conftest.py is not found
done
exit $status
