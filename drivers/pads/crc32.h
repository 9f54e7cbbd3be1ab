// The checksum of Sony's Bluetooth reports: CRC-32 as in Ethernet (polynomial 04c11db7, reflected,
// start and end inverted), over one byte for the direction and then the report.
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace gaitpad {

constexpr std::array<std::uint32_t, 256> crc32_table() noexcept {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    table[byte] = crc;
  }
  return table;
}
inline constexpr std::array<std::uint32_t, 256> kCrc32Table = crc32_table();

// The checksum of these bytes. `before`: the checksum of the bytes before them; 0: none.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes,
                              std::uint32_t before = 0) noexcept {
  std::uint32_t crc = ~before;
  for (const std::uint8_t byte : bytes) crc = (crc >> 8) ^ kCrc32Table[(crc ^ byte) & 0xffu];
  return ~crc;
}

}  // namespace gaitpad
