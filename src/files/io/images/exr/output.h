// SPDX-License-Identifier: Apache-2.0
// Helpers that all writers of OpenEXR files share.
#pragma once

#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfPixelType.h>

#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/image.h"

namespace frontmost::detail {

/// A file in memory. The library goes back to fill in its table of offsets, which standard output does not allow.
class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(const std::string& name) : Imf::OStream(name.c_str()) {}

  void write(const char bytes[], int count) override {
    const std::size_t end = place_ + std::size_t(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + place_, bytes, std::size_t(count));
    place_ = end;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = std::size_t(place); }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t place_ = 0;
};

/// Calls `write` and turns exceptions of OpenEXR into an Error that begins with the file's name.
template <class Write>
void with_named_errors(const std::string& name, Write&& write) {
  try {
    write();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::unsupported, name, "EXR", error.what());
  }
}

[[nodiscard]] inline Imf::PixelType type_of(const Channel& channel) {
  return channel.is_integer() ? Imf::UINT : Imf::FLOAT;
}

}  // namespace frontmost::detail
