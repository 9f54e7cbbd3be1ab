"""A hand that moves both sticks of a pad through the steps of `gaitpad calibrate`, as lines of a trace."""
import math

from support import traces


class Hand:
    """A hand at a pad. The pad's class says in data() what the pad reports while the sticks are at `place` (x right, y
    forward, -1..1) and the triggers are pulled or not."""

    rate_hz = 100
    releases_a_turn = 7
    thumb_s = 0.06  # time that a thumb takes from one place to another
    release_s, turn_s, after_turns_s, push_s, trigger_s = (0.1, 0.68), 0.9, 0.2, (0.4, 0.3), (0.4, 0.2)

    def __init__(self):
        self.place, self.is_pulled, self.lines = (0.0, 0.0), False, []

    def data(self):
        raise NotImplementedError

    def hold(self, seconds):
        for _ in range(round(seconds * self.rate_hz)):
            self.lines.append(traces.report(len(self.lines) / self.rate_hz, self.data()))

    def go(self, *place):
        start, steps = self.place, round(self.thumb_s * self.rate_hz)
        for i in range(1, steps + 1):
            self.place = tuple(a + (b - a) * i / steps for a, b in zip(start, place))
            self.hold(1 / self.rate_hz)

    def push(self, angle, held_s, rest_s):
        """Pushes the stick. The movement there counts as held time, the movement back as rest."""
        self.go(math.cos(angle), math.sin(angle))
        self.hold(held_s - self.thumb_s)
        self.go(0.0, 0.0)
        self.hold(rest_s - self.thumb_s)

    def releases(self, first, count):
        for i in range(first, first + count):
            self.push(2 * math.pi * i / self.releases_a_turn + 0.2, *self.release_s)

    def turns(self, count):
        for i in range(round(count * self.turn_s * self.rate_hz)):
            angle = 2 * math.pi * i / self.rate_hz / self.turn_s
            self.place = (math.cos(angle), math.sin(angle))
            self.hold(1 / self.rate_hz)
        self.place = (0.0, 0.0)
        self.hold(self.after_turns_s)

    def pushes(self):
        for angle in (math.pi / 2, 0.0, -math.pi / 2, math.pi):
            self.push(angle, *self.push_s)

    def triggers(self):
        self.is_pulled = True
        self.hold(self.trigger_s[0])
        self.is_pulled = False
        self.hold(self.trigger_s[1])
