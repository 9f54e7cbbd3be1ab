#include <SDL2/SDL_scancode.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "selftest/self_test.h"
#include "view/pad_dialog.h"

namespace gaitpad {
namespace {

constexpr double kSelfTestWidth = 760.0, kSelfTestHeight = 320.0;  // the dialog's size at scale 1

std::string outcome(const Result<std::optional<SelfTestResult>>& result) {
  if (!result) return result.error().message;
  if (!*result) return "the self-test was given up; nothing was kept";
  const SelfTestResult& done = **result;
  const std::string found =
      done.failures.empty()
          ? "everything that was asked for was seen"
          : fmt::format("{} failed, the first: {}", done.failures.size(), done.failures.front());
  return fmt::format("{}: {}", done.folder, found);
}

// Runs the test on a thread of its own, because it waits for the user, and exchanges prompts and
// answers with the window's thread.
class WindowPerson final : public SelfTestPerson {
 public:
  explicit WindowPerson(const SelfTestOptions& options) : options_(options) {
    thread_ = std::thread([this] {
      const std::string said = outcome(run_self_test(options_, *this));
      const std::lock_guard lock(mutex_);
      remarks_.push_back(said);
      has_ended_ = true;
    });
  }
  ~WindowPerson() override {  // Cancels the test.
    is_leaving_ = true;
    answer(Answer::quit);
    thread_.join();
  }

  void show(const SelfTestPrompt& prompt) override {
    const std::lock_guard lock(mutex_);
    prompt_ = prompt;
  }
  Answer take_answer() override {
    const std::lock_guard lock(mutex_);
    return is_leaving_ ? Answer::quit : std::exchange(answer_, Answer::none);
  }
  void tell(const std::string& sentence) override {
    const std::lock_guard lock(mutex_);
    remarks_.push_back(sentence);
  }

  void answer(Answer answer) {
    const std::lock_guard lock(mutex_);
    answer_ = answer;
  }
  SelfTestPrompt prompt() {
    const std::lock_guard lock(mutex_);
    return prompt_;
  }
  // Returns false when the test has ended and all remarks were taken.
  bool take_remarks(std::vector<std::string>& messages) {
    const std::lock_guard lock(mutex_);
    std::ranges::move(remarks_, std::back_inserter(messages));
    remarks_.clear();
    return !has_ended_;
  }

 private:
  const SelfTestOptions options_;
  std::mutex mutex_;  // guards the members after it
  SelfTestPrompt prompt_;
  Answer answer_ = Answer::none;
  std::vector<std::string> remarks_;
  bool has_ended_ = false;
  std::atomic<bool> is_leaving_ = false;
  std::thread thread_;
};

class SelfTestView final : public PadDialog {
 public:
  explicit SelfTestView(const SelfTestOptions& options) : person_(options) {}
  State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages) override;

 private:
  WindowPerson person_;
};

PadDialog::State SelfTestView::draw(Ui& ui, const ImVec2& window_px,
                                    std::vector<std::string>& messages) {
  if (!person_.take_remarks(messages)) return State::ended;
  const SelfTestPrompt prompt = person_.prompt();
  const ImVec2 size = begin_modal(ui, "self test", kSelfTestWidth, kSelfTestHeight, window_px);
  draw_step(ui,
            prompt.parts > 0
                ? fmt::format("Part {} of {}: {}", prompt.part, prompt.parts, prompt.title)
                : "Test this pad",
            "", prompt.parts > 0 ? prompt.request : "Looking for the pad.");
  progress_bar(ui, prompt.done);
  note(ui, drawable(prompt.seen), 4);

  go_to_buttons(size.y);
  if (prompt.is_question) {
    if (key_button(ui, "self test yes", "Yes  (Y)", SDLK_y))
      person_.answer(SelfTestPerson::Answer::yes);
    ImGui::SameLine();
  }
  if (key_button(ui, "self test no",
                 prompt.is_question ? "No  (N)" : "It shows something else  (N)", SDLK_n))
    person_.answer(SelfTestPerson::Answer::no);
  ImGui::SameLine();
  if (key_button(ui, "self test next", "The pad cannot do it  (Enter)", SDLK_RETURN))
    person_.answer(SelfTestPerson::Answer::next);
  ImGui::SameLine();
  if (button(ui, "self test give up", "Give up  (Esc)"))
    person_.answer(SelfTestPerson::Answer::quit);
  end_modal();
  return State::goes_on;
}

}  // namespace

Result<std::unique_ptr<PadDialog>> start_self_test(const PadDialogOptions& options) {
  auto files = load_pad_files(options.config_folders, options.map, "");
  if (!files) return files.error();
  return std::unique_ptr<PadDialog>(
      new SelfTestView({std::move(*files), options.selector, options.config_folders, options.map,
                        "", options.program}));
}

}  // namespace gaitpad
