"""Virtual pads in the guest: `with Pad("dualsense") as pad: pad.set(lx=200)`; see class Pad."""
import collections
import contextlib
import glob
import os
import subprocess
import sys
import time

ROOT = os.environ.get("RIG_ROOT") or os.path.realpath(os.path.join(os.path.dirname(__file__), "../.."))
GADGET = os.path.join(ROOT, "build/rig/pad_gadget")
LONG = os.environ.get("RIG_LONG") == "1"  # True for a run with the long floods and counts
PATIENCE = 6  # factor on time limits of a free machine, because a busy host gives the guest a fraction of it
KERNEL = tuple(int(part) for part in os.uname().release.split(".")[:2])

KINDS = ("generic", "ds4", "dualsense", "switch", "xbox360", "xboxone")
# the numbers of hidraw and event nodes that a bound driver makes
NODES = {"generic": (1, 1), "ds4": (1, 3), "dualsense": (1, 3), "switch": (1, 2), "xbox360": (0, 1),
         "xboxone": (0, 1), "gamecube": (1, 0)}  # the kernel does not recognise the adapter's usages as a pad

Sent = collections.namedtuple("Sent", "ns number data")  # ns: CLOCK_MONOTONIC before the write
Packet = collections.namedtuple("Packet", "ns data")


def wait_for(condition, seconds=10.0, what="a condition"):
    """The first true value of `condition()`; raises TimeoutError after `seconds` of a free machine."""
    end = time.monotonic() + PATIENCE * seconds
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise TimeoutError(f"waited {PATIENCE * seconds} s for {what}")
        time.sleep(0.02)


def settle():
    """Asks again where udev's daemon breaks off its answer ("Broken pipe"), as it does on a busy host."""
    wait_for(lambda: subprocess.run(["udevadm", "settle", "--timeout=90"], check=False).returncode == 0,
             what="udev to settle")


def udev_properties(node):
    """The properties of a device node in udev's data base; none where the node is not there yet, or no longer."""
    try:
        number = os.stat(node).st_rdev
        with open(f"/run/udev/data/c{os.major(number)}:{os.minor(number)}") as file:
            lines = [line[2:].rstrip("\n") for line in file if line.startswith("E:")]
    except FileNotFoundError:
        return {}
    return dict(line.split("=", 1) for line in lines)


class Nodes:
    """Device nodes below one folder of /sys/devices; each property searches again."""

    def __init__(self, sysfs):
        self.sysfs = sysfs

    def _find(self, kind, prefix):
        """Uses the links of /sys/class, because walking through the folder itself takes the guest a tenth of a
        second."""
        links, found = f"/sys/class/{kind}", []
        inside = self.sysfs.removeprefix("/sys/") + "/"
        with contextlib.suppress(FileNotFoundError):  # no device of this class has been there yet
            for name in os.listdir(links):
                with contextlib.suppress(FileNotFoundError):  # the device is being removed
                    if name.startswith(prefix) and inside in os.readlink(f"{links}/{name}"):
                        found.append(name)
        return sorted(found, key=lambda name: int(name[len(prefix):]))

    @property
    def hidraws(self):
        return ["/dev/" + name for name in self._find("hidraw", "hidraw")]

    @property
    def events(self):
        return ["/dev/input/" + name for name in self._find("input", "event")]

    @property
    def hidraw(self):
        return next(iter(self.hidraws), None)

    @property
    def joystick(self):
        """The event node of the pad itself, neither of its motion sensors nor of its touchpad."""
        for node in self.events:
            properties = udev_properties(node)
            if properties.get("ID_INPUT_JOYSTICK") and not properties.get("ID_INPUT_ACCELEROMETER"):
                return node
        return None

    def wait_nodes(self, hidraws, events, seconds=20.0):
        wait_for(lambda: (len(self.hidraws), len(self.events)) == (hidraws, events), seconds,
                 f"{hidraws} hidraw and {events} event nodes at {self.sysfs}, there are "
                 f"{self.hidraws} {self.events}")
        settle()


class Pad(Nodes):
    """One USB pad on port INDEX (0..5), plugged in by entering the `with` block.

    kind    one of KINDS, or "trace" with trace=FILE.hid: that file's ids and descriptor
    serial  of the USB device; "" for none
    plug    False: starts unplugged
    """

    def __init__(self, kind, index=0, serial=None, trace=None, plug=True):
        super().__init__(f"/sys/devices/platform/dummy_hcd.{index}")
        self.kind, self.index, self.folder = kind, index, f"/run/rig/pad-{index}"
        self._command = [GADGET, kind, str(index)]
        if serial is not None:
            self._command += ["--serial", serial]
        if trace is not None:
            self._command += ["--trace", trace]
        self._plug = plug
        self._daemon = self._log = None
        self._lines, self._rest = collections.defaultdict(list), ""
        self._bursts_ended = 0

    def __enter__(self):
        if os.path.exists(self.folder + "/log"):
            os.unlink(self.folder + "/log")
        self._daemon = subprocess.Popen(self._command)
        try:
            wait_for(lambda: self.lines("ready") or self._daemon.poll() is not None, 10, "pad_gadget")
            if self._daemon.poll() is not None:
                raise RuntimeError(f"pad_gadget ended with {self._daemon.returncode}")
            if self._plug:
                self.plug()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self._daemon.poll() is None:
            self.command("quit")
            try:
                self._daemon.wait(5)
            except subprocess.TimeoutExpired:
                self._daemon.kill()
                self._daemon.wait()
        self.lines("sent")
        if self._log:
            self._log.close()

    # --- the log

    def lines(self, word):
        """The log's lines that begin with this word, as lists of words."""
        if self._log is None:
            try:
                self._log = open(self.folder + "/log")
            except FileNotFoundError:
                return []
        *whole, self._rest = (self._rest + self._log.read()).split("\n")
        for line in whole:
            self._lines[line.split(" ", 1)[0]].append(line.split())
        return list(self._lines[word])

    def sent(self):
        return [Sent(int(line[1]), int(line[2]), bytes.fromhex(line[3])) for line in self.lines("sent")
                if len(line) > 3]

    def out_packets(self, since_ns=0):
        """The packets that have arrived at the OUT endpoint."""
        return [Packet(int(line[1]), bytes.fromhex(line[2])) for line in self.lines("out")
                if int(line[1]) >= since_ns]

    def setups(self):
        return [Packet(int(line[1]), bytes.fromhex(line[-1])) for line in self.lines("setup")]

    # --- commands

    def command(self, text):
        """Sends the text to the daemon without waiting for its answer."""
        with open(self.folder + "/fifo", "w") as fifo:
            fifo.write(text + "\n")

    def _done(self, text):
        """Waits for the daemon's answer; raises ValueError if it refused."""
        before = len(self.lines("answer"))
        self.command(text)
        answer = wait_for(lambda: self.lines("answer")[before:], 5, text)[-1]
        if answer[2] != "done":
            raise ValueError(f"pad_gadget refused: {text}")

    def plug(self, wait=True):
        self.command("plug")
        if wait:
            self.wait_ready()

    def unplug(self, wait=True):
        self.command("unplug")
        if wait:
            wait_for(lambda: not self.hidraws and not self.events and not self.usb, 10, "the unplugging")

    def wait_ready(self, seconds=20.0):
        if self.kind in NODES:
            self.wait_nodes(*NODES[self.kind], seconds)
        else:
            wait_for(lambda: self.events, seconds, "an event node")
            settle()

    def set(self, **fields):
        """Sets fields of the state in the device's own units: lx ly rx ry lt rt hat buttons a b x y."""
        self._done("set " + " ".join(f"{name}={int(value)}" for name, value in fields.items()))

    def move(self, **fields):
        """Moves a stick like a thumb, in about 60 ms: `ly=(from, to)`."""
        for part in (1 / 3, 2 / 3, 1.0):
            self.set(**{name: round(start + (end - start) * part) for name, (start, end) in fields.items()})

    def report(self, data):
        """Sends the whole state; except for counters it is sent unchanged."""
        self._done("report " + bytes(data).hex())

    def raw(self, data):
        """Sends one packet of any length and content."""
        self._done("raw " + bytes(data).hex())

    def stream(self, rate_hz):
        """Sets the rate of reports; 0: a report at each change only."""
        self._done(f"stream {rate_hz}")

    def silence(self, on=True):
        self._done(f"silence {int(on)}")

    def stall(self):
        self._done("stall")

    def burst(self, rate_hz, seconds, at):
        """Sends numbered reports, the 32-bit number little-endian from byte `at`; returns at once."""
        self._bursts_ended = len(self.lines("burst_end"))
        self._done(f"burst {rate_hz} {seconds} {at}")

    def wait_burst(self, seconds=120.0):
        """Waits for the last burst to end; returns (reports sent, number of those more than a period late)."""
        end = wait_for(lambda: self.lines("burst_end")[self._bursts_ended:], seconds, "the burst's end")[-1]
        return int(end[2]), int(end[3])

    def play(self, trace=""):
        """Plays a recording's reports at its own times; returns at once. Empty: the constructor's recording."""
        self._done(f"play {trace}")

    def wait_play(self, seconds=120.0):
        wait_for(lambda: self.lines("play_end"), seconds, "the trace's end")

    def flash(self, address, data):
        """Writes into a Switch pad's flash memory, 0x8010..0x803f (the user's calibration)."""
        self._done(f"flash {address:x} {bytes(data).hex()}")

    # --- where it is

    @property
    def usb(self):
        """Path of the pad's /dev/bus/usb node."""
        for folder in glob.glob(self.sysfs + "/usb*/[0-9]*-1"):
            try:
                with open(folder + "/busnum") as bus, open(folder + "/devnum") as device:
                    return f"/dev/bus/usb/{int(bus.read()):03}/{int(device.read()):03}"
            except OSError:  # the device is being removed
                pass
        return None


def main(arguments):
    """pads.py KIND... -- COMMAND...: plugs these pads in at ports 0, 1 ... and runs the command."""
    if "--" not in arguments:
        sys.exit(main.__doc__)
    split = arguments.index("--")
    with contextlib.ExitStack() as stack:
        for index, kind in enumerate(arguments[:split]):
            stack.enter_context(Pad(kind, index))
        command = arguments[split + 1:]
        sys.exit(subprocess.run(command[0] if len(command) == 1 else command, shell=len(command) == 1).returncode)


if __name__ == "__main__":
    main(sys.argv[1:])
