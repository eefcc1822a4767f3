// SPDX-License-Identifier: Apache-2.0
// Answers of importers that are kept: when the importer runs again, and entries that are broken or malicious.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "frontmost/frontmost.h"
#include "io/import/impostor.h"
#include "io/models/import_cache.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string binary_frame(char kind, const std::string& payload) {
  const import_frames::Header header = import_frames::header_of(import_frames::Kind(kind), payload.size());
  return std::string(header.begin(), header.end()) + payload;
}

/// A triangle as binary glTF.
std::string glb_of_triangle() {
  const ScratchFolder folder;
  Scene scene;
  scene.meshes.emplace_back();
  scene.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  scene.meshes[0].triangles = {{0, 1, 2}};
  scene.instances.emplace_back();
  save(scene, folder.file("triangle.glb"));
  return read_text(folder.file("triangle.glb"));
}

/// Waits until files that were written are older than whatever begins now.
void settle() { usleep(20'000); }

/// An importer that counts its runs and always answers with a triangle.
class CountedImporter {
 public:
  /// `made_by`: frames that name the importer's files; by default its own file.
  explicit CountedImporter(std::optional<std::string> made_by = std::nullopt)
      : script_("echo run >> \"$0.runs\"; cat > /dev/null; cat \"$0.answer\"") {
    write_text(script_ / "import.answer", made_by.value_or(binary_frame('f', script_ / "import")) +
                                              binary_frame('p', "0.5") + binary_frame('w', "a \x1b[31mred face") +
                                              binary_frame('s', "0.0254 -x") + binary_frame('m', glb_of_triangle()));
  }
  /// Loads the part, which must be the triangle. \returns how often the importer has run so far.
  [[nodiscard]] int runs_after_loading(const ImportOptions& import = {}) const {
    settle();
    LoadOptions options;
    options.import = import;
    const Scene scene = load(script_.part(), options);
    EXPECT_EQ(triangle_count(scene), 1u);
    EXPECT_EQ(scene.meshes.at(0).positions.at(2), glm::vec3(0, 2, 0));
    EXPECT_EQ(scene.source.metres_per_unit, 0.0254);
    EXPECT_EQ(scene.source.format, ModelFormat::step);
    EXPECT_EQ(scene.up, Axis::minus_x);
    EXPECT_EQ(scene.name, "part");
    EXPECT_THAT(scene.warnings, ElementsAre(script_.part() + ": a \\x1B[31mred face"));
    const std::string runs = read_text(script_ / "import.runs");
    return int(std::count(runs.begin(), runs.end(), '\n'));
  }
  [[nodiscard]] std::vector<fs::path> entries() const { return script_.importer().entries(); }
  [[nodiscard]] fs::path folder() const { return script_.importer().folder(); }
  [[nodiscard]] std::string program() const { return script_ / "import"; }
  [[nodiscard]] std::string part() const { return script_.part(); }
  /// The cache as load() uses it for the part.
  [[nodiscard]] ImportCache cache(Bytes model) const {
    return {folder(), {program(), "step", "0", "0.20943951023931953", std::to_string(ImportOptions().bytes)}, model};
  }

 private:
  Impostor script_;
};

TEST(ImportCache, AFileIsTessellatedOnce) {
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading(), 1);
  EXPECT_EQ(importer.runs_after_loading(), 1);
  EXPECT_EQ(importer.entries().size(), 1u);
  // Time and threads do not change an answer.
  EXPECT_EQ(importer.runs_after_loading({.seconds = 10}), 1);
  EXPECT_EQ(triangle_count(load(importer.part(), {}, {.threads = 1})), 1u);
  EXPECT_EQ(importer.runs_after_loading(), 1);
  // Whatever changes an answer does.
  EXPECT_EQ(importer.runs_after_loading({.tolerance = 0.5}), 2);
  EXPECT_EQ(importer.runs_after_loading({.angle = 0.5}), 3);
  EXPECT_EQ(importer.runs_after_loading({.tolerance = 0.5}), 3);
  EXPECT_EQ(importer.runs_after_loading({.angle = 0.5}), 3);
  EXPECT_EQ(importer.entries().size(), 3u);
  write_text(importer.part(), "ISO-10303-21; another");
  EXPECT_EQ(importer.runs_after_loading(), 4);
  // The name of the file does not.
  fs::copy_file(importer.part(), importer.part() + ".stp");
  EXPECT_EQ(triangle_count(load(importer.part() + ".stp")), 1u);
  EXPECT_EQ(importer.runs_after_loading(), 4);
}

TEST(ImportCache, AnswersWithLessMemoryAreNotThoseWithMore) {
  // OpenCASCADE leaves out faces for which it finds no memory.
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading({.bytes = std::uint64_t(1) << 30}), 1);
  EXPECT_EQ(importer.runs_after_loading({.bytes = std::uint64_t(2) << 30}), 2);
  EXPECT_EQ(importer.runs_after_loading({.bytes = std::uint64_t(1) << 30}), 2);
}

TEST(ImportCache, OtherLibrariesMayBeLoadedInAnotherEnvironment) {
  const CountedImporter importer;
  int runs = importer.runs_after_loading();
  for (const char* const name : {"LD_LIBRARY_PATH", "LD_PRELOAD", "CSF_StandardDefaults", "CASROOT"}) {
    SCOPED_TRACE(name);
    const char* const before = std::getenv(name);
    const std::optional<std::string> value = before ? std::optional<std::string>(before) : std::nullopt;
    setenv(name, std::string(name) == "LD_PRELOAD" ? "" : "/somewhere/else", 1);
    if (!before || std::string(name) != "LD_PRELOAD") {
      EXPECT_EQ(importer.runs_after_loading(), ++runs);
    }
    EXPECT_EQ(importer.runs_after_loading(), runs);
    unsetenv(name);
    if (value) setenv(name, value->c_str(), 1);
    EXPECT_EQ(importer.runs_after_loading(), runs) << "as before";
  }
}

TEST(ImportCache, ProgramsAreKnownByTheirFiles) {
  // A script in front of the importer, which the answer does not name.
  const ScratchFolder folder;
  write_text(folder.file("library"), "library");
  const CountedImporter importer(binary_frame('f', folder.file("library")));
  int runs = importer.runs_after_loading();
  std::ofstream(importer.program(), std::ios::app) << "# version 2\n";
  EXPECT_EQ(importer.runs_after_loading(), ++runs);
  // One path, by way of which the program is another.
  fs::create_directory_symlink(fs::path(importer.program()).parent_path(), folder.file("link"));
  setenv("FRONTMOST_IMPORT", folder.file("link/import").c_str(), 1);
  EXPECT_EQ(importer.runs_after_loading(), runs);
  fs::remove(folder.file("link"));
  const CountedImporter other(binary_frame('f', folder.file("library")));
  fs::create_directory_symlink(fs::path(other.program()).parent_path(), folder.file("link"));
  setenv("FRONTMOST_IMPORT", folder.file("link/import").c_str(), 1);
  EXPECT_EQ(other.runs_after_loading(), 1);
}

TEST(ImportCache, AChangedLibraryReadsAgain) {
  const ScratchFolder folder;
  const std::string library = folder.file("library");
  write_text(library, "library 1");
  const CountedImporter importer(binary_frame('f', library));
  int runs = importer.runs_after_loading();
  EXPECT_EQ(importer.runs_after_loading(), runs);
  // With the same size and time.
  const auto time = fs::last_write_time(library);
  write_text(library, "library 2");
  fs::last_write_time(library, time);
  EXPECT_EQ(importer.runs_after_loading(), ++runs);
  EXPECT_EQ(importer.runs_after_loading(), runs);
}

TEST(ImportCache, LibrariesThatChangeMeanwhileMadeAnUnknownAnswer) {
  const ScratchFolder folder;
  const std::string library = folder.file("library");
  write_text(library, "library 1");
  settle();
  const std::string model = "model";
  const Importer importer("none");
  const ImportCache cache(importer.folder(), {library}, std::as_bytes(std::span(model)));
  write_text(library, "library 2");
  ImportAnswer answer;
  answer.files = {library};
  cache.keep(answer);
  EXPECT_TRUE(importer.entries().empty());
  settle();
  const ImportCache later(importer.folder(), {library}, std::as_bytes(std::span(model)));
  answer.files.assign(ImportAnswer::most_files + 1, library);
  later.keep(answer);
  EXPECT_TRUE(importer.entries().empty()) << "further files may have been cut off";
  answer.files.pop_back();
  later.keep(answer);
  EXPECT_EQ(importer.entries().size(), 1u);
}

TEST(ImportCache, CanBeSwitchedOff) {
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading({.cache = false}), 1);
  EXPECT_TRUE(importer.entries().empty());
  EXPECT_EQ(importer.runs_after_loading(), 2);
  EXPECT_EQ(importer.runs_after_loading({.cache = false}), 3);
  EXPECT_EQ(importer.runs_after_loading(), 3);
}

TEST(ImportCache, ANewImporterOrLibraryReadsAgain) {
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading(), 1);
  std::ofstream(importer.program(), std::ios::app) << "# version 2\n";
  EXPECT_EQ(importer.runs_after_loading(), 2);
  EXPECT_EQ(importer.runs_after_loading(), 2);
  fs::last_write_time(importer.program(), fs::last_write_time(importer.program()) - std::chrono::seconds(1));
  EXPECT_EQ(importer.runs_after_loading(), 3);
  EXPECT_EQ(importer.entries().size(), 1u) << "the old answer is replaced";
}

TEST(ImportCache, AnswersThatNameNoFilesAreNotKept) {
  const CountedImporter nothing("");
  EXPECT_EQ(nothing.runs_after_loading(), 1);
  EXPECT_EQ(nothing.runs_after_loading(), 2);
  EXPECT_TRUE(nothing.entries().empty());
  const CountedImporter missing(binary_frame('f', "/missing/library.so"));
  EXPECT_EQ(missing.runs_after_loading(), 1);
  EXPECT_EQ(missing.runs_after_loading(), 2);
  EXPECT_TRUE(missing.entries().empty());
}

TEST(ImportCache, BrokenEntriesAreReadAgain) {
  const CountedImporter importer;
  int runs = importer.runs_after_loading();
  const std::string whole = read_text(importer.entries().at(0).string());
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 40) {
    write_text(importer.entries().at(0).string(), whole.substr(0, size));
    EXPECT_EQ(importer.runs_after_loading(), ++runs) << size;
  }
  for (std::size_t at = 0; at < whole.size(); at += 1 + at / 8) {
    std::string broken = whole;
    broken[at] ^= char(1 << at % 8);
    write_text(importer.entries().at(0).string(), broken);
    EXPECT_EQ(importer.runs_after_loading(), ++runs) << at;
  }
  write_text(importer.entries().at(0).string(), whole + "x");
  EXPECT_EQ(importer.runs_after_loading(), ++runs);
  EXPECT_EQ(importer.runs_after_loading(), runs);
}

TEST(ImportCache, MaliciousEntriesAreReadAgain) {
  const CountedImporter importer;
  int runs = importer.runs_after_loading();
  const std::string part = read_text(importer.part());
  const ImportCache cache = importer.cache(std::as_bytes(std::span(part)));
  ASSERT_TRUE(cache.find()) << "the test must know the question";
  const std::string glb = glb_of_triangle();
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    std::string model = i == 0 ? "glTF is not this" : i == 1 ? "" : glb;
    for (int change = 0; i > 1 && change < 3; ++change) {
      const auto at = std::size_t(random.below(int(model.size())));
      if (change == 0) model[at] = char(random.below(256));
      if (change == 1 && i % 2 == 0) model.resize(at);
    }
    ImportAnswer answer;
    answer.files = {importer.program()};
    answer.space = "0.0254 -x";
    answer.warnings = {"a \x1b[31mred face"};
    const auto bytes = std::as_bytes(std::span(model));
    answer.model.assign(bytes.begin(), bytes.end());
    cache.keep(answer);
    // A changed number may be a model nevertheless.
    LoadOptions options;
    const Scene scene = load(importer.part(), options);
    EXPECT_NO_THROW(validate(scene));
    if (i < 2) {
      EXPECT_EQ(importer.runs_after_loading(), ++runs);
    }
  }
}

TEST(ImportCache, NothingIsWrittenThroughLinksOrPipes) {
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading(), 1);
  const fs::path entry = importer.entries().at(0), precious = importer.part() + ".txt";
  write_text(precious.string(), "precious");
  fs::remove(entry);
  fs::create_symlink(precious, entry);
  EXPECT_EQ(importer.runs_after_loading(), 2);
  EXPECT_EQ(read_text(precious.string()), "precious");
  fs::remove(entry);
  ASSERT_EQ(mkfifo(entry.c_str(), 0600), 0);
  EXPECT_EQ(importer.runs_after_loading(), 3);
  fs::remove(entry);
  fs::create_directory(entry);
  EXPECT_EQ(importer.runs_after_loading(), 4);
}

TEST(ImportCache, FoldersOfOthersAreNotUsed) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder to another user";
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading(), 1);
  ASSERT_EQ(chown(importer.entries().at(0).c_str(), 1, 1), 0);
  EXPECT_EQ(importer.runs_after_loading(), 2) << "an entry of another user";
  EXPECT_EQ(importer.runs_after_loading(), 2) << "which is replaced";
  ASSERT_EQ(chown(importer.folder().c_str(), 1, 1), 0);
  EXPECT_EQ(importer.runs_after_loading(), 3);
  EXPECT_EQ(importer.runs_after_loading(), 4);
}

TEST(ImportCache, FoldersThatOthersMayWriteAreNotUsed) {
  const CountedImporter importer;
  int runs = importer.runs_after_loading();
  struct ::stat status {};
  ASSERT_EQ(::stat(importer.entries().at(0).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  for (const fs::path& folder : {importer.folder(), importer.folder().parent_path()}) {
    for (const mode_t mode : {0770, 0707}) {
      chmod(folder.c_str(), mode);
      EXPECT_EQ(importer.runs_after_loading(), ++runs) << folder << mode;
    }
    chmod(folder.c_str(), 0755);
    EXPECT_EQ(importer.runs_after_loading(), runs) << "others may read";
  }
  chmod(importer.entries().at(0).c_str(), 0660);
  EXPECT_EQ(importer.runs_after_loading(), ++runs);
  // A folder in another place, by way of a link.
  const ScratchFolder elsewhere;
  fs::rename(importer.folder(), elsewhere.file("import"));
  fs::create_directory_symlink(elsewhere.file("import"), importer.folder());
  EXPECT_EQ(importer.runs_after_loading(), ++runs);
  EXPECT_EQ(importer.runs_after_loading(), ++runs);
}

TEST(ImportCache, AFolderThatCannotBeWrittenIsReadAlone) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write to every folder";
  const CountedImporter importer;
  EXPECT_EQ(importer.runs_after_loading(), 1);
  chmod(importer.folder().c_str(), 0500);
  EXPECT_EQ(importer.runs_after_loading(), 1);
  EXPECT_EQ(importer.runs_after_loading({.angle = 0.5}), 2);
  EXPECT_EQ(importer.runs_after_loading({.angle = 0.5}), 3);
  chmod(importer.folder().c_str(), 0700);
}

TEST(ImportCache, NoFolderIsMadeInThoseOfOthers) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder to another user";
  const CountedImporter importer;
  const fs::path base = importer.folder().parent_path().parent_path();
  fs::create_directory(base);
  ASSERT_EQ(chown(base.c_str(), 1, 1), 0);
  EXPECT_EQ(importer.runs_after_loading(), 1);
  EXPECT_TRUE(fs::is_empty(base));
}

TEST(ImportCache, WithoutAFolderFilesAreRead) {
  const CountedImporter importer;
  const std::string base = importer.folder().parent_path().parent_path().string();
  write_text(base, "a file in place of the folder");
  EXPECT_EQ(importer.runs_after_loading(), 1);
  EXPECT_EQ(importer.runs_after_loading(), 2);
  EXPECT_EQ(read_text(base), "a file in place of the folder");
}

TEST(ImportCache, TheFolderIsThatOfTheUser) {
  const Importer importer("none");  // which restores the environment
  const char* const home_before = std::getenv("HOME");
  const std::string home = home_before != nullptr ? home_before : "/root";
  setenv("XDG_CACHE_HOME", "/somewhere/cache", 1);
  EXPECT_EQ(ImportCache::folder_of_user(), "/somewhere/cache/frontmost/import");
  setenv("HOME", "/home/ada", 1);
  setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(ImportCache::folder_of_user(), "/home/ada/.cache/frontmost/import");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(ImportCache::folder_of_user(), "/home/ada/.cache/frontmost/import");
  unsetenv("HOME");
  EXPECT_EQ(ImportCache::folder_of_user(), "");
  setenv("HOME", home.c_str(), 1);
}

TEST(ImportCache, TheLeastRecentlyUsedEntriesGo) {
  const Importer importer("none");
  const std::string library = importer.folder().parent_path().parent_path().string() + ".so";
  write_text(library, "library");
  settle();
  constexpr std::uint64_t most = 64 << 10;
  const std::string model = "model";
  const auto cache = [&](int question) {
    return ImportCache(importer.folder(), {library, std::to_string(question)}, std::as_bytes(std::span(model)), most);
  };
  const auto is_kept = [&](int question) { return cache(question).find().has_value(); };
  ImportAnswer answer;
  answer.files = {library};
  answer.model.resize(10 << 10);
  for (int i = 0; i < 6; ++i) {
    cache(i).keep(answer);
    EXPECT_TRUE(is_kept(i));
    const auto entries = importer.entries();
    EXPECT_EQ(entries.size(), std::size_t(i + 1));
    for (const fs::path& entry : entries)
      fs::last_write_time(entry, fs::last_write_time(entry) - std::chrono::hours(1));
  }
  // Six entries of more than 10 KiB have room, seven have not.
  EXPECT_TRUE(is_kept(0)) << "was used now";
  cache(6).keep(answer);
  std::vector<int> kept;
  for (int i = 0; i < 7; ++i)
    if (is_kept(i)) kept.push_back(i);
  EXPECT_THAT(kept, ElementsAre(0, 2, 3, 4, 5, 6));
  std::uint64_t total = 0;
  for (const fs::path& entry : importer.entries()) total += fs::file_size(entry);
  EXPECT_LE(total, most);
  answer.model.resize(most / 4);
  cache(7).keep(answer);
  EXPECT_FALSE(is_kept(7)) << "an entry is a quarter of the cache at most";
  EXPECT_EQ(importer.entries().size(), 6u);
  const std::string large(most / 4 + 1, 'x');
  ImportCache(importer.folder(), {library}, std::as_bytes(std::span(large)), most).keep({});
  EXPECT_EQ(importer.entries().size(), 6u);
}

TEST(ImportCache, FilesOfOthersStay) {
  const Importer importer("none");
  const std::string library = importer.folder().parent_path().parent_path().string() + ".so", model = "model";
  write_text(library, "library");
  settle();
  const auto keep = [&](const std::string& word) {
    ImportAnswer answer;
    answer.files = {library};
    answer.model.resize(10 << 10);
    ImportCache(importer.folder(), {library, word}, std::as_bytes(std::span(model)), 48 << 10).keep(answer);
  };
  keep("first");
  const auto add = [&](const char* name, int hours) {
    const fs::path file = importer.folder() / name;
    write_text(file.string(), std::string(60 << 10, 'x'));
    fs::last_write_time(file, fs::last_write_time(file) - std::chrono::hours(hours));
    return file;
  };
  const fs::path notes = add("notes.txt", 1000), upper = add("0123456789ABCDEF", 1000),
                 hidden = add(".x.1-0.tmp", 1000), unfinished = add(".0123456789abcdef.1-0.tmp", 0),
                 left = add(".0123456789abcdef.2-0.tmp", 2);
  for (int i = 0; i < 6; ++i) keep("again " + std::to_string(i));
  for (const fs::path& file : {notes, upper, hidden, unfinished}) EXPECT_TRUE(fs::exists(file)) << file;
  EXPECT_FALSE(fs::exists(left)) << "what a killed process left";
  EXPECT_EQ(importer.entries().size(), 4u + 4u) << "files that are no entries take no room";
}

TEST(ImportCache, OneHashIsNotOneModel) {
  const Importer importer("none");
  const std::string library = importer.folder().parent_path().parent_path().string() + ".so", a = "model a",
                    b = "model b";
  write_text(library, "library");
  settle();
  const ImportCache of_a(importer.folder(), {library, "question"}, std::as_bytes(std::span(a)));
  ImportAnswer answer;
  answer.files = {library};
  of_a.keep(answer);
  ASSERT_EQ(importer.entries().size(), 1u);
  const fs::path entry_of_a = importer.entries()[0];
  const ImportCache of_b(importer.folder(), {library, "question"}, std::as_bytes(std::span(b)));
  of_b.keep(answer);
  const auto entries = importer.entries();
  ASSERT_EQ(entries.size(), 2u);
  // As if both had one hash.
  fs::copy_file(entry_of_a, entries[0] == entry_of_a ? entries[1] : entries[0], fs::copy_options::overwrite_existing);
  EXPECT_TRUE(of_a.find());
  EXPECT_FALSE(of_b.find());
}

}  // namespace
}  // namespace frontmost::test
