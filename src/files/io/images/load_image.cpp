// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "io/images/formats.h"
#include "io/input_file.h"

namespace frontmost {

Image load_image(const std::string& path) {
  if (path == "-") {
    const InputFile file = InputFile::standard_input("standard input");
    return load_image(file.bytes(), "standard input");
  }
  const InputFile file = InputFile::open(path, path);
  return load_image(file.bytes(), path);
}

Image load_image(std::span<const std::byte> bytes, const std::string& name) {
  using namespace std::string_view_literals;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG\r\n\x1a\n"sv)) return detail::load_png(bytes, name);
  if (text.starts_with("\x76\x2f\x31\x01"sv)) return detail::load_exr(bytes, name);
  if (text.starts_with("\x93NUMPY"sv)) return detail::load_npy(bytes, name);
  if (text.starts_with("PF"sv) || text.starts_with("Pf"sv)) return detail::load_pfm(bytes, name);
  if (text.starts_with("#?"sv)) return detail::load_radiance(bytes, name);
  throw Error(ErrorCode::file_malformed, name, "", "neither PNG nor OpenEXR, Radiance, PFM or NPY");
}

}  // namespace frontmost
