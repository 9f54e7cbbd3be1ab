# Sourced with `root` set: chooses this run's part of the long sweeps, in GAITPAD_SLICE, by the commit's hash, so that
# every commit tries another part and a failure can be repeated. GAITPAD_ALL=1 runs everything.
export GAITPAD_SLICE=${GAITPAD_SLICE:-$((16#$(git -C "$root" rev-parse --short=8 HEAD 2>/dev/null || echo 0) % 2520))}
[ "${GAITPAD_ALL:-}" = 1 ] || echo "Slice $GAITPAD_SLICE of the long sweeps (GAITPAD_SLICE=$GAITPAD_SLICE repeats it, GAITPAD_ALL=1 runs all)" >&2
