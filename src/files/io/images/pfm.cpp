// SPDX-License-Identifier: Apache-2.0
// Portable float maps: "PF" (three channels) or "Pf" (one), width and height, and a scale whose sign gives the byte
// order, each on a line of its own. Floats follow, the bottom row first.
#include <cctype>
#include <charconv>
#include <string_view>

#include "io/images/formats.h"
#include "io/images/raw_planes.h"

namespace frontmost::detail {
namespace {

[[noreturn]] void fail_pfm(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, name, "PFM", reason);
}

/// Takes words off the front of the file. Exactly one blank ends each word, because pixels may look like blanks.
class Header {
 public:
  Header(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::string_view word() {
    // A file of another format may hold no blank for megabytes.
    constexpr std::size_t longest = 64;
    const auto* text = reinterpret_cast<const char*>(bytes_.data());
    std::size_t end = 0;
    while (end < bytes_.size() && end < longest && !std::isspace(static_cast<unsigned char>(text[end]))) ++end;
    if (end == 0 || end == bytes_.size() || end == longest) fail_pfm(name_, "the header is cut short");
    bytes_ = bytes_.subspan(end + 1);
    return {text, end};
  }

  std::size_t size() {
    const std::string_view text = word();
    std::uint32_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || rest != text.data() + text.size()) fail_pfm(name_, "a size is not a number");
    return value;
  }

  [[nodiscard]] std::span<const std::byte> rest() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
};

}  // namespace

void save_pfm(const Image& image, OutputFile& file) {
  const std::size_t channels = image.channels.size();
  bool floats = true;
  for (const Channel& channel : image.channels) floats = floats && !channel.is_integer();
  if (!floats || (channels != 1 && channels != 3))
    throw Error(ErrorCode::unsupported, file.name(), "",
                "PFM holds one or three channels of floats, not " + channel_list(image));
  const std::string header = std::string(channels == 1 ? "Pf\n" : "PF\n") + std::to_string(image.width) + " " +
                             std::to_string(image.height) + "\n-1.0\n";
  file.write(std::as_bytes(std::span(header)));
  RawLayout layout{std::size_t(image.width), std::size_t(image.height), channels};
  layout.bottom_row_first = true;
  write_raw(image, layout, file);
}

Image load_pfm(std::span<const std::byte> bytes, const std::string& name) {
  Header header(bytes, name);
  RawLayout layout;
  // Other programs have extended the format, for example PF4 with four channels. A prefix match would misread such
  // files.
  const std::string_view kind = header.word();
  if (kind != "PF" && kind != "Pf") fail_pfm(name, "neither PF nor Pf");
  layout.channels = kind == "PF" ? 3 : 1;
  layout.width = header.size();
  layout.height = header.size();
  const std::string_view scale = header.word();
  // A scale of 0 is refused: its sign cannot give the byte order, because 0 and -0 are one number.
  if (scale.find_first_of("123456789") == std::string_view::npos) fail_pfm(name, "the scale is not a number");
  layout.big_endian = scale[0] != '-';  // the scale's size has no agreed meaning and is ignored
  layout.bottom_row_first = true;
  return read_raw(header.rest(), layout, name, "PFM");
}

}  // namespace frontmost::detail
