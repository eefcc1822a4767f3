// SPDX-License-Identifier: Apache-2.0
// load() itself: the sources of bytes, and the detection of formats.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "model_bytes.h"

namespace frontmost {
namespace {

using test::load_text;
using testing::HasSubstr;
using testing::StartsWith;

const std::string one_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string one_off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string one_ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string one_stl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";

std::string temporary(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) / ("frontmost-load-" + std::to_string(::getpid()) + "-" + name))
      .string();
}

std::string failure(const std::string& path, ErrorCode code) {
  try {
    (void)load(path);
    return "loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
}

TEST(Load, KnowsFormatsByContent) {
  for (const std::string& text : {one_obj, one_off, one_ply, one_stl}) {
    const Scene scene = load_text(text);
    EXPECT_EQ(triangle_count(scene), 1u);
    EXPECT_EQ(scene.name, "model");
    EXPECT_EQ(scene.up, &text == &one_stl || text == one_stl ? Axis::z : Axis::y);
  }
}

// Editors on Windows write a byte order mark before every text.
TEST(Load, AByteOrderMarkIsPassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  test::ByteWriter binary_ply;
  binary_ply.text = one_ply.substr(0, one_ply.find("0 0 0"));
  binary_ply.text.replace(binary_ply.text.find("ascii"), 5, "binary_little_endian");
  binary_ply.put({0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}).put(std::uint8_t(3)).put({0, 1, 2});
  for (const std::string& text : {one_obj, one_off, one_ply, one_stl, binary_ply.text}) {
    const Scene plain = load_text(text), marked = load_text(mark + text);
    ASSERT_EQ(triangle_count(marked), 1u) << text;
    EXPECT_EQ(marked.meshes[0].positions, plain.meshes[0].positions);
    EXPECT_TRUE(marked.warnings.empty());
  }
  const std::string path = temporary("marked.txt");
  std::ofstream(path) << mark + "1 0 0" + mark;
  EXPECT_EQ(frontmost::load_text(path, 100), "1 0 0" + mark);
  std::filesystem::remove(path);
}

TEST(Load, RefusesWhatIsNoModel) {
  for (const std::string& text :
       {std::string("hello"), std::string("\x89PNG\r\n\x1a\n rest of it"), std::string(1000, '\0')}) {
    try {
      (void)load_text(text);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::unsupported);
      EXPECT_THAT(error.what(), StartsWith("model: not a model that Frontmost can read"));
    }
  }
}

TEST(Load, SuffixInAnyCaseThenContent) {
  for (const auto& [name, text] :
       {std::pair{"a.OBJ", one_obj}, {"b.oFF", one_off}, {"c.unknown", one_stl}, {"d", one_ply}}) {
    const std::string path = temporary(name);
    std::ofstream(path) << text;
    EXPECT_EQ(triangle_count(load(path)), 1u) << name;
    std::filesystem::remove(path);
  }
}

TEST(Load, UpIsTheFormatsUnlessGiven) {
  EXPECT_EQ(load_text(one_stl).up, Axis::z);
  EXPECT_EQ(load_text(one_ply).up, Axis::y);
  EXPECT_EQ(load(test::bytes_of(one_ply), "x.ply", {.format = {}, .up = Axis::minus_x}).up, Axis::minus_x);
}

TEST(Load, UnreadablePathsSayWhy) {
  EXPECT_THAT(failure("/no/such/file.stl", ErrorCode::file_unreadable),
              StartsWith("/no/such/file.stl: cannot open: No such file"));
  EXPECT_THAT(failure(testing::TempDir(), ErrorCode::file_unreadable), HasSubstr("is a folder"));
  EXPECT_THAT(failure("", ErrorCode::file_unreadable), HasSubstr("cannot open"));
  EXPECT_THAT(failure("/dev/null", ErrorCode::file_malformed), HasSubstr("the file is empty"));
  EXPECT_THAT(failure("builtin:nothing", ErrorCode::bad_argument), HasSubstr("teapot"));
}

TEST(Load, BuiltinScenes) {
  const Scene scene = load("builtin:cubes", {.format = {}, .up = Axis::z});
  EXPECT_GT(triangle_count(scene), 0u);
  EXPECT_EQ(scene.up, Axis::z);
}

TEST(Load, PipesAreStreams) {
  const std::string path = temporary("pipe.stl");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  // The text is longer than the pipe and the first block.
  std::string text = "solid\n";
  const std::size_t count = 3000;
  for (std::size_t i = 0; i < count; ++i) text += one_stl.substr(6, one_stl.size() - 15);
  std::thread writer([&] { std::ofstream(path) << text + "endsolid\n"; });
  EXPECT_EQ(triangle_count(load(path)), count);
  writer.join();
  std::filesystem::remove(path);
}

TEST(Load, StandardInput) {
  const std::string path = temporary("stdin");
  std::ofstream(path) << one_obj;
  const int saved = ::dup(STDIN_FILENO), file = ::open(path.c_str(), O_RDONLY);
  ::dup2(file, STDIN_FILENO);
  const Scene scene = load("-");
  ::dup2(saved, STDIN_FILENO);
  ::close(saved);
  ::close(file);
  std::filesystem::remove(path);
  EXPECT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(scene.name, "stdin");
}

// Mapped files release their pages during reading, which must not change the result.
TEST(Load, LargeFilesEqualMemory) {
  std::string text = "v 0 0 0\nv 1 0 0\n";
  for (int i = 0; i < 200'000; ++i) text += "v " + std::to_string(i) + " 1 0\nf 1 2 -1\n";
  const std::string path = temporary("large.obj");
  std::ofstream(path) << text;
  const Scene file = load(path), memory = load_text(text);
  std::filesystem::remove(path);
  EXPECT_EQ(triangle_count(file), 200'000u);
  EXPECT_TRUE(file.meshes.at(0).positions == memory.meshes.at(0).positions);
  EXPECT_TRUE(file.meshes[0].triangles == memory.meshes[0].triangles);
}

TEST(Load, CanBeCancelled) {
  std::string text = "v 0 0 0\n";
  while (text.size() < 3'000'000) text += "f 1 1 1\n";
  Watch watch;
  watch.cancelled = [] { return true; };
  try {
    (void)load(test::bytes_of(text), "x.obj", {}, {.watch = &watch});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace frontmost
