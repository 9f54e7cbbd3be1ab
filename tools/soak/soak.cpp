// soak SECONDS --record FILE.hid | MOTION...: runs the window for a long time with everything that
// may leak: plugs a pad in and out, changes styles, panels and themes, and either records the
// session and replays it at the end, or loads these motions repeatedly. Prints the memory in use
// every few seconds and rows for tools/measured.py as the last line; exit status 1 if a row is out
// of its bounds. tools/soak.sh builds it and makes the motions.
#include <SDL2/SDL.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "gaitpad/config_files.h"
#include "gaitpad/replay.h"
#include "view/window.h"

namespace gaitpad {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kLook_s = 5.0, kPlug_s = 8.0, kStyle_s = 1.7, kKey_s = 0.9, kLoad_s = 11.0;
constexpr int kWidth = 640, kHeight = 360;  // size of the window; software draws it in milliseconds
constexpr double kTick_s = 1.0 / kDefaultRateHz;
// The caches fill during the first ten minutes, or the first quarter of a shorter run.
constexpr double kFilling_s = 600.0, kFillingShare = 0.25;
// Allowed growth between the first and the last quarter of the rest.
constexpr double kGrowth_mb = 1.0;

// Sanitizers keep freed memory, so growth is not judged with them.
#ifdef GAITPAD_SANITIZED
constexpr bool kIsJudged = false;
#else
constexpr bool kIsJudged = true;
#endif

double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

// --- what the machine does meanwhile

// A thread that only sleeps until its next tick, with a higher priority than the program's threads
// if that is allowed. If it is late, the machine stood still.
class SleepingThread {
 public:
  SleepingThread() : thread_([this] { run(); }) {}
  ~SleepingThread() {
    is_ending_ = true;
    thread_.join();
  }
  long late() const { return late_; }

 private:
  void run() {
    sched_param highest{};
    highest.sched_priority = ::sched_get_priority_max(SCHED_FIFO);
    static_cast<void>(::sched_setscheduler(0, SCHED_FIFO, &highest));
    const auto tick =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kTick_s));
    for (auto due = Clock::now() + tick; !is_ending_; due += tick) {
      std::this_thread::sleep_until(due);
      late_ += Clock::now() - due > tick;
    }
  }
  std::atomic<bool> is_ending_{false};
  std::atomic<long> late_{0};
  std::thread thread_;
};

// Seconds that the host took from all of this machine's processors since it started.
double stolen_s() {
  std::ifstream file("/proc/stat");
  std::string word;
  double ticks = 0.0;
  // The first line begins: cpu user nice system idle iowait irq softirq steal.
  for (int i = 0; i <= 8; ++i) file >> word;
  ticks = std::atof(word.c_str());
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// The time for which the loop's threads could have run but got no processor (sched-stats.rst in the
// kernel).
class LoopWait {
 public:
  void look() {
    namespace fs = std::filesystem;
    std::error_code ignored;
    for (const auto& task : fs::directory_iterator("/proc/self/task", ignored)) {
      std::string name;
      std::ifstream(task.path() / "comm") >> name;
      if (name != "gaitpad-loop") continue;
      double running_ns = 0.0, waiting_ns = 0.0;
      std::ifstream(task.path() / "schedstat") >> running_ns >> waiting_ns;
      waiting_s_[task.path()] = waiting_ns * 1e-9;
    }
  }
  double sum_s() const {
    double sum_s = 0.0;
    for (const auto& [task, waiting_s] : waiting_s_) sum_s += waiting_s;
    return sum_s;
  }

 private:
  std::map<std::string, double> waiting_s_;
};

// --- what is done to the program

// A virtual joystick inside SDL.
class VirtualPad {
 public:
  void plug() {
    SDL_VirtualJoystickDesc desc{};
    desc.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    desc.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
    desc.naxes = SDL_CONTROLLER_AXIS_MAX;
    desc.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
    desc.vendor_id = 0x1209;
    desc.product_id = 0x0005;
    desc.name = "soak pad";
    index_ = SDL_JoystickAttachVirtualEx(&desc);
    joystick_ = index_ < 0 ? nullptr : SDL_JoystickOpen(index_);
    plugs_ += joystick_ != nullptr;
  }
  void unplug() {
    if (joystick_ != nullptr) SDL_JoystickClose(joystick_);
    if (index_ >= 0) SDL_JoystickDetachVirtual(index_);
    joystick_ = nullptr;
    index_ = -1;
  }
  bool is_plugged() const { return joystick_ != nullptr; }
  int plugs() const { return plugs_; }  // Number of times that the pad was plugged in.
  void push(double forward) {
    if (joystick_ == nullptr) return;
    SDL_JoystickSetVirtualAxis(joystick_, SDL_CONTROLLER_AXIS_LEFTY,
                               static_cast<Sint16>(-32767.0 * forward));
  }

 private:
  int index_ = -1;
  int plugs_ = 0;
  SDL_Joystick* joystick_ = nullptr;
};

void press(SDL_Keycode key) {
  for (const Uint32 type : {SDL_KEYDOWN, SDL_KEYUP}) {
    SDL_Event event{};
    event.type = type;
    event.key.state = type == SDL_KEYDOWN ? SDL_PRESSED : SDL_RELEASED;
    event.key.keysym.sym = key;
    event.key.keysym.scancode = SDL_GetScancodeFromKey(key);
    SDL_PushEvent(&event);
  }
}

void drop(const std::string& path) {
  SDL_Event event{};
  event.type = SDL_DROPFILE;
  event.drop.file = SDL_strdup(path.c_str());
  SDL_PushEvent(&event);
}

// Is due once in each interval of a fixed number of seconds.
class Every {
 public:
  explicit Every(double period_s) : period_s_(period_s), next_s_(period_s) {}
  bool is_due(double time_s) {
    if (time_s < next_s_) return false;
    next_s_ = time_s + period_s_;
    return true;
  }

 private:
  double period_s_, next_s_;
};

class Soak {
 public:
  Soak(double seconds, std::vector<std::string> motions)
      : seconds_(seconds), motions_(std::move(motions)) {}

  void frame() {
    const double time_s = std::chrono::duration<double>(Clock::now() - start_).count();
    pad_.push(0.5 + 0.5 * std::sin(time_s));
    if (plug_.is_due(time_s)) pad_.is_plugged() ? pad_.unplug() : pad_.plug();
    if (style_.is_due(time_s)) press(kStyles[count_++ % kStyles.size()]);
    if (key_.is_due(time_s)) press(kKeys[count_++ % kKeys.size()]);
    if (!motions_.empty() && load_.is_due(time_s)) drop(motions_[count_++ % motions_.size()]);
    if (look_.is_due(time_s)) look(time_s);
    if (time_s >= seconds_) press_quit();
  }

  int plugs() const { return pad_.plugs(); }
  double loop_wait_s() const { return loop_wait_.sum_s(); }
  double last_mb() const { return memory_mb_.empty() ? resident_mb() : memory_mb_.back(); }

  // Megabytes by which the last quarter is above the first, once the caches are full.
  double growth_mb() const {
    const double filling_s = std::min(kFilling_s, kFillingShare * seconds_);
    const auto filling = std::min(memory_mb_.size(), static_cast<std::size_t>(filling_s / kLook_s));
    const std::span rest = std::span(memory_mb_).subspan(filling);
    const std::size_t quarter = rest.size() / 4;
    if (quarter == 0) return 0.0;
    const auto mean = [quarter](std::span<const double> part) {
      return std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(quarter);
    };
    return mean(rest.last(quarter)) - mean(rest.first(quarter));
  }

 private:
  static constexpr std::array kStyles = {SDLK_1, SDLK_2, SDLK_3, SDLK_4};
  static constexpr std::array kKeys = {SDLK_F1, SDLK_F2, SDLK_F3,  SDLK_F4, SDLK_F5,
                                       SDLK_F6, SDLK_F7, SDLK_TAB, SDLK_t};

  void look(double time_s) {
    ::malloc_trim(0);  // freed memory that was not returned is not a leak
    memory_mb_.push_back(resident_mb());
    loop_wait_.look();
    fmt::print("{:6.0f} s  {:7.1f} MB\n", time_s, memory_mb_.back());
    std::fflush(stdout);
  }
  static void press_quit() {
    SDL_Event event{};
    event.type = SDL_QUIT;
    SDL_PushEvent(&event);
  }

  double seconds_;
  std::vector<std::string> motions_;
  Clock::time_point start_ = Clock::now();
  VirtualPad pad_;
  Every plug_{kPlug_s}, style_{kStyle_s}, key_{kKey_s}, load_{kLoad_s}, look_{kLook_s};
  LoopWait loop_wait_;
  std::size_t count_ = 0;
  std::vector<double> memory_mb_;
};

// --- what came of it

struct Rows {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  bool are_kept = true;

  void add(std::string_view name, double value, std::string_view unit = "") {
    list.push_back({{"name", name}, {"worst", value}, {"unit", unit}});
  }
  void judge(std::string_view name, double value, std::string_view unit, std::string_view allowed,
             bool is_kept) {
    list.push_back({{"name", name},
                    {"worst", value},
                    {"allowed", allowed},
                    {"unit", unit},
                    {"runs", 1},
                    {"failed", is_kept ? 0 : 1}});
    are_kept = are_kept && is_kept;
  }
};

// Replays the recording and counts the ticks whose pose differs from the session's: by the hash,
// either all or none.
void replay_recording(const SessionSpec& session, const RunSummary& live, double seconds,
                      Rows& rows) {
  SessionSpec spec;
  spec.config_folders = session.config_folders;
  spec.replay.trace = session.live.record;
  spec.replay.max_hours = 2.0 * seconds / 3600.0 + 1.0;
  const auto again = replay(spec);
  if (!again) fmt::print(stderr, "soak: {}\n", again.error().message);
  const bool is_same =
      again && again->summary.pose_hash == live.pose_hash && again->summary.ticks == live.ticks;
  rows.add("ticks recorded and replayed", static_cast<double>(live.ticks));
  rows.judge("replays to another hash", is_same ? 0.0 : 1.0, "", "== 0", is_same);
}

void judge_ticks(const LiveStatus& status, long sleeper_late, double steal_s, double wait_s,
                 Rows& rows) {
  const bool is_machines = sleeper_late > 0 || steal_s > 0.0 || wait_s > kTick_s;
  rows.add("ticks", static_cast<double>(status.ticks));
  rows.add("ticks more than a tick late", static_cast<double>(status.overruns));
  rows.add("a thread that only sleeps was as late", static_cast<double>(sleeper_late));
  rows.add("the loop waited for a processor", wait_s, "s");
  rows.add("the host took away (steal)", steal_s, "s");
  const auto without_cause = is_machines ? 0.0 : static_cast<double>(status.overruns);
  rows.judge("late ticks that the machine did not cause", without_cause, "", "== 0",
             without_cause == 0.0 || !kIsJudged);
}

int run(double seconds, const std::string& record, const std::vector<std::string>& motions) {
  if (SDL_InitSubSystem(SDL_INIT_JOYSTICK) != 0) {
    fmt::print(stderr, "soak: {}\n", SDL_GetError());
    return 1;
  }
  Soak soak(seconds, motions);
  WindowOptions options;
  options.session.config_folders = config_folders(GAITPAD_CONFIG_DIR);
  options.session.walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
  options.session.pad.selector.driver = "sdl";
  options.session.live.keyboard = true;
  options.session.live.record = record;
  options.width = kWidth;
  options.height = kHeight;
  options.script = [&soak](const WindowGlance&) { soak.frame(); };
  const double stolen_before_s = stolen_s();
  const Clock::time_point start = Clock::now();
  SleepingThread sleeper;
  const auto result = run_window(options);
  if (!result) {
    fmt::print(stderr, "soak: {}\n", result.error().message);
    return 1;
  }
  const double lasted_s = std::chrono::duration<double>(Clock::now() - start).count();
  const long sleeper_late = sleeper.late();
  const double steal_s = stolen_s() - stolen_before_s;
  for (const std::string& remark : result->remarks) fmt::print("{}\n", remark);

  Rows rows;
  rows.add("time", lasted_s / 3600.0, "h");
  rows.add("frames drawn", static_cast<double>(result->frames));
  rows.add("memory at the end", soak.last_mb(), "MB");
  const double growth_mb = soak.growth_mb();
  rows.judge("memory grows once the caches are full", growth_mb, "MB",
             fmt::format("<= {}", kGrowth_mb), growth_mb <= kGrowth_mb || !kIsJudged);
  rows.add("times plugged in", soak.plugs());
  if (!record.empty() && result->status) {
    // The session may not have seen the last plug: it may come after the session's last check.
    const auto missed = static_cast<double>(soak.plugs() - result->status->pads.plugged);
    rows.judge("of these not noticed", missed, "", "<= 1", missed >= 0.0 && missed <= 1.0);
    judge_ticks(*result->status, sleeper_late, steal_s, soak.loop_wait_s(), rows);
    replay_recording(options.session, result->summary, seconds, rows);
  }
  for (const auto& row : rows.list) {
    fmt::print("{:42} {:12.6g} {:2} {}{}\n", row["name"].get<std::string>(),
               row["worst"].get<double>(), row["unit"].get<std::string>(), row.value("allowed", ""),
               row.value("failed", 0) > 0 ? "  FAILED" : "");
  }
  fmt::print("{}\n", rows.list.dump());
  return rows.are_kept ? 0 : 1;
}

}  // namespace
}  // namespace gaitpad

int main(int count, char** arguments) {
  if (count < 4) {
    fmt::print(stderr, "usage: soak SECONDS --record FILE.hid | soak SECONDS MOTION MOTION...\n");
    return 2;
  }
  const double seconds = std::atof(arguments[1]);
  if (std::string_view(arguments[2]) == "--record") return gaitpad::run(seconds, arguments[3], {});
  return gaitpad::run(seconds, "", {arguments + 2, arguments + count});
}
