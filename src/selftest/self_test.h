// A guided test of a pad: each driver, each control by prompt, unplugging, the motors, a
// calibration and a straight walk. Its results are kept in one folder, without serial numbers, so
// that they can be published.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The present request to the user.
struct SelfTestPrompt {
  int part = 0, parts = 0;   // `part` counts from 1
  std::string title;         // of the part: "controls"
  std::string request;       // one sentence
  std::string seen;          // the pad's present state, or why the test waits
  double done = 0.0;         // progress of the request, 0 .. 1
  bool is_question = false;  // answered with yes or no
};

// The user, at a terminal or a window. Called on the test's thread.
class SelfTestPerson {
 public:
  enum class Answer {
    none,
    next,  // skip: the pad has no such control
    yes,
    no,  // for a control: done, but the wrong control was shown
    quit,
  };
  virtual ~SelfTestPerson() = default;
  virtual void show(const SelfTestPrompt& prompt) = 0;  // about fifty times a second
  virtual Answer take_answer() = 0;                     // since the last call
  virtual void tell(const std::string& sentence) = 0;   // a remark
};

struct SelfTestOptions {
  PadFiles files;
  PadSelector selector;
  std::vector<std::string> config_folders;
  std::string map;      // pad file; empty: none
  std::string folder;   // must not exist; empty: a new one in the working directory
  std::string program;  // "gaitpad 1.2.3"
};
struct SelfTestResult {
  std::string folder;
  std::string report;                 // the text of report.json
  std::vector<std::string> failures;  // one sentence each; empty: everything passed
};
// Runs the test, which takes some minutes. None: the user gave up, and nothing is kept. Error: no
// such pad, or the folder exists or cannot be written.
Result<std::optional<SelfTestResult>> run_self_test(const SelfTestOptions& options,
                                                    SelfTestPerson& person);

// The request to press this button.
std::string button_request(PadButton button);

}  // namespace gaitpad
