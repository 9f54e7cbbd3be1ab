// The effects of force feedback that programs have uploaded to a virtual pad, each with its number
// on the real pad behind it. The kernel numbers the effects of every device by itself.
#pragma once
#include <linux/input.h>

#include <array>
#include <cstdint>
#include <optional>

namespace gaitpad {

// A device's effects. Each call gives 0 or errno.
class EffectTarget {
 public:
  virtual ~EffectTarget() = default;
  // Changes effect.id; one of -1 becomes the number of the new effect.
  virtual int upload(ff_effect& effect) noexcept = 0;
  virtual int erase(int id) noexcept = 0;
  // An event of EV_FF. `code`: an effect, which starts `value` times or stops (0), or FF_GAIN.
  virtual int send(std::uint16_t code, std::int32_t value) noexcept = 0;
};

class EffectTable {
 public:
  // The pad behind it is there (then everything is uploaded to it anew, and nothing runs), or gone
  // (null). Meanwhile effects are kept.
  void set_target(EffectTarget* target) noexcept;

  // A program's requests to the virtual pad, by the program's numbers; as EffectTarget.
  int upload(const ff_effect& effect) noexcept;
  int erase(int id) noexcept;
  void send(std::uint16_t code, std::int32_t value) noexcept;

 private:
  struct Entry {
    ff_effect effect{};     // as it was uploaded last, with the program's number
    int id_on_target = -1;  // -1: it is not there
  };
  int upload_to_target(Entry& entry) noexcept;

  // Numbers of effects are below FF_GAIN, whose code is in the same place.
  std::array<std::optional<Entry>, FF_GAIN> entries_;
  std::optional<std::int32_t> gain_;
  EffectTarget* target_ = nullptr;
};

}  // namespace gaitpad
