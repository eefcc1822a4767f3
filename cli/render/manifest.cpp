// SPDX-License-Identifier: Apache-2.0
#include "cli/render/manifest.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <frontmost/base.h>
#include <frontmost/files.h>
#include <frontmost/version.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "cli/failure.h"
#include "cli/json.h"

namespace frontmost::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view suffix = ".jsonl";
constexpr std::uint64_t most_manifest_bytes = std::uint64_t(1) << 30;

Json json_of(const FinishedView& view) {
  Json files = Json::array();
  for (const FinishedFile& file : view.files)
    files.push_back({{"path", file.path}, {"bytes", file.hash.bytes}, {"hash", digits_of_hash(file.hash.hash)}});
  return {{"view", view.number}, {"name", view.name}, {"key", digits_of_hash(view.key)}, {"files", std::move(files)}};
}

/// Returns a line of JSON. Invalid UTF-8 in file names is replaced, because JSON cannot hold it.
std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::uint64_t number_in(const Json& json) {
  if (!json.is_number_unsigned()) throw Error(ErrorCode::file_malformed, "not a number");
  return json.get<std::uint64_t>();
}

std::uint64_t hash_in(const Json& json) {
  const std::string& text = json.get_ref<const std::string&>();
  std::uint64_t hash = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 16)
    throw Error(ErrorCode::file_malformed, "not a hash");
  return hash;
}

FinishedView view_in(const Json& json) {
  FinishedView view{number_in(json.at("view")), json.at("name").get<std::string>(), hash_in(json.at("key")), {}};
  for (const Json& file : json.at("files"))
    view.files.push_back({file.at("path").get<std::string>(), {number_in(file.at("bytes")), hash_in(file.at("hash"))}});
  return view;
}

Manifest head_in(const Json& json) {
  (void)json.at("frontmost").get_ref<const std::string&>();
  const Json& shard = json.at("shard");
  return {hash_in(json.at("batch")),
          number_in(json.at("views")),
          {int(number_in(shard.at(0))), int(number_in(shard.at(1)))},
          {}};
}

/// Returns the result of `read` for the line, or nothing if the line is malformed.
template <class Read>
auto read_line(std::string_view line, const Read& read) -> std::optional<decltype(read(Json()))> {
  try {
    return read(Json::parse(line));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

[[noreturn]] void fail_to_write(const std::string& path) {
  const int code = errno;  // before strings are made: that may change it
  throw Error(ErrorCode::file_unwritable, path, "", "cannot write: " + std::generic_category().message(code));
}

}  // namespace

std::string manifest_name(const std::string& stem, const Shard& shard) {
  return fmt::format("{}.{}-of-{}{}", stem, shard.number, shard.count, suffix);
}

std::optional<std::string> stem_of_manifest(const std::string& file_name) {
  if (!file_name.ends_with(suffix)) return std::nullopt;
  const std::string name = file_name.substr(0, file_name.size() - suffix.size());
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0) return std::nullopt;
  const std::string_view count = std::string_view(name).substr(dot + 1);
  const std::size_t of = count.find("-of-");
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (of == std::string_view::npos || !is_number(count.substr(0, of)) || !is_number(count.substr(of + 4)))
    return std::nullopt;
  return name.substr(0, dot);
}

Manifest read_manifest(const std::string& path) {
  const std::string text = load_text(path, most_manifest_bytes);
  std::optional<Manifest> manifest;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;  // a truncated line
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    if (!manifest) {
      manifest = read_line(line, head_in);
      if (!manifest) break;
    } else if (auto view = read_line(line, view_in)) {
      manifest->finished.push_back(std::move(*view));
    }
  }
  if (!manifest) throw Error(ErrorCode::file_malformed, path, "line 1", "this is not a manifest that frontmost wrote");
  return std::move(*manifest);
}

void write_manifest(const Manifest& manifest, const std::string& path) {
  std::string text = line_of({{"frontmost", FRONTMOST_VERSION},
                              {"batch", digits_of_hash(manifest.batch)},
                              {"views", manifest.view_count},
                              {"shard", {manifest.shard.number, manifest.shard.count}}});
  for (const FinishedView& view : manifest.finished) text += line_of(json_of(view));
  const WritingFiles writing;
  save_text(text, path);
}

void append_to_manifest(const FinishedView& view, const std::string& path) {
  const std::string line = line_of(json_of(view));
  const WritingFiles writing;
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor < 0) fail_to_write(path);
  errno = 0;
  const ssize_t written = ::write(descriptor, line.data(), line.size());
  const int code = errno;
  ::close(descriptor);
  errno = code;
  // An incomplete line is an error; a later run writes it anew.
  if (written != ssize_t(line.size())) fail_to_write(path);
}

std::optional<std::string> changed_file(const FinishedView& view, const std::string& folder) {
  for (const FinishedFile& file : view.files) {
    const std::string path = (fs::path(folder) / file.path).string();
    std::error_code error;
    if (fs::file_size(path, error) != file.hash.bytes || error || hash_of_file(path) != file.hash) return path;
  }
  return std::nullopt;
}

}  // namespace frontmost::cli
