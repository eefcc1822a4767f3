// SPDX-License-Identifier: Apache-2.0
// Any bytes read as 3MF: an archive as it is, or else the texts of its parts, which get an archive around them, because
// mutations would never get past its checksums.
#pragma once

#include "support/reader_fuzz.h"
#include "support/threemf_maker.h"

namespace frontmost {

/// The parts of an input that is no archive are parted by zeros: the model, then "/a.model".
inline bool fuzz_3mf(std::string_view input) {
  const auto read = [](std::string_view bytes) {
    return fuzz_reader(ModelFormat::threemf, {reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()});
  };
  if (input.starts_with("PK")) return read(input);
  const std::size_t split = std::min(input.find('\0'), input.size());
  test::ZipMaker zip = test::package_of(std::string(input.substr(0, split)));
  if (split < input.size()) zip.add("a.model", std::string(input.substr(split + 1)));
  return read(zip.bytes());
}

}  // namespace frontmost
