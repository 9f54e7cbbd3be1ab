// The self-test in the window: the same test and the same folder as `gaitpad selftest`.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "session/self_test.h"
#include "view/widgets.h"

namespace gaitpad {

// The test runs on a thread of its own, because it waits for the person; the window shows its
// prompts and passes the answers on. No session may hold the pad meanwhile.
class SelfTestView {
 public:
  static std::unique_ptr<SelfTestView> start(const SelfTestOptions& options);
  ~SelfTestView();  // gives the test up

  // Draws in the middle of a window of this size. False once the test has ended; what came of it is
  // then in `messages`, as are remarks before.
  bool draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages);

 private:
  SelfTestView() = default;
  class Person;
  std::unique_ptr<Person> person_;
};

}  // namespace gaitpad
