// SPDX-License-Identifier: Apache-2.0
// Radiance pictures in the encodings that writers use: plain, with repeated pixels, and packed by component.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontmost::test {

/// Red, green, blue, exponent.
using RadiancePixel = std::array<std::uint8_t, 4>;
using RadianceRows = std::vector<std::vector<RadiancePixel>>;

inline std::string radiance_header(const std::string& size, const std::string& format = "32-bit_rle_rgbe") {
  return "#?RADIANCE\n# made for a test\nEXPOSURE=2.0\nFORMAT=" + format + "\n\n" + size + "\n";
}

inline std::string radiance_header(const RadianceRows& rows) {
  return radiance_header("-Y " + std::to_string(rows.size()) + " +X " + std::to_string(rows[0].size()));
}

inline std::string bytes_of(const RadiancePixel& pixel) { return {pixel.begin(), pixel.end()}; }

/// Every pixel by itself.
inline std::string plain_radiance(const RadianceRows& rows) {
  std::string bytes = radiance_header(rows);
  for (const auto& row : rows)
    for (const RadiancePixel& pixel : row) bytes += bytes_of(pixel);
  return bytes;
}

/// Runs of pixels, whose lengths are digits of base 256, lowest first.
inline std::string repeating_radiance(const RadianceRows& rows) {
  std::string bytes = radiance_header(rows);
  for (const auto& row : rows)
    for (std::size_t x = 0; x < row.size();) {
      std::size_t same = 1;
      while (x + same < row.size() && row[x + same] == row[x]) ++same;
      bytes += bytes_of(row[x]);
      for (std::size_t repeats = same - 1; repeats > 0; repeats >>= 8) bytes += {1, 1, 1, char(repeats & 0xFF)};
      x += same;
    }
  return bytes;
}

/// Runs of at most 127 bytes, and literals of up to 128 bytes.
inline std::string packed_radiance(const RadianceRows& rows) {
  std::string bytes = radiance_header(rows);
  for (const auto& row : rows) {
    bytes += {2, 2, char(row.size() >> 8), char(row.size() & 0xFF)};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t x = 0; x < row.size();) {
        const auto run_at = [&](std::size_t at) {
          std::size_t same = 1;
          while (at + same < row.size() && same < 127 && row[at + same][k] == row[at][k]) ++same;
          return same;
        };
        if (const std::size_t same = run_at(x); same >= 3) {
          bytes += {char(128 + same), char(row[x][k])};
          x += same;
          continue;
        }
        std::string values;
        for (; x < row.size() && values.size() < 128 && run_at(x) < 3; ++x) values += char(row[x][k]);
        bytes += char(values.size()) + values;
      }
  }
  return bytes;
}

}  // namespace frontmost::test
