// SPDX-License-Identifier: Apache-2.0
// Files are complete or absent, whatever happens during writing.
#include "base/output_file.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <thread>

#include "frontmost/files.h"
#include "support/scratch_folder.h"
#include "support/test_images.h"

namespace frontmost::test {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

unsigned mode_of(const std::string& path) {
  struct ::stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 0777;
}

/// Sets the process's umask for the object's lifetime.
class Umask {
 public:
  explicit Umask(mode_t mask) : before_(::umask(mask)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

/// Tests run with both ways to keep the bytes until the file is complete.
class Output : public testing::TestWithParam<OutputFile::Staging> {
 protected:
  void write_file(const std::string& path, std::string_view text) {
    OutputFile file(path, GetParam());
    file.write(bytes(text));
    file.commit();
  }
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Staging, Output, testing::Values(OutputFile::Staging::best, OutputFile::Staging::named),
                         [](const auto& each) { return each.param == OutputFile::Staging::best ? "best" : "named"; });

TEST_P(Output, FilesAppearWhole) {
  const std::string path = folder_.file("a.txt");
  {
    OutputFile file(path, GetParam());
    file.write(bytes("one "));
    file.write(bytes("two"));
    EXPECT_FALSE(fs::exists(path));
    file.commit();
  }
  EXPECT_EQ(read_text(path), "one two");
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_P(Output, NothingIsLeftWithoutCommit) {
  write_text(folder_.file("old.txt"), "old");
  {
    OutputFile fresh(folder_.file("a.txt"), GetParam()), old(folder_.file("old.txt"), GetParam());
    fresh.write(bytes("half"));
    old.write(bytes("half"));
  }
  EXPECT_EQ(folder_.entry_count(), 1u);
  EXPECT_EQ(read_text(folder_.file("old.txt")), "old");
}

TEST_P(Output, OldFilesAreReplacedAndKeepTheirPermissions) {
  const std::string path = folder_.file("a.txt");
  write_text(path, "old and longer");
  ::chmod(path.c_str(), 0640);
  write_file(path, "new");
  EXPECT_EQ(read_text(path), "new");
  EXPECT_EQ(mode_of(path), 0640u);
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_P(Output, NewFilesFollowTheUmask) {
  for (const mode_t mask : {0022u, 0077u, 0000u}) {
    const Umask scope(mask);
    const std::string path = folder_.file("mask" + std::to_string(mask));
    write_file(path, "new");
    EXPECT_EQ(mode_of(path), 0666u & ~mask);
  }
}

TEST_P(Output, LinksAreFollowed) {
  fs::create_directory(folder_.path() / "elsewhere");
  write_text(folder_.file("elsewhere/real.txt"), "old");
  fs::create_symlink("elsewhere/real.txt", folder_.path() / "link.txt");
  fs::create_symlink("link.txt", folder_.path() / "link2.txt");
  fs::create_symlink("elsewhere/new.txt", folder_.path() / "dangling.txt");
  write_file(folder_.file("link2.txt"), "new");
  write_file(folder_.file("dangling.txt"), "new too");
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "link.txt"));
  EXPECT_EQ(read_text(folder_.file("elsewhere/real.txt")), "new");
  EXPECT_EQ(read_text(folder_.file("elsewhere/new.txt")), "new too");
}

TEST_P(Output, LinksInARingAreAnError) {
  fs::create_symlink("b", folder_.path() / "a");
  fs::create_symlink("a", folder_.path() / "b");
  EXPECT_EQ(error_of([&] { write_file(folder_.file("a"), "x"); }), ErrorCode::file_unwritable);
}

TEST_P(Output, DevicesAndPipesAreWrittenTo) {
  write_file("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const std::string path = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = read_text(path); });
  write_file(path, "through the pipe");
  reader.join();
  EXPECT_EQ(got, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST_P(Output, WhatCannotBeWrittenIsNamed) {
  for (const std::string& path : {folder_.path().string(), folder_.file("missing/a.txt"), folder_.file("no/"),
                                  folder_.file(std::string(300, 'x')), std::string("/proc/none.txt")}) {
    std::string message;
    EXPECT_EQ(error_of([&] { write_file(path, "x"); }, &message), ErrorCode::file_unwritable) << path;
    EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
  }
  EXPECT_EQ(folder_.entry_count(), 0u);
}

TEST_P(Output, FoldersAndFilesWithoutPermissionAreErrors) {
  if (::geteuid() == 0) GTEST_SKIP() << "permissions do not bind root";
  write_text(folder_.file("a.txt"), "old");
  ::chmod(folder_.file("a.txt").c_str(), 0444);
  EXPECT_EQ(error_of([&] { write_file(folder_.file("a.txt"), "x"); }), ErrorCode::file_unwritable);
  EXPECT_EQ(read_text(folder_.file("a.txt")), "old");
  ::chmod(folder_.path().c_str(), 0555);
  EXPECT_EQ(error_of([&] { write_file(folder_.file("b.txt"), "x"); }), ErrorCode::file_unwritable);
  ::chmod(folder_.path().c_str(), 0755);
}

// The folder may change between opening and naming a file.
TEST_P(Output, APlaceThatIsGoneWhenTheFileIsWhole) {
  fs::create_directory(folder_.path() / "gone");
  OutputFile file(folder_.file("gone/a.txt"), GetParam());
  file.write(bytes("whole"));
  fs::remove_all(folder_.path() / "gone");
  std::string message;
  EXPECT_EQ(error_of([&] { file.commit(); }, &message), ErrorCode::file_unwritable);
  const char* doing = GetParam() == OutputFile::Staging::named ? ": cannot replace: " : ": cannot create: ";
  EXPECT_EQ(message, folder_.file("gone/a.txt") + doing + std::generic_category().message(ENOENT));
  EXPECT_EQ(folder_.entry_count(), 0u);
}

TEST_P(Output, AFolderThatTookThePlaceIsNotReplaced) {
  const std::string path = folder_.file("a.txt");
  {
    OutputFile file(path, GetParam());
    file.write(bytes("whole"));
    fs::create_directory(path);
    std::string message;
    EXPECT_EQ(error_of([&] { file.commit(); }, &message), ErrorCode::file_unwritable);
    EXPECT_EQ(message, path + ": cannot replace: " + std::generic_category().message(EISDIR));
  }
  EXPECT_TRUE(fs::is_directory(path));
  EXPECT_EQ(folder_.entry_count(), 1u) << "the hidden file is gone";
}

TEST_P(Output, AFileThatCameMeanwhileIsReplaced) {
  const std::string path = folder_.file("a.txt");
  OutputFile file(path, GetParam());
  file.write(bytes("mine"));
  write_text(path, "somebody else's");
  file.commit();
  EXPECT_EQ(read_text(path), "mine");
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_P(Output, ReasonsAreNamed) {
  const auto reason = [&](const std::string& path) {
    std::string message;
    EXPECT_EQ(error_of([&] { write_file(path, "x"); }, &message), ErrorCode::file_unwritable);
    return message.substr(std::min(message.size(), path.size()));
  };
  EXPECT_EQ(reason(folder_.path().string()), ": is a folder");
  EXPECT_EQ(reason(folder_.file("no/")), ": is not a file name");
  EXPECT_EQ(reason(""), "'': is not a file name");
  EXPECT_EQ(reason(folder_.file("missing/a.txt")), ": cannot create: " + std::generic_category().message(ENOENT));
  write_text(folder_.file("file"), "");
  EXPECT_EQ(reason(folder_.file("file/a.txt")), ": cannot write: " + std::generic_category().message(ENOTDIR));
}

// Hidden names of other writers of the same file, or of a process that died, are skipped.
TEST_P(Output, NamesThatAreTakenArePassedOver) {
  const std::string path = folder_.file("a.txt");
  write_text(path, "old");
  const std::string stem = ".a.txt." + std::to_string(::getpid()) + "-";
  for (int i = 0; i < 3; ++i) write_text(folder_.file(stem + std::to_string(i) + ".tmp"), "dead");
  write_file(path, "new");
  EXPECT_EQ(read_text(path), "new");
  EXPECT_EQ(folder_.entry_count(), 4u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(read_text(folder_.file(stem + std::to_string(i) + ".tmp")), "dead");
}

TEST_P(Output, LongNamesAreFine) {
  const std::string path = folder_.file(std::string(255, 'x'));
  write_file(path, "old");
  write_file(path, "new");
  EXPECT_EQ(read_text(path), "new");
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_P(Output, AFullDiskLeavesTheOldFile) {
  // A limit on file sizes stands for a full disk.
  const std::string path = folder_.file("a.txt");
  write_text(path, "old");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 1000;
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  const ErrorCode code = error_of([&] { write_file(path, std::string(100000, 'x')); }, &message);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(code, ErrorCode::file_unwritable);
  EXPECT_NE(message.find("cannot write"), std::string::npos) << message;
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_P(Output, ManyThreadsMayWriteOneFile) {
  const std::string path = folder_.file("a.txt");
  std::vector<std::thread> writers;
  for (char c = 'a'; c < 'i'; ++c)
    writers.emplace_back([&, c] {
      for (int i = 0; i < 50; ++i) write_file(path, std::string(5000, c));
    });
  for (std::thread& writer : writers) writer.join();
  const std::string text = read_text(path);
  EXPECT_EQ(text, std::string(5000, text[0]));  // the last writer's text, complete
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST(OutputDevice, AFullDeviceIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  OutputFile file("/dev/full");
  EXPECT_EQ(error_of([&] { file.write(bytes("x")); }), ErrorCode::file_unwritable);
}

TEST(SaveFiles, ErrorsAndCancellationLeaveTheOldFile) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.png");
  write_text(path, "old");
  const Image image = random_floats(300, 300, {"R", "G", "B"});
  SaveOptions wrong;
  wrong.bits = 7;
  EXPECT_EQ(error_of([&] { save(image, path, wrong); }), ErrorCode::bad_argument);
  const Watch watch{{}, [] { return true; }};
  Execution cancelled;
  cancelled.watch = &watch;
  for (const char* name : {"a.png", "b.npy", "b.pfm"})
    EXPECT_EQ(error_of([&] { save(image, folder.file(name), {}, cancelled); }), ErrorCode::cancelled);
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(SaveFiles, TheSuffixChoosesTheFormat) {
  const ScratchFolder folder;
  const Image image = random_floats(3, 3, {"R", "G", "B"});
  save(image, folder.file("a.PNG"));
  save(image, folder.file("a.Npy"));
  EXPECT_EQ(read_text(folder.file("a.PNG")).substr(1, 3), "PNG");
  EXPECT_EQ(read_text(folder.file("a.Npy")).substr(1, 5), "NUMPY");
  SaveOptions options;
  options.format = ImageFormat::pfm;
  save(image, folder.file("a.raw"), options);
  EXPECT_EQ(read_text(folder.file("a.raw")).substr(0, 2), "PF");
  std::string message;
  EXPECT_EQ(error_of([&] { save(image, folder.file("a.tif")); }, &message), ErrorCode::unsupported);
  EXPECT_NE(message.find("not in \".tif\""), std::string::npos) << message;
  EXPECT_EQ(error_of([&] { save(image, "-"); }), ErrorCode::bad_argument);
}

TEST(SaveFiles, WhatIsNotThereCannotBeLoaded) {
  const ScratchFolder folder;
  EXPECT_EQ(error_of([&] { (void)load_image(folder.file("none.png")); }), ErrorCode::file_unreadable);
  EXPECT_EQ(error_of([&] { (void)load_image(folder.path().string()); }), ErrorCode::file_unreadable);
}

}  // namespace
}  // namespace frontmost::test
