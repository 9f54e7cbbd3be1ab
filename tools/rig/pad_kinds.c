// Device facts: report layouts, sizes and replies of the real models; the descriptors are our own
// words for the same layouts. Stick calibration, feature replies and packets as Linux'
// hid-playstation, hid-nintendo and xpad read them.
#include "pad_kinds.h"

#include <string.h>

// Shorthands for items of descriptors.
#define PAGE(id) 0x05, id
#define USAGE(id) 0x09, id
#define REPORT_ID(id) 0x85, id
#define FIELDS(size, count, tag, flags) 0x75, size, 0x95, count, tag, flags
#define BYTES(count, tag) FIELDS(8, count, tag, 2)
#define REPORT(id, usage, count, tag) REPORT_ID(id), USAGE(usage), BYTES(count, tag)
#define INPUT 0x81
#define OUTPUT 0x91
#define FEATURE 0xb1
#define GAMEPAD PAGE(0x01), USAGE(0x05), 0xa1, 0x01
#define STICKS USAGE(0x30), USAGE(0x31), USAGE(0x32), USAGE(0x35)  // usages X Y Z Rz
#define VENDOR_PAGE 0x06, 0x00, 0xff
#define ZERO_TO_255 0x15, 0, 0x26, 0xff, 0
#define BUTTONS(count) \
  PAGE(0x09), 0x19, 1, 0x29, count, 0x15, 0, 0x25, 1, FIELDS(1, count, INPUT, 2)
// A hat: 0..7 clockwise from the top in steps of 45 degrees; other values mean released.
#define HAT                                                                      \
  PAGE(0x01), USAGE(0x39), 0x15, 0, 0x25, 7, 0x35, 0, 0x46, 0x3b, 1, 0x65, 0x14, \
      FIELDS(4, 1, INPUT, 0x42), 0x65, 0, 0x45, 0
#define DESCRIPTOR(array) .descriptor = array, .descriptor_size = sizeof array

// Calibration of the motion sensors, from byte 1: no bias, +-8000, speed 500, +-1 g = 8192. Zeros
// would make hid-sony divide by zero.
static size_t motion_calibration(uint8_t id, size_t size, uint8_t* reply) {
  static const int16_t values[17] = {0,   0,   0,    8000,  -8000, 8000,  -8000, 8000, -8000,
                                     500, 500, 8192, -8192, 8192,  -8192, 8192,  -8192};
  memset(reply, 0, size);
  reply[0] = id;
  for (size_t i = 0; i < 17; ++i) {
    reply[1 + 2 * i] = (uint8_t)values[i];
    reply[2 + 2 * i] = (uint8_t)((uint16_t)values[i] >> 8);
  }
  return size;
}

// The MAC address after the report id, least significant byte first.
static size_t mac_report(const struct pad* pad, uint8_t id, size_t size, uint8_t* reply) {
  memset(reply, 0, size);
  reply[0] = id;
  for (int i = 0; i < 6; ++i) reply[1 + i] = pad->mac[5 - i];
  return size;
}

// --- generic: no report id, triggers on the simulation page, four vendor bytes for numbers
// clang-format off
static const uint8_t generic_descriptor[] = {
    GAMEPAD, ZERO_TO_255, STICKS, BYTES(4, INPUT), PAGE(0x02), USAGE(0xc5), USAGE(0xc4),
    BYTES(2, INPUT), HAT, BUTTONS(12), VENDOR_PAGE, ZERO_TO_255, USAGE(0x20),
    BYTES(4, INPUT), 0xc0};
static const struct field generic_fields[] = {
    {"lx", 0, 8}, {"ly", 8, 8}, {"rx", 16, 8}, {"ry", 24, 8}, {"lt", 32, 8}, {"rt", 40, 8},
    {"hat", 48, 4}, {"buttons", 52, 12}, {"a", 52, 1}, {"b", 53, 1}, {"x", 54, 1}, {"y", 55, 1},
    {"button5", 56, 1}, {"button6", 57, 1}, {"button7", 58, 1}, {"button8", 59, 1},
    {"button9", 60, 1}, {"button10", 61, 1}, {"button11", 62, 1}, {"button12", 63, 1}, {0}};
// clang-format on

// --- DualShock 4
// clang-format off
static const uint8_t ds4_descriptor[] = {
    GAMEPAD, REPORT_ID(1), ZERO_TO_255, STICKS, BYTES(4, INPUT), HAT, BUTTONS(14),
    VENDOR_PAGE, USAGE(0x20), 0x25, 0x3f, FIELDS(6, 1, 0x81, 2), PAGE(0x01), ZERO_TO_255,
    USAGE(0x33), USAGE(0x34), BYTES(2, INPUT), VENDOR_PAGE, USAGE(0x21), BYTES(54, INPUT),
    REPORT(0x05, 0x22, 31, OUTPUT), REPORT(0x02, 0x24, 36, FEATURE),
    REPORT(0x12, 0x25, 15, FEATURE), REPORT(0x81, 0x26, 6, FEATURE),
    REPORT(0xa3, 0x27, 48, FEATURE), 0xc0};
static const struct field ds4_fields[] = {
    {"lx", 8, 8}, {"ly", 16, 8}, {"rx", 24, 8}, {"ry", 32, 8}, {"lt", 64, 8}, {"rt", 72, 8},
    {"hat", 40, 4}, {"x", 44, 1}, {"a", 45, 1}, {"b", 46, 1}, {"y", 47, 1}, {"buttons", 44, 14},
    {"leftshoulder", 48, 1}, {"rightshoulder", 49, 1}, {"back", 52, 1}, {"start", 53, 1},
    {"leftstick", 54, 1}, {"rightstick", 55, 1}, {"guide", 56, 1}, {"touchpad", 57, 1}, {0}};
// clang-format on

static size_t ds4_feature(const struct pad* pad, uint8_t id, uint8_t* reply) {
  switch (id) {
    case 0x02:
      return motion_calibration(id, 37, reply);
    case 0x12:
      return mac_report(pad, id, 16, reply);
    case 0x81:
      return mac_report(pad, id, 7, reply);
    case 0xa3: {  // firmware's date and version
      memset(reply, 0, 49);
      reply[0] = id;
      memcpy(reply + 1, "Jan  1 2020\0\0\0\0\00012:00:00", 24);
      reply[35] = 0x00, reply[36] = 0xa0;  // hardware version
      reply[41] = 0x0a;
      return 49;
    }
    default:
      return 0;
  }
}

// --- DualSense
// clang-format off
static const uint8_t dualsense_descriptor[] = {
    GAMEPAD, REPORT_ID(1), ZERO_TO_255, STICKS, USAGE(0x33), USAGE(0x34), BYTES(6, INPUT),
    VENDOR_PAGE, USAGE(0x20), BYTES(1, INPUT), HAT, BUTTONS(15), VENDOR_PAGE,
    USAGE(0x21), FIELDS(1, 13, 0x81, 2), USAGE(0x22), ZERO_TO_255, BYTES(52, INPUT),
    REPORT(0x02, 0x23, 47, OUTPUT), REPORT(0x05, 0x24, 40, FEATURE),
    REPORT(0x09, 0x25, 19, FEATURE), REPORT(0x20, 0x26, 63, FEATURE), 0xc0};
static const struct field dualsense_fields[] = {
    {"lx", 8, 8}, {"ly", 16, 8}, {"rx", 24, 8}, {"ry", 32, 8}, {"lt", 40, 8}, {"rt", 48, 8},
    {"hat", 64, 4}, {"x", 68, 1}, {"a", 69, 1}, {"b", 70, 1}, {"y", 71, 1}, {"buttons", 68, 15},
    {"leftshoulder", 72, 1}, {"rightshoulder", 73, 1}, {"back", 76, 1}, {"start", 77, 1},
    {"leftstick", 78, 1}, {"rightstick", 79, 1}, {"guide", 80, 1}, {"touchpad", 81, 1},
    {"misc1", 82, 1}, {0}};
// clang-format on

static size_t dualsense_feature(const struct pad* pad, uint8_t id, uint8_t* reply) {
  switch (id) {
    case 0x05:
      return motion_calibration(id, 41, reply);
    case 0x09:
      return mac_report(pad, id, 20, reply);
    case 0x20:
      memset(reply, 0, 64);
      reply[0] = id;
      reply[24] = 0x14, reply[28] = 0x01;  // versions of hardware and firmware
      reply[44] = 0x24, reply[45] = 0x02;  // update 2.36: the newer vibration flag
      return 64;
    default:
      return 0;
  }
}

// --- Switch Pro: 12-bit sticks whatever the descriptor says; commands answered by content
// clang-format off
static const uint8_t switch_descriptor[] = {
    PAGE(0x01), USAGE(0x04), 0xa1, 0x01, REPORT_ID(0x30), BUTTONS(14), 0x95, 2, 0x81, 3,
    PAGE(0x01), USAGE(0x01), 0xa1, 0x00, STICKS, 0x15, 0, 0x27, 0xff, 0xff, 0, 0,
    FIELDS(16, 4, 0x81, 2), 0xc0, HAT, PAGE(0x09), 0x19, 15, 0x29, 18, 0x15, 0, 0x25, 1,
    FIELDS(1, 4, 0x81, 2), FIELDS(8, 52, 0x81, 3), VENDOR_PAGE, ZERO_TO_255,
    REPORT(0x21, 1, 63, INPUT), REPORT(0x81, 2, 63, INPUT), REPORT(0x01, 3, 63, OUTPUT),
    REPORT(0x10, 4, 63, OUTPUT), REPORT(0x80, 5, 63, OUTPUT), REPORT(0x82, 6, 63, OUTPUT), 0xc0};
static const struct field switch_fields[] = {
    {"lx", 48, 12}, {"ly", 60, 12}, {"rx", 72, 12}, {"ry", 84, 12}, {"lt", 47, 1},
    {"rt", 31, 1}, {"y", 24, 1}, {"x", 25, 1}, {"b", 26, 1}, {"a", 27, 1}, {"buttons", 24, 24},
    {"rightshoulder", 30, 1}, {"back", 32, 1}, {"start", 33, 1}, {"rightstick", 34, 1},
    {"leftstick", 35, 1}, {"guide", 36, 1}, {"misc1", 37, 1}, {"dpdown", 40, 1}, {"dpup", 41, 1},
    {"dpright", 42, 1}, {"dpleft", 43, 1}, {"leftshoulder", 46, 1}, {0}};
// clang-format on

// The flash memory that hosts read: stick calibration of the factory, of the user (none: ff), dead
// zones, IMU. Left: distance to the top, centre, distance to the bottom; right: centre, bottom,
// top; 12 bits a number.
static uint8_t switch_flash(const struct pad* pad, uint32_t address) {
  static const uint8_t sticks[18] = {0x00, 0x06, 0x60, 0x00, 0x08, 0x80, 0x00, 0x06, 0x60,
                                     0x00, 0x08, 0x80, 0x00, 0x06, 0x60, 0x00, 0x06, 0x60};
  static const uint8_t imu[24] = {0, 0, 0, 0, 0, 0, 0,    0x40, 0,    0x40, 0,    0x40,
                                  0, 0, 0, 0, 0, 0, 0x3b, 0x34, 0x3b, 0x34, 0x3b, 0x34};
  if (address >= 0x603d && address < 0x603d + sizeof sticks) return sticks[address - 0x603d];
  if (address >= 0x6020 && address < 0x6020 + sizeof imu) return imu[address - 0x6020];
  if (address >= kUserFlash && address < kUserFlash + sizeof pad->user_flash)
    return pad->user_flash[address - kUserFlash];
  return 0xff;
}

static void switch_subcommand(struct pad* pad, const struct packet* out, struct packet* reply) {
  const uint8_t command = out->bytes[10], *data = out->bytes + 11;
  uint8_t* r = reply->bytes;
  r[0] = 0x21;
  r[1] = (uint8_t)pad->counter++;
  memcpy(r + 2, pad->state.bytes + 2, 10);  // battery, buttons, sticks
  r[13] = 0x80;
  r[14] = command;
  if (command == 0x02) {  // device info: firmware, Pro Controller, MAC
    r[13] = 0x82;
    memcpy(r + 15, (const uint8_t[]){0x03, 0x48, 0x03, 0x02}, 4);
    memcpy(r + 19, pad->mac, 6);
    r[25] = r[26] = 1;
    // Sets the input mode: 30 streams, 3f reports changes in another format.
  } else if (command == 0x03) {
    pad->awake = data[0] == 0x30;
  } else if (command == 0x10) {  // reads flash memory
    const uint32_t address =
        data[0] | data[1] << 8 | (uint32_t)data[2] << 16 | (uint32_t)data[3] << 24;
    r[13] = 0x90;
    memcpy(r + 15, data, 5);
    for (uint32_t i = 0; i < data[4] && 20 + i < reply->size; ++i)
      r[20 + i] = switch_flash(pad, address + i);
  }
}

static bool switch_answer(struct pad* pad, const struct packet* out, struct packet* reply) {
  memset(reply->bytes, 0, 64);
  reply->size = 64;
  if (out->bytes[0] == 0x80) {
    const uint8_t command = out->bytes[1];
    if (command == 0x04) pad->awake = true;  // keeps using USB; has no reply
    if (command == 0x05) pad->awake = false;
    reply->bytes[0] = 0x81;
    reply->bytes[1] = command;
    if (command == 0x01) {
      reply->bytes[3] = 0x03;
      for (int i = 0; i < 6; ++i) reply->bytes[4 + i] = pad->mac[i];
    }
    return command >= 0x01 && command <= 0x03;
  }
  if (out->bytes[0] != 0x01 || out->size < 11) return false;
  switch_subcommand(pad, out, reply);
  return true;
}

// --- Xbox 360, wired
// clang-format off
static const struct field xbox360_fields[] = {
    {"lx", 48, 16}, {"ly", 64, 16}, {"rx", 80, 16}, {"ry", 96, 16}, {"lt", 32, 8},
    {"rt", 40, 8}, {"a", 28, 1}, {"b", 29, 1}, {"x", 30, 1}, {"y", 31, 1}, {"buttons", 16, 16},
    {"dpup", 16, 1}, {"dpdown", 17, 1}, {"dpleft", 18, 1}, {"dpright", 19, 1}, {"start", 20, 1},
    {"back", 21, 1}, {"leftstick", 22, 1}, {"rightstick", 23, 1}, {"leftshoulder", 24, 1},
    {"rightshoulder", 25, 1}, {"guide", 26, 1}, {0}};
// clang-format on

// --- Xbox One S, wired: silent until it is powered on
// clang-format off
static const struct field xboxone_fields[] = {
    {"lx", 80, 16}, {"ly", 96, 16}, {"rx", 112, 16}, {"ry", 128, 16}, {"lt", 48, 16},
    {"rt", 64, 16}, {"a", 36, 1}, {"b", 37, 1}, {"x", 38, 1}, {"y", 39, 1}, {"buttons", 32, 16},
    {"start", 34, 1}, {"back", 35, 1}, {"dpup", 40, 1}, {"dpdown", 41, 1}, {"dpleft", 42, 1},
    {"dpright", 43, 1}, {"leftshoulder", 44, 1}, {"rightshoulder", 45, 1}, {"leftstick", 46, 1},
    {"rightstick", 47, 1}, {0}};
// clang-format on

static size_t xboxone_announce(const struct pad* pad, uint8_t* packet) {
  memset(packet, 0, 32);
  memcpy(packet, (const uint8_t[]){0x02, 0x20, 0x01, 0x1c}, 4);
  memcpy(packet + 4, pad->mac, 6);
  packet[12] = 0x5e, packet[13] = 0x04, packet[14] = 0xea, packet[15] = 0x02;
  return 32;
}

static bool xboxone_answer(struct pad* pad, const struct packet* out, struct packet* reply) {
  (void)reply;
  if (out->size >= 5 && out->bytes[0] == 0x05 && out->bytes[1] == 0x20 && out->bytes[4] == 0x00)
    pad->awake = true;
  return false;
}

// --- Xbox Series, wired: packets of 48 bytes, the share button in byte 22 (Linux' xpad.c)
// clang-format off
static const struct field xboxseries_fields[] = {
    {"lx", 80, 16}, {"ly", 96, 16}, {"rx", 112, 16}, {"ry", 128, 16}, {"lt", 48, 16},
    {"rt", 64, 16}, {"a", 36, 1}, {"b", 37, 1}, {"x", 38, 1}, {"y", 39, 1},
    {"start", 34, 1}, {"back", 35, 1}, {"dpup", 40, 1}, {"dpdown", 41, 1}, {"dpleft", 42, 1},
    {"dpright", 43, 1}, {"leftshoulder", 44, 1}, {"rightshoulder", 45, 1}, {"leftstick", 46, 1},
    {"rightstick", 47, 1}, {"misc1", 176, 1}, {0}};
// clang-format on

// --- DualShock 3 on USB: buttons by bits, their pressure by bytes (Linux' hid-sony.c)
// clang-format off
static const uint8_t ds3_descriptor[] = {
    PAGE(0x01), USAGE(0x04), 0xa1, 0x01, REPORT_ID(1), FIELDS(8, 1, INPUT, 3),
    PAGE(0x09), 0x19, 1, 0x29, 0x13, 0x15, 0, 0x25, 1, FIELDS(1, 19, INPUT, 2),
    FIELDS(1, 13, INPUT, 3), PAGE(0x01), STICKS, ZERO_TO_255, BYTES(4, INPUT),
    USAGE(0x01), ZERO_TO_255, BYTES(39, INPUT), VENDOR_PAGE,
    REPORT_ID(1), USAGE(0x30), BYTES(48, OUTPUT), REPORT(0xf2, 0x31, 16, FEATURE),
    REPORT(0xf5, 0x32, 7, FEATURE), 0xc0};
static const struct field ds3_fields[] = {
    {"lx", 48, 8}, {"ly", 56, 8}, {"rx", 64, 8}, {"ry", 72, 8}, {"lt", 144, 8}, {"rt", 152, 8},
    {"back", 16, 1}, {"leftstick", 17, 1}, {"rightstick", 18, 1}, {"start", 19, 1},
    {"dpup", 20, 1}, {"dpright", 21, 1}, {"dpdown", 22, 1}, {"dpleft", 23, 1},
    {"leftshoulder", 26, 1}, {"rightshoulder", 27, 1}, {"y", 28, 1}, {"b", 29, 1}, {"a", 30, 1},
    {"x", 31, 1}, {"guide", 32, 1}, {0}};
// clang-format on

// f2: the pad's address from byte 4; f5: the address of the paired host.
static size_t ds3_feature(const struct pad* pad, uint8_t id, uint8_t* reply) {
  if (id != 0xf2 && id != 0xf5) return 0;
  memset(reply, 0, 17);
  reply[0] = id;
  if (id == 0xf2) memcpy(reply + 4, pad->mac, 6);
  return id == 0xf2 ? 17 : 8;
}

// --- Nintendo's adapter for GameCube controllers, one in the first plug (SDL's
// SDL_hidapi_gamecube.c): silent until it is asked
// clang-format off
static const uint8_t gamecube_descriptor[] = {
    PAGE(0x05), USAGE(0x00), 0xa1, 0x01, ZERO_TO_255,
    REPORT(0x11, 0x00, 5, OUTPUT), REPORT(0x21, 0x00, 36, INPUT), REPORT(0x12, 0x00, 1, INPUT),
    REPORT(0x22, 0x00, 25, INPUT), REPORT(0x13, 0x00, 1, OUTPUT), REPORT(0x23, 0x00, 2, INPUT),
    0xc0};
static const struct field gamecube_fields[] = {
    {"a", 16, 1}, {"b", 17, 1}, {"x", 18, 1}, {"y", 19, 1}, {"dpleft", 20, 1}, {"dpright", 21, 1},
    {"dpdown", 22, 1}, {"dpup", 23, 1}, {"start", 24, 1}, {"rightshoulder", 25, 1},
    {"lx", 32, 8}, {"ly", 40, 8}, {"rx", 48, 8}, {"ry", 56, 8}, {"lt", 64, 8}, {"rt", 72, 8},
    {0}};
// clang-format on

static bool gamecube_answer(struct pad* pad, const struct packet* out, struct packet* reply) {
  (void)reply;
  if (out->size >= 1 && out->bytes[0] == 0x13) pad->awake = true;
  return false;
}

static const struct pad_kind kinds[] = {
    {.name = "generic",
     .manufacturer = "Rig",
     .product = "Test Pad",
     .vendor = 0x1209,
     .product_id = 0x0001,
     .version = 0x0100,
     .interface_class = {3, 0, 0},
     .interval_ms = 1,
     .fields = generic_fields,
     DESCRIPTOR(generic_descriptor),
     .report_size = 12,
     .neutral = {0x80, 0x80, 0x80, 0x80, 0, 0, 0x08}},
    {.name = "ds4",
     .manufacturer = "Sony Interactive Entertainment",
     .product = "Wireless Controller",
     .vendor = 0x054c,
     .product_id = 0x09cc,
     .version = 0x0100,
     .interface_class = {3, 0, 0},
     .interval_ms = 4,
     .stream_rate_hz = 250,
     .fields = ds4_fields,
     .counter = {"", 58, 6},
     DESCRIPTOR(ds4_descriptor),
     .report_size = 64,
     .feature = ds4_feature,
     .neutral = {1, 0x80, 0x80, 0x80, 0x80, 0x08, [30] = 0x1b, [35] = 0x80, [39] = 0x80}},
    {.name = "dualsense",
     .manufacturer = "Sony Interactive Entertainment",
     .product = "DualSense Wireless Controller",
     .vendor = 0x054c,
     .product_id = 0x0ce6,
     .version = 0x0100,
     .interface_class = {3, 0, 0},
     .interval_ms = 4,
     .stream_rate_hz = 250,
     .fields = dualsense_fields,
     .counter = {"", 56, 8},
     DESCRIPTOR(dualsense_descriptor),
     .report_size = 64,
     .feature = dualsense_feature,
     .neutral = {1, 0x80, 0x80, 0x80, 0x80, [8] = 0x08, [33] = 0x80, [37] = 0x80, [53] = 0x18}},
    {.name = "switch",
     .manufacturer = "Nintendo Co., Ltd.",
     .product = "Pro Controller",
     .vendor = 0x057e,
     .product_id = 0x2009,
     .version = 0x0200,
     .interface_class = {3, 0, 0},
     .interval_ms = 8,
     .stream_rate_hz = 125,
     .fields = switch_fields,
     .counter = {"", 8, 8},
     .starts_asleep = true,
     DESCRIPTOR(switch_descriptor),
     .report_size = 64,
     .answer = switch_answer,
     .neutral = {0x30, 0, 0x8e, [6] = 0x00, 0x08, 0x80, 0x00, 0x08, 0x80}},
    {.name = "xbox360",
     .manufacturer = "Microsoft",
     .product = "Controller",
     .vendor = 0x045e,
     .product_id = 0x028e,
     .version = 0x0114,
     .interface_class = {0xff, 0x5d, 1},
     .interval_ms = 4,
     .fields = xbox360_fields,
     .report_size = 20,
     .neutral = {0x00, 0x14}},
    {.name = "xboxone",
     .manufacturer = "Microsoft",
     .product = "Controller",
     .vendor = 0x045e,
     .product_id = 0x02ea,
     .version = 0x0301,
     .interface_class = {0xff, 0x47, 0xd0},
     .interval_ms = 4,
     .fields = xboxone_fields,
     .counter = {"", 16, 8},
     .starts_asleep = true,
     .report_size = 18,
     .answer = xboxone_answer,
     .announce = xboxone_announce,
     .neutral = {0x20, 0x00, 0x00, 0x0e}},
    {.name = "xboxseries",
     .manufacturer = "Microsoft",
     .product = "Xbox Wireless Controller",
     .vendor = 0x045e,
     .product_id = 0x0b12,
     .version = 0x0507,
     .interface_class = {0xff, 0x47, 0xd0},
     .interval_ms = 4,
     .fields = xboxseries_fields,
     .counter = {"", 16, 8},
     .starts_asleep = true,
     .report_size = 48,
     .answer = xboxone_answer,
     .announce = xboxone_announce,
     .neutral = {0x20, 0x00, 0x00, 0x2c}},
    {.name = "powera",  // 20d6:2001 is in xpad's table
     .manufacturer = "PowerA",
     .product = "Xbox Series X EnWired",
     .vendor = 0x20d6,
     .product_id = 0x2001,
     .version = 0x0101,
     .interface_class = {0xff, 0x47, 0xd0},
     .interval_ms = 4,
     .fields = xboxone_fields,
     .counter = {"", 16, 8},
     .starts_asleep = true,
     .report_size = 18,
     .answer = xboxone_answer,
     .announce = xboxone_announce,
     .neutral = {0x20, 0x00, 0x00, 0x0e}},
    {.name = "f310x",  // Logitech F310 with its switch at X
     .manufacturer = "Logitech",
     .product = "Gamepad F310",
     .vendor = 0x046d,
     .product_id = 0xc21d,
     .version = 0x4014,
     .interface_class = {0xff, 0x5d, 1},
     .interval_ms = 4,
     .fields = xbox360_fields,
     .report_size = 20,
     .neutral = {0x00, 0x14}},
    {.name = "edge",
     .manufacturer = "Sony Interactive Entertainment",
     .product = "DualSense Edge Wireless Controller",
     .vendor = 0x054c,
     .product_id = 0x0df2,
     .version = 0x0100,
     .interface_class = {3, 0, 0},
     .interval_ms = 4,
     .stream_rate_hz = 250,
     .fields = dualsense_fields,
     .counter = {"", 56, 8},
     DESCRIPTOR(dualsense_descriptor),
     .report_size = 64,
     .feature = dualsense_feature,
     .neutral = {1, 0x80, 0x80, 0x80, 0x80, [8] = 0x08, [33] = 0x80, [37] = 0x80, [53] = 0x18}},
    {.name = "ds3",
     .manufacturer = "Sony",
     .product = "PLAYSTATION(R)3 Controller",
     .vendor = 0x054c,
     .product_id = 0x0268,
     .version = 0x0100,
     .interface_class = {3, 0, 0},
     .interval_ms = 10,
     .stream_rate_hz = 100,
     .fields = ds3_fields,
     DESCRIPTOR(ds3_descriptor),
     .report_size = 49,
     .feature = ds3_feature,
     .neutral = {1, [6] = 0x80, 0x80, 0x80, 0x80, [30] = 0xee}},
    {.name = "gamecube",
     .manufacturer = "Nintendo",
     .product = "WUP-028",
     .vendor = 0x057e,
     .product_id = 0x0337,
     .version = 0x0100,
     .interface_class = {3, 0, 0},
     .interval_ms = 8,
     .stream_rate_hz = 125,
     .fields = gamecube_fields,
     .starts_asleep = true,
     DESCRIPTOR(gamecube_descriptor),
     .report_size = 37,
     .answer = gamecube_answer,
     .neutral = {0x21, 0x14, 0x00, 0x00, 0x80, 0x80, 0x80, 0x80, 0, 0,
                 0x04, [19] = 0x04, [28] = 0x04}},
};

const struct pad_kind* find_kind(const char* name) {
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
    if (strcmp(kinds[i].name, name) == 0) return &kinds[i];
  return NULL;
}

const struct pad_kind* find_kind_by_id(uint16_t vendor, uint16_t product) {
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
    if (kinds[i].vendor == vendor && kinds[i].product_id == product) return &kinds[i];
  return NULL;
}

void write_bits(struct packet* report, struct field field, uint32_t value) {
  for (unsigned i = 0; i < field.width; ++i) {
    const unsigned bit = field.bit + i;
    if (bit / 8 >= report->size) return;
    const uint8_t mask = (uint8_t)(1u << bit % 8);
    if (value >> i & 1)
      report->bytes[bit / 8] |= mask;
    else
      report->bytes[bit / 8] &= (uint8_t)~mask;
  }
}

bool set_field(const struct pad_kind* kind, struct packet* report, const char* name, long value) {
  for (const struct field* field = kind->fields; field && field->name; ++field) {
    if (strcmp(field->name, name) != 0) continue;
    write_bits(report, *field, (uint32_t)value);
    return true;
  }
  return false;
}
