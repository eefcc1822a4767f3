// SPDX-License-Identifier: Apache-2.0
// The zip archive that a 3MF file is: its parts by name, unpacked piece by piece, so that no part is ever in memory as
// a whole.
//
//   _rels/.rels               which part is the model
//   3D/3dmodel.model          the model: XML
//   3D/Objects/lid.model      a part that the model refers to
//   Metadata/...              nobody asks
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>

#include "io/models/reader.h"

struct zip;

namespace frontmost::threemf {

/// A part's name without the slash before it, as messages and this class have it: "3D/3dmodel.model".
[[nodiscard]] std::string part_name(std::string_view reference);

class Package {
 public:
  /// Borrows both. \throws Error file_malformed for what is no zip archive, or one that was cut short.
  Package(Bytes bytes, const ModelSource& source);

  [[nodiscard]] bool has(const std::string& part) const { return numbers_.count(key_of(part)) > 0; }

  /// Hands the contents of a part to `receive(text, is_last)`, some 64 KiB at a time.
  /// \throws Error file_malformed with the part's name (not there, encrypted, damaged), cancelled, and limit_exceeded
  /// before all parts together unpack to far more than the file's size can mean.
  void unpack(const std::string& part, const std::function<void(std::string_view, bool)>& receive);

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  [[nodiscard]] std::uint64_t number_of(const std::string& part) const;
  /// Parts are told apart without case.
  [[nodiscard]] static std::string key_of(const std::string& part);

  const ModelSource& source_;
  std::unique_ptr<zip, Close> archive_;
  std::unordered_map<std::string, std::uint64_t> numbers_;  ///< in the archive, by key
  std::uint64_t most_, unpacked_ = 0;
};

/// By the package's relationships or, where they name none, its content types.
/// \throws Error file_malformed where no part is a model.
[[nodiscard]] std::string find_start_part(Package& package, const ModelSource& source);

}  // namespace frontmost::threemf
