// One study of the built-in motion for the tests of src/paper, and ways to find a claim.
#pragma once
#include <gtest/gtest.h>

#include <string_view>

#include "paper/claims.h"
#include "tests/folders.h"
#include "tests/value_of.h"

namespace gaitpad::test {

inline Study& study() {
  static Study made = value_of(
      Study::of(value_of(load_paper_source("", std::nullopt, {kSourceFolder + "/config"}))));
  return made;
}

inline const Claim& claim_of(const std::vector<Claim>& claims, std::string_view name) {
  for (const Claim& claim : claims) {
    if (claim.name == name) return claim;
  }
  ADD_FAILURE() << "no claim " << name;
  static const Claim kNone;
  return kNone;
}
inline bool passes(const std::vector<Claim>& claims, std::string_view name) {
  return claim_of(claims, name).pass.value_or(false);
}

inline const Walk& even() { return study().walk("even", IkMode::robust); }

}  // namespace gaitpad::test
