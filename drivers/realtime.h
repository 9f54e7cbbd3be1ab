// Real-time scheduling and locked memory, if the system allows them.
#pragma once
#include <optional>
#include <string>

namespace gaitpad {

// Keeps this process's memory from being swapped out: what is in memory now, and what is touched
// later of the memory allocated so far. It reads nothing in, and memory allocated afterwards is not
// locked, so it is quick and takes no memory, however much a renderer maps. Call it from the thread
// that needs it (its stack is touched) after everything was allocated and written to. Undo each
// success by one unlock_memory(). Returns the cause if it is refused: `mlockall: Cannot allocate
// memory`.
std::optional<std::string> lock_memory();
void unlock_memory() noexcept;

// Lets the calling thread run before ordinary threads (SCHED_FIFO) and end its sleeps on time.
// Threads that it starts are ordinary. The loop ranks above the pads: opening a joystick may keep a
// library busy for some milliseconds. Returns the cause if it is refused.
enum class RealtimeRank { loop, pads };
std::optional<std::string> take_priority(RealtimeRank rank);
// Makes the calling thread ordinary again: one that never sleeps would leave no time for the
// others.
void give_up_priority() noexcept;
// The calling thread's scheduling in words: `SCHED_FIFO 20`, `normal priority`.
std::string time_policy();

// One sentence that says what was refused and how to allow it; nothing if nothing was refused.
std::optional<std::string> realtime_remark(const std::optional<std::string>& priority,
                                           const std::optional<std::string>& memory);

}  // namespace gaitpad
