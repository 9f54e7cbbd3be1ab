// Undo and redo of a user's changes to the characters: sliders, styles, overrides. A change is a
// list of commands; its opposite is computed from the frame before it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/session_frame.h"

namespace gaitpad {

// The commands that restore for the addressed characters what `command` changes; empty if it is
// malformed or changes nothing that a command can restore (`reset`, `mark`).
std::vector<std::string> opposite_of(std::string_view command, const SessionFrame& frame,
                                     const Cast& cast);

class UndoList {
 public:
  // Remembers a command that is being sent. The commands of one drag of a slider form one change.
  void add(const std::string& command, const SessionFrame& frame, const Cast& cast);
  // The commands to send; empty: there is nothing to undo or redo.
  std::vector<std::string> undo();
  std::vector<std::string> redo();
  void clear();  // Forgets all changes. Call it when a new session begins.

 private:
  struct Change {
    std::vector<std::string> back, again;
    std::string what;       // the command up to its value
    std::int64_t tick = 0;  // tick of the last command
  };
  static constexpr std::size_t kMost = 200;
  std::vector<Change> changes_;
  std::size_t done_ = 0;  // changes_ before this index are done; the later ones can be redone
};

}  // namespace gaitpad
