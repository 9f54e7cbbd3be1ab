// Game controllers of SDL2, for users who ask for the driver `sdl`. SDL names their controls, by
// its own data base and the user's; here they all have one constant HID descriptor. SDL has one
// list of joysticks, one set of hints and one queue of events for the whole program, which may be a
// host program. So hints are only set if the program has no joysticks, and no events of others are
// taken off the queue: an event watch sees each joystick event when SDL creates it, on any thread,
// and stores the controller's state for the open device. SDL has nothing to poll(): it looks at its
// joysticks when it is asked to, here once a millisecond.
#include <SDL2/SDL.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/driver_rows.h"
#include "drivers/system_nodes.h"
#include "hid/sdl_lines.h"
#include "system/clock.h"
#include "system/descriptors.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace {

// SDL's functions under their own names. Its library is loaded when this driver is first asked for:
// loading it with the forty libraries that it needs takes longer than replaying a recording.
// clang-format off
#define GAITPAD_SDL_FUNCTIONS(each) \
  each(SDL_AddEventWatch) each(SDL_DelEventWatch) each(SDL_Delay) each(SDL_FilterEvents) \
  each(SDL_GameControllerClose) each(SDL_GameControllerGetAxis) \
  each(SDL_GameControllerGetButton) each(SDL_GameControllerGetJoystick) \
  each(SDL_GameControllerOpen) each(SDL_GameControllerRumble) each(SDL_GetError) \
  each(SDL_GetRevision) each(SDL_InitSubSystem) each(SDL_IsGameController) \
  each(SDL_JoystickGetDeviceGUID) each(SDL_JoystickGetDeviceInstanceID) \
  each(SDL_JoystickGetDeviceProduct) each(SDL_JoystickGetDeviceProductVersion) \
  each(SDL_JoystickGetDeviceVendor) each(SDL_JoystickInstanceID) each(SDL_JoystickNameForIndex) \
  each(SDL_JoystickPathForIndex) each(SDL_JoystickUpdate) each(SDL_LockJoysticks) \
  each(SDL_NumJoysticks) each(SDL_QuitSubSystem) each(SDL_SetHint) each(SDL_TLSCleanup) \
  each(SDL_UnlockJoysticks) each(SDL_WasInit)
// clang-format on
// NOLINTNEXTLINE(bugprone-macro-parentheses): a declared name
#define GAITPAD_SDL_POINTER(name) decltype(&::name) name = nullptr;
GAITPAD_SDL_FUNCTIONS(GAITPAD_SDL_POINTER)
#undef GAITPAD_SDL_POINTER

// Loads the library; returns the reason if that fails. Empty: all functions can be called. A
// program that has loaded SDL already keeps its own.
std::string load_library() {
  constexpr const char* kLibrary = "libSDL2-2.0.so.0";
  void* library = RTLD_DEFAULT;  // the handle RTLD_DEFAULT is a null pointer
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

// Expires once a millisecond, when SDL's joysticks have to be updated. All open devices share the
// timer; whichever finds it expired updates SDL for all of them.
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

constexpr int kAxes = SDL_CONTROLLER_AXIS_TRIGGERRIGHT + 1,
              kButtons = SDL_CONTROLLER_BUTTON_TOUCHPAD + 1;
static_assert(kAxes == 6 && kButtons == 21, "the descriptor below states as many");

// The descriptor of every controller: SDL's axes and buttons in SDL's order.
constexpr std::uint8_t kDescriptor[] = {
    0x05, 0x01, 0x09, 0x05, 0xa1, 0x01,              // collection: game pad
    0x09, 0x30, 0x09, 0x31, 0x09, 0x33, 0x09, 0x34,  // X Y Rx Ry, the sticks:
    0x16, 0x00, 0x80, 0x26, 0xff, 0x7f, 0x75, 0x10, 0x95, 0x04, 0x81, 0x02,  // -32768 .. 32767
    0x09, 0x32, 0x09, 0x35, 0x15, 0x00, 0x95, 0x02, 0x81, 0x02,  // Z Rz, the triggers: 0 .. 32767
    0x05, 0x09, 0x19, 0x01, 0x29, 0x15, 0x25, 0x01, 0x75, 0x01, 0x95, 0x15, 0x81, 0x02,  // buttons
    0x95, 0x03, 0x81, 0x03, 0xc0};
// Buttons are b0, b1 ..., axes are counted by their usages: X Y Z Rx Ry Rz.
constexpr const char* kMapping =
    "00000000000000000000000000000000,SDL game controller,"
    "a:b0,b:b1,x:b2,y:b3,back:b4,guide:b5,start:b6,leftstick:b7,rightstick:b8,leftshoulder:b9,"
    "rightshoulder:b10,dpup:b11,dpdown:b12,dpleft:b13,dpright:b14,misc1:b15,paddle1:b16,"
    "paddle2:b17,paddle3:b18,paddle4:b19,touchpad:b20,"
    "leftx:a0,lefty:a1,lefttrigger:a2,rightx:a3,righty:a4,righttrigger:a5,platform:Linux,";

struct ControllerState {
  std::array<Sint16, kAxes> axes{};
  std::uint32_t buttons = 0;  // a bit for each button
};

ControllerState current_state(SDL_GameController* controller) {
  ControllerState state;
  for (int i = 0; i < kAxes; ++i)
    state.axes[static_cast<std::size_t>(i)] =
        SDL_GameControllerGetAxis(controller, static_cast<SDL_GameControllerAxis>(i));
  for (int i = 0; i < kButtons; ++i) {
    const auto button = static_cast<SDL_GameControllerButton>(i);
    state.buttons |= std::uint32_t{SDL_GameControllerGetButton(controller, button)} << i;
  }
  return state;
}

// A bit for each control that differs.
std::uint32_t difference(const ControllerState& a, const ControllerState& b) noexcept {
  std::uint32_t bits = a.buttons ^ b.buttons;
  for (std::size_t i = 0; i < kAxes; ++i)
    if (a.axes[i] != b.axes[i]) bits |= std::uint32_t{1} << (kButtons + i);
  return bits;
}

// False while the left stick is in a corner that no stick reaches: until the pad has sent something
// the kernel reports 0, which is the end of most axes.
bool is_known(const ControllerState& state) noexcept {
  const auto is_end = [](int value) { return std::abs(value) >= 32767; };
  return !is_end(state.axes[0]) || !is_end(state.axes[1]);
}

void write(const ControllerState& state, std::int64_t time_ns, Report& report) noexcept {
  report.time_ns = time_ns;
  report.kind = ReportKind::input;
  report.size = 0;
  const auto put = [&report](unsigned byte) {
    report.bytes[report.size++] = static_cast<std::uint8_t>(byte);
  };
  for (const Sint16 value : state.axes) {
    const auto bits = static_cast<std::uint16_t>(value);
    put(bits & 0xffu);
    put(bits >> 8u);
  }
  for (int i = 0; i < kButtons; i += 8) put(state.buttons >> i & 0xffu);
}

// The states of one open controller that its device has not read yet.
struct Inbox {
  struct Entry {
    std::int64_t time_ns = 0;
    ControllerState state;
  };
  SDL_GameController* controller = nullptr;
  SDL_JoystickID id = -1;
  ControllerState before;  // the state before the first entry
  std::deque<Entry> entries;
  bool removed = false;
  // Number of the oldest entries that were dropped because the reader was too slow.
  std::int64_t lost = 0;

  const ControllerState& newest() const { return entries.empty() ? before : entries.back().state; }
  void drop_oldest() {
    before = entries.front().state;
    entries.pop_front();
  }
  void put(std::int64_t time_ns);
  void mark_removed();
  bool take(Entry& entry);
};

void Inbox::put(std::int64_t time_ns) {
  constexpr std::size_t kMaxEntries = 8192;
  const ControllerState state = current_state(controller);
  if (removed || difference(newest(), state) == 0) return;
  if (entries.size() >= kMaxEntries) {
    drop_oldest();
    ++lost;
  }
  entries.push_back({time_ns, state});
}

// Drops the entries that SDL makes just before it reports a joystick as removed. It then releases
// all controls, and moves the axes to where they were first seen (one end, if the pad had sent
// nothing yet).
void Inbox::mark_removed() {
  removed = true;
  const ControllerState left = current_state(controller);
  while (!entries.empty()) {
    const ControllerState last = entries.back().state;
    const ControllerState& previous =
        entries.size() > 1 ? entries[entries.size() - 2].state : before;
    if ((difference(previous, last) & difference(last, left)) != 0) break;
    entries.pop_back();
  }
}

// Takes the next state out. SDL reports each control by itself, so entries are merged up to the
// second change of one control, so that no change is lost. False: the queue is empty.
bool Inbox::take(Entry& entry) {
  std::uint32_t changed = 0;
  while (!entries.empty()) {
    const std::uint32_t next = difference(before, entries.front().state);
    if ((changed & next) != 0) break;
    changed |= next;
    entry = entries.front();
    drop_oldest();
  }
  return changed != 0;
}

// SDL's joysticks. They are started on first use, which takes up to a second.
class Sdl {
 public:
  static Sdl& started() {
    static Sdl sdl;
    static thread_local const ThreadStorage storage;
    return sdl;
  }
  Sdl(const Sdl&) = delete;
  // Takes events of our open joysticks off the queue, if no other part of the program does so.
  void clear_queue() noexcept;
  ~Sdl() {
    if (!problem_.empty()) return;
    SDL_DelEventWatch(&Sdl::watch, this);
    SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
  }

  const std::string& problem() const { return problem_; }  // Why SDL does not run; empty: it runs.

  // Call it with SDL's joysticks locked, so that no change is lost between state and inbox.
  void add(Inbox& inbox) {
    const std::lock_guard lock(mutex_);
    inboxes_.push_back(&inbox);
  }
  void remove(const Inbox& inbox) noexcept {
    const std::lock_guard lock(mutex_);
    std::erase(inboxes_, &inbox);
  }
  // Calls `use` with the inbox of each open device of that joystick. Any thread that updates SDL's
  // joysticks fills the inboxes.
  template <typename Use>
  void with_inboxes(SDL_JoystickID id, Use use) {
    const std::lock_guard lock(mutex_);
    for (Inbox* inbox : inboxes_)
      if (inbox->id == id) use(*inbox);
  }

 private:
  struct ThreadStorage {  // frees what SDL allocates for each thread that it did not start
    ThreadStorage() = default;
    ~ThreadStorage() {
      if (library_problem().empty()) SDL_TLSCleanup();
    }
  };
  Sdl();
  static int SDLCALL watch(void* self, SDL_Event* event);
  static int SDLCALL is_of_others(void* self, SDL_Event* event);
  std::string problem_;
  bool has_host_ = false;  // the program had started SDL's events before this driver
  std::mutex mutex_;
  std::vector<Inbox*> inboxes_;  // inboxes of all open devices
};

// HIDAPI is off because its drivers send packets to pads while they look for them. Buttons are
// named by position: the one that Nintendo labels A is our b. A program that has started SDL's
// joysticks itself keeps its own hints.
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
  if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0) {
    problem_ = fmt::format("SDL does not start: {}", SDL_GetError());
    return;
  }
  SDL_AddEventWatch(&Sdl::watch, this);
}

// The joystick that an event about a control or about unplugging concerns; -1: another event.
SDL_JoystickID joystick_of(const SDL_Event& event) noexcept {
  switch (event.type) {
    case SDL_JOYAXISMOTION:
      return event.jaxis.which;
    case SDL_JOYBUTTONDOWN:
    case SDL_JOYBUTTONUP:
      return event.jbutton.which;
    case SDL_JOYHATMOTION:
      return event.jhat.which;
    case SDL_JOYDEVICEREMOVED:
      return event.jdevice.which;
    case SDL_CONTROLLERAXISMOTION:
      return event.caxis.which;
    case SDL_CONTROLLERBUTTONDOWN:
    case SDL_CONTROLLERBUTTONUP:
      return event.cbutton.which;
    default:
      return -1;
  }
}

// SDL calls this from SDL_JoystickUpdate() with its joysticks locked, after it has changed the
// state.
int SDLCALL Sdl::watch(void* self, SDL_Event* event) {
  static_cast<Sdl*>(self)->with_inboxes(joystick_of(*event), [event](Inbox& inbox) {
    if (event->type == SDL_JOYDEVICEREMOVED)
      inbox.mark_removed();
    else
      inbox.put(now_ns());
  });
  return 1;
}

struct JoystickLock {
  JoystickLock() { SDL_LockJoysticks(); }
  ~JoystickLock() { SDL_UnlockJoysticks(); }
  JoystickLock(const JoystickLock&) = delete;
};

int SDLCALL Sdl::is_of_others(void* self, SDL_Event* event) {
  int is_ours = 0;
  if (event->type != SDL_JOYDEVICEREMOVED) {
    static_cast<Sdl*>(self)->with_inboxes(joystick_of(*event), [&is_ours](Inbox&) { is_ours = 1; });
  }
  return 1 - is_ours;
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

struct ControllerClosing {
  void operator()(SDL_GameController* controller) const noexcept {
    SDL_GameControllerClose(controller);
  }
};
using ControllerHandle = std::unique_ptr<SDL_GameController, ControllerClosing>;

class SdlDevice : public Device {
 public:
  // Call it with SDL's joysticks locked, so that no change is lost between state and inbox.
  SdlDevice(ControllerHandle controller, const DeviceListing& listing, std::shared_ptr<Timer> timer)
      : controller_(std::move(controller)),
        info_(listing.info),
        timer_(std::move(timer)),
        poll_fd_{timer_->fd(), POLLIN, 0} {
    info_.descriptor.assign(std::begin(kDescriptor), std::end(kDescriptor));
    inbox_.controller = controller_.get();
    inbox_.id = SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(controller_.get()));
    inbox_.before = current_state(controller_.get());
    if (is_known(inbox_.before)) first_ = inbox_.before;
    Sdl::started().add(inbox_);
  }
  ~SdlDevice() override { Sdl::started().remove(inbox_); }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&poll_fd_, 1}; }
  std::int64_t lost() const noexcept override { return read_.lost; }
  Status read(Report& report) noexcept override;
  // SDL stops the motors after 65 seconds.
  bool rumble(const Rumble& motors) noexcept override {
    constexpr std::uint32_t kLongest_ms = 0xffff;
    return SDL_GameControllerRumble(controller_.get(), motors.strong, motors.weak, kLongest_ms) ==
           0;
  }

 private:
  void fetch() noexcept;

  ControllerHandle controller_;
  DeviceInfo info_;
  std::shared_ptr<Timer> timer_;
  pollfd poll_fd_;
  std::optional<ControllerState> first_;  // the state at the opening, if it is known
  Inbox inbox_;                           // the watch puts new states here
  Inbox read_;                            // what was taken from inbox_ and is being read
};

// Reads the present state as well, because SDL does not report the first small movement of an axis;
// with the joysticks locked, so that no event comes in between.
void SdlDevice::fetch() noexcept {
  if (timer_->take()) update_joysticks();
  const JoystickLock lock;
  Sdl::started().with_inboxes(inbox_.id, [this](Inbox& inbox) {
    if (&inbox != &inbox_) return;
    inbox.put(now_ns());
    read_ = std::move(inbox);
    inbox = {read_.controller, read_.id, read_.newest(), {}, read_.removed, read_.lost};
  });
}

// Returns the state at the opening first, if it is known, then every change.
Device::Status SdlDevice::read(Report& report) noexcept {
  if (const auto first = std::exchange(first_, std::nullopt)) {
    write(*first, now_ns(), report);
    return Status::report;
  }
  if (read_.entries.empty()) fetch();
  if (Inbox::Entry entry; read_.take(entry)) {
    write(entry.state, entry.time_ns, report);
    return Status::report;
  }
  return read_.removed ? Status::gone : Status::nothing;
}

// SDL's path of the device with this index. Call it with the joysticks locked.
std::string node_of(int index) {
  const char* path = SDL_JoystickPathForIndex(index);
  if (path) return path;
  return fmt::format("sdl joystick {}", SDL_JoystickGetDeviceInstanceID(index));
}

// `system` is null for a joystick without a node. Call it with the joysticks locked.
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
  info.mapping = kMapping;
  listing.node = node_of(index);
  if (SDL_IsGameController(index) == SDL_FALSE) {
    listing.problem =
        listing.node + ": SDL has no mapping for it; --driver evdev and hidraw need none";
  }
  if (listing.pad_path.empty()) listing.pad_path = listing.node;
  return listing;
}

// True if the node is the motion sensor or touchpad of a pad, whose buttons are on another node.
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
    // The pad was unplugged, which SDL does not know yet.
    if (!known && name.starts_with("/dev/")) continue;
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
  // Number of attempts to find a node in SDL, which learns of it from udev, as we do, perhaps a
  // little later.
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
    ControllerHandle controller(SDL_GameControllerOpen(i));
    if (!controller) return Error{fmt::format("{}: {}", listing.node, SDL_GetError())};
    return std::unique_ptr<Device>(
        std::make_unique<SdlDevice>(std::move(controller), listing, std::move(timer)));
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
