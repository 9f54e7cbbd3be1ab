// Joysticks of SDL2, where a user asks for the driver `sdl`. SDL has
// one list of joysticks, one set of hints and one queue of events for the whole program, which may
// belong to a host program. So hints are only set if the program has no joysticks, and nothing of
// others is taken off the queue: an event watch sees each joystick event when SDL creates it, on
// any thread, and stores it for the open device. SDL has nothing to poll(): it looks at its
// joysticks when it is asked to, here once a millisecond.
#include <SDL2/SDL.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "base/files.h"
#include "drivers/driver_rows.h"
#include "drivers/posix.h"
#include "drivers/sdl_reports.h"
#include "drivers/system_nodes.h"
#include "gaitpad/driver_registry.h"
#include "gaitpad/trace.h"
#include "hid/evdev_layout.h"
#include "hid/sdl_lines.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxAxes = 64, kMaxButtons = 255, kMaxHats = 4;

// SDL's functions under their own names. Its library is loaded when this driver is first asked for:
// with the forty that it needs, that takes longer than to replay a recording.
// clang-format off
#define GAITPAD_SDL_FUNCTIONS(each) \
  each(SDL_AddEventWatch) each(SDL_DelEventWatch) each(SDL_Delay) each(SDL_FilterEvents) \
  each(SDL_GameControllerMappingForDeviceIndex) each(SDL_GetError) each(SDL_GetRevision) \
  each(SDL_InitSubSystem) each(SDL_JoystickClose) each(SDL_JoystickFromInstanceID) \
  each(SDL_JoystickGetAxis) each(SDL_JoystickGetAxisInitialState) each(SDL_JoystickGetButton) \
  each(SDL_JoystickGetDeviceGUID) each(SDL_JoystickGetDeviceInstanceID) \
  each(SDL_JoystickGetDeviceProduct) each(SDL_JoystickGetDeviceProductVersion) \
  each(SDL_JoystickGetDeviceVendor) each(SDL_JoystickGetHat) each(SDL_JoystickInstanceID) \
  each(SDL_JoystickNameForIndex) each(SDL_JoystickNumAxes) each(SDL_JoystickNumButtons) \
  each(SDL_JoystickNumHats) each(SDL_JoystickOpen) each(SDL_JoystickPathForIndex) \
  each(SDL_JoystickRumble) each(SDL_JoystickUpdate) each(SDL_LockJoysticks) \
  each(SDL_NumJoysticks) each(SDL_QuitSubSystem) each(SDL_SetHint) each(SDL_TLSCleanup) \
  each(SDL_UnlockJoysticks) each(SDL_WasInit) each(SDL_free)
// clang-format on
// NOLINTNEXTLINE(bugprone-macro-parentheses): a declared name
#define GAITPAD_SDL_POINTER(name) decltype(&::name) name = nullptr;
GAITPAD_SDL_FUNCTIONS(GAITPAD_SDL_POINTER)
#undef GAITPAD_SDL_POINTER

// Loads the library; returns what prevents it. Empty: all functions can be called. A program that
// has SDL already keeps its own.
std::string load_library() {
  constexpr const char* kLibrary = "libSDL2-2.0.so.0";
  void* library = RTLD_DEFAULT;  // a null pointer
  if (::dlsym(RTLD_DEFAULT, "SDL_GetRevision") == nullptr) {
    library = ::dlopen(kLibrary, RTLD_NOW | RTLD_NODELETE);
    if (library == nullptr) return fmt::format("{} cannot be loaded", kLibrary);
  }
  std::string missing;
  const auto find = [&](const char* name) {
    void* function = ::dlsym(library, name);
    if (function == nullptr) missing = fmt::format("{} has no {}", kLibrary, name);
    return function;
  };
#define GAITPAD_SDL_FIND(name) name = reinterpret_cast<decltype(name)>(find(#name));
  GAITPAD_SDL_FUNCTIONS(GAITPAD_SDL_FIND)
#undef GAITPAD_SDL_FIND
#undef GAITPAD_SDL_FUNCTIONS
  return missing;
}
const std::string& library_problem() {
  static const std::string problem = load_library();
  return problem;
}

using Change = JoystickReports::Change;
using Control = JoystickReports::Control;

// When to look at SDL's joysticks: once a millisecond. All open devices share the timer; whichever
// finds it expired updates SDL for all of them.
std::shared_ptr<Timer> millisecond_timer() {
  static std::mutex mutex;
  static std::weak_ptr<Timer> running;
  const std::lock_guard lock(mutex);
  auto timer = running.lock();
  if (timer) return timer;
  running = timer = std::make_shared<Timer>();
  timer->set(1, 1'000'000);
  return timer;
}

// SDL's joysticks, started on first use: that takes up to a second.
class Sdl {
 public:
  static Sdl& started() {
    static Sdl sdl;
    static thread_local const ThreadStorage storage;
    return sdl;
  }
  Sdl(const Sdl&) = delete;
  // Takes events of our open joysticks off the queue, if no other part of the program empties it.
  void clear_queue() noexcept;
  ~Sdl() {
    if (!problem_.empty()) return;
    SDL_DelEventWatch(&Sdl::watch, this);
    SDL_QuitSubSystem(SDL_INIT_JOYSTICK);
  }

  const std::string& problem() const { return problem_; }  // empty: it runs
  JoystickInboxes inboxes;                                 // of all open devices

 private:
  struct ThreadStorage {  // SDL allocates some for each thread that it did not start
    ThreadStorage() = default;
    ~ThreadStorage() {
      if (library_problem().empty()) SDL_TLSCleanup();
    }
  };
  Sdl();
  static int SDLCALL watch(void* self, SDL_Event* event);
  static int SDLCALL is_of_others(void* self, SDL_Event* event);
  std::string problem_;
  bool has_host_ = false;  // the program had started SDL's events before
};

// Joysticks only. HIDAPI is off because its drivers send packets to pads while they look for them.
// Buttons are named by position: the one that Nintendo labels A is our b. A program that has
// started SDL's joysticks itself keeps its own hints.
Sdl::Sdl() : problem_(library_problem()) {
  if (!problem_.empty()) return;
  has_host_ = SDL_WasInit(SDL_INIT_EVENTS) != 0;
  constexpr std::pair<const char*, const char*> kHints[] = {
      {SDL_HINT_JOYSTICK_HIDAPI, "0"},
      {SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1"},
      {SDL_HINT_NO_SIGNAL_HANDLERS, "1"},
      {SDL_HINT_GAMECONTROLLER_USE_BUTTON_LABELS, "0"}};
  if (SDL_WasInit(SDL_INIT_JOYSTICK) == 0) {
    for (const auto& [name, value] : kHints) SDL_SetHint(name, value);
  }
  if (SDL_InitSubSystem(SDL_INIT_JOYSTICK) != 0) {
    problem_ = fmt::format("SDL does not start: {}", SDL_GetError());
    return;
  }
  SDL_AddEventWatch(&Sdl::watch, this);
}

// Just before SDL reports a joystick as removed, it resets all controls, the axes to where they
// were first seen (one end, if the pad had sent nothing yet). These changes are dropped.
void mark_removed(JoystickInboxes& inboxes, SDL_JoystickID id) {
  SDL_Joystick* joystick = SDL_JoystickFromInstanceID(id);
  inboxes.mark_removed(id, [joystick](const Change& change) {
    Sint16 rest = 0;
    if (change.control == Control::axis) {
      SDL_JoystickGetAxisInitialState(joystick, change.number, &rest);
    }
    return change.value == rest;
  });
}

// SDL calls this from SDL_JoystickUpdate() with its joysticks locked.
int SDLCALL Sdl::watch(void* self, SDL_Event* event) {
  JoystickInboxes& inboxes = static_cast<Sdl*>(self)->inboxes;
  const auto put = [&](SDL_JoystickID id, Control control, Uint8 number, Sint16 value) {
    inboxes.put(id, {now_ns(), control, number, value});
  };
  switch (event->type) {
    case SDL_JOYAXISMOTION:
      put(event->jaxis.which, Control::axis, event->jaxis.axis, event->jaxis.value);
      break;
    case SDL_JOYBUTTONDOWN:
    case SDL_JOYBUTTONUP:
      put(event->jbutton.which, Control::button, event->jbutton.button, event->jbutton.state);
      break;
    case SDL_JOYHATMOTION:
      put(event->jhat.which, Control::hat, event->jhat.hat, event->jhat.value);
      break;
    case SDL_JOYDEVICEREMOVED:
      mark_removed(inboxes, event->jdevice.which);
      break;
    default:
      break;
  }
  return 1;
}

struct JoystickLock {
  JoystickLock() { SDL_LockJoysticks(); }
  ~JoystickLock() { SDL_UnlockJoysticks(); }
  JoystickLock(const JoystickLock&) = delete;
};

int SDLCALL Sdl::is_of_others(void* self, SDL_Event* event) {
  const JoystickInboxes& inboxes = static_cast<Sdl*>(self)->inboxes;
  switch (event->type) {
    case SDL_JOYAXISMOTION:
      return !inboxes.has(event->jaxis.which);
    case SDL_JOYBUTTONDOWN:
    case SDL_JOYBUTTONUP:
      return !inboxes.has(event->jbutton.which);
    case SDL_JOYHATMOTION:
      return !inboxes.has(event->jhat.which);
    default:
      return 1;
  }
}

void Sdl::clear_queue() noexcept {
  if (!has_host_ && SDL_WasInit(SDL_INIT_VIDEO) == 0) SDL_FilterEvents(&Sdl::is_of_others, this);
}

// Updates all joysticks and looks for new ones; SDL does both in one call, which waits for the
// kernel when a joystick was plugged in. The watch has stored the events.
void update_joysticks() {
  SDL_JoystickUpdate();
  Sdl::started().clear_queue();
}

JoystickState current_state(SDL_Joystick* joystick) {
  const auto sized = [](int count, std::size_t max) {
    return std::min(static_cast<std::size_t>(std::max(count, 0)), max);
  };
  JoystickState state;
  state.axes.resize(sized(SDL_JoystickNumAxes(joystick), kMaxAxes));
  state.buttons.resize(sized(SDL_JoystickNumButtons(joystick), kMaxButtons));
  state.hats.resize(sized(SDL_JoystickNumHats(joystick), kMaxHats));
  const auto read_all = [joystick](auto& values, auto value_of) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = value_of(joystick, static_cast<int>(i));
    }
  };
  read_all(state.axes, SDL_JoystickGetAxis);
  read_all(state.buttons, SDL_JoystickGetButton);
  read_all(state.hats, SDL_JoystickGetHat);
  return state;
}

struct JoystickClosing {
  void operator()(SDL_Joystick* joystick) const noexcept { SDL_JoystickClose(joystick); }
};
using JoystickHandle = std::unique_ptr<SDL_Joystick, JoystickClosing>;

class SdlDevice : public Device {
 public:
  // The caller has locked SDL's joysticks, so that no change is lost between state and inbox.
  SdlDevice(JoystickHandle joystick, const DeviceListing& listing, std::shared_ptr<Timer> timer)
      : joystick_(std::move(joystick)),
        info_(listing.info),
        reports_(joystick_reports(current_state(joystick_.get()), listing.node, info_.version)),
        timer_(std::move(timer)),
        poll_fd_{timer_->fd(), POLLIN, 0} {
    info_.descriptor = reports_.layout().descriptor;
    inbox_.joystick = SDL_JoystickInstanceID(joystick_.get());
    Sdl::started().inboxes.add(inbox_);
  }
  ~SdlDevice() override { Sdl::started().inboxes.remove(inbox_); }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&poll_fd_, 1}; }
  std::int64_t lost() const noexcept override { return lost_; }
  Status read(Report& report) noexcept override;
  // SDL stops the motors after 65 seconds.
  bool rumble(const Rumble& motors) noexcept override {
    constexpr std::uint32_t kLongest_ms = 0xffff;
    return SDL_JoystickRumble(joystick_.get(), motors.strong, motors.weak, kLongest_ms) == 0;
  }

 private:
  void fetch() noexcept;

  JoystickHandle joystick_;
  DeviceInfo info_;
  JoystickReports reports_;
  std::shared_ptr<Timer> timer_;
  pollfd poll_fd_;
  JoystickInbox inbox_;
  bool has_reported_ = false, removed_ = false;
  std::int64_t lost_ = 0;
};

// SDL does not report the first small movement of an axis, so the axes are also read; locked, so
// that no event comes in between.
void SdlDevice::fetch() noexcept {
  if (timer_->take()) update_joysticks();
  const JoystickLock lock;
  JoystickInbox inbox = Sdl::started().inboxes.take(inbox_);
  removed_ = inbox.removed;
  lost_ = inbox.lost;
  reports_.changes = std::move(inbox.changes);
  if (removed_) return;
  const std::int64_t time_ns = now_ns();
  for (std::size_t i = 0; i < reports_.state().axes.size(); ++i) {
    const auto number = static_cast<std::uint8_t>(i);
    const std::int16_t value = SDL_JoystickGetAxis(joystick_.get(), static_cast<int>(i));
    reports_.changes.push_back({time_ns, Control::axis, number, value});
  }
}

// First the state at the opening, if it is known, then every change.
Device::Status SdlDevice::read(Report& report) noexcept {
  if (!has_reported_ && reports_.is_known()) {
    has_reported_ = true;
    reports_.write(now_ns(), report);
    return Status::report;
  }
  if (reports_.changes.empty()) fetch();
  if (reports_.next(report)) {
    has_reported_ = true;
    return Status::report;
  }
  return removed_ ? Status::gone : Status::nothing;
}

// Copies a string that SDL allocated, and frees it.
std::string take_text(char* line) {
  std::string text = line ? line : "";
  SDL_free(line);
  if (text.size() > kMaxTraceTextBytes) text.clear();
  return text;
}

// SDL's path of the device with this index; the joysticks are locked.
std::string node_of(int index) {
  const char* path = SDL_JoystickPathForIndex(index);
  if (path) return path;
  return fmt::format("sdl joystick {}", SDL_JoystickGetDeviceInstanceID(index));
}

// `system` is null for a joystick without a node; the joysticks are locked.
DeviceListing listing_of(int index, const SystemNode* system) {
  DeviceListing listing = system ? listing_of(*system, "sdl") : DeviceListing{};
  const SDL_JoystickGUID guid = SDL_JoystickGetDeviceGUID(index);
  DeviceInfo& info = listing.info;
  info.driver = "sdl";
  info.bus = static_cast<BusType>(guid.data[0] | guid.data[1] << 8);
  info.vendor = SDL_JoystickGetDeviceVendor(index);
  info.product = SDL_JoystickGetDeviceProduct(index);
  info.version = SDL_JoystickGetDeviceProductVersion(index);
  if (const char* name = SDL_JoystickNameForIndex(index)) info.name = name;
  // The codes of a node tell more than SDL's guess.
  info.mapping =
      system ? sdl_mapping_of(info) : take_text(SDL_GameControllerMappingForDeviceIndex(index));
  listing.node = node_of(index);
  if (listing.pad_path.empty()) listing.pad_path = listing.node;
  return listing;
}

// Whether the node is the motion sensor or touchpad of a pad, whose buttons are on another node.
// udev may not have marked it yet.
bool is_part_of_pad(const SystemNode& node) {
  return node.is_motion_sensor || node.is_touchpad || node.name.ends_with("(IMU)") ||
         node.name.ends_with(" IMU");
}
bool is_joystick(const SystemNode& node) { return node.is_joystick && !is_part_of_pad(node); }

std::vector<DeviceListing> joysticks_among(const std::vector<SystemNode>& nodes) {
  std::vector<DeviceListing> listings;
  const JoystickLock lock;
  for (int i = 0; i < SDL_NumJoysticks(); ++i) {
    const std::string name = node_of(i);
    const auto node = std::find_if(nodes.begin(), nodes.end(),
                                   [&](const SystemNode& n) { return n.node == name; });
    const bool known = node != nodes.end();
    if (!known && name.starts_with("/dev/")) continue;  // unplugged; SDL does not know yet
    if (known && is_part_of_pad(*node)) continue;
    listings.push_back(listing_of(i, known ? &*node : nullptr));
  }
  return listings;
}

bool is_listed(const std::vector<DeviceListing>& listings, const SystemNode& node) {
  return std::any_of(listings.begin(), listings.end(),
                     [&node](const DeviceListing& l) { return l.node == node.node; });
}

}  // namespace

std::vector<DeviceListing> find_sdl_devices() {
  const Sdl& sdl = Sdl::started();
  std::vector<SystemNode> nodes = system_nodes("input");
  std::vector<DeviceListing> listings;
  const auto is_missing = [&](const SystemNode& node) {
    return is_joystick(node) && !is_listed(listings, node) && access_problem(node.node).empty();
  };
  // SDL learns of a new node from udev, as we do, perhaps a moment later.
  constexpr int kTries = 10;
  constexpr std::uint32_t kPause_ms = 10;
  for (int i = 0; sdl.problem().empty() && i < kTries; ++i) {
    if (i > 0) {
      SDL_Delay(kPause_ms);
      nodes = system_nodes("input");
    }
    update_joysticks();
    listings = joysticks_among(nodes);
    if (std::none_of(nodes.begin(), nodes.end(), is_missing)) break;
  }
  for (const SystemNode& node : nodes) {
    if (!is_joystick(node) || is_listed(listings, node)) continue;
    listings.push_back(listing_of(node, "sdl"));
    std::string& problem = listings.back().problem;
    problem = sdl.problem().empty() ? access_problem(node.node) : sdl.problem();
    if (problem.empty()) problem = node.node + ": SDL does not recognise it as a pad";
  }
  return listings;
}

Result<std::unique_ptr<Device>> open_sdl_device(const DeviceListing& listing, Detach) {
  const Sdl& sdl = Sdl::started();
  if (!sdl.problem().empty()) return Error{listing.node + ": " + sdl.problem()};
  auto timer = millisecond_timer();
  if (timer->fd() < 0) return Error{listing.node + ": no timer: too many open files"};
  update_joysticks();
  const JoystickLock lock;
  for (int i = 0; i < SDL_NumJoysticks(); ++i) {
    if (node_of(i) != listing.node) continue;
    JoystickHandle joystick(SDL_JoystickOpen(i));
    if (!joystick) return Error{fmt::format("{}: {}", listing.node, SDL_GetError())};
    return std::unique_ptr<Device>(
        std::make_unique<SdlDevice>(std::move(joystick), listing, std::move(timer)));
  }
  return Error{listing.node + ": SDL has no such joystick"};
}

std::vector<std::string> sdl_library_lines() {
  Dl_info library{};
  if (!library_problem().empty() ||
      ::dladdr(reinterpret_cast<const void*>(SDL_GetRevision), &library) == 0)
    return {};
  constexpr std::size_t kMaxLibraryBytes = std::size_t{64} << 20;
  auto text = file_text(library.dli_fname, kMaxLibraryBytes);
  if (!text) return {};
  std::replace(text->begin(), text->end(), '\0', '\n');
  return mapping_lines(*text);
}

}  // namespace gaitpad
