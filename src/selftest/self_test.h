// A person with a pad proves that it works: each driver, each control by prompt, unplugging, the
// motors, a calibration and a straight walk. One folder keeps what was seen, without a serial
// number, so that it can be given away.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"

namespace gaitpad {

// What the person is asked for at the moment.
struct SelfTestPrompt {
  int part = 0, parts = 0;   // `part` counts from 1
  std::string title;         // of the part: "controls"
  std::string request;       // one sentence
  std::string seen;          // what the pad shows now, or why nothing goes on
  double done = 0.0;         // of the request, 0..1
  bool is_question = false;  // to be answered with yes or no
};

// The person, at a terminal or a window. Called on the thread of the test.
class SelfTestPerson {
 public:
  enum class Answer {
    none,
    next,  // it cannot be done: the pad has no such control
    yes,
    no,  // of a control: it was done, and something else was shown
    quit,
  };
  virtual ~SelfTestPerson() = default;
  virtual void show(const SelfTestPrompt& prompt) = 0;  // some fifty times a second
  virtual Answer take_answer() = 0;                     // since the last call
  virtual void tell(const std::string& sentence) = 0;   // a remark
};

struct SelfTestOptions {
  PadFiles files;
  PadWish wish;
  std::vector<std::string> config_folders;
  std::string map;      // pad file; empty: none
  std::string folder;   // to be made; empty: a new one in the working directory
  std::string program;  // "gaitpad 1.2.3"
};
struct SelfTestResult {
  std::string folder;
  std::string report;                 // the text of report.json
  std::vector<std::string> failures;  // one sentence each; empty: everything that was asked for
};
// Runs the test, for some minutes. None: the person gave up, and nothing is kept. Error: no such
// pad, or the folder exists or cannot be written.
Result<std::optional<SelfTestResult>> run_self_test(const SelfTestOptions& options,
                                                    SelfTestPerson& person);

// What the report calls this control, and what a person is told to do.
std::string button_request(PadButton button);

}  // namespace gaitpad
