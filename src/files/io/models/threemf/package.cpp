// SPDX-License-Identifier: Apache-2.0
// Unpacks parts piece by piece. The unpacked size is checked against a limit for archives of this size before memory is
// allocated: a kilobyte of zip can hold a megabyte of blanks.
#include "io/models/threemf/package.h"

#include <zip.h>

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "io/models/model_source.h"

namespace frontmost::threemf {
namespace {

// Models are 4 to 30 times as large as their archives. Each byte of the file allows 64 unpacked bytes; 256 MiB more are
// free.
constexpr std::uint64_t free_bytes = std::uint64_t(1) << 28, bytes_per_byte = 64;

struct CloseFile {
  void operator()(zip_file* file) const { zip_fclose(file); }
};

}  // namespace

std::string part_name(std::string_view reference) {
  std::string name(reference);
  std::replace(name.begin(), name.end(), '\\', '/');
  name.erase(0, std::min(name.find_first_not_of('/'), name.size()));
  return name;
}

std::string Package::key_of(const std::string& part) {
  std::string key = part_name(part);
  for (char& c : key)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return key;
}

void Package::Close::operator()(zip* archive) const { zip_discard(archive); }

Package::Package(Bytes bytes, const ModelSource& source)
    : source_(source), most_(free_bytes + bytes_per_byte * bytes.size()) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const contents = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (contents != nullptr) archive_.reset(zip_open_from_source(contents, ZIP_RDONLY, &error));
  if (!archive_) {
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    if (contents != nullptr) zip_source_free(contents);
    source.fail("zip archive", why + "; the file may have been cut short");
  }
  zip_error_fini(&error);
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i)
    // The first of several parts with one name counts.
    if (const char* const name = zip_get_name(archive_.get(), zip_uint64_t(i), ZIP_FL_ENC_RAW))
      numbers_.try_emplace(key_of(name), std::uint64_t(i));
}

std::uint64_t Package::number_of(const std::string& part) const {
  const auto found = numbers_.find(key_of(part));
  if (found == numbers_.end()) source_.fail(printable(part), "there is no such part in the archive");
  return found->second;
}

void Package::unpack(const std::string& part, const std::function<void(std::string_view, bool)>& receive) {
  const std::uint64_t number = number_of(part);
  const std::string place = printable(part);
  zip_stat_t stated;
  zip_stat_init(&stated);
  const bool is_stated = zip_stat_index(archive_.get(), number, 0, &stated) == 0 && (stated.valid & ZIP_STAT_SIZE) != 0;
  if (is_stated && stated.size > most_ - unpacked_)
    source_.fail_limit(place, "unpacks to " + std::to_string(stated.size) +
                                  " bytes, far more than an archive of this " + "size should hold");
  const std::unique_ptr<zip_file, CloseFile> file(zip_fopen_index(archive_.get(), number, 0));
  if (!file) source_.fail(place, zip_strerror(archive_.get()));
  std::vector<char> piece(std::size_t(1) << 16);
  const std::uint64_t before = unpacked_;
  for (;;) {
    check_cancelled(source_.execution());
    if (is_stated && stated.size > 0)
      report_progress(source_.execution(), "load", std::min(1.0, double(unpacked_ - before) / double(stated.size)));
    const zip_int64_t size = zip_fread(file.get(), piece.data(), piece.size());
    if (size < 0) source_.fail(place, std::string(zip_file_strerror(file.get())) + "; the archive is damaged");
    // Sizes stated in an archive may be wrong, so the unpacked bytes are counted.
    if (std::uint64_t(size) > most_ - unpacked_)
      source_.fail_limit(place, "unpacks to far more than an archive of this size should hold");
    unpacked_ += std::uint64_t(size);
    receive({piece.data(), std::size_t(size)}, size == 0);
    if (size == 0) return;
  }
}

}  // namespace frontmost::threemf
