// hidp_link HOST PAD VENDOR PRODUCT VERSION NAME DESCRIPTOR: a pad behind the Bluetooth controller
// hciPAD, connected to hciHOST and handed to the kernel's HIDP. Ids and descriptor are hexadecimal.
// Prints `ready ADDRESS`, then each packet that the host sends: `c HEX` on the control channel,
// `i HEX` on the interrupt channel. Lines of the same kind on standard input are sent to the host.
// The link is lost when standard input ends, and the program ends when the host drops it.
// Kernel interfaces: include/net/bluetooth/{hci_sock,l2cap}.h, net/bluetooth/hidp/hidp.h.
#include <errno.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

enum { kBluetooth = 31, kL2cap = 0, kHci = 1, kHidp = 6, kControlPsm = 17, kInterruptPsm = 19 };
enum { kScanBoth = 3, kMaxPacket = 1024, kMaxDescriptor = 4096 };
#define HCI_DEV_UP _IOW('H', 201, int)
#define HCI_DEV_INFO _IOR('H', 211, int)
#define HCI_SET_SCAN _IOW('H', 221, int)
#define HIDP_CONNECTION_ADD _IOW('H', 200, int)

struct address {  // a sockaddr_l2; its numbers are little-endian
  uint16_t family, psm;
  uint8_t bdaddr[6];
  uint16_t cid;
  uint8_t type;
};
struct device_request {
  uint16_t device;
  uint32_t option;
};
struct device_info {
  uint16_t device;
  char name[8];
  uint8_t bdaddr[6];
  uint8_t rest[256];
};
struct connection_request {
  int control, interrupt;
  uint16_t parser, descriptor_size;
  const uint8_t* descriptor;
  uint8_t country, subclass;
  uint16_t vendor, product, version;
  uint32_t flags, idle_s;
  char name[128];
};

static _Noreturn void die(const char* what) {
  fprintf(stderr, "hidp_link: %s: %s\n", what, strerror(errno));
  exit(1);
}

// Starts the controller, makes it discoverable and returns its address.
static struct address controller(int number) {
  const int hci = socket(kBluetooth, SOCK_RAW, kHci);
  if (hci < 0) die("no Bluetooth");
  if (ioctl(hci, HCI_DEV_UP, number) != 0 && errno != EALREADY) die("HCIDEVUP");
  const struct device_request scan = {(uint16_t)number, kScanBoth};
  if (ioctl(hci, HCI_SET_SCAN, &scan) != 0) die("HCISETSCAN");
  struct device_info info = {.device = (uint16_t)number};
  if (ioctl(hci, HCI_DEV_INFO, &info) != 0) die("HCIGETDEVINFO");
  close(hci);
  struct address address = {.family = kBluetooth};
  memcpy(address.bdaddr, info.bdaddr, sizeof info.bdaddr);
  return address;
}

static int bound(struct address address, uint16_t psm) {
  const int channel = socket(kBluetooth, SOCK_SEQPACKET, kL2cap);
  address.psm = psm;
  if (channel < 0 || bind(channel, (struct sockaddr*)&address, sizeof address) != 0) die("bind");
  return channel;
}

struct channel {
  int host, pad;
};

static struct channel connected(struct address host, struct address pad, uint16_t psm) {
  const int listener = bound(pad, psm);
  if (listen(listener, 1) != 0) die("listen");
  struct channel channel = {bound(host, 0), -1};
  pad.psm = psm;
  if (connect(channel.host, (struct sockaddr*)&pad, sizeof pad) != 0) die("connect");
  channel.pad = accept(listener, NULL, NULL);
  if (channel.pad < 0) die("accept");
  close(listener);
  return channel;
}

static size_t bytes_of(const char* hex, uint8_t* bytes, size_t most) {
  size_t size = 0;
  for (unsigned value; size < most && sscanf(hex, "%2x", &value) == 1; hex += 2)
    bytes[size++] = (uint8_t)value;
  return size;
}

// Prints a packet from the host. False: the host has dropped the link.
static int print_packet(int channel, char letter) {
  uint8_t bytes[kMaxPacket];
  const ssize_t size = recv(channel, bytes, sizeof bytes, 0);
  if (size <= 0) return 0;
  printf("%c ", letter);
  for (ssize_t i = 0; i < size; ++i) printf("%02x", bytes[i]);
  putchar('\n');
  return 1;
}

int main(int count, char** arguments) {
  if (count != 8) {
    fprintf(stderr, "usage: hidp_link HOST PAD VENDOR PRODUCT VERSION NAME DESCRIPTOR\n");
    return 2;
  }
  setvbuf(stdout, NULL, _IOLBF, 0);
  const struct address host = controller(atoi(arguments[1])), pad = controller(atoi(arguments[2]));
  const struct channel control = connected(host, pad, kControlPsm);
  const struct channel interrupt = connected(host, pad, kInterruptPsm);
  static uint8_t descriptor[kMaxDescriptor];
  struct connection_request request = {
      .control = control.host,
      .interrupt = interrupt.host,
      .parser = 0x0100,
      .descriptor_size = (uint16_t)bytes_of(arguments[7], descriptor, sizeof descriptor),
      .descriptor = descriptor,
      .vendor = (uint16_t)strtoul(arguments[3], NULL, 16),
      .product = (uint16_t)strtoul(arguments[4], NULL, 16),
      .version = (uint16_t)strtoul(arguments[5], NULL, 16)};
  snprintf(request.name, sizeof request.name, "%s", arguments[6]);
  const int hidp = socket(kBluetooth, SOCK_RAW, kHidp);
  if (hidp < 0 || ioctl(hidp, HIDP_CONNECTION_ADD, &request) != 0) die("HIDPCONNADD");
  close(control.host);  // the kernel keeps both channels open
  close(interrupt.host);
  printf("ready ");
  for (int i = 5; i >= 0; --i) printf("%02x%s", pad.bdaddr[i], i > 0 ? ":" : "\n");

  static char line[2 * kMaxPacket + 16];
  size_t used = 0;
  for (;;) {
    struct pollfd wait[] = {{0, POLLIN, 0}, {control.pad, POLLIN, 0}, {interrupt.pad, POLLIN, 0}};
    if (poll(wait, 3, -1) < 0) die("poll");
    if (wait[1].revents && !print_packet(control.pad, 'c')) return 0;
    if (wait[2].revents && !print_packet(interrupt.pad, 'i')) return 0;
    if (!wait[0].revents) continue;
    const ssize_t got = read(0, line + used, sizeof line - 1 - used);
    if (got <= 0) return 0;
    used += (size_t)got;
    line[used] = 0;
    for (char* end; (end = strchr(line, '\n')) != NULL;) {
      uint8_t bytes[kMaxPacket];
      const size_t size = bytes_of(line + 2, bytes, sizeof bytes);
      const int channel = line[0] == 'c' ? control.pad : interrupt.pad;
      if (send(channel, bytes, size, MSG_NOSIGNAL) < 0) return 0;
      used -= (size_t)(end + 1 - line);
      memmove(line, end + 1, used + 1);
    }
    if (used == sizeof line - 1) used = 0;
  }
}
