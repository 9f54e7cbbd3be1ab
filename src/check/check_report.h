// Results of checked recordings as text for other programs: TAP for a terminal or a harness,
// JUnit's XML for a CI server.
#pragma once
#include <cstddef>
#include <string>

#include "check/trace_check.h"

namespace gaitpad {

// The lines of one result in TAP (testanything.org, version 14). `number` counts from 1. A result
// that is not met carries a YAML block; after an update the changes follow as comments.
std::string tap_result(std::size_t number, const CheckedTrace& trace, const CheckResult& result,
                       bool updates);

// Collects results and writes them as one JUnit test suite.
class JunitReport {
 public:
  void add(const CheckedTrace& trace, const CheckResult& result);
  std::string text() const;

 private:
  std::string cases_;
  int tests_ = 0, failures_ = 0;
  double seconds_ = 0.0;
};

}  // namespace gaitpad
