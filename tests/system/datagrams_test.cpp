#include "system/datagrams.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <memory>

#include "tests/value_of.h"

namespace gaitpad {
namespace {

// A socket of this machine that receives.
class Receiver {
 public:
  Receiver() : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    ::getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  // The next datagram that has arrived; "none" if none has.
  std::string next() {
    std::array<char, 100> bytes{};
    const ssize_t count = ::recv(fd_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    return count < 0 ? "none" : std::string(bytes.data(), static_cast<std::size_t>(count));
  }
  int port = 0;

 private:
  OwnedFd fd_;
};

TEST(Datagrams, ArriveWholeOneByOne) {
  Receiver receiver;
  const OwnedFd socket = value_of(datagram_socket("127.0.0.1", receiver.port));
  send_datagram(socket, "a pose");
  send_datagram(socket, std::string_view("\0 next", 6));
  EXPECT_EQ(receiver.next(), "a pose");
  EXPECT_EQ(receiver.next(), std::string("\0 next", 6));
  EXPECT_EQ(receiver.next(), "none");
}

// The answer of the machine, "connection refused", would be the error of the next send().
TEST(Datagrams, AreLostWhileNoProgramReceivesThem) {
  auto receiver = std::make_unique<Receiver>();
  const int port = receiver->port;
  const OwnedFd socket = value_of(datagram_socket("127.0.0.1", port));
  receiver = nullptr;
  for (int i = 0; i < 3; ++i) send_datagram(socket, "a pose");
}

TEST(Datagrams, ABroadcastIsRefused) {
  EXPECT_EQ(cause_of(datagram_socket("255.255.255.255", 9)),
            "255.255.255.255:9: nothing can be sent there: Permission denied");
}

}  // namespace
}  // namespace gaitpad
