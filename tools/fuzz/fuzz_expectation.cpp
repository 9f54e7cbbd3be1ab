// libFuzzer target: an expectation (NAME.expect.toml). An accepted expectation must survive writing
// and reading unchanged.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "check/expectation.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaitpad;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto expectation = parsed_expectation(text, "fuzz.expect.toml");
  if (!expectation) {
    if (expectation.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  const std::string written = expectation_text(*expectation);
  const auto again = parsed_expectation(written, "again.expect.toml");
  if (!again || expectation_text(*again) != written) std::abort();
  if (again->pose_hash != expectation->pose_hash || again->files != expectation->files)
    std::abort();
  (void)session_of(*expectation, "folder", "folder/fuzz.hid");
  if (!changed_files(*expectation, expectation->files).empty()) std::abort();
  Measured measured;
  measured.characters.resize(expectation->characters.size());
  (void)unmet_numbers(*expectation, measured);
  const Expectation after = renewed(*expectation, measured);
  (void)changes(*expectation, after);
  if (!parsed_expectation(expectation_text(after), "renewed.expect.toml")) std::abort();
  return 0;
}
