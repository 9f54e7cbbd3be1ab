// The thirty assertions that the paper's text comes down to, measured. Numbers, wording and bounds
// of most are those of the project's notes on the paper; where the walk's own, stricter bounds
// exist, they count. A claim that does not hold as the paper words it is reported as failed.
//
// Each function measures one group from what it is given, so that a broken walk shows.
#pragma once
#include <vector>

#include "paper/claim.h"
#include "paper/study.h"

namespace gaitpad {

// All groups, those that depend on the solver in both modes, ordered by number.
std::vector<Claim> all_claims(Study& study);

// --- claims_flight.cpp: 1-5, section 3.2 ---------------------------------------------------------
std::vector<Claim> flight_claims(const PaperSource& source, IkMode mode);
// --- claims_retarget.cpp: 6, 29 ------------------------------------------------------------------
std::vector<Claim> scaling_claims(const Study& study);
std::vector<Claim> sliding_claims(const Study& study, IkMode mode);
// --- claims_cycle.cpp: 7, 8, 30 ------------------------------------------------------------------
std::vector<Claim> table_1_claims(const Walk& walk, double after_s, IkMode mode);
struct FootBuild {  // of a walk's character
  std::array<double, 2> toe_rest_m{};
};
FootBuild foot_build(const WalkModel& model);
std::vector<Claim> continuity_claims(const Walk& walk, const FootBuild& build, double after_s,
                                     IkMode mode);
std::vector<Claim> endurance_claims(const Walk& long_walk, IkMode mode);
// --- claims_chain.cpp: 9-12, section 3.3.2; claims_reach.cpp: 23
// -----------------------------------
std::vector<Claim> jacobian_claims(const WalkModel& model, IkMode mode);
std::vector<Claim> chain_claims(IkMode mode);
std::vector<Claim> reach_claims(const WalkModel& model, IkMode mode);
// --- claims_weights.cpp: 13-17, figure 5a
// ----------------------------------------------------------
struct WeightWalks {
  const Walk *even = nullptr, *stiff_hip = nullptr, *stiff_knee = nullptr;
};
std::vector<Claim> weight_claims(const WeightWalks& walks, const Ticks& stride, IkMode mode);
// RMS of the hip's change, falling weights (0.9, 0.8, 0.5, 0.2), degrees.
std::vector<Claim> monotone_claims(const std::vector<double>& rms_deg, IkMode mode);
// --- claims_limp.cpp: 18-20, figure 5b
// ------------------------------------------------------------
struct LimpWalks {
  const Walk *even = nullptr, *limp = nullptr, *limp_hip = nullptr, *limp_knee = nullptr;
};
std::vector<Claim> limp_claims(const LimpWalks& walks, IkMode mode);
std::vector<Claim> limp_weight_claims(const LimpWalks& walks, const Ticks& stride, IkMode mode);
// --- claims_cost.cpp: 21
// --------------------------------------------------------------------------
std::vector<Claim> cost_claims(Study& study);
// --- claims_terrain.cpp: 22
// -----------------------------------------------------------------------
std::vector<Claim> terrain_claims(const Study& study, IkMode mode);
// --- claims_turn.cpp: 24
// --------------------------------------------------------------------------
std::vector<Claim> turn_claims(const Study& study, IkMode mode);
// --- claims_pad.cpp: 25, section 3.1
// ----------------------------------------------------------------
std::vector<Claim> pad_claims(const Study& study);
// --- claims_style.cpp: 26-28
// ----------------------------------------------------------------------
std::vector<Claim> fatigue_claims(const Study& study);
std::vector<Claim> hip_claims(const Study& study, IkMode mode);
std::vector<Claim> body_claims(const Study& study);

}  // namespace gaitpad
