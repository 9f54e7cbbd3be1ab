// The kinds of virtual pads of the rig: their ids and descriptors, input reports and answers.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { kMaxPacket = 512, kMaxDescriptor = 4096, kUserFlash = 0x8010 };

struct packet {
  size_t size;
  uint8_t bytes[kMaxPacket];
};

// A little-endian bit field of the input report: the command `set lx=200` writes it by its name.
struct field {
  const char* name;
  uint16_t bit;
  uint8_t width;
};

struct pad;
struct pad_kind {
  const char *name, *manufacturer, *product;
  uint16_t vendor, product_id, version;
  uint8_t interface_class[3];
  uint8_t interval_ms;        // polling interval that the endpoints state
  uint16_t stream_rate_hz;    // rate at which reports are sent; 0: a report at each change only
  const uint8_t* descriptor;  // report descriptor; null: the pad has a vendor class
  size_t descriptor_size;
  const struct field* fields;
  struct field counter;  // field that counts the reports; width 0: there is none
  bool starts_asleep;    // sends input only after an OUT packet has woken it
  size_t report_size;
  uint8_t neutral[64];
  // Writes the reply to GET_REPORT of a feature and returns its size; 0 stalls the request.
  size_t (*feature)(const struct pad* pad, uint8_t id, uint8_t* reply);
  // Handles an OUT packet; true if `reply` is to be sent.
  bool (*answer)(struct pad* pad, const struct packet* out, struct packet* reply);
  // Writes the packet that is sent first when the pad is plugged in, and returns its size.
  size_t (*announce)(const struct pad* pad, uint8_t* packet);
};

// State shared by the pad's threads; pad_gadget.c locks it.
struct pad {
  struct pad_kind kind;
  uint8_t mac[6];  // the address, most significant byte first
  struct packet state;
  uint32_t counter;
  bool awake;
  uint8_t user_flash[48];  // Switch pads: flash memory from kUserFlash on with the user's
                           // calibration; ff where there is none
  bool refuses_features;
};

const struct pad_kind* find_kind(const char* name);
// Null: no kind has these ids.
const struct pad_kind* find_kind_by_id(uint16_t vendor, uint16_t product);
bool set_field(const struct pad_kind* kind, struct packet* report, const char* name, long value);
void write_bits(struct packet* report, struct field field, uint32_t value);
