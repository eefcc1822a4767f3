// SPDX-License-Identifier: Apache-2.0
// Bytes out: files that are whole or not there at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace frontmost {

/// A file being written. Until commit() nothing is seen at its place, and a file that was there stays as it is;
/// destruction without commit() leaves no trace.
///
/// Where the file system can (O_TMPFILE), the bytes are kept in a file without a name, so that not even a killed
/// process leaves something behind; otherwise in a hidden one beside the target. Symbolic links are followed: the file
/// that they lead to is replaced, not the link. A replaced file's permissions are kept, a new one's follow the umask.
/// "-" is standard output; it, devices and pipes are written to directly.
class OutputFile {
 public:
  enum class Staging { best, named };

  /// \throws Error file_unwritable, as all members do.
  explicit OutputFile(const std::string& path, Staging staging = Staging::best);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void commit();

  /// What stands for the file in messages.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  enum class Kind { standard_output, direct, unnamed, named };

  [[noreturn]] void fail(const char* doing) const;
  void open_direct();
  void open_staged(Staging staging);
  bool open_unnamed();
  void open_named();
  void give_name();
  void close();

  std::string name_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< exists as long as this is not empty
  std::optional<unsigned> mode_;     ///< of the file that is replaced
  Kind kind_ = Kind::direct;
  int descriptor_ = -1;
};

}  // namespace frontmost
