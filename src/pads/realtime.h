// What makes a thread punctual, where the system allows it.
#pragma once
#include <optional>
#include <string>

namespace gaitpad {

// For the whole process: what is in memory now is not swapped out, nor what is touched later of
// what has been allocated. Nothing is read in for it and nothing that is allocated afterwards
// counts, so it is quick and takes no memory, however much a renderer has mapped or will map. Call
// it when everything that the thread needs is allocated and was written to, from that thread (its
// stack is touched). Each success is undone by one unlock_memory(). The cause where it is refused:
// `mlockall: Cannot allocate memory`.
std::optional<std::string> lock_memory();
void unlock_memory() noexcept;

// For the calling thread: it runs before ordinary ones (SCHED_FIFO), and its sleeps end on time.
// Threads that it starts are ordinary ones. The loop comes before the pads: opening a joystick may
// keep a library busy for some milliseconds.
enum class RealtimeRank { loop, pads };
std::optional<std::string> take_priority(RealtimeRank rank);
// As if it had never been taken: a thread that never sleeps would leave nothing for the others.
void give_up_priority() noexcept;
// How the calling thread is scheduled: `SCHED_FIFO 20`, `normal priority`.
std::string time_policy();

// One sentence of what was refused and how to allow it; none where nothing was.
std::optional<std::string> realtime_remark(const std::optional<std::string>& priority,
                                           const std::optional<std::string>& memory);

}  // namespace gaitpad
