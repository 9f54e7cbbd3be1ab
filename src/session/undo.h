// Undo and redo of what a person changes of the characters: sliders, styles, overrides. A change is
// commands for the session; its opposite is worked out from the frame before it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/session_frame.h"

namespace gaitpad {

// The commands that give the addressed characters back what `command` would change of them; empty
// if it is malformed or changes nothing that a command can give back (`reset`, `mark`).
std::vector<std::string> opposite_of(std::string_view command, const SessionFrame& frame,
                                     const Cast& cast);

class UndoList {
 public:
  // Remembers a command that is being sent. Commands of one drag of a slider are one change.
  void add(const std::string& command, const SessionFrame& frame, const Cast& cast);
  // The commands to send; empty: there is nothing to undo or redo.
  std::vector<std::string> undo();
  std::vector<std::string> redo();
  void clear();  // a new session begins

 private:
  struct Change {
    std::vector<std::string> back, again;
    std::string what;       // the command without its value
    std::int64_t tick = 0;  // of the last command
  };
  static constexpr std::size_t kMost = 200;
  std::vector<Change> changes_;
  std::size_t done_ = 0;  // of changes_; those behind can be redone
};

}  // namespace gaitpad
