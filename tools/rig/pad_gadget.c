// pad_gadget KIND INDEX [--trace FILE.hid] [--serial TEXT]: one USB pad by FunctionFS on
// dummy_udc.INDEX. KIND as in pad_kinds.c, or `trace`: ids and descriptor of the file, replies of
// the kind with these ids. Lines from /run/rig/pad-INDEX/fifo are obeyed (plug, unplug, quit and
// those of pad_sender.h); what happens goes to /run/rig/pad-INDEX/log.
#include <errno.h>
#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pad_kinds.h"
#include "pad_log.h"
#include "pad_sender.h"
#include "pad_trace.h"
#include "pad_usb.h"

static struct pad pad;
static int port;
static struct endpoints endpoints;
static struct trace trace;

static _Noreturn void* out_thread(void* unused) {
  (void)unused;
  struct packet out, reply;
  for (;;) {
    const ssize_t size = read(endpoints.out, out.bytes, sizeof out.bytes);
    if (size <= 0) {  // the device was unplugged
      usleep(2000);
      continue;
    }
    out.size = (size_t)size;
    memset(out.bytes + size, 0, sizeof out.bytes - out.size);
    log_line("out", now_ns(), "", out.bytes, out.size);
    if (!pad.kind.answer) continue;
    pthread_mutex_lock(&pad_mutex);
    if (pad.kind.answer(&pad, &out, &reply)) enqueue(&reply);
    wake_sender();
    pthread_mutex_unlock(&pad_mutex);
  }
}

static size_t copy(uint8_t* to, const void* from, size_t size) {
  memcpy(to, from, size);
  return size;
}

// Writes the answer to an IN request and returns its size; 0 stalls the request.
static size_t control_reply(const struct usb_ctrlrequest* request, uint8_t* reply) {
  const uint8_t high = (uint8_t)(request->wValue >> 8), id = (uint8_t)request->wValue;
  const size_t descriptor_size = pad.kind.descriptor_size;
  if (descriptor_size == 0) return 0;
  if (request->bRequestType == 0x81 && request->bRequest == 6 && high == 0x22)
    return copy(reply, pad.kind.descriptor, descriptor_size);
  // Only GET_REPORT has an answer.
  if (request->bRequestType != 0xa1 || request->bRequest != 1) return 0;
  pthread_mutex_lock(&pad_mutex);
  size_t size = 0;
  // Without report ids the requested id is 0.
  if (high == 1 && (id == 0 || id == pad.state.bytes[0]))
    size = copy(reply, pad.state.bytes, pad.state.size);
  if (high == 3 && pad.kind.feature && !pad.refuses_features)
    size = pad.kind.feature(&pad, id, reply);
  pthread_mutex_unlock(&pad_mutex);
  return size;
}

static void answer_setup(const struct usb_ctrlrequest* request) {
  uint8_t data[kMaxDescriptor] = {0};
  size_t size = request->wLength < sizeof data ? request->wLength : sizeof data;
  if (request->bRequestType & 0x80) {
    const size_t reply_size = control_reply(request, data);
    if (reply_size < size) size = reply_size;
    log_line("setup", now_ns(), size != 0 ? "" : "stalled ", (const uint8_t*)request,
             sizeof *request);
    // A transfer in the wrong direction stalls the request.
    if (size != 0 ? write(endpoints.control, data, size) < 0 : read(endpoints.control, data, 0) < 0)
      return;
  } else {
    const ssize_t got = read(endpoints.control, data, size);
    char text[24];
    snprintf(text, sizeof text, "%02x%02x%04x ", request->bRequestType, request->bRequest,
             request->wValue);
    size = got < 0 ? 0 : (size_t)got;
    log_line("setup_out", now_ns(), text, data, size < kMaxPacket ? size : kMaxPacket);
  }
}

static _Noreturn void* control_thread(void* unused) {
  (void)unused;
  struct usb_functionfs_event event;
  for (;;) {
    // Wait by poll(): a read that waits would hold the lock that unplugging needs since Linux 6.12.
    struct pollfd wait = {endpoints.control, POLLIN, 0};
    if (poll(&wait, 1, -1) != 1 || !(wait.revents & POLLIN)) {
      usleep(1000);
      continue;
    }
    if (read(endpoints.control, &event, sizeof event) != sizeof event) {
      usleep(1000);
      continue;
    }
    if (event.type == FUNCTIONFS_ENABLE) sender_enable(true);
    if (event.type == FUNCTIONFS_DISABLE || event.type == FUNCTIONFS_UNBIND) sender_enable(false);
    if (event.type == FUNCTIONFS_SETUP) answer_setup(&event.u.setup);
  }
}

// Carries out a command. False: it was `quit`.
static bool obey(char* line) {
  char word[16] = "", whole[64];
  int used = 0;
  sscanf(line, "%15s %n", word, &used);
  if (strcmp(word, "quit") == 0) return false;
  if (strcmp(word, "plug") == 0 || strcmp(word, "unplug") == 0) {
    plug_gadget(port, word[0] == 'p');
    return true;
  }
  // Copied first, because the command may cut its text into words.
  snprintf(whole, sizeof whole, "done %.50s", line);
  pthread_mutex_lock(&pad_mutex);
  const bool done = sender_command(word, line + used);
  wake_sender();
  pthread_mutex_unlock(&pad_mutex);
  if (!done) memcpy(whole, "not ", 4);
  note("answer", whole);
  return true;
}

static void obey_commands(const char* folder) {
  char path[96], line[4096];
  size_t size = 0;
  snprintf(path, sizeof path, "%s/fifo", folder);
  unlink(path);
  if (mkfifo(path, 0600) != 0) die(path);
  const int fifo = open(path, O_RDWR);  // opened for writing as well, so that it has no end of file
  note("ready", pad.kind.name);
  for (;;) {
    struct pollfd wait = {fifo, POLLIN, 0};
    if (poll(&wait, 1, 20) == 0) {
      flush_log();
      continue;
    }
    const ssize_t got = read(fifo, line + size, sizeof line - 1 - size);
    if (got <= 0) continue;
    size += (size_t)got;
    line[size] = 0;
    char* end;
    while ((end = strchr(line, '\n')) != NULL) {
      *end = 0;
      if (!obey(line)) return;
      size -= (size_t)(end + 1 - line);
      memmove(line, end + 1, size + 1);
    }
    if (size == sizeof line - 1) size = 0;
  }
}

// The kind with the trace's ids, or else a plain HID pad; if its class is HID, it gets the trace's
// descriptor.
static struct pad_kind trace_kind(void) {
  const struct pad_kind* known = find_kind_by_id(trace.vendor, trace.product);
  struct pad_kind kind = known ? *known : *find_kind("generic");
  if (!known) kind.fields = NULL;
  kind.product = trace.name;
  kind.vendor = trace.vendor;
  kind.product_id = trace.product;
  kind.stream_rate_hz = 0;  // reports come from the trace alone
  if (kind.descriptor_size != 0) {
    kind.descriptor = trace.descriptor;
    kind.descriptor_size = trace.descriptor_size;
  }
  return kind;
}

static void make_pad(const char* kind_name) {
  const struct pad_kind* kind = find_kind(kind_name);
  if (!kind && strcmp(kind_name, "trace") != 0) {
    fprintf(stderr, "pad_gadget: unknown kind %s\n", kind_name);
    exit(2);
  }
  pad.kind = kind ? *kind : trace_kind();
  const uint8_t mac[] = {0x02, 0x52, 0x49, 0x47, (uint8_t)pad.kind.product_id, (uint8_t)(port + 1)};
  memcpy(pad.mac, mac, sizeof mac);
  memset(pad.user_flash, 0xff, sizeof pad.user_flash);
  pad.state.size = pad.kind.report_size;
  memcpy(pad.state.bytes, pad.kind.neutral, sizeof pad.kind.neutral);
}

int main(int count, char** arguments) {
  const char *serial = NULL, *trace_path = NULL;
  for (int i = 3; i + 1 < count; i += 2) {
    if (strcmp(arguments[i], "--serial") == 0) serial = arguments[i + 1];
    if (strcmp(arguments[i], "--trace") == 0) trace_path = arguments[i + 1];
  }
  if (count < 3 || (trace_path && !read_trace(trace_path, &trace)) ||
      (strcmp(arguments[1], "trace") == 0 && !trace_path)) {
    fprintf(stderr, "usage: pad_gadget KIND INDEX [--trace FILE.hid] [--serial TEXT]\n");
    return 2;
  }
  port = atoi(arguments[2]);
  make_pad(arguments[1]);

  char folder[64], path[96], own_serial[32];
  snprintf(folder, sizeof folder, "/run/rig/pad-%d", port);
  mkdir("/run/rig", 0755);
  mkdir(folder, 0755);
  snprintf(path, sizeof path, "%s/log", folder);
  open_log(path);
  snprintf(own_serial, sizeof own_serial, "RIG%04x-%d", pad.kind.product_id, port);
  endpoints = make_gadget(&pad.kind, port, serial ? serial : own_serial, folder);
  start_sender(&pad, endpoints.in, &trace);
  void* (*const threads[])(void*) = {control_thread, out_thread};
  for (size_t i = 0; i < 2; ++i) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, threads[i], NULL) != 0) die("thread");
    pthread_detach(thread);
  }
  obey_commands(folder);
  plug_gadget(port, false);
  flush_log();
  _exit(0);  // without the usual cleanup: threads may still be in the kernel
}
