// Which style a walker walks in, tick by tick: what commands chose, what a zone of the terrain
// gives, how one goes over into the next, and how tired it is. All but the commands follows from
// the state alone, so a replay computes it again.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "gaitpad/simulation.h"

namespace gaitpad {

// By a command: counts at once, in a zone too, whose style is then not given back and not given
// again before the walker has left it.
void take_style(Walker& walker, int style, std::span<const Style> styles) noexcept;

// Where the hips are now. `zone_styles`: of each zone the index of its style. Who enters a zone
// takes its style; who leaves it takes the one from before, with what commands had changed in that.
void look_at_zones(Walker& walker, const Terrain& terrain, std::span<const int> zone_styles,
                   std::span<const Style> styles) noexcept;

// What this tick walks by.
StyleValues style_of_tick(Walker& walker, double dt_s) noexcept;

// As at the beginning: in the style that was chosen last, rested, in no zone.
void restart_style(Walker& walker, std::span<const Style> styles) noexcept;

}  // namespace gaitpad
