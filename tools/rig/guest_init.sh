# The guest's first process inside the host's root: file systems, drivers, udevd; then /results/.run, whose output and
# exit status go to the host; then power-off in any case.
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8
exec >/results/output 2>&1 </dev/null

mount -t sysfs sys /sys
mount -t tmpfs run /run
mkdir -p /run/rig /dev/pts /dev/shm
mount -t devpts devpts /dev/pts
mount -t tmpfs shm /dev/shm
mount -t configfs configfs /sys/kernel/config 2>/dev/null
chmod 1777 /tmp
hostname rig
ip link set lo up 2>/dev/null

# udevd before any device: it loads usbhid, hid-playstation, xpad ... by modalias as on a PC.
/lib/systemd/systemd-udevd --daemon 2>/run/rig/udevd
modprobe -a libcomposite usb_f_fs evdev uhid uinput joydev
mountpoint -q /sys/kernel/config || mount -t configfs configfs /sys/kernel/config
modprobe dummy_hcd num=6
udevadm trigger --action=add --subsystem-match=input --subsystem-match=misc --subsystem-match=usb
udevadm settle --timeout=30

cut -d' ' -f1 /proc/uptime >/results/.boot_s
bash /results/.run
echo $? >/results/.status
sync
echo o >/proc/sysrq-trigger
sleep 10
