#include "pad_sender.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "pad_log.h"

enum { kQueue = 64 };

pthread_mutex_t pad_mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t wake;

static struct pad* pad;
static struct trace* trace;
static int endpoint;
static bool enabled, changed, silent, stall;
static struct packet queue[kQueue];
static unsigned queue_first, queue_count;
static double stream_rate_hz;
static int64_t next_stream_ns, sent_count;
static struct {
  int64_t next_ns, period_ns, left, number, late;
  unsigned at;  // place of the number's lowest byte in the report
} burst;
static struct {
  bool running;
  size_t next;
  int64_t start_ns;
} playing;

void enqueue(const struct packet* packet) {
  if (queue_count == kQueue) {
    log_line("dropped", now_ns(), "", packet->bytes, packet->size);
    return;
  }
  queue[(queue_first + queue_count++) % kQueue] = *packet;
  wake_sender();
}

static bool due(int64_t at_ns, int64_t now, int64_t* next_ns) {
  if (at_ns <= now) return true;
  if (at_ns < *next_ns) *next_ns = at_ns;
  return false;
}

static bool burst_packet(int64_t now, struct packet* packet, int64_t* next_ns) {
  if (burst.left == 0 || !due(burst.next_ns, now, next_ns)) return false;
  if (now - burst.next_ns > burst.period_ns) {
    ++burst.late;
    // Reports that are late are not sent faster later: a pad never exceeds its rate.
    burst.next_ns = now;
  }
  burst.next_ns += burst.period_ns;
  write_bits(&pad->state, (struct field){"", (uint16_t)(8 * burst.at), 32},
             (uint32_t)burst.number++);
  *packet = pad->state;
  if (--burst.left == 0) {
    char text[64];
    snprintf(text, sizeof text, "%lld %lld", (long long)burst.number, (long long)burst.late);
    note("burst_end", text);
  }
  return true;
}

static bool trace_packet(int64_t now, struct packet* packet, int64_t* next_ns) {
  if (!playing.running ||
      !due(playing.start_ns + trace->events[playing.next].time_ns, now, next_ns))
    return false;
  const struct trace_event* event = &trace->events[playing.next];
  packet->size = event->size;
  memcpy(packet->bytes, trace->bytes + event->first_byte, event->size);
  if (++playing.next == trace->event_count) {
    playing.running = false;
    pad->state = *packet;
    note("play_end", trace->path);
  }
  return true;
}

static bool state_packet(int64_t now, struct packet* packet, int64_t* next_ns) {
  const bool stream = stream_rate_hz > 0.0 && due(next_stream_ns, now, next_ns);
  if (!stream && (!changed || stream_rate_hz > 0.0)) return false;
  if (stream) {
    next_stream_ns += (int64_t)(1e9 / stream_rate_hz);
    if (next_stream_ns < now) next_stream_ns = now;  // the host did not poll: skip missed reports
  }
  changed = false;
  write_bits(&pad->state, pad->kind.counter, pad->counter++);
  *packet = pad->state;
  return true;
}

// The packet to send now; if there is none, the time to check again. With pad_mutex.
static bool next_packet(struct packet* packet, int64_t* next_ns) {
  const int64_t now = now_ns();
  *next_ns = now + INT64_C(1000000000);
  if (!enabled || silent) return false;
  if (queue_count != 0) {
    *packet = queue[queue_first];
    queue_first = (queue_first + 1) % kQueue;
    --queue_count;
    return true;
  }
  if (!pad->awake) return false;
  if (burst.left != 0) return burst_packet(now, packet, next_ns);
  if (playing.running) return trace_packet(now, packet, next_ns);
  return state_packet(now, packet, next_ns);
}

static void send_packet(const struct packet* packet) {
  char number[24];
  snprintf(number, sizeof number, "%lld ", (long long)++sent_count);
  const int64_t before_ns = now_ns();
  const ssize_t written = write(endpoint, packet->bytes, packet->size);
  if (written == (ssize_t)packet->size) {
    log_line("sent", before_ns, number, packet->bytes, packet->size);
  } else {
    log_line("unsent", before_ns, number, packet->bytes, packet->size);
    if (errno == ESHUTDOWN || errno == ENODEV)
      usleep(1000);  // the device was unplugged: the control endpoint's event comes soon
  }
}

static _Noreturn void* in_thread(void* unused) {
  (void)unused;
  struct packet packet;
  pthread_mutex_lock(&pad_mutex);
  for (;;) {
    int64_t next_ns;
    if (stall && enabled) {  // a transfer in the wrong direction halts the endpoint
      stall = false;
      pthread_mutex_unlock(&pad_mutex);
      const ssize_t result = read(endpoint, packet.bytes, 1);
      note("stalled", result < 0 && errno == EBADMSG ? "" : "failed");
    } else if (next_packet(&packet, &next_ns)) {
      pthread_mutex_unlock(&pad_mutex);
      send_packet(&packet);
    } else {
      const struct timespec until = {next_ns / 1000000000, next_ns % 1000000000};
      pthread_cond_timedwait(&wake, &pad_mutex, &until);
      continue;
    }
    pthread_mutex_lock(&pad_mutex);
  }
}

void start_sender(struct pad* the_pad, int in_endpoint, struct trace* the_trace) {
  pad = the_pad;
  trace = the_trace;
  endpoint = in_endpoint;
  stream_rate_hz = pad->kind.stream_rate_hz;
  pthread_condattr_t clock;
  pthread_condattr_init(&clock);
  pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
  pthread_cond_init(&wake, &clock);
  pthread_t thread;
  if (pthread_create(&thread, NULL, in_thread, NULL) != 0) die("thread");
  pthread_detach(thread);
}

void wake_sender(void) { pthread_cond_signal(&wake); }

void sender_enable(bool on) {
  pthread_mutex_lock(&pad_mutex);
  enabled = on;
  queue_count = 0;
  if (on) {
    pad->awake = !pad->kind.starts_asleep;
    pad->counter = 0;
    next_stream_ns = now_ns();
    struct packet announce;
    if (pad->kind.announce && (announce.size = pad->kind.announce(pad, announce.bytes)) != 0)
      enqueue(&announce);
  }
  wake_sender();
  pthread_mutex_unlock(&pad_mutex);
  note(on ? "enable" : "disable", "");
}

static size_t read_hex(const char* text, uint8_t* bytes, size_t space) {
  size_t size = 0;
  unsigned value;
  int used;
  while (size < space && sscanf(text, "%2x%n", &value, &used) == 1) {
    bytes[size++] = (uint8_t)value;
    text += used;
  }
  return size;
}

static bool set_fields(char* text) {
  char* place;
  bool all = true;
  for (char* word = strtok_r(text, " ", &place); word; word = strtok_r(NULL, " ", &place)) {
    char* equals = strchr(word, '=');
    if (!equals) return false;
    *equals = 0;
    all = set_field(&pad->kind, &pad->state, word, strtol(equals + 1, NULL, 0)) && all;
  }
  changed = true;
  return all;
}

static bool start_burst(const char* text) {
  double rate_hz, seconds;
  if (sscanf(text, "%lf %lf %u", &rate_hz, &seconds, &burst.at) != 3 || rate_hz <= 0.0)
    return false;
  burst.period_ns = (int64_t)(1e9 / rate_hz);
  burst.left = (int64_t)(rate_hz * seconds);
  burst.number = burst.late = 0;
  burst.next_ns = now_ns();
  return true;
}

static bool start_trace(const char* path) {
  if (*path && !read_trace(path, trace)) return false;
  if (trace->event_count == 0) return false;
  playing.running = true;
  playing.next = 0;
  playing.start_ns = now_ns() - trace->events[0].time_ns;
  return true;
}

bool sender_command(const char* word, char* rest) {
  if (strcmp(word, "set") == 0) return set_fields(rest);
  if (strcmp(word, "burst") == 0) return start_burst(rest);
  if (strcmp(word, "play") == 0) return start_trace(rest);
  if (strcmp(word, "stall") == 0) return stall = true;
  if (strcmp(word, "silence") == 0) {
    silent = atoi(rest) != 0;
  } else if (strcmp(word, "stream") == 0) {
    stream_rate_hz = atof(rest);
    next_stream_ns = now_ns();
  } else if (strcmp(word, "report") == 0) {
    pad->state.size = read_hex(rest, pad->state.bytes, kMaxPacket);
    changed = true;
  } else if (strcmp(word, "raw") == 0) {
    struct packet packet;
    packet.size = read_hex(rest, packet.bytes, kMaxPacket);
    enqueue(&packet);
  } else if (strcmp(word, "features") == 0) {
    pad->refuses_features = atoi(rest) == 0;
  } else if (strcmp(word, "flash") == 0) {
    const long offset = strtol(rest, &rest, 16) - kUserFlash;
    if (offset < 0 || offset >= (long)sizeof pad->user_flash) return false;
    read_hex(rest, pad->user_flash + offset, sizeof pad->user_flash - (size_t)offset);
  } else {
    return false;
  }
  return true;
}
