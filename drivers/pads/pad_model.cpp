#include "drivers/pads/pad_model.h"

namespace gaitpad {

std::unique_ptr<PadModel> make_pad_model(const DeviceInfo& device) {
  for (const auto make : {make_one_of_several_model, make_sony_model, make_switch_model,
                          make_steam_model, make_motor_model}) {
    if (auto model = make(device)) return model;
  }
  return std::make_unique<PadModel>();
}

}  // namespace gaitpad
