// SPDX-License-Identifier: Apache-2.0
// Data URIs and percent escapes. The decoder is lenient where exporters are: both base64 alphabets are accepted,
// padding may be missing, and an invalid escape stays as text.
#include <array>
#include <cstdint>

#include "io/models/gltf/container.h"

namespace frontmost::gltf {
namespace {

constexpr std::uint8_t no_digit = 0xFF;

constexpr std::array<std::uint8_t, 256> make_base64_digits() {
  std::array<std::uint8_t, 256> digits{};
  for (std::uint8_t& digit : digits) digit = no_digit;
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    digits[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
  digits['-'] = 62;  // the URL-safe alphabet, which some exporters write
  digits['_'] = 63;
  return digits;
}

constexpr std::array<std::uint8_t, 256> base64_digits = make_base64_digits();

std::vector<std::byte> decode_base64(std::string_view text, const JsonValue& place) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) place.fail("base64 data end within a byte");
  std::vector<std::byte> out(text.size() / 4 * 3 + (text.size() % 4 == 0 ? 0 : text.size() % 4 - 1));
  std::uint32_t bits = 0;
  std::size_t written = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t digit = base64_digits[static_cast<unsigned char>(text[i])];
    if (digit == no_digit) place.fail("character " + std::to_string(i) + " of the base64 data is not in its alphabet");
    // Older digits fall off the top of the 32 bits; at most six bits wait for their byte.
    bits = bits << 6 | digit;
    // Six bits come in; whenever eight or more are held, the upper eight go out.
    if (i % 4 != 0) out[written++] = std::byte(bits >> (6 - 2 * (i % 4)));
  }
  return out;
}

// isxdigit() is not used, because it depends on the locale and is undefined for negative characters.
int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::vector<std::byte> decode_data_uri(std::string_view uri, const JsonValue& place) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) place.fail("a data URI without a comma");
  const std::string_view payload = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) return decode_base64(payload, place);
  const std::string decoded = percent_decode(payload);
  const auto* first = reinterpret_cast<const std::byte*>(decoded.data());
  return {first, first + decoded.size()};
}

std::string percent_decode(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    out += low >= 0 ? static_cast<char>(high * 16 + low) : text[i];
    if (low >= 0) i += 2;
  }
  return out;
}

}  // namespace frontmost::gltf
