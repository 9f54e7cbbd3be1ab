// Datagrams (UDP) to one address.
#pragma once
#include <string>
#include <string_view>

#include "gaitpad/result.h"
#include "system/descriptors.h"

namespace gaitpad {

// A socket that sends to this address alone and never waits. `host` is a name or an address of IPv4
// or IPv6. Error: `host` cannot be resolved, or nothing can be sent there.
Result<OwnedFd> datagram_socket(const std::string& host, int port);

// A datagram that cannot be sent is lost: a missing or slow receiver is no error.
void send_datagram(const OwnedFd& socket, std::string_view bytes) noexcept;

}  // namespace gaitpad
