#include "drivers/pads/packet_sender.h"

#include <condition_variable>
#include <mutex>
#include <system_error>
#include <utility>

namespace gaitpad {

using namespace std::chrono_literals;

struct PacketSender::State {
  Write write;
  std::mutex mutex;  // guards all members below
  std::condition_variable changed;
  std::optional<OutPacket> next;
  bool is_ending = false, has_ended = false, has_failed = false;
};

PacketSender::PacketSender(std::shared_ptr<State> state, std::thread thread)
    : state_(std::move(state)), thread_(std::move(thread)) {}

std::unique_ptr<PacketSender> PacketSender::create(Write write) {
  auto state = std::make_shared<State>();
  state->write = std::move(write);
  try {
    return std::unique_ptr<PacketSender>(
        new PacketSender(state, std::thread(&PacketSender::run, state)));
  } catch (const std::system_error&) {
    return nullptr;
  }
}

PacketSender::~PacketSender() {
  std::unique_lock lock(state_->mutex);
  state_->is_ending = true;
  state_->changed.notify_all();
  const bool has_ended =
      state_->changed.wait_for(lock, 100ms, [this] { return state_->has_ended; });
  lock.unlock();
  if (has_ended)
    thread_.join();
  else
    thread_.detach();
}

bool PacketSender::send(const OutPacket& packet) noexcept {
  const std::lock_guard lock(state_->mutex);
  state_->next = packet;
  state_->changed.notify_all();
  return !state_->has_failed;
}

void PacketSender::run(const std::shared_ptr<State>& state) {
  OutPacket packet;
  std::unique_lock lock(state->mutex);
  while (true) {
    const auto is_wanted = [&] { return state->next || state->is_ending; };
    if (packet.repeat > 0ms)
      state->changed.wait_for(lock, packet.repeat, is_wanted);
    else
      state->changed.wait(lock, is_wanted);
    if (state->is_ending && !state->next) break;
    if (state->next) packet = *std::exchange(state->next, std::nullopt);
    lock.unlock();
    const bool has_left = state->write(packet);
    lock.lock();
    state->has_failed = !has_left;
    if (!has_left) packet.repeat = 0ms;
  }
  state->has_ended = true;
  state->changed.notify_all();
}

}  // namespace gaitpad
