// SPDX-License-Identifier: Apache-2.0
// An entry holds the whole question, the model's bytes included, so that its name may be a hash that others can match:
//
//   | magic | hash of all that follows | state of files | sizes | question | model | frames: files, warnings, space,
//   model |
//
// The state hashes path, size and time of every file of the importer (its program and libraries), which the answer
// names. Entries and folders of other users are not used: in a shared folder anybody could leave an answer. Entries are
// copied and not mapped, because another process may cut them short.
#include "io/models/import_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/output_file.h"
#include "base/word_hash.h"
#include "io/descriptor.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kEntryMagic = 0x31304D49'54534D46;  // changes with the layout, and with what frames mean

struct EntryHeader {
  std::uint64_t magic = 0, hash = 0, state = 0, question_size = 0, model_size = 0;
};

void add_to(WordHash& hash, Bytes bytes) {
  hash.add(bytes.size());
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), sizeof(std::uint64_t)))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
    hash.add(word);
  }
}

Bytes bytes_of_text(const std::string& text) { return std::as_bytes(std::span(text.data(), text.size())); }

/// A hash that changes with each of the files; none if one is missing, or if there are none.
std::optional<std::uint64_t> state_of(const std::vector<std::string>& files) {
  WordHash hash;
  for (const std::string& file : files) {
    struct ::stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    add_to(hash, bytes_of_text(file));
    for (const auto number :
         {std::uint64_t(status.st_size), std::uint64_t(status.st_mtim.tv_sec), std::uint64_t(status.st_mtim.tv_nsec)})
      hash.add(number);
  }
  return files.empty() ? std::nullopt : std::optional(hash.value());
}

std::uint64_t hash_of_entry(const EntryHeader& header, std::initializer_list<Bytes> parts) {
  WordHash hash;
  for (const std::uint64_t word : {header.state, header.question_size, header.model_size}) hash.add(word);
  for (const Bytes part : parts) add_to(hash, part);
  return hash.value();
}

/// The bytes of an ordinary file of this user; empty for anything else.
std::vector<std::byte> bytes_of_entry(const fs::path& path, std::uint64_t most) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct ::stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) ||
      status.st_uid != ::geteuid() || std::uint64_t(status.st_size) > most)
    return {};
  std::vector<std::byte> bytes(std::size_t(status.st_size));
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::read(file.number(), bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return {};
    done += std::size_t(got);
  }
  ::futimens(file.number(), nullptr);  // it was used now
  return bytes;
}

/// Paths that the first frames name.
std::vector<std::string> files_of(Bytes frames) {
  std::vector<std::string> files;
  while (frames.size() >= import_frames::header_bytes && char(frames[0]) == char(import_frames::Kind::file)) {
    const std::uint64_t size = import_frames::payload_size(frames.data());
    frames = frames.subspan(import_frames::header_bytes);
    if (size > frames.size()) return {};
    files.emplace_back(reinterpret_cast<const char*>(frames.data()), std::size_t(size));
    frames = frames.subspan(std::size_t(size));
  }
  return files;
}

std::vector<std::byte> frames_of(const ImportAnswer& answer) {
  using import_frames::Kind;
  std::vector<std::byte> frames;
  const auto add = [&](Kind kind, Bytes payload) {
    const import_frames::Header header = import_frames::header_of(kind, payload.size());
    const Bytes start = std::as_bytes(std::span(header));
    frames.insert(frames.end(), start.begin(), start.end());
    frames.insert(frames.end(), payload.begin(), payload.end());
  };
  for (const std::string& file : answer.files) add(Kind::file, bytes_of_text(file));
  for (const std::string& warning : answer.warnings) add(Kind::warning, bytes_of_text(warning));
  add(Kind::space, bytes_of_text(answer.space));
  add(Kind::model, answer.model);
  return frames;
}

}  // namespace

fs::path ImportCache::folder_of_user() {
  const char *const cache = std::getenv("XDG_CACHE_HOME"), *const home = std::getenv("HOME");
  fs::path base = cache != nullptr ? cache : "";
  // The standard of XDG: a path that is not absolute does not count.
  if (!base.is_absolute()) base = home != nullptr && *home == '/' ? fs::path(home) / ".cache" : fs::path();
  return base.empty() ? base : base / "frontmost" / "import";
}

ImportCache::ImportCache(fs::path folder, std::string question, Bytes model, std::uint64_t most)
    : folder_(std::move(folder)), question_(std::move(question)), model_(model), most_(most) {
  WordHash hash;
  add_to(hash, bytes_of_text(question_));
  add_to(hash, model_);
  char name[32];
  std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash.value()));
  entry_ = folder_ / name;
}

std::optional<std::vector<std::byte>> ImportCache::find() const {
  if (folder_.empty() || !has_safe_folder()) return std::nullopt;
  std::vector<std::byte> bytes = bytes_of_entry(entry_, most_);
  EntryHeader header;
  if (bytes.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kEntryMagic || header.question_size != question_.size() || header.model_size != model_.size() ||
      bytes.size() - sizeof header < question_.size() + model_.size())
    return std::nullopt;
  const Bytes rest = Bytes(bytes).subspan(sizeof header), question = rest.first(question_.size()),
              model = rest.subspan(question.size(), model_.size()),
              frames = rest.subspan(question.size() + model.size());
  if (!std::equal(question.begin(), question.end(), bytes_of_text(question_).begin()) ||
      !std::equal(model.begin(), model.end(), model_.begin()) ||
      header.hash != hash_of_entry(header, {question, model, frames}))
    return std::nullopt;
  if (state_of(files_of(frames)) != header.state) return std::nullopt;
  bytes.erase(bytes.begin(), bytes.end() - std::ptrdiff_t(frames.size()));
  return bytes;
}

void ImportCache::keep(const ImportAnswer& answer) const {
  const std::optional<std::uint64_t> state = state_of(answer.files);
  if (folder_.empty() || !state) return;
  const std::vector<std::byte> frames = frames_of(answer);
  EntryHeader header{kEntryMagic, 0, *state, question_.size(), model_.size()};
  const std::uint64_t size = sizeof header + question_.size() + model_.size() + frames.size();
  if (size > most_ / greatest_share) return;
  for (const fs::path& folder : {folder_.parent_path().parent_path(), folder_.parent_path(), folder_})
    ::mkdir(folder.c_str(), S_IRWXU);
  // Nothing is written through a link or into a pipe.
  std::error_code ignored;
  const fs::file_type type = fs::symlink_status(entry_, ignored).type();
  if (!has_safe_folder() || (type != fs::file_type::not_found && type != fs::file_type::regular)) return;
  header.hash = hash_of_entry(header, {bytes_of_text(question_), model_, frames});
  make_room(size);
  try {
    OutputFile file(entry_.string());
    for (const Bytes part : {std::as_bytes(std::span(&header, 1)), bytes_of_text(question_), model_, Bytes(frames)})
      file.write(part);
    file.commit();
  } catch (const Error&) {  // of a full disk, for example
  }
}

bool ImportCache::has_safe_folder() const {
  const auto is_own = [](const fs::path& folder) {
    struct ::stat status {};
    return ::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid();
  };
  return is_own(folder_.parent_path()) && is_own(folder_);
}

void ImportCache::make_room(std::uint64_t bytes) const {
  struct Entry {
    fs::file_time_type time;
    std::uint64_t size;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::error_code error;
  std::uint64_t total = bytes;
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    if (!fs::is_regular_file(at->symlink_status(gone))) continue;
    const Entry entry{at->last_write_time(gone), at->file_size(gone), at->path()};
    if (gone) continue;
    entries.push_back(entry);
    total += entry.size;
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (auto oldest = entries.begin(); total > most_ && oldest != entries.end(); ++oldest) {
    total -= oldest->size;
    fs::remove(oldest->path, error);
  }
}

}  // namespace frontmost
