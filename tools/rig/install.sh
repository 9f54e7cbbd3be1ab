#!/usr/bin/env bash
# install.sh: installs what the rig needs from Debian 12.
exec bash "$(dirname "$0")/../install.sh" qemu-system-x86 busybox-static kmod cpio gzip xz-utils udev util-linux gcc \
  bluez-test-tools
