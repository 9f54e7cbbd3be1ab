#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "view/plot.h"

namespace gaitpad {
namespace {

constexpr int kMaxTicks = 64;
constexpr double kRounding = 1e-9;  // of a step: an end that is a tick but for its last bits

// Of one pixel column, in the order in which they came.
struct Column {
  std::size_t first = 0, low = 0, high = 0, last = 0;
};

void add_column(std::span<const PlotPoint> points, const Column& c, std::vector<PlotPoint>& out) {
  std::size_t order[] = {c.first, std::min(c.low, c.high), std::max(c.low, c.high), c.last};
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == 0 || order[i] != order[i - 1]) out.push_back(points[order[i]]);
  }
}

bool is_drawable(const PlotPoint& p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y); }

void add_gap(std::vector<PlotPoint>& out) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!out.empty() && is_drawable(out.back())) out.push_back({kNone, kNone});
}

}  // namespace

double nice_step(double span, int max_steps) noexcept {
  if (!std::isfinite(span) || span <= 0.0 || max_steps < 1) return 0.0;
  const double wanted = span / max_steps;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  if (!(power > 0.0)) return 0.0;
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if (span / (factor * power) <= max_steps + kRounding) return factor * power;
  }
  return 20.0 * power;
}

std::vector<double> nice_ticks(double min, double max, int max_steps) {
  std::vector<double> ticks;
  const double step = nice_step(max - min, std::min(max_steps, kMaxTicks));
  if (step == 0.0) return ticks;
  const double first = std::ceil(min / step - kRounding);
  for (int i = 0; i <= kMaxTicks; ++i) {
    const double tick = (first + i) * step;
    if (!(tick <= max + kRounding * step)) break;
    ticks.push_back(tick == 0.0 ? 0.0 : tick);  // no -0
  }
  return ticks;
}

std::string tick_text(double value, double step) {
  if (!std::isfinite(value)) return "-";
  const double magnitude = step > 0.0 ? std::floor(std::log10(step) + kRounding) : 0.0;
  const int decimals = static_cast<int>(std::clamp(-magnitude, 0.0, 6.0));
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

PlotRange nice_range(double min, double max, double least) noexcept {
  if (!std::isfinite(min) || !std::isfinite(max) || min > max) return {0.0, std::max(least, 1e-9)};
  if (max - min < least) {
    const double middle = (min + max) / 2.0;
    min = middle - least / 2.0;
    max = middle + least / 2.0;
  }
  const double step = nice_step(max - min, 4);
  if (step == 0.0) return {min - 0.5, max + 0.5};
  return {std::floor(min / step + kRounding) * step, std::ceil(max / step - kRounding) * step};
}

void decimate(std::span<const PlotPoint> points, const PlotRange& x, int columns,
              std::vector<PlotPoint>& out) {
  out.clear();
  const double width = x.max - x.min;
  if (columns < 1 || !(width > 0.0)) return;
  const bool is_few = points.size() <= static_cast<std::size_t>(columns) * 2;
  Column column;
  int at = -1;  // the column that is being filled, -1: none
  const auto finish = [&] {
    if (at >= 0) add_column(points, column, out);
    at = -1;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlotPoint& p = points[i];
    if (!is_drawable(p)) {
      finish();
      add_gap(out);
      continue;
    }
    const double place = std::clamp((p.x - x.min) / width * columns, 0.0, columns - 1.0);
    if (is_few || static_cast<int>(place) != at) {
      finish();
      at = static_cast<int>(place);
      column = {i, i, i, i};
      continue;
    }
    if (p.y < points[column.low].y) column.low = i;
    if (p.y > points[column.high].y) column.high = i;
    column.last = i;
  }
  finish();
}

// From each point that stays, the slopes under which all points since are met within the tolerance;
// a point that lies outside of them ends the stretch.
void thin_out(std::vector<ImVec2>& line, float tolerance) {
  if (line.size() < 3) return;
  std::size_t kept = 1;
  ImVec2 anchor = line[0];
  float low = -FLT_MAX, high = FLT_MAX;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const ImVec2 here = line[i], next = line[i + 1];
    const float dx = here.x - anchor.x, next_dx = next.x - anchor.x;
    if (dx > 0.0f) {
      low = std::max(low, (here.y - tolerance - anchor.y) / dx);
      high = std::min(high, (here.y + tolerance - anchor.y) / dx);
    }
    const float slope = next_dx > 0.0f ? (next.y - anchor.y) / next_dx : FLT_MAX;
    if (dx > 0.0f && slope >= low && slope <= high) continue;
    line[kept++] = anchor = here;
    low = -FLT_MAX;
    high = FLT_MAX;
  }
  line[kept++] = line.back();
  line.resize(kept);
}

}  // namespace gaitpad
