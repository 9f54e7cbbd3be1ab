// The paper's gradient rule with its parts taken off one by one, to show what each is for. (The
// rule that the program walks by is motion/flight.h.)
// Meredith & Maddock 2005, section 3.2, figure 2.
#pragma once
#include <optional>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

struct FlightRule {
  bool has_bands = true;    // a target's height is within 10 % of the range of the extreme
  bool takes_last = false;  // the first target: the last low before the peak, not the first of all
};
struct FlightTargets {  // indices of the heights
  int lift = 0, peak = 0, land = 0;
  bool operator==(const FlightTargets&) const = default;
};
inline constexpr double kFlightBand = 0.10;
std::optional<FlightTargets> flight_targets(const std::vector<double>& heights,
                                            const FlightRule& rule);

enum class FootPoint { ankle, heel, toe_tip };
// Heights over two strides of the motion, from that foot's strike on, metres above the lowest point
// of both feet: forward kinematics in the sagittal plane that stands on the ground by itself.
std::vector<double> stride_heights(const GaitCycle& cycle, Side side, FootPoint point,
                                   int samples_a_stride);
// What a standing foot of captured data does: lows of a few millimetres while it should be flat.
void add_standing_jitter(std::vector<double>& heights, int samples_a_stride);

// A foot's height over some 50 frames with a stand-still (0) or a small rise (`blip_m`) on its way
// down near frame 25: the case that figure 2 shows.
std::vector<double> blip_curve(double blip_m);
inline constexpr int kBlipFrame = 25;

}  // namespace gaitpad
