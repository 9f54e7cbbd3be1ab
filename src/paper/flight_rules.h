// The paper's gradient rule with parts that can be switched off, to show the purpose of each. (The
// walk uses gaitpad/flight.h.) Meredith & Maddock 2005, section 3.2, figure 2.
#pragma once
#include <optional>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

struct FlightRule {
  bool has_bands = true;    // a target's height must be within 10 % of the extreme
  bool takes_last = false;  // the lift is the last low before the peak, not the first low
};
struct FlightTargets {  // the three targets of a flight, as indices of the heights
  int lift = 0, peak = 0, land = 0;
  bool operator==(const FlightTargets&) const = default;
};
inline constexpr double kFlightBand = 0.10;
std::optional<FlightTargets> flight_targets(const std::vector<double>& heights,
                                            const FlightRule& rule);

enum class FootPoint { ankle, heel, toe_tip };
// Heights over two strides of the motion from the foot's strike, in metres above the lowest point
// of both feet, by forward kinematics in the sagittal plane.
std::vector<double> stride_heights(const GaitCycle& cycle, Side side, FootPoint point,
                                   int samples_a_stride);
// Adds the jitter of captured data: a standing foot moves by a few millimetres.
void add_standing_jitter(std::vector<double>& heights, int samples_a_stride);

// Height of a foot over 50 frames that stops (0) or rises by `blip_m` during its descent near frame
// 25, as in figure 2.
std::vector<double> blip_curve(double blip_m);
inline constexpr int kBlipFrame = 25;

}  // namespace gaitpad
