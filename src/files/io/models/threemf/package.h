// SPDX-License-Identifier: Apache-2.0
// The zip archive of a 3MF file. Parts are found by name and unpacked piece by piece, so that no part is ever in memory
// as a whole.
//
//   _rels/.rels               says which part is the model
//   3D/3dmodel.model          the model: XML
//   3D/Objects/lid.model      a part that the model refers to
//   Metadata/...              not read
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>

#include "io/models/reader.h"

struct zip;

namespace frontmost::threemf {

/// A part's name without its leading slash, for messages and for this class: "3D/3dmodel.model".
[[nodiscard]] std::string part_name(std::string_view reference);

class Package {
 public:
  /// Borrows both. \throws Error file_malformed if the bytes are no zip archive, or a truncated one.
  Package(Bytes bytes, const ModelSource& source);

  [[nodiscard]] bool has(const std::string& part) const { return numbers_.count(key_of(part)) > 0; }

  /// Passes the contents of a part to `receive(text, is_last)`, some 64 KiB at a time. \throws Error file_malformed
  /// with the part's name (missing, encrypted, damaged), cancelled, and limit_exceeded before all parts together unpack
  /// to more than the limit for the file's size.
  void unpack(const std::string& part, const std::function<void(std::string_view, bool)>& receive);

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  [[nodiscard]] std::uint64_t number_of(const std::string& part) const;
  /// Normalises the case of a part's name, because names differ only without regard to case.
  [[nodiscard]] static std::string key_of(const std::string& part);

  const ModelSource& source_;
  std::unique_ptr<zip, Close> archive_;
  std::unordered_map<std::string, std::uint64_t> numbers_;  ///< in the archive, by key
  std::uint64_t most_, unpacked_ = 0;
};

/// The model's part, by the package's relationships or, if these name none, by its content types.
/// \throws Error file_malformed if no part is a model.
[[nodiscard]] std::string find_start_part(Package& package, const ModelSource& source);

}  // namespace frontmost::threemf
