#include "pad_usb.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pad_log.h"

enum { kEndpointSize = 64 };

static char gadget[64];

static void write_file(const char* name, const char* format, ...) {
  char path[192], text[128];
  va_list arguments;
  va_start(arguments, format);
  const int size = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  snprintf(path, sizeof path, "%s/%s", gadget, name);
  const int file = open(path, O_WRONLY);
  if (file < 0 || write(file, text, (size_t)size) != size) die(path);
  close(file);
}

static void make_folder(const char* name) {
  char path[192];
  snprintf(path, sizeof path, "%s/%s", gadget, name);
  if (mkdir(path, 0755) != 0 && errno != EEXIST) die(path);
}

static void make_function(const char* function) {
  char from[192], to[192];
  make_folder("configs/c.1");
  make_folder(function);
  snprintf(from, sizeof from, "%s/%s", gadget, function);
  snprintf(to, sizeof to, "%s/configs/c.1/pad", gadget);
  if (symlink(from, to) != 0 && errno != EEXIST) die(to);
}

static size_t put(uint8_t* to, const void* from, size_t size) {
  memcpy(to, from, size);
  return size;
}

// Writes the descriptors for one speed: the interface, the HID class descriptor (not for vendor
// classes), IN and OUT endpoints.
static size_t put_speed(const struct pad_kind* kind, uint8_t* to, uint8_t interval) {
  const uint8_t* type = kind->interface_class;
  const uint8_t interface[] = {9, 4, 0, 0, 2, type[0], type[1], type[2], 0};
  const uint8_t hid[] = {9,
                         0x21,
                         0x11,
                         1,
                         0,
                         1,
                         0x22,
                         (uint8_t)kind->descriptor_size,
                         (uint8_t)(kind->descriptor_size >> 8)};
  const uint8_t in[] = {7, 5, 0x81, 3, kEndpointSize, 0, interval};
  const uint8_t out[] = {7, 5, 0x02, 3, kEndpointSize, 0, interval};
  size_t size = put(to, interface, sizeof interface);
  if (kind->descriptor_size != 0) size += put(to + size, hid, sizeof hid);
  size += put(to + size, in, sizeof in);
  return size + put(to + size, out, sizeof out);
}

static void describe(const struct pad_kind* kind, int control) {
  const uint32_t count = kind->descriptor_size != 0 ? 4 : 3;
  uint8_t high_interval = 4;  // at high speed the number n means 2^(n-1) eighths of a millisecond
  for (unsigned ms = kind->interval_ms; ms > 1; ms /= 2) ++high_interval;
  uint8_t text[256];
  uint32_t head[] = {FUNCTIONFS_DESCRIPTORS_MAGIC_V2, 0,
                     FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC, count, count};
  size_t size = sizeof head;
  size += put_speed(kind, text + size, kind->interval_ms);
  size += put_speed(kind, text + size, high_interval);
  head[1] = (uint32_t)size;
  memcpy(text, head, sizeof head);
  if (write(control, text, size) != (ssize_t)size) die("descriptors");
  const uint32_t no_strings[] = {FUNCTIONFS_STRINGS_MAGIC, 16, 0, 0};
  if (write(control, no_strings, sizeof no_strings) != sizeof no_strings) die("strings");
}

static int open_endpoint(const char* folder, const char* name) {
  char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  const int file = open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) die(path);
  return file;
}

struct endpoints make_gadget(const struct pad_kind* kind, int index, const char* serial,
                             const char* folder) {
  char mount_point[96], function[32];
  snprintf(gadget, sizeof gadget, "/sys/kernel/config/usb_gadget/pad%d", index);
  snprintf(function, sizeof function, "functions/ffs.pad%d", index);
  make_folder("");
  write_file("idVendor", "0x%04x", kind->vendor);
  write_file("idProduct", "0x%04x", kind->product_id);
  write_file("bcdDevice", "0x%04x", kind->version);
  write_file("bcdUSB", "0x0200");
  make_folder("strings/0x409");
  write_file("strings/0x409/manufacturer", "%s", kind->manufacturer);
  write_file("strings/0x409/product", "%s", kind->product);
  write_file("strings/0x409/serialnumber", "%s", serial);
  make_function(function);

  snprintf(mount_point, sizeof mount_point, "%s/ffs", folder);
  mkdir(mount_point, 0755);
  umount2(mount_point, MNT_DETACH);  // unmounts what a killed daemon has left
  if (mount(strchr(function, '.') + 1, mount_point, "functionfs", 0, NULL) != 0) die("functionfs");
  struct endpoints endpoints;
  endpoints.control = open_endpoint(mount_point, "ep0");
  describe(kind, endpoints.control);
  endpoints.in = open_endpoint(mount_point, "ep1");
  endpoints.out = open_endpoint(mount_point, "ep2");
  return endpoints;
}

void plug_gadget(int index, bool on) {
  char path[96], udc[32] = "\n";
  if (on) snprintf(udc, sizeof udc, "dummy_udc.%d", index);
  snprintf(path, sizeof path, "%s/UDC", gadget);
  const int file = open(path, O_WRONLY);
  if (!on) note("unplugging", "");
  const bool done = file >= 0 && write(file, udc, strlen(udc)) > 0;
  note(on ? "plug" : "unplug", done ? "" : strerror(errno));
  if (file >= 0) close(file);
}
