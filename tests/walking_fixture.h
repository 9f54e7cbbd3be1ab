// Characters of the program's own files in a simulation; every tick is kept in a history, which the
// window shows.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "gaitpad/session_frame.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/simulation.h"
#include "session/history.h"
#include "tests/folders.h"
#include "tests/value_of.h"

namespace gaitpad {

class WalkingTest : public testing::Test {
 protected:
  // Starts characters in these styles.
  void start(const std::vector<std::string>& styles, int crowd = 0,
             const std::string& terrain = "") {
    SessionSpec spec;
    spec.config_folders = {kSourceFolder + "/config"};
    spec.walk.styles = styles;
    spec.walk.characters.assign(styles.size(), "adult");
    spec.walk.crowd = crowd;
    spec.walk.terrain = terrain;
    const SimulationConfig config = value_of(simulation_config(spec, 240));
    simulation = std::make_unique<Simulation>(value_of(Simulation::create(config)));
    cast = cast_of(*simulation, config);
    history = History();
    step(1);
  }
  void step(int ticks, const std::vector<std::string>& commands = {}) {
    std::vector<Report> reports;
    for (const std::string& text : commands) {
      Report& report = reports.emplace_back();
      report.kind = ReportKind::command;
      report.size = static_cast<std::uint16_t>(text.size());
      std::copy(text.begin(), text.end(), report.bytes.begin());
    }
    for (int i = 0; i < ticks; ++i) {
      simulation->step(reports);
      reports.clear();
      TickSample sample;
      copy_sample(*simulation, sample);
      sample.step_us = 150.0f + static_cast<float>(i % 7);
      history.add(sample);
    }
    copy_frame(*simulation, *frame);
  }

  std::unique_ptr<Simulation> simulation;
  Cast cast;
  std::unique_ptr<SessionFrame> frame = std::make_unique<SessionFrame>();
  History history;
};

}  // namespace gaitpad
