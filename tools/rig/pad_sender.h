// The sending thread of a pad. A write to the IN endpoint blocks until the host polls it, so a
// thread of its own writes: the newest state, but every packet of the queue, of numbered bursts and
// of recordings.
#pragma once
#include <pthread.h>

#include "pad_kinds.h"
#include "pad_trace.h"

// Guards everything here and `pad`.
extern pthread_mutex_t pad_mutex;

// Starts the thread. `pad` is set up; nothing is sent before `sender_enable`. `trace` is what
// `play` plays when it names no file, and is replaced by the file that it names.
void start_sender(struct pad* pad, int in_endpoint, struct trace* trace);
// Tells the thread that the host has configured the device (on), or that it is gone (off).
void sender_enable(bool on);
// Queues a reply. The caller has locked pad_mutex.
void enqueue(const struct packet* packet);
// Wakes the thread after a change of its inputs. The caller has locked pad_mutex.
void wake_sender(void);

// A command that changes what is sent; false: refused. The caller has locked pad_mutex.
//   set NAME=VALUE...   fields of the state, in the device's own units
//   report HEX          the whole state          raw HEX     one packet as it is, of any length
//   stream HZ           0: at changes only       silence 0|1 nothing leaves, not even replies
//   burst HZ S BYTE     HZ * S reports, a 32-bit number in each from BYTE on
//   play [FILE]         a recording's reports at its own times
//   stall               halts the IN endpoint    features 0|1  0: feature requests are stalled
//   flash ADDRESS HEX   the user's area of a Switch pad
bool sender_command(const char* word, char* rest);
