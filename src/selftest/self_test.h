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
  int part = 0, parts = 0;   // number of the present part, counted from 1, and of all parts
  std::string title;         // title of the part: "controls"
  std::string request;       // what the user has to do, in one sentence
  std::string seen;          // the pad's present state, or why the test waits
  double done = 0.0;         // share of the request that is done, 0 .. 1
  bool is_question = false;  // the request is a question, answered with yes or no
};

// The user, at a terminal or a window. Called on the test's thread.
class SelfTestPerson {
 public:
  enum class Answer {
    none,
    next,  // goes on without this control, which the pad does not have
    yes,
    no,  // the control was operated, but the prompt showed another one
    quit,
  };
  virtual ~SelfTestPerson() = default;
  virtual void show(const SelfTestPrompt& prompt) = 0;  // Called about fifty times a second.
  virtual Answer take_answer() = 0;                     // The answer since the last call.
  virtual void tell(const std::string& sentence) = 0;   // Shows a remark.
};

struct SelfTestOptions {
  PadFiles files;
  PadSelector selector;
  std::vector<std::string> config_folders;
  std::string map;  // path of a pad file (--map); empty: none
  // Folder for the results, which must not exist; empty: a new one in the working directory.
  std::string folder;
  std::string program;  // name and version of the program: "gaitpad 1.2.3"
};
struct SelfTestResult {
  std::string folder;
  std::string report;  // the text of report.json
  // One sentence for each test that failed; empty: everything passed.
  std::vector<std::string> failures;
};
// Runs the test, which takes some minutes. Returns nothing if the user gave up; then nothing is
// kept. Error: there is no such pad, or the folder exists or cannot be written.
Result<std::optional<SelfTestResult>> run_self_test(const SelfTestOptions& options,
                                                    SelfTestPerson& person);

// The request to press this button.
std::string button_request(PadButton button);

}  // namespace gaitpad
