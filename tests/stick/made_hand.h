// A simulated hand that holds a made pad and does what the guide asks for, or something else.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "stick/guide.h"
#include "tests/hid/made_pads.h"

namespace gaitpad {

enum class Controls { one_stick, two_sticks, two_sticks_and_triggers };

// A descriptor of a game pad with 16-bit axes: X Y, Z Rz, Brake Accelerator.
inline std::vector<std::uint8_t> descriptor_of(Controls controls) {
  std::vector<std::uint8_t> d = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x16, 0x01, 0x80, 0x26, 0xff,
                                 0x7f, 0x75, 0x10, 0x09, 0x30, 0x09, 0x31, 0x95, 0x02, 0x81, 0x02};
  const auto add = [&d](const std::vector<std::uint8_t>& more) {
    d.insert(d.end(), more.begin(), more.end());
  };
  if (controls != Controls::one_stick) add({0x09, 0x32, 0x09, 0x35, 0x95, 0x02, 0x81, 0x02});
  if (controls == Controls::two_sticks_and_triggers)
    add({0x05, 0x02, 0x15, 0x00, 0x26, 0xff, 0x00, 0x09, 0xc5, 0x09, 0xc4, 0x95, 0x02, 0x81, 0x02});
  add({0xc0});
  return d;
}

inline PadLayout layout_of(Controls controls) {
  DeviceInfo info;
  info.descriptor = descriptor_of(controls);
  return value_of(pad_layout(info, {}));
}

inline const std::array<StickFrame, 8> kFrames = {
    StickFrame{RawDirection::plus_x, RawDirection::plus_y},
    {RawDirection::plus_x, RawDirection::minus_y},
    {RawDirection::minus_x, RawDirection::plus_y},
    {RawDirection::minus_x, RawDirection::minus_y},
    {RawDirection::plus_y, RawDirection::plus_x},
    {RawDirection::plus_y, RawDirection::minus_x},
    {RawDirection::minus_y, RawDirection::plus_x},
    {RawDirection::minus_y, RawDirection::minus_x}};

inline vec2 unit(RawDirection direction) {
  const double length = is_negative(direction) ? -1.0 : 1.0;
  return is_along_x(direction) ? vec2(length, 0.0) : vec2(0.0, length);
}

// A pad in a hand, and the guide that gets its reports. Thumb positions are relative to rest, +x
// right, +y forward.
struct MadeHand {
  explicit MadeHand(Controls controls = Controls::two_sticks)
      : layout(layout_of(controls)), guide(layout) {}

  PadLayout layout;
  CalibrationGuide guide;
  StickFrame frame;    // frame in which the pad reports its raw axes
  vec2 centre{0.0};    // raw position at rest
  double sigma = 0.0;  // noise of each report, raw
  double reach = 0.95;
  bool reports_changes_only = false;
  double period_s = 0.004;
  std::int64_t time_ns = 1'000'000'000;
  std::array<vec2, 2> thumb{vec2(0.0), vec2(0.0)};
  std::array<double, 2> finger{};  // positions of the triggers, 0..1
  std::mt19937 random{1};
  std::vector<std::uint8_t> last;
  CalibrationGuide* copy = nullptr;  // a second guide, which takes the reports but no ticks

  std::int16_t word(double raw) {
    if (sigma > 0.0) raw += std::normal_distribution(0.0, sigma)(random);
    return static_cast<std::int16_t>(std::lround(std::clamp(raw, -1.0, 1.0) * 32767.0));
  }
  std::vector<std::uint8_t> report() {
    std::vector<std::uint8_t> bytes;
    for (const vec2& p : thumb) {
      const vec2 raw = centre + p.x * unit(frame.right) + p.y * unit(frame.forward);
      for (const std::int16_t axis : {word(raw.x), word(-raw.y)}) {
        bytes.push_back(static_cast<std::uint8_t>(axis & 0xff));
        bytes.push_back(static_cast<std::uint8_t>((axis >> 8) & 0xff));
      }
    }
    for (const double trigger : finger) {
      const auto value = static_cast<std::uint16_t>(std::lround(trigger * 255.0));
      bytes.push_back(static_cast<std::uint8_t>(value));
      bytes.push_back(0);
    }
    return bytes;
  }
  void send(const std::vector<std::uint8_t>& bytes) {
    const Report report = report_of(bytes, time_ns);
    guide.take_report(report);
    if (copy != nullptr) copy->take_report(report);
  }
  // Lets the time between two reports pass.
  void pass() {
    time_ns += std::llround(period_s * 1e9);
    const std::vector<std::uint8_t> bytes = report();
    if (!reports_changes_only || bytes != last) send(bytes);
    last = bytes;
    guide.tick(time_ns);
  }
  void wait(double seconds) {
    for (int i = 0; i < std::lround(seconds / period_s); ++i) pass();
  }
  void move(int side, const vec2& to, double seconds) {
    const vec2 from = thumb[static_cast<std::size_t>(side)];
    const long steps = std::max(1L, std::lround(seconds / period_s));
    for (long i = 1; i <= steps; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(steps);
      thumb[static_cast<std::size_t>(side)] = from + (to - from) * part;
      pass();
    }
  }
  void push(int side, const vec2& to, double held_s = 0.4, double rest_s = 0.8) {
    move(side, to * reach, 0.1);
    wait(held_s);
    move(side, vec2(0.0), 0.03);
    wait(rest_s);
  }
  void release_around(int side, int count) {
    for (int i = 0; i < count; ++i) {
      const SinCos angle = sin_cos(i * 2.0 * kPi / count + 0.2);
      push(side, vec2(angle.cos, angle.sin), 0.1);
    }
  }
  // Does the whole first step, with the rest at its end.
  void rest_step(int side) {
    release_around(side, kWantedReleasesAside);
    wait(2.0);
  }
  void turn(int side, double turns, double radius, double start_turn = 0.0) {
    for (double t = 0.0; t < turns; t += period_s / 1.5) {
      const SinCos angle = sin_cos((start_turn + t) * 2.0 * kPi);
      thumb[static_cast<std::size_t>(side)] = radius * vec2(angle.cos, angle.sin);
      pass();
    }
  }
  void full_turns(int side) {
    turn(side, 3.0, reach);
    move(side, vec2(0.0), 0.05);
    wait(0.2);
  }
  // Does all steps of a pad with this number of sticks.
  void steps_of_sticks(int sticks) {
    for (int side = 0; side < sticks; ++side) rest_step(side);
    for (int side = 0; side < sticks; ++side) full_turns(side);
    for (const vec2& to : {vec2(0, 1), vec2(1, 0), vec2(0, -1), vec2(-1, 0)})
      for (int side = 0; side < sticks; ++side) push(side, to);
  }
  void press(int side, double to) {
    const double from = std::exchange(finger[static_cast<std::size_t>(side)], to);
    wait(0.4);
    finger[static_cast<std::size_t>(side)] = from;
    wait(0.2);
  }
  std::string text(std::size_t control = 0) const {
    const auto progress = guide.progress();
    return control < progress.size() ? progress[control].text : "(none)";
  }
  std::size_t samples(int side = 0) const {
    const PadTracks tracks = guide.tracks();
    std::size_t count = 0;
    for (const StickTrack& track : tracks.stick[static_cast<std::size_t>(side)])
      count += track.size();
    return count;
  }
  void skip_to(GuideStep step) {
    while (guide.step() != step && guide.step() != GuideStep::done) guide.skip();
  }
};

}  // namespace gaitpad
