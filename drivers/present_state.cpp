#include "drivers/present_state.h"

#include <sys/eventfd.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "gaitpad/descriptor.h"
#include "gaitpad/report.h"

namespace gaitpad {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

namespace {

constexpr long kSilence_ns = 30'000'000;
constexpr auto kPatience = 1s;         // a pad that takes longer to refuse is not asked again
constexpr std::size_t kMaxAsked = 16;  // ids; the state of a pad is in one or two

bool take_count(int fd) noexcept {
  std::uint64_t count = 0;
  return fd >= 0 && ::read(fd, &count, sizeof count) == sizeof count;
}

bool is_zeros(std::span<const std::uint8_t> bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

}  // namespace

struct PresentState::Request {
  std::uint8_t id = 0;
  std::size_t size = 0;
};

// One round of requests, shared with the thread that asks.
struct PresentState::Round {
  OwnedFd bell{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  std::mutex mutex;  // guards all below
  std::vector<Answer> answers;
  bool has_ended = false, was_slow = false;
};

std::vector<ReportSize> reports_with_stick(std::span<const std::uint8_t> descriptor) {
  std::vector<ReportSize> reports;
  const auto parsed = parse_descriptor(descriptor);
  const auto pad = parsed ? pad_application(*parsed) : std::nullopt;
  if (!pad) return reports;
  for (const Field& field : parsed->fields) {
    if (field.kind != FieldKind::input || field.usage != usage::kX || field.application != *pad)
      continue;
    const std::size_t bytes = report_bytes(*parsed, field.kind, field.report_id);
    if (bytes <= kMaxReportBytes &&
        std::ranges::count(reports, field.report_id, &ReportSize::id) == 0)
      reports.push_back({field.report_id, static_cast<std::uint16_t>(bytes)});
  }
  return reports;
}

void PresentState::settle(Known& known) noexcept {
  if (std::exchange(known.is_missed, false)) --missed_count_;
}

void PresentState::heard(std::span<const std::uint8_t> report) noexcept {
  if (report.empty()) return;
  Known& known = known_[is_numbered_ ? report[0] : 0];
  known.size = static_cast<std::uint16_t>(report.size());
  known.was_zeros = known.was_zeros || is_zeros(report.subspan(is_numbered_ ? 1 : 0));
  settle(known);
}

void PresentState::give_up() noexcept {
  for (Known& known : known_) settle(known);
}

bool PresentState::start_timer() noexcept {
  if (timer_.get() < 0)
    timer_ = OwnedFd(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC));
  const itimerspec silence{{0, 0}, {0, kSilence_ns}};
  return ::timerfd_settime(timer_.get(), 0, &silence, nullptr) == 0;
}

void PresentState::missed() noexcept {
  if (!ask_ || !start_timer()) return;
  is_round_valid_ = false;
  missed_count_ = 0;
  for (Known& known : known_) {
    known.is_missed = known.size > 0;
    missed_count_ += known.is_missed;
  }
}

void PresentState::opened(std::span<const ReportSize> reports) noexcept {
  for (const ReportSize& report : reports) known_[report.id].size = report.bytes;
  if (!reports.empty()) missed();
}

std::array<pollfd, 2> PresentState::poll_fds() const noexcept {
  return {{{.fd = timer_.get(), .events = POLLIN, .revents = 0},
           {.fd = round_ ? round_->bell.get() : -1, .events = POLLIN, .revents = 0}}};
}

std::span<const std::uint8_t> PresentState::take_answer() noexcept {
  if (!is_waiting()) return {};
  if (take_count(timer_.get())) ask_all();
  if (round_) take_count(round_->bell.get());
  while (next_answer()) {
    Known& known = known_[answer_.id];
    const bool is_wanted = known.is_missed && fits(known);
    settle(known);
    if (is_wanted) return std::span(answer_.bytes).subspan(is_numbered_ ? 0 : 1);
  }
  return {};
}

// Runs in the thread.
void PresentState::run(Round& round, const Ask& ask,
                       const std::vector<Request>& requests) noexcept {
  for (const Request& request : requests) {
    Answer answer{request.id, std::vector<std::uint8_t>(request.size)};
    const Clock::time_point begin = Clock::now();
    const std::size_t size = ask(request.id, answer.bytes);
    const bool is_refused = size == 0 || size > request.size;
    answer.bytes.resize(is_refused ? 0 : size);
    const std::lock_guard lock(round.mutex);
    round.answers.push_back(std::move(answer));
    round.was_slow = is_refused && Clock::now() - begin > kPatience;
    round.has_ended = round.was_slow || &request == &requests.back();
    const std::uint64_t one = 1;
    static_cast<void>(!::write(round.bell.get(), &one, sizeof one));
    if (round.has_ended) return;
  }
}

// False: the last round still waits for the pad, or the pad was too slow to be asked again.
bool PresentState::may_ask() noexcept {
  if (!round_) return true;
  const std::lock_guard lock(round_->mutex);
  if (round_->was_slow) {
    ask_ = nullptr;
    give_up();
  } else if (!round_->has_ended) {
    start_timer();
  }
  return round_->has_ended && !round_->was_slow;
}

void PresentState::ask_all() noexcept {
  if (!may_ask()) return;
  std::vector<Request> requests;
  for (std::size_t id = 0; id < known_.size() && requests.size() < kMaxAsked; ++id)
    if (known_[id].is_missed)
      // Exactly as many bytes as expected: some pads do not end a shorter answer on the control
      // endpoint.
      requests.push_back(
          {static_cast<std::uint8_t>(id), known_[id].size + (is_numbered_ ? 0u : 1u)});
  round_ = std::make_shared<Round>();
  is_round_valid_ = true;
  try {
    std::thread([round = round_, ask = ask_, requests] { run(*round, ask, requests); }).detach();
  } catch (const std::system_error&) {
    round_.reset();
    give_up();
  }
}

bool PresentState::next_answer() noexcept {
  if (!round_ || !is_round_valid_) return false;
  const std::lock_guard lock(round_->mutex);
  if (round_->answers.empty()) return false;
  answer_ = std::move(round_->answers.front());
  round_->answers.erase(round_->answers.begin());
  return true;
}

// Some pads always answer zeros, which on most would be a corner of the sticks: such an answer
// counts only if the pad has reported zeros itself.
bool PresentState::fits(const Known& known) const noexcept {
  const std::span<const std::uint8_t> bytes = answer_.bytes;
  if (bytes.empty() || bytes.size() != known.size + (is_numbered_ ? 0u : 1u)) return false;
  if (bytes[0] != (is_numbered_ ? answer_.id : 0)) return false;
  return known.was_zeros || !is_zeros(bytes.subspan(1));
}

}  // namespace gaitpad
