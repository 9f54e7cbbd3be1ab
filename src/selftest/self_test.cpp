#include "selftest/self_test.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

#include "base/numeric.h"
#include "base/shown_number.h"
#include "base/text.h"
#include "drivers/system_nodes.h"
#include "drivers/system_users.h"
#include "gaitpad/decode.h"
#include "gaitpad/limbs.h"
#include "gaitpad/live.h"
#include "pads/calibration_store.h"
#include "pads/guided_calibration.h"
#include "session/live_loop.h"
#include "stick/guide.h"
#include "stick/new_values.h"
#include "stick/pad_analysis.h"
#include "system/clock.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Answer = SelfTestPerson::Answer;

constexpr std::chrono::milliseconds kLook{20};
// Longest time that the opening of a pad may take.
constexpr std::int64_t kOpening_ns = 8 * kSecond_ns;

// Removing everything that identifies the pad from the kept files.

// A Bluetooth address as bytes, most significant first, else the text itself.
std::vector<std::uint8_t> identity_bytes(const std::string& unique_id) {
  std::vector<std::uint8_t> bytes;
  for (std::string_view rest = unique_id; !rest.empty();) {
    const auto byte = parse_number<std::uint8_t>(take_part(rest, ':'), 16);
    if (!byte) return {unique_id.begin(), unique_id.end()};
    bytes.push_back(*byte);
  }
  return bytes.size() == 6 ? bytes : std::vector<std::uint8_t>(unique_id.begin(), unique_id.end());
}

bool holds(std::span<const std::uint8_t> report, const std::vector<std::uint8_t>& identity) {
  // Shorter addresses are not searched for, because they may match by chance.
  constexpr std::size_t kShortest = 4;
  if (identity.size() < kShortest) return false;
  return std::search(report.begin(), report.end(), identity.begin(), identity.end()) !=
             report.end() ||
         std::search(report.begin(), report.end(), identity.rbegin(), identity.rend()) !=
             report.end();
}

// Removes serial numbers, addresses and ports from the devices' descriptions, and each report that
// holds one (a pad may send it to its driver).
void leave_identity_out(Trace& trace) {
  for (std::size_t i = 0; i < trace.devices.size(); ++i) {
    DeviceInfo& info = trace.devices[i].info;
    const std::vector<std::uint8_t> identity = identity_bytes(info.unique_id);
    std::erase_if(trace.events, [&](const TraceEvent& event) {
      const std::span all(trace.bytes);
      return event.device == i && holds(all.subspan(event.first_byte, event.size), identity);
    });
    info.unique_id.clear();
    info.physical_path.clear();
  }
}

// --- one pad, open through one driver

class OpenPad {
 public:
  static Result<std::unique_ptr<OpenPad>> open(const PadFiles& files, const PadSelector& selector) {
    auto stream = PadStream::start({files, selector});
    if (!stream) return stream.error();
    return std::unique_ptr<OpenPad>(new OpenPad(std::move(*stream)));
  }

  // Takes the reports that have arrived, or waits briefly.
  void look(CalibrationGuide* guide = nullptr);
  bool has_come() const noexcept { return device_ != kNoDevice; }
  bool is_plugged() const noexcept { return is_plugged_; }
  bool has_ended() const noexcept { return stream_->has_ended(); }
  const PadState& state() const noexcept { return state_; }
  const PadLayout& layout() const noexcept { return *config_.layout; }
  const DeviceInfo& info() const noexcept { return stream_->device(device_).info; }
  bool has_factory_sticks() const noexcept { return config_.has_factory_sticks; }
  std::int64_t reports() const noexcept { return reports_; }
  std::int64_t reports_since_plugged() const noexcept { return reports_since_plugged_; }
  double time_s() const noexcept { return static_cast<double>(now_ns() - start_ns_) / 1e9; }
  std::vector<std::string> take_remarks() { return stream_->take_remarks(); }
  void rumble(const Rumble& strength, std::chrono::milliseconds duration) {
    stream_->rumble(device_, strength, duration);
  }

  ordered_json rate() const;  // The rate and the jitter of all reports so far.
  std::optional<Error> save(const std::string& path) &&;

 private:
  explicit OpenPad(std::unique_ptr<PadStream> stream) : stream_(std::move(stream)) {}
  void take_report(const Report& report);

  std::unique_ptr<PadStream> stream_;
  std::uint16_t device_ = kNoDevice;
  PadConfig config_;
  PadState state_;
  Trace trace_;
  bool is_plugged_ = false;
  std::int64_t start_ns_ = now_ns();
  std::int64_t reports_ = 0, bad_reports_ = 0, reports_since_plugged_ = 0, last_ns_ = 0;
  std::vector<double> interval_us_;
  NewValueCount new_values_;
};

void OpenPad::take_report(const Report& report) {
  if (report.kind == ReportKind::added && device_ == kNoDevice) {
    device_ = report.device;
    config_ = stream_->take_config(device_);
    TraceDevice& device = trace_.devices.emplace_back(stream_->device(device_));
    device.index = 0;
    device.calibration.clear();
  }
  if (report.device != device_ || device_ == kNoDevice) return;
  if (report.kind == ReportKind::added || report.kind == ReportKind::removed) {
    is_plugged_ = report.kind == ReportKind::added;
    state_ = {};
    reports_since_plugged_ = last_ns_ = 0;
  } else {
    if (last_ns_ != 0) interval_us_.push_back(static_cast<double>(report.time_ns - last_ns_) / 1e3);
    last_ns_ = report.time_ns;
    ++reports_, ++reports_since_plugged_;
    if (decode(layout(), report, state_)) {
      const auto& axis = state_.axis;
      new_values_.take(report.time_ns, {axis[kLeftX], axis[kLeftY]},
                       {axis[kRightX], axis[kRightY]});
    } else {
      ++bad_reports_;
    }
  }
  const auto first = static_cast<std::uint32_t>(trace_.bytes.size());
  trace_.bytes.insert(trace_.bytes.end(), report.bytes.begin(), report.bytes.begin() + report.size);
  const std::int64_t time_us = std::max<std::int64_t>((report.time_ns - start_ns_) / 1000, 0);
  trace_.events.push_back({time_us, 0, first, report.size, 0, report.kind});
}

void OpenPad::look(CalibrationGuide* guide) {
  stream_->wait(kLook);
  for (; const Report* report = stream_->front(); stream_->pop()) {
    take_report(*report);
    if (guide != nullptr && report->device == device_) guide->take_report(*report);
  }
  // A report may arrive this long after the user's answer.
  constexpr std::int64_t kOnTheWay_ns = 50'000'000;
  if (guide != nullptr) guide->tick(now_ns() - kOnTheWay_ns);
}

ordered_json OpenPad::rate() const {
  // A pad that reports only changes pauses; do not count pauses as intervals.
  constexpr double kPause_us = 100e3;
  std::vector<double> running = interval_us_;
  std::erase_if(running, [](double us) { return us > kPause_us; });
  const auto count = static_cast<double>(running.size());
  const double sum = std::accumulate(running.begin(), running.end(), 0.0);
  double squares = 0.0;
  for (const double us : running) squares += (us - sum / count) * (us - sum / count);
  const auto moving = new_values_.rate();
  return {{"reports", reports_},
          {"moving_rate_hz", moving ? ordered_json(moving->report_hz) : nullptr},
          {"new_values_hz", moving ? ordered_json(moving->new_value_hz) : nullptr},
          {"repeats", moving ? ordered_json(moving->repeats()) : nullptr},
          {"bad_reports", bad_reports_},
          {"lost", stream_->counts().lost},
          {"rate_hz", sum > 0.0 ? count * 1e6 / sum : 0.0},
          {"interval_us_median", median(running)},
          {"interval_us_p99", percentile(running, 99)},
          {"jitter_us", count > 1.0 ? std::sqrt(squares / (count - 1.0)) : 0.0}};
}

std::optional<Error> OpenPad::save(const std::string& path) && {
  leave_identity_out(trace_);
  const auto written = write_trace(trace_, path);
  if (!written) return written.error();
  return std::nullopt;
}

// --- the system

std::string file_or_nothing(const std::string& path) {
  constexpr std::size_t kMost = std::size_t{1} << 20;
  auto text = file_text(path, kMost);
  return text ? std::move(*text) : std::string();
}

std::string distribution() {
  const std::string text = file_or_nothing("/etc/os-release");
  for (std::string_view rest = text; !rest.empty();) {
    std::string_view line = take_line(rest);
    if (line.starts_with("PRETTY_NAME=")) return std::string(trimmed(line.substr(12), "\""));
  }
  return {};
}

// The first of udev's folders that holds the project's rule.
std::string installed_rule() {
  for (const char* folder :
       {"/etc/udev/rules.d", "/run/udev/rules.d", "/usr/local/lib/udev/rules.d",
        "/usr/lib/udev/rules.d", "/lib/udev/rules.d"}) {
    const std::string path = std::string(folder) + "/60-gaitpad.rules";
    std::error_code ignored;
    if (fs::exists(path, ignored)) return path;
  }
  return {};
}

ordered_json permissions(const std::string& node) {
  const auto rights = node_rights(node);
  if (!rights) return nullptr;
  return {{"mode", fmt::format("{:04o}", rights->mode)},
          {"owner", rights->owner},
          {"group", rights->group},
          {"problem", access_problem(node)}};
}

ordered_json system_facts() {
  const KernelName kernel = kernel_name();
  const std::string rule = installed_rule();
  return {{"kernel", kernel.release},
          {"machine", kernel.machine},
          {"distribution", distribution()},
          {"udev_rule", rule.empty() ? ordered_json(nullptr) : ordered_json(rule)},
          {"is_root", is_root()}};
}

// The controls that a pad has, and the requests to operate them.

struct ControlAction {
  std::string name;     // the control's name in the report: left_x+, left_trigger, a
  std::string request;  // the request to the user
  int axis = -1;        // a PadAxis; -1: the control is `button`
  float direction = 1.0f;
  PadButton button = kButtonA;
};

constexpr float kPushed = 0.6f, kBeside = 0.4f, kBack = 0.3f;

struct Controls {
  std::uint32_t axes = 0, buttons = 0;  // operated axes and buttons, a bit each
};

Controls controls_of(const PadLayout& layout) {
  Controls all;
  const auto add_dpad = [&all] {
    for (const PadButton b : {kButtonDpadUp, kButtonDpadDown, kButtonDpadLeft, kButtonDpadRight})
      all.buttons |= 1u << b;
  };
  for (const ReportLayout& report : layout.reports) {
    for (const AxisOp& op : report.axes) all.axes |= 1u << op.axis;
    for (const ButtonOp& op : report.buttons) all.buttons |= op.button;
    for (const HatOp& op : report.hats) {
      if (op.directions == 0) add_dpad();
      all.buttons |= op.directions == 0 ? 0 : op.button;
      if (op.value != 0.0f) all.axes |= 1u << op.axis;
    }
    for (const ArrayOp& op : report.arrays)
      for (const std::uint32_t button : op.button) all.buttons |= button;
  }
  return all;
}

std::vector<ControlAction> actions_for(const PadLayout& layout) {
  const Controls controls = controls_of(layout);
  std::vector<ControlAction> actions;
  for (const int axis : {kLeftX, kLeftY, kRightX, kRightY}) {
    if ((controls.axes >> axis & 1u) == 0) continue;
    const char* stick = kSideNames[axis >= kRightX];
    const bool is_x = axis == kLeftX || axis == kRightX;
    for (const float direction : {1.0f, -1.0f}) {
      const char* where = is_x
                              ? (direction > 0.0f ? "to the right" : "to the left")
                              : (direction > 0.0f ? "forward, away from you" : "back, towards you");
      actions.push_back({fmt::format("{}{}", kAxisNames[static_cast<std::size_t>(axis)],
                                     direction > 0.0f ? "+" : "-"),
                         fmt::format("Push the {} stick {}, and let it go.", stick, where), axis,
                         direction});
    }
  }
  for (const int axis : {kLeftTrigger, kRightTrigger}) {
    if ((controls.axes >> axis & 1u) == 0) continue;
    actions.push_back({std::string(kAxisNames[static_cast<std::size_t>(axis)]),
                       fmt::format("Pull the {} trigger all the way, and let it go.",
                                   kSideNames[axis == kRightTrigger]),
                       axis, 1.0f});
  }
  for (int button = 0; button < kButtonCount; ++button) {
    if ((controls.buttons >> button & 1u) == 0) continue;
    const auto b = static_cast<PadButton>(button);
    actions.push_back({std::string(kButtonNames[static_cast<std::size_t>(button)]),
                       button_request(b), -1, 1.0f, b});
  }
  return actions;
}

bool is_at_rest(const PadState& state) {
  return state.buttons == 0 &&
         std::ranges::all_of(state.axis, [](float value) { return std::abs(value) < kBack; });
}

// True if only this control is operated, and fully.
bool shows(const PadState& state, const ControlAction& action) {
  if (action.axis < 0) return state.buttons == 1u << action.button;
  for (int i = 0; i < kAxisCount; ++i) {
    const float value = state.axis[static_cast<std::size_t>(i)];
    if (i == action.axis ? value * action.direction < kPushed : std::abs(value) > kBeside)
      return false;
  }
  return true;
}

// Names of the operated controls, for users and the report.
std::vector<std::string> shown_controls(const PadState& state) {
  std::vector<std::string> names;
  for (int i = 0; i < kAxisCount; ++i) {
    const float value = state.axis[static_cast<std::size_t>(i)];
    if (std::abs(value) < kPushed) continue;
    const char* sign = i >= kLeftTrigger ? "" : value > 0.0f ? "+" : "-";
    names.push_back(fmt::format("{}{}", kAxisNames[static_cast<std::size_t>(i)], sign));
  }
  for (int i = 0; i < kButtonCount; ++i)
    if (pressed(state, static_cast<PadButton>(i)))
      names.emplace_back(kButtonNames[static_cast<std::size_t>(i)]);
  return names;
}

std::string shown_text(const OpenPad& pad) {
  if (!pad.is_plugged()) return "UNPLUGGED: plug it in again, it goes on from here";
  const std::vector<std::string> names = shown_controls(pad.state());
  return names.empty() ? "nothing is pressed" : fmt::format("{}", fmt::join(names, ", "));
}

// --- the test

class SelfTest {
 public:
  SelfTest(const SelfTestOptions& options, SelfTestPerson& person)
      : options_(options), person_(person) {}
  std::optional<Error> find_pad();
  std::optional<Error> make_folder();
  Result<std::optional<SelfTestResult>> run();

 private:
  enum class Part { drivers, controls, replug, rumble, calibration, walk };
  static constexpr int kParts = 6;
  static constexpr const char* kTitles[kParts] = {"drivers", "controls",    "unplugging",
                                                  "rumble",  "calibration", "straight walk"};
  // Each returns false if the user gave up or `problem_` is set.
  bool compare_drivers();
  bool try_driver(const PadSighting& way);
  bool turn_stick(OpenPad& pad, ordered_json& driver);
  bool ask_controls();
  bool ask_control(const ControlAction& action, ordered_json& control);
  bool replug();
  bool feel_rumble();
  bool calibrate();
  bool walk_straight();

  SelfTestPrompt prompt_of(Part part, std::string request) const;
  bool open(const std::string& driver, bool& is_open);
  bool close(const std::string& name);
  // Shows the prompt until `look_on` returns true (Answer::none) or the user answers.
  template <class LookOn>
  Answer ask(SelfTestPrompt& prompt, const LookOn& look_on);
  void fail(std::string sentence) { failures_.push_back(std::move(sentence)); }
  std::string path_of(const std::string& name) const { return folder_ + "/" + name; }
  bool has_way() const noexcept { return !driver_.empty(); }

  const SelfTestOptions& options_;
  SelfTestPerson& person_;
  std::string folder_;
  std::vector<PadSighting> ways_;  // the same pad as each driver sees it, one for each driver
  PadSelector selector_;           // the pad's ids, by which it is found again after unplugging
  std::string driver_;             // the first driver that could open the pad
  std::unique_ptr<OpenPad> pad_;
  CalibrationFile calibration_;
  bool has_calibration_ = false;
  ordered_json report_;
  std::vector<std::string> failures_;
  std::optional<Error> problem_;
};

std::optional<Error> SelfTest::find_pad() {
  if (is_recording(options_.selector.pad))
    return Error{options_.selector.pad + ": a recording, but the test needs the pad itself"};
  auto all = pad_sightings(options_.files, options_.selector, Drivers::all);
  if (!all) return all.error();
  auto mine = matching_pads(*all, options_.selector);
  if (!mine) return mine.error();
  const auto usable = std::ranges::find_if(
      *mine, [](const PadSighting& s) { return s.is_pad && s.problem.empty(); });
  if (usable == mine->end())
    return Error{"no pad can be opened; gaitpad doctor says why, and what to do"};
  const std::string key = pad_key(*usable);
  for (PadSighting& way : *mine) {
    const bool is_known =
        std::ranges::any_of(ways_, [&](const PadSighting& w) { return w.driver == way.driver; });
    if (pad_key(way) == key && way.is_pad && !is_known) ways_.push_back(std::move(way));
  }
  const DeviceInfo& info = ways_.front().listing.info;
  selector_.pad = fmt::format("{:04x}:{:04x}", info.vendor, info.product);
  return std::nullopt;
}

std::optional<Error> SelfTest::make_folder() {
  folder_ = options_.folder;
  if (folder_.empty()) {
    std::string ids = selector_.pad;
    std::ranges::replace(ids, ':', '-');
    folder_ = fmt::format("selftest-{}-{:%Y%m%d-%H%M%S}", ids, fmt::localtime(std::time(nullptr)));
  }
  std::error_code error;
  if (fs::exists(folder_, error)) return Error{folder_ + ": exists already; name another folder"};
  if (!fs::create_directories(folder_, error)) return write_error(folder_, error.value());
  return std::nullopt;
}

SelfTestPrompt SelfTest::prompt_of(Part part, std::string request) const {
  const int index = static_cast<int>(part);
  return {index + 1, kParts, kTitles[index], std::move(request), "", 0.0, false};
}

template <class LookOn>
Answer SelfTest::ask(SelfTestPrompt& prompt, const LookOn& look_on) {
  static_cast<void>(person_.take_answer());  // drops an answer that was given before the question
  for (;;) {
    if (look_on(prompt)) return Answer::none;
    person_.show(prompt);
    const Answer answer = person_.take_answer();
    if (answer != Answer::none) return answer;
  }
}

// `is_open`: false if this driver cannot use the pad, with a remark.
bool SelfTest::open(const std::string& driver, bool& is_open) {
  is_open = false;
  auto pad = OpenPad::open(options_.files, {selector_.pad, driver});
  if (!pad) {
    problem_ = pad.error();
    return false;
  }
  pad_ = std::move(*pad);
  SelfTestPrompt prompt = prompt_of(Part::drivers, fmt::format("Opening it through {}.", driver));
  const std::int64_t end_ns = now_ns() + kOpening_ns;
  const Answer answer = ask(prompt, [&](SelfTestPrompt&) {
    pad_->look();
    return pad_->is_plugged() || now_ns() > end_ns;
  });
  for (const std::string& remark : pad_->take_remarks()) person_.tell(remark);
  is_open = pad_->is_plugged();
  return answer != Answer::quit;
}

// Saves the recorded reports as NAME.
bool SelfTest::close(const std::string& name) {
  if (pad_->has_come()) problem_ = std::move(*pad_).save(path_of(name));
  pad_.reset();
  return !problem_;
}

bool SelfTest::compare_drivers() {
  report_["drivers"] = ordered_json::array();
  for (const PadSighting& way : ways_)
    if (!try_driver(way)) return false;
  if (!has_way()) fail("no driver opened the pad");
  // The other drivers are compared with the first.
  const ordered_json* first = nullptr;
  for (ordered_json& driver : report_["drivers"]) {
    if (!driver.contains("left_stick")) continue;
    if (first == nullptr) {
      first = &driver;
      continue;
    }
    double worst = 0.0;
    for (const char* key : {"min_x", "max_x", "min_y", "max_y"})
      worst = std::max(worst, std::abs(driver["left_stick"][key].get<double>() -
                                       (*first)["left_stick"][key].get<double>()));
    driver["differs_by"] = worst;
    // Allowed difference: two turns by hand differ, and kernel drivers scale values.
    constexpr double kAlike = 0.25;
    if (worst > kAlike)
      fail(fmt::format("{} shows the left stick otherwise than {}: by {:.2f}",
                       driver["driver"].get<std::string>(), (*first)["driver"].get<std::string>(),
                       worst));
  }
  return true;
}

bool SelfTest::try_driver(const PadSighting& way) {
  ordered_json driver = {{"driver", way.driver->name},
                         {"kernel_driver", way.listing.kernel_driver},
                         {"permissions", permissions(way.listing.node)}};
  bool is_open = false, goes_on = true;
  if (way.problem.empty()) goes_on = open(way.driver->name, is_open);
  driver["opened"] = is_open;
  driver["problem"] = !way.problem.empty() ? way.problem
                      : is_open            ? ""
                                           : "it did not come within 8 s";
  if (goes_on && is_open) {
    if (!has_way()) {
      driver_ = way.driver->name;
      const DeviceInfo& info = pad_->info();
      report_["pad"] = {{"name", info.name},
                        {"bus", static_cast<int>(info.bus)},
                        {"vendor", info.vendor},
                        {"product", info.product},
                        {"version", info.version}};
      std::string hex;
      for (const std::uint8_t byte : info.descriptor) hex += fmt::format("{:02x} ", byte);
      problem_ = write_file(path_of("descriptor.txt"), hex + "\n");
    }
    goes_on = !problem_ && turn_stick(*pad_, driver);
    if (goes_on) goes_on = close(fmt::format("driver-{}.hid", way.driver->name));
  }
  pad_.reset();
  report_["drivers"].push_back(std::move(driver));
  return goes_on;
}

bool SelfTest::turn_stick(OpenPad& pad, ordered_json& driver) {
  constexpr int kDirections = 16;
  constexpr double kRim = 0.5;
  std::uint32_t seen = 0;
  double min_x = 0.0, max_x = 0.0, min_y = 0.0, max_y = 0.0;
  SelfTestPrompt prompt = prompt_of(
      Part::drivers, fmt::format("Through {}: turn the left stick twice along its rim, and let it "
                                 "go. (Enter: it has none)",
                                 printable(driver["driver"].get<std::string>())));
  const Answer answer = ask(prompt, [&](SelfTestPrompt& p) {
    pad.look();
    const double x = static_cast<double>(pad.state().axis[kLeftX]),
                 y = static_cast<double>(pad.state().axis[kLeftY]);
    min_x = std::min(min_x, x), max_x = std::max(max_x, x);
    min_y = std::min(min_y, y), max_y = std::max(max_y, y);
    if (std::hypot(x, y) > kRim) {
      const double turn = std::atan2(y, x) / (2.0 * kPi) + 0.5;
      seen |= 1u << static_cast<int>(turn * kDirections) % kDirections;
    }
    const int count = std::popcount(seen);
    p.done = static_cast<double>(count) / kDirections;
    p.seen = fmt::format("{} of {} directions, {} {}", count, kDirections, signed_number(x, 2),
                         signed_number(y, 2));
    return count == kDirections && is_at_rest(pad.state());
  });
  driver["rate"] = pad.rate();
  if (answer == Answer::quit) return false;
  if (answer == Answer::next) return true;
  driver["left_stick"] = {{"directions", std::popcount(seen)},
                          {"min_x", min_x},
                          {"max_x", max_x},
                          {"min_y", min_y},
                          {"max_y", max_y}};
  if (answer == Answer::no)
    fail(fmt::format("through {} the left stick does not show how it was turned",
                     driver["driver"].get<std::string>()));
  return true;
}

bool SelfTest::ask_controls() {
  report_["controls"] = ordered_json::array();
  if (!has_way()) return true;
  bool is_open = false;
  if (!open(driver_, is_open)) return false;
  if (!is_open) {
    fail("the pad did not open a second time");
    return true;
  }
  for (const ControlAction& action : actions_for(pad_->layout())) {
    ordered_json control = {{"control", action.name}};
    if (!ask_control(action, control)) return false;
    report_["controls"].push_back(std::move(control));
  }
  return true;
}

bool SelfTest::ask_control(const ControlAction& action, ordered_json& control) {
  bool is_seen = false;
  std::vector<std::string> others;
  SelfTestPrompt prompt = prompt_of(Part::controls, action.request);
  const double from_s = pad_->time_s();
  const Answer answer = ask(prompt, [&](SelfTestPrompt& p) {
    pad_->look();
    is_seen = is_seen || shows(pad_->state(), action);
    p.done = is_seen ? 0.5 : 0.0;
    p.seen = shown_text(*pad_);
    for (std::string& name : shown_controls(pad_->state()))
      if (name != action.name && std::ranges::count(others, name) == 0)
        others.push_back(std::move(name));
    return is_seen && is_at_rest(pad_->state());
  });
  if (answer == Answer::quit) return false;
  const bool is_wrong = answer == Answer::no;
  control["result"] = is_seen && !is_wrong ? "seen" : is_wrong ? "wrong" : "absent";
  control["others"] = others;  // controls that were operated at the same time
  control["from_s"] = from_s;
  control["to_s"] = pad_->time_s();
  if (is_wrong)
    fail(fmt::format("{}: something else was shown{}", action.name,
                     others.empty() ? "" : fmt::format(": {}", fmt::join(others, ", "))));
  return true;
}

bool SelfTest::replug() {
  if (!pad_) return true;
  SelfTestPrompt prompt =
      prompt_of(Part::replug, "Unplug the pad, or switch it off. (Enter: leave this out)");
  ordered_json replugged = {{"left_out", true}};
  Answer answer = ask(prompt, [&](SelfTestPrompt& p) {
    pad_->look();
    p.seen = "it is there";
    return !pad_->is_plugged();
  });
  if (answer == Answer::none) {
    prompt = prompt_of(Part::replug, "Plug it in again, or switch it on.");
    answer = ask(prompt, [&](SelfTestPrompt& p) {
      pad_->look();
      p.seen = "it is gone";
      return pad_->is_plugged();
    });
    const double back_s = pad_->time_s();
    if (answer == Answer::none) {
      prompt = prompt_of(Part::replug, "Push the left stick forward, and let it go.");
      bool is_pushed = false;
      answer = ask(prompt, [&](SelfTestPrompt& p) {
        pad_->look();
        is_pushed = is_pushed || pad_->state().axis[kLeftY] > kPushed;
        p.seen = shown_text(*pad_);
        return is_pushed && is_at_rest(pad_->state());
      });
      replugged = {{"left_out", false},
                   {"is_back", answer == Answer::none},
                   {"reports", pad_->reports_since_plugged()},
                   {"seconds_until_pushed", pad_->time_s() - back_s}};
    } else {
      replugged = {{"left_out", false}, {"is_back", false}};
    }
    if (answer != Answer::none) fail("after it was plugged in again the pad did not work");
  }
  report_["unplugging"] = std::move(replugged);
  return answer != Answer::quit;
}

bool SelfTest::feel_rumble() {
  if (!pad_) return true;
  constexpr std::uint16_t kFull = 65535;
  constexpr std::chrono::milliseconds kShaking{600};
  constexpr std::int64_t kAgain_ns = 2 * kSecond_ns;
  for (const bool is_strong : {true, false}) {
    const char* motor = is_strong ? "strong" : "weak";
    SelfTestPrompt prompt = prompt_of(
        Part::rumble, fmt::format("Do you feel the {} motor shake, every two seconds? (y, n; "
                                  "Enter: the pad has none)",
                                  motor));
    prompt.is_question = true;
    std::int64_t due_ns = 0;
    const Answer answer = ask(prompt, [&](SelfTestPrompt&) {
      pad_->look();
      if (now_ns() < due_ns) return false;
      due_ns = now_ns() + kAgain_ns;
      pad_->rumble(is_strong ? Rumble{kFull, 0} : Rumble{0, kFull}, kShaking);
      return false;
    });
    if (answer == Answer::quit) return false;
    report_["rumble"][motor] = answer == Answer::yes  ? "felt"
                               : answer == Answer::no ? "not felt"
                                                      : "none";
    if (answer == Answer::no) fail(fmt::format("the {} motor was not felt", motor));
  }
  return true;
}

bool SelfTest::calibrate() {
  report_["calibration"] = nullptr;
  if (!pad_) return true;
  CalibrationGuide guide(pad_->layout());
  while (guide.step() != GuideStep::done) {
    const std::size_t index = guide.index();
    SelfTestPrompt prompt = prompt_of(
        Part::calibration, fmt::format("{} of {}, {}: {}", index + 1, guide.steps().size() - 1,
                                       name_of(guide.step()), guide.instruction()));
    const Answer answer = ask(prompt, [&](SelfTestPrompt& p) {
      pad_->look(&guide);
      p.seen.clear();
      p.done = 1.0;
      for (const GuideProgress& control : guide.progress()) {
        p.seen +=
            fmt::format("{}{}: {}", p.seen.empty() ? "" : "; ", control.control, control.text);
        p.done = std::min(p.done, control.done);
      }
      if (!pad_->is_plugged()) p.seen = shown_text(*pad_);
      return guide.index() != index;
    });
    if (answer == Answer::quit) return false;
    if (answer != Answer::none) guide.skip();
  }
  const PadAnalysis analysis =
      analysis_of(pad_->layout(), guide.tracks(), {guide.frame(0), guide.frame(1)});
  ordered_json sticks = ordered_json::object();
  for (std::size_t i = 0; i < 2; ++i) {
    if (!analysis.stick[i]) continue;
    const StickAdvice& advice = analysis.stick[i]->advice;
    const StickStatistics& s = analysis.stick[i]->statistics;
    const auto value = [](const std::optional<double>& v) {
      return v ? ordered_json(*v) : ordered_json(nullptr);
    };
    sticks[kSideNames[i]] = {
        {"verdict", name_of(advice.verdict)}, {"reason", advice.reason},
        {"inner_zone", advice.inner_zone},    {"outer_zone", advice.outer_zone},
        {"hysteresis", value(s.hysteresis)},  {"circularity_error", value(s.circularity_error)},
        {"rate_hz", value(s.rate_hz)},        {"jitter_ms", value(s.jitter_ms)}};
  }
  report_["calibration"] = std::move(sticks);
  if (!is_useful(analysis)) {
    fail(why_useless(analysis));
    return true;
  }
  calibration_ = calibration_for(pad_->info(), pad_->has_factory_sticks());
  calibration_.unique_id.clear();
  calibration_.port.clear();
  calibration_.devices = {{pad_->info().vendor, pad_->info().product}};
  take_advice(analysis, calibration_);
  calibration_.measured_on = today();
  problem_ =
      save_calibration(path_of("calibration.toml"), calibration_, calibration_comments(analysis));
  has_calibration_ = !problem_;
  return !problem_;
}

bool SelfTest::walk_straight() {
  report_["walk"] = nullptr;
  if (pad_ && !close("controls.hid")) return false;
  if (!has_way()) return true;
  SessionSpec spec;
  spec.pad.selector = {selector_.pad, driver_};
  spec.pad.map = options_.map;
  if (has_calibration_) spec.pad.calibration = path_of("calibration.toml");
  spec.live.record = path_of("walk.hid");
  spec.config_folders = options_.config_folders;
  auto session = LiveSession::start(spec);
  if (!session) {
    problem_ = session.error();
    return false;
  }
  constexpr double kLong_s = 5.0, kForwardStick = 0.9, kMostAside = 0.02;
  constexpr int kLeastSteps = 4;
  std::int64_t frames = 0, straight = 0, first_tick = -1, tick = -1;
  vec3 from_m{0.0}, to_m{0.0};
  SelfTestPrompt prompt = prompt_of(
      Part::walk, "Hold the left stick straight forward until this is over. (Enter: leave it out)");
  const Answer answer = ask(prompt, [&](SelfTestPrompt& p) {
    std::this_thread::sleep_for(kLook);
    bool is_new = false;
    const SessionFrame& frame = (*session)->latest(is_new);
    p.seen = fmt::format("stick {} {}", signed_number(frame.stick.left.x, 2),
                         signed_number(frame.stick.left.y, 2));
    // The walk was not straight ahead: measure from the beginning.
    if (static_cast<double>(frame.stick.left.y) < kForwardStick) {
      first_tick = -1, frames = straight = 0;
      p.done = 0.0;
      return false;
    }
    tick = frame.tick;
    to_m = frame.walkers[0].pose.root_m;
    if (first_tick < 0) first_tick = tick, from_m = to_m;
    ++frames;
    straight += frame.stick.left.x == 0.0;
    p.done = static_cast<double>(tick - first_tick) / (kLong_s * kDefaultRateHz);
    return p.done >= 1.0;
  });
  for (const std::string& remark : (*session)->take_remarks()) person_.tell(remark);
  const auto run = (*session)->stop();
  if (!run) problem_ = run.error();
  if (problem_ || answer == Answer::quit) return false;
  auto trace = read_trace(spec.live.record);
  if (!trace) {
    problem_ = trace.error();
    return false;
  }
  leave_identity_out(*trace);
  if (const auto written = write_trace(*trace, spec.live.record); !written) {
    problem_ = written.error();
    return false;
  }
  if (answer != Answer::none) return true;
  const vec3 way_m = to_m - from_m;
  const int steps = run->walkers.front().steps[0] + run->walkers.front().steps[1];
  const double aside = std::abs(way_m.x) / std::max(std::abs(way_m.z), 0.01);
  report_["walk"] = {{"seconds", kLong_s},
                     {"steps", steps},
                     {"forward_m", way_m.z},
                     {"aside_m", way_m.x},
                     {"straight_share", static_cast<double>(straight) /
                                            static_cast<double>(std::max<std::int64_t>(frames, 1))},
                     {"pose_hash", fmt::format("{:016x}", run->pose_hash)}};
  if (steps < kLeastSteps) fail(fmt::format("{} steps in the walk", steps));
  if (aside > kMostAside)
    fail(fmt::format("the walk went {:.0f} cm aside on {:.1f} m", 100.0 * std::abs(way_m.x),
                     way_m.z));
  return true;
}

Result<std::optional<SelfTestResult>> SelfTest::run() {
  report_ = {{"format", 1},
             {"program", options_.program},
             {"date", today()},
             {"pad", nullptr},
             {"system", system_facts()}};
  const bool is_done = compare_drivers() && ask_controls() && replug() && feel_rumble() &&
                       calibrate() && walk_straight();
  pad_.reset();
  if (!is_done) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    if (problem_) return *problem_;
    return std::optional<SelfTestResult>();
  }
  report_["failures"] = failures_;
  SelfTestResult result{folder_,
                        report_.dump(1, ' ', true, ordered_json::error_handler_t::replace) + "\n",
                        failures_};
  if (auto wrong = write_file(path_of("report.json"), result.report)) return *wrong;
  return std::optional(std::move(result));
}

}  // namespace

std::string button_request(PadButton button) {
  switch (button) {
    case kButtonA:
      return "Press the bottom one of the four buttons on the right (A, Cross; Nintendo's B).";
    case kButtonB:
      return "Press the right one of these four (B, Circle; Nintendo's A).";
    case kButtonX:
      return "Press the left one of these four (X, Square; Nintendo's Y).";
    case kButtonY:
      return "Press the top one of these four (Y, Triangle; Nintendo's X).";
    case kButtonBack:
      return "Press the small button left of the middle (Back, View, Share, Select, minus).";
    case kButtonGuide:
      return "Press the button in the middle (Guide, Home, PS).";
    case kButtonStart:
      return "Press the small button right of the middle (Start, Menu, Options, plus).";
    case kButtonLeftStick:
      return "Press the left stick in, without moving it.";
    case kButtonRightStick:
      return "Press the right stick in, without moving it.";
    case kButtonLeftShoulder:
      return "Press the left shoulder button, above the trigger.";
    case kButtonRightShoulder:
      return "Press the right shoulder button, above the trigger.";
    case kButtonDpadUp:
      return "Press the cross (D-pad) up.";
    case kButtonDpadDown:
      return "Press the cross (D-pad) down.";
    case kButtonDpadLeft:
      return "Press the cross (D-pad) to the left.";
    case kButtonDpadRight:
      return "Press the cross (D-pad) to the right.";
    case kButtonTouchpad:
      return "Press the touchpad in.";
    default:
      return fmt::format("Press the button that SDL calls {} (a paddle, Capture, Mute or alike).",
                         kButtonNames[static_cast<std::size_t>(button)]);
  }
}

Result<std::optional<SelfTestResult>> run_self_test(const SelfTestOptions& options,
                                                    SelfTestPerson& person) {
  SelfTest test(options, person);
  if (auto problem = test.find_pad()) return *problem;
  if (auto problem = test.make_folder()) return *problem;
  return test.run();
}

}  // namespace gaitpad
