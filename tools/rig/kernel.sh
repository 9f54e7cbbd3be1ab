#!/usr/bin/env bash
# kernel.sh [6.1|6.12]: prepares the current Debian kernel for booting under build/rig and prints its folder:
# vmlinuz, initramfs, modules/ (pruned, with their index). 6.1 is the kernel of Debian 12, 6.12 that of its
# backports. Package lists and downloads stay in that folder; the machine itself is not changed. Exit status 3:
# apt has no such kernel.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
series=${1:-6.1}
rig=$root/build/rig
apt=$rig/apt-$series
mkdir -p "$rig" "$apt/lists/partial" "$apt/archives/partial" "$apt/sources"
exec 9>"$rig/lock"
flock 9  # two runs at once share the cache

# The machine's own sources; backports beside them for 6.12 only.
cp /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list "$apt/sources/" 2>/dev/null || true
release=()
if [ "$series" = 6.12 ]; then
  release=(--target-release bookworm-backports)
  printf '%s\n' 'Types: deb' 'URIs: http://deb.debian.org/debian' 'Suites: bookworm-backports' \
    'Components: main' 'Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg' \
    >"$apt/sources/rig-backports.sources"
elif [ "$series" != 6.1 ]; then
  echo "kernel.sh: unknown kernel series $series (6.1 or 6.12)" >&2
  exit 2
fi
options=(-o "Dir::State::lists=$apt/lists" -o "Dir::Cache=$apt" -o "Dir::Etc::sourceparts=$apt/sources"
  -o APT::Update::Error-Mode=any -o APT::Sandbox::User=root -o Acquire::Languages=none -o Acquire::Retries=3)

# The number changes with every security update, and old ones leave the archive: ask, never assume. The
# lists are asked for once in twelve hours; without network the kernel of the last time serves.
if [ -z "$(find "$apt/updated" -mmin -720 2>/dev/null)" ]; then
  if apt-get "${options[@]}" update >"$apt/log" 2>&1; then touch "$apt/updated"; fi
fi
package=$(apt-cache "${options[@]}" "${release[@]}" depends linux-image-amd64 2>>"$apt/log" |
  awk '/Depends: linux-image-/ && !name {name = $2} END {print name}') || true
current=$(cat "$apt/current" 2>/dev/null || true)
if [ -z "$package" ] || [ "$package" = "$current" ]; then
  if [ -z "$current" ]; then
    echo "kernel.sh: no kernel package found for $series" >&2
    cat "$apt/log" >&2
    exit 3
  fi
  [ -f "$rig/$current/initramfs" ] && [ ! "$0" -nt "$rig/$current/initramfs" ] &&
    [ ! "$root/tools/rig/init" -nt "$rig/$current/initramfs" ] &&
    { echo "$rig/$current"; exit 0; }
  package=$current
fi

echo "Fetching $package" >&2
work=$rig/unpack-$series
rm -rf "$work"
mkdir -p "$work/initramfs"
cd "$work"
if ! apt-get "${options[@]}" download "$package" >>"$apt/log" 2>&1; then
  cat "$apt/log" >&2
  rm -f "$apt/updated"  # the archive may have moved on since the lists were asked for
  exit 3
fi
dpkg-deb -x ./*.deb deb
version=$(basename deb/lib/modules/*)
depmod -b deb "$version"  # the package makes its index only when it is installed

# Kept: what the rig loads by hand, every HID and joystick driver, and what those need.
boot=(virtio_pci 9pnet_virtio 9p overlay)
mapfile -t drivers < <(find "deb/lib/modules/$version/kernel/drivers/"{hid,input/joystick} -name '*.ko*' \
  -printf '%f\n' | sed 's/\.ko.*//')
closure() {  # builtin ones have no path
  local name
  for name in "$@"; do modprobe -d deb -S "$version" --show-depends "$name"; done |
    awk '$1 == "insmod" && !seen[$2]++ {print $2}'
}
bluetooth=(hci_vhci hidp af_alg algif_skcipher algif_hash cmac ecb)  # and what btvirt needs
closure "${boot[@]}" configfs libcomposite usb_f_fs dummy_hcd usbmon evdev uhid uinput joydev \
  "${bluetooth[@]}" "${drivers[@]}" | while read -r module; do
  install -D -m 644 "$module" "modules/lib/${module#"$work/deb/lib/"}"
done
cp "deb/lib/modules/$version/"modules.{builtin,builtin.modinfo,order} "modules/lib/modules/$version/"
depmod -b modules "$version"

# The initramfs: busybox and the modules that mount the host's folders.
install -m 755 /bin/busybox "$root/tools/rig/init" initramfs/
mkdir -p initramfs/{dev,proc,sys,new,host,upper,modules}
number=10
closure "${boot[@]}" | while read -r module; do
  file=initramfs/modules/$((number++))-$(basename "${module%.xz}")
  case $module in *.xz) xz -dc "$module" >"$file" ;; *) cp "$module" "$file" ;; esac
done
mkdir result
(cd initramfs && find . | cpio --quiet -o -H newc | gzip -1) >result/initramfs
cp "deb/boot/vmlinuz-$version" result/vmlinuz
mv modules/lib/modules result/modules
rm -rf "${rig:?}/$package" "${rig:?}/${current:-none}"
mv result "$rig/$package"
echo "$package" >"$apt/current"
rm -rf "$work" "$apt/archives"
echo "$rig/$package"
