"""A program at a terminal of its own: `with Terminal("gaitpad", "calibrate") as terminal: terminal.press("s")`."""
import fcntl
import os
import re
import signal
import struct
import subprocess
import termios
import threading
import time


class Terminal:
    """Runs until the block ends; `text` is everything that it shows."""

    def __init__(self, *command, env=None, rows=24, columns=80):
        self._command = [str(word) for word in command]
        self._env = {**os.environ, **(env or {})}
        self._size = struct.pack("HHHH", rows, columns, 0, 0)
        self.text = ""
        self._more = threading.Condition()

    def __enter__(self):
        self._master, self._slave = os.openpty()
        fcntl.ioctl(self._slave, termios.TIOCSWINSZ, self._size)
        self.mode_before = termios.tcgetattr(self._slave)
        slave = self._slave
        self.process = subprocess.Popen(
            self._command, stdin=slave, stdout=slave, stderr=slave, env=self._env, start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(slave, termios.TIOCSCTTY, 0))
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self._slave)
        self._reader.join(5)
        os.close(self._master)

    def _read(self):
        while True:
            try:
                data = os.read(self._master, 4096)
            except OSError:  # the other end of the terminal is closed
                return
            with self._more:
                self.text += data.decode(errors="replace")
                self._more.notify_all()

    def press(self, keys):
        os.write(self._master, keys.encode())

    def resize(self, rows, columns):
        fcntl.ioctl(self._slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def wait_for(self, pattern, seconds=20.0, since=0):
        """The first match of a regular expression in the output after that character."""
        end = time.monotonic() + seconds
        with self._more:
            while True:
                is_last = self.process.poll() is not None or time.monotonic() > end
                if is_last:
                    self._read_all()
                found = re.compile(pattern).search(self.text, since)
                if found:
                    return found
                if is_last:
                    raise AssertionError(f"{pattern!r} was not shown: ...{self.text[-1500:]!r}")
                self._more.wait(0.05)

    def wait_end(self, seconds=20.0):
        """Waits for the end and returns the exit status."""
        status = self.process.wait(seconds)
        with self._more:
            self._read_all()
        return status

    def _read_all(self):
        """Waits until everything that the program wrote has arrived."""
        os.write(self._slave, b"\0")
        self._more.wait_for(lambda: "\0" in self.text, 10)
        self.text = self.text.replace("\0", "")

    def send_signal(self, number):
        self.process.send_signal(number)

    def wait_stopped(self, seconds=10.0):
        end = time.monotonic() + seconds
        while os.waitid(os.P_PID, self.process.pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT) is None:
            assert time.monotonic() < end, "it was not stopped"
            time.sleep(0.01)

    def go_on(self):
        self.process.send_signal(signal.SIGCONT)

    def is_as_before(self):
        """True if the terminal's mode is the one before the program."""
        return termios.tcgetattr(self._slave) == self.mode_before

    def is_cooked(self):
        """True if the terminal has line mode and echo, as in a shell."""
        flags = termios.tcgetattr(self._slave)[3]
        return bool(flags & termios.ECHO) and bool(flags & termios.ICANON)
