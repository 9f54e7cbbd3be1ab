#!/usr/bin/env bash
# guest.sh [--kernel 6.12] [--memory MB] [--timeout S] [--results FOLDER] -- COMMAND...
# Boots the kernel in QEMU on the host's own files and runs COMMAND there as root. Changes stay in the guest; only
# /results is the host's FOLDER. One argument is a line of bash, several are a program and its arguments. The
# command's output goes to stdout and its exit status is this script's; 124 after S seconds, 125 if the guest
# ended without a status. outside.py answers beside it what needs no kernel.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
series=6.1 memory=1024 seconds=300 results=
while [ $# -gt 0 ]; do
  case $1 in
    --kernel) series=$2 ;;
    --memory) memory=$2 ;;
    --timeout) seconds=$2 ;;
    --results) results=$2 ;;
    --) shift; break ;;
    *) echo "guest.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
[ $# -gt 0 ] || { echo "guest.sh: no command" >&2; exit 2; }

bash "$root/tools/rig/install.sh"
bash "$root/tools/rig/build.sh"
kernel=$(bash "$root/tools/rig/kernel.sh" "$series")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ -n "$results" ] || results=$work/results
mkdir -p "$results"
rm -f "$results/.status"
: >"$results/output"
cp "$root/tools/rig/guest_init.sh" "$results/.guest_init"
{
  printf 'cd %q\nexport RIG_ROOT=%q\n' "$PWD" "$root"
  if [ $# -eq 1 ]; then printf '%s\n' "$1"; else printf '%q ' "$@"; echo; fi
} >"$results/.run"

share() {
  echo "local,path=$2,mount_tag=$1,security_model=none,multidevs=remap${3:-}"
}
machine=(-smp 1 -nodefaults -display none -nic none -no-reboot -kernel "$kernel/vmlinuz" -initrd "$kernel/initramfs")
# no_timer_check: a kernel that boots slowly on a busy host would assume a broken timer.
boot="console=ttyS0 quiet loglevel=4 panic=-1 mitigations=off random.trust_cpu=on no_timer_check"

# Uses KVM if it boots this kernel within ten seconds, otherwise emulation. Tried once for each kernel and machine: on
# some machines /dev/kvm can be opened but runs nothing, and a process that hangs there may ignore signals.
accelerator() {
  local known=$kernel/accelerator host probe i
  host=$(uname -nr; grep -m 1 'model name' /proc/cpuinfo || true)
  if [ ! -f "$known" ] || [ "$(tail -n +2 "$known")" != "$host" ]; then
    if [ -w /dev/kvm ]; then
      qemu-system-x86_64 -accel kvm "${machine[@]}" -m 256 -append "$boot rig_probe" -serial "file:$work/probe" \
        </dev/null >/dev/null 2>&1 &
      probe=$!
      for ((i = 0; i < 100; ++i)); do kill -0 $probe 2>/dev/null && sleep 0.1; done
      kill -KILL $probe 2>/dev/null || true
    fi
    if grep -qs 'rig: alive' "$work/probe"; then echo kvm; else echo tcg; fi >"$known"
    echo "$host" >>"$known"
  fi
  head -n 1 "$known"
}
accelerator=$(accelerator)

/usr/bin/python3 "$root/tools/rig/outside.py" "$results" &
outside=$!
timeout -s KILL "$seconds" qemu-system-x86_64 -accel "$accelerator" "${machine[@]}" -m "$memory" -append "$boot" \
  -serial "file:$results/console" -virtfs "$(share hostroot / ,readonly=on)" \
  -virtfs "$(share modules "$kernel/modules" ,readonly=on)" -virtfs "$(share results "$results")" \
  </dev/null 2>"$results/qemu" &
qemu=$!
trap 'kill $qemu $outside 2>/dev/null || true; rm -rf "$work"' EXIT
tail -s 0.2 -c +1 -f --pid=$qemu "$results/output"
status=0
wait $qemu 2>/dev/null || status=$?

if [ -f "$results/.status" ]; then exit "$(cat "$results/.status")"; fi
tail -n 30 "$results/console" "$results/qemu" >&2
if [ $status -eq 137 ]; then
  echo "guest.sh: ended after $seconds s" >&2
  exit 124
fi
echo "guest.sh: the guest ended without a status" >&2
exit 125
