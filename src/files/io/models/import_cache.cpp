// SPDX-License-Identifier: Apache-2.0
// An entry holds the whole question, the model's bytes included, so that its name may be a hash that others can match:
//
//   | magic | hash of all that follows | state of files | sizes | question | model | frames: files, warnings, space,
//   model |
//
// The question is the program, its words, and the variables of the environment that choose libraries and settings of
// OpenCASCADE. The state hashes path, size, number and times of the files that made the answer: the program, its
// libraries, which the answer names, and the lists of the dynamic loader.
//
// Entries and folders that others may write are not used: anybody could leave an answer there. Entries are copied and
// not mapped, because another process may cut them short.
#include "io/models/import_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <tuple>

#include "base/output_file.h"
#include "base/word_hash.h"
#include "io/descriptor.h"

extern char** environ;  // NOLINT: of the system

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

/// Names of an entry: sixteen hexadecimal digits; and of an entry that is being written, as OutputFile makes them.
constexpr std::size_t kNameDigits = 16;

bool is_entry_name(std::string_view name) {
  return name.size() == kNameDigits && name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_unfinished_name(std::string_view name) {
  return name.size() > kNameDigits + 1 && name[0] == '.' && is_entry_name(name.substr(1, kNameDigits)) &&
         name[kNameDigits + 1] == '.' && name.ends_with(".tmp");
}

/// Whether nobody but this user can write the file or folder.
bool is_private(const struct ::stat& status) {
  return status.st_uid == ::geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

bool is_private_folder(const fs::path& folder) {
  struct ::stat status {};
  return ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && is_private(status);
}

/// Makes a folder in a folder of this user. Another user's home, as under sudo, is left alone.
void make_folder(const fs::path& folder) {
  struct ::stat parent {};
  if (::stat(folder.parent_path().c_str(), &parent) == 0 && parent.st_uid == ::geteuid())
    ::mkdir(folder.c_str(), S_IRWXU);
}

/// The variables by which the dynamic loader chooses libraries, and OpenCASCADE its settings; sorted.
std::vector<std::string> choosing_variables() {
  std::vector<std::string> found;
  for (char** at = environ; at != nullptr && *at != nullptr; ++at) {
    const std::string_view variable = *at;
    if (variable.starts_with("LD_") || variable.starts_with("CSF_") || variable.starts_with("CASROOT="))
      found.emplace_back(variable);
  }
  std::sort(found.begin(), found.end());
  return found;
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
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) || !is_private(status) ||
      std::uint64_t(status.st_size) > most)
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

ImportCache::ImportCache(fs::path folder, const std::vector<std::string>& words, Bytes model, std::uint64_t most)
    : folder_(std::move(folder)), model_(model), most_(most) {
  if (model_.size() > most_ / greatest_share) folder_.clear();
  if (folder_.empty()) return;
  ::clock_gettime(CLOCK_REALTIME_COARSE, &start_);  // the clock of file systems
  std::error_code error;
  program_ = fs::canonical(words.at(0), error).string();
  if (error) program_ = words[0];
  const auto ask = [&](const std::string& word) { question_ += word + '\0'; };
  ask(program_);
  std::for_each(words.begin() + 1, words.end(), ask);
  for (const std::string& variable : choosing_variables()) ask(variable);
  WordHash hash;
  add_to(hash, bytes_of_text(question_));
  add_to(hash, model_);
  char name[kNameDigits + 1];
  std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash.value()));
  entry_ = folder_ / name;
}

std::optional<std::vector<std::byte>> ImportCache::find() const try {
  if (folder_.empty() || !is_private_folder(folder_.parent_path()) || !is_private_folder(folder_)) return std::nullopt;
  std::vector<std::byte> bytes = bytes_of_entry(entry_, most_ / greatest_share);
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
  if (state_of(files_of(frames), false) != header.state) return std::nullopt;
  bytes.erase(bytes.begin(), bytes.end() - std::ptrdiff_t(frames.size()));
  return bytes;
} catch (const std::exception&) {  // no memory for an entry: the importer, which needs less here, reads the file
  return std::nullopt;
}

void ImportCache::keep(const ImportAnswer& answer) const try {
  if (!folder_.empty()) write(answer);
} catch (const std::exception&) {  // of a full disk, or for want of memory: the answer is good, although it is not kept
}

void ImportCache::write(const ImportAnswer& answer) const {
  const std::optional<std::uint64_t> state = state_of(answer.files, true);
  const std::uint64_t most = most_ / greatest_share;
  if (!state || answer.model.size() > most) return;
  const std::vector<std::byte> frames = frames_of(answer);
  EntryHeader header{kEntryMagic, 0, *state, question_.size(), model_.size()};
  const std::uint64_t size = sizeof header + question_.size() + model_.size() + frames.size();
  if (size > most) return;
  for (const fs::path& folder : {folder_.parent_path().parent_path(), folder_.parent_path(), folder_})
    make_folder(folder);
  if (!is_private_folder(folder_.parent_path()) || !is_private_folder(folder_)) return;
  header.hash = hash_of_entry(header, {bytes_of_text(question_), model_, frames});
  make_room(size);
  // Whatever is there goes first, so that nothing is written through a link or into a pipe, and permissions are new.
  if (::unlink(entry_.c_str()) != 0 && errno != ENOENT) return;
  OutputFile file(entry_.string(), OutputFile::Staging::best, S_IRUSR | S_IWUSR);
  for (const Bytes part : {std::as_bytes(std::span(&header, 1)), bytes_of_text(question_), model_, Bytes(frames)})
    file.write(part);
  file.commit();
}

/// A hash that changes with the program, each of the files and the loader's lists. None if a file is missing, if the
/// answer names no files or too many, and, `are_old`, if one is not older than this object. The number of the device is
/// no part: it changes whenever a container starts.
std::optional<std::uint64_t> ImportCache::state_of(const std::vector<std::string>& files, bool are_old) const {
  if (files.empty() || files.size() > ImportAnswer::most_files) return std::nullopt;
  WordHash hash;
  const auto add = [&](const std::string& file, bool is_needed) {
    struct ::stat status {};
    const bool is_there = ::stat(file.c_str(), &status) == 0;
    const timespec &content = status.st_mtim, &change = status.st_ctim;
    add_to(hash, bytes_of_text(file));
    for (const std::uint64_t number :
         {std::uint64_t(is_there), std::uint64_t(status.st_size), std::uint64_t(status.st_ino),
          std::uint64_t(content.tv_sec), std::uint64_t(content.tv_nsec), std::uint64_t(change.tv_sec),
          std::uint64_t(change.tv_nsec)})
      hash.add(number);
    const bool is_old = std::tie(change.tv_sec, change.tv_nsec) < std::tie(start_.tv_sec, start_.tv_nsec);
    return (is_there || !is_needed) && (is_old || !are_old);
  };
  bool is_known = add(program_, true);
  for (const std::string& file : files) is_known = add(file, true) && is_known;
  for (const char* const list : {"/etc/ld.so.cache", "/etc/ld.so.preload"}) is_known = add(list, false) && is_known;
  return is_known ? std::optional(hash.value()) : std::nullopt;
}

void ImportCache::make_room(std::uint64_t bytes) const {
  struct Entry {
    fs::file_time_type time;
    std::uint64_t size;
    fs::path path;
  };
  constexpr auto longest_writing = std::chrono::hours(1);
  std::vector<Entry> entries;
  std::error_code error;
  std::uint64_t total = bytes;
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    if (!fs::is_regular_file(at->symlink_status(gone))) continue;
    const Entry entry{at->last_write_time(gone), at->file_size(gone), at->path()};
    if (gone) continue;
    const std::string name = entry.path.filename().string();
    if (is_unfinished_name(name) && entry.time < fs::file_time_type::clock::now() - longest_writing)
      fs::remove(entry.path, gone);  // of a process that was killed
    if (!is_entry_name(name)) continue;
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
