// What makes a thread punctual, where the system allows it.
#pragma once
#include <optional>
#include <string>

namespace gaitpad {

// For the whole process: memory is not swapped out. Call it when everything big is allocated.
// The cause where it is refused: `mlockall: Cannot allocate memory`.
std::optional<std::string> lock_memory();
void unlock_memory() noexcept;

// For the calling thread: it runs before ordinary ones (SCHED_FIFO), and its sleeps end on time.
std::optional<std::string> take_priority();
// As if it had never been taken: a thread that never sleeps would leave nothing for the others.
void give_up_priority() noexcept;

// One sentence of what was refused and how to allow it; none where nothing was.
std::optional<std::string> realtime_remark(const std::optional<std::string>& priority,
                                           const std::optional<std::string>& memory);

}  // namespace gaitpad
