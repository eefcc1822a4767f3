// SPDX-License-Identifier: Apache-2.0
// Contents of files: polygons, attributes, both byte orders, gaps, and false counts.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>

#include "stream/as_whole.h"
#include "support/stream_fuzz.h"

namespace frontmost {
namespace {

using test::expect_streams_as_whole;

class StreamFormats : public test::StreamFiles {
 protected:
  static std::string seed(const std::string& name) { return std::string(FRONTMOST_CORPUS) + "/stream/" + name; }
  static std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

std::span<const std::byte> as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

TEST_F(StreamFormats, EverySeedOfTheFuzzerIsReadAsByLoad) {
  int files = 0, read = 0;
  for (const char* folder : {"/stream", "/ply", "/stl"})
    for (const auto& entry : std::filesystem::directory_iterator(FRONTMOST_CORPUS + std::string(folder))) {
      SCOPED_TRACE(entry.path());
      const std::string text = bytes_of(entry.path());
      for (const std::uint64_t at_once : {1u, 2u, 1000u}) read += fuzz_stream(entry.path(), as_bytes(text), at_once);
      ++files;
    }
  EXPECT_GE(files, 30);
  EXPECT_GE(read, 3 * 14);  // the others are text, truncated, or promise too much
}

TEST_F(StreamFormats, PolygonsAttributesAndByteOrdersAreDrawnAsAWhole) {
  for (const std::uint32_t at_once : {1u, 4u}) {
    for (const char* name : {"quads_big.ply", "quads_little.ply", "attributes.ply", "face_colours.ply", "between.ply",
                             "wedges.ply", "degenerate.ply", "many_vertices.ply", "end_in_comment.ply", "open.stl"})
      expect_streams_as_whole({seed(name)}, at_once);
    expect_streams_as_whole({seed("quads_big.ply"), seed("nine.stl"), seed("attributes.ply"), seed("quads_little.ply")},
                            at_once);
  }
}

/// A strip of quads with these types for positions, list lengths and vertex indices.
std::string binary_ply(const std::string& place, const std::string& count, const std::string& corner, bool big) {
  std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                     "_endian 1.0\nelement vertex 20\nproperty " + place + " x\nproperty " + place + " y\nproperty " +
                     place + " z\nelement face 9\nproperty list " + count + " " + corner +
                     " vertex_indices\nend_header\n";
  const auto append = [&](const auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (big) std::reverse(bytes, bytes + sizeof value);
    text.append(bytes, sizeof value);
  };
  const auto put = [&](const std::string& type, int value) {
    if (type == "char") append(std::int8_t(value));
    if (type == "uchar") append(std::uint8_t(value));
    if (type == "short") append(std::int16_t(value));
    if (type == "ushort") append(std::uint16_t(value));
    if (type == "int") append(std::int32_t(value));
    if (type == "uint") append(std::uint32_t(value));
    if (type == "float") append(float(value));
    if (type == "double") append(double(value));
  };
  for (int i = 0; i < 20; ++i)
    for (const int coordinate : {i / 2 * 3, i % 2 * 10, i * i % 7}) put(place, coordinate);
  for (int i = 0; i < 9; ++i) {
    put(count, 4);
    for (const int vertex : {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1}) put(corner, vertex);
  }
  return text;
}

TEST_F(StreamFormats, EveryTypeOfAPlyIsStreamedAsItIsLoaded) {
  for (const bool big : {false, true})
    for (const std::string type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"}) {
      const std::string whole = type == "float" || type == "double" ? "uchar" : type;
      const std::string path = file(type + (big ? "_big.ply" : "_little.ply"), binary_ply(type, whole, whole, big));
      expect_streams_as_whole({path}, 5);
    }
}

TEST_F(StreamFormats, LyingHeadersGiveTheErrorsOfTheReader) {
  for (const char* name :
       {"lying_faces.ply", "lying_vertices.ply", "two_that_do_not_fit.ply", "wrapping.ply", "promises.stl"}) {
    const std::string message = test::error_of(seed(name), 3);
    EXPECT_NE(message, "read") << name;
    EXPECT_EQ(message, test::error_of_whole(seed(name)));
  }
}

std::string stl_with_count(std::uint32_t promised, std::size_t bytes) {
  std::string text(80, ' ');
  text.append(reinterpret_cast<const char*>(&promised), 4);
  return text + std::string(bytes, '\1');
}

/// Message of the error that reading from a pipe ends in; "read" if there is none.
std::string error_of_pipe(const std::string& text, ModelFormat format) {
  const FullPipe pipe(as_bytes(text));
  try {
    (void)read_in_pieces(pipe.path(), {.format = format, .up = {}}, 3);
    return "read";
  } catch (const Error& error) {
    return error.what();
  }
}

// The length of a pipe is unknown until its end, so the reader trusts smaller counts only.
TEST_F(StreamFormats, PipesThatPromiseTooMuchAreRefusedBeforeMemoryIsAskedFor) {
  const std::string ply = bytes_of(seed("many_vertices.ply"));
  std::string many = ply;
  many.replace(many.find("vertex 1200"), 11, "vertex 4000000000");
  EXPECT_THAT(error_of_pipe(many, ModelFormat::ply), testing::HasSubstr("give a file in place of the pipe"));
  EXPECT_THAT(error_of_pipe(ply.substr(0, 5000), ModelFormat::ply),
              testing::ContainsRegex("vertex [0-9]+: the file ends within the row"));
  EXPECT_THAT(error_of_pipe(ply.substr(0, ply.size() - 1), ModelFormat::ply),
              testing::HasSubstr("face 299: the file ends within the row"));
  constexpr std::size_t forty = 40 * 50;
  EXPECT_EQ(error_of_pipe(stl_with_count(40, forty), ModelFormat::stl), "read");
  EXPECT_THAT(error_of_pipe(stl_with_count(41, forty), ModelFormat::stl), testing::HasSubstr("promises 41 triangles"));
  for (const std::uint32_t open : {0u, 0xFFFFFFFFu}) {
    EXPECT_EQ(error_of_pipe(stl_with_count(open, forty), ModelFormat::stl), "read");
    EXPECT_THAT(error_of_pipe(stl_with_count(open, forty - 1), ModelFormat::stl),
                testing::HasSubstr("triangle 39: the file ends within the triangle"));
  }
}

TEST_F(StreamFormats, ColorsOfAnStlAreStreamedIfTheyStartEarly) {
  constexpr std::uint32_t count = 1200;
  const auto write = [&](std::uint32_t colored) {
    Mesh mesh;
    for (std::uint32_t t = 0; t < count; ++t) {
      for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
        mesh.positions.emplace_back(corner.x + float(t % 40), corner.y + float(t / 40), 0);
      mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    std::string text = test::stl_of(mesh);
    const std::uint16_t red = 0xFC00;
    std::memcpy(&text[84 + 50 * colored + 48], &red, sizeof red);
    return text;
  };
  for (const std::uint32_t at_once : {1u, 500u}) expect_streams_as_whole({file("early.stl", write(999))}, at_once);
  const std::string early = write(0);
  EXPECT_TRUE(fuzz_stream(file("first.stl", early), as_bytes(early), 7)) << "from a pipe, too";
  const Flat late = read_in_pieces(file("late.stl", write(1000)), {}, 600);
  EXPECT_TRUE(late.colors.empty());
  EXPECT_THAT(late.warnings, testing::ElementsAre(testing::HasSubstr("none of the first 1000 triangles has one")));
}

TEST_F(StreamFormats, AByteOrderMarkIsStreamedAsItIsLoaded) {
  const std::string text = "\xEF\xBB\xBF" + bytes_of(seed("quads_little.ply"));
  expect_streams_as_whole({file("marked.ply", text)}, 3);
}

TEST_F(StreamFormats, TextIsRefusedWithAReason) {
  const std::string ply = file("a.ply",
                               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_THAT(test::error_of(ply, 3), testing::HasSubstr("text PLY cannot be streamed; binary STL and PLY can"));
  const std::string stl = file("a.stl",
                               "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                               "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
  EXPECT_THAT(test::error_of(stl, 3), testing::HasSubstr("text STL cannot be streamed; binary STL and PLY can"));
  EXPECT_THAT(test::error_of(file("empty.ply", ""), 3), testing::HasSubstr("the file is empty"));
}

/// Faces of `corners` corners each, all at vertex 0.
std::string equal_faces(int faces, int corners) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "element face " +
      std::to_string(faces) + "\nproperty list uchar uchar vertex_indices\nend_header\n" + std::string(12, '\0');
  for (int i = 0; i < faces; ++i) {
    text += char(corners);
    text.append(std::size_t(corners), '\0');
  }
  return text;
}

// Faces of two corners give no triangles, while polygons give many from a few bytes. No piece grows with the file's
// length, whatever the faces are.
TEST_F(StreamFormats, PiecesStaySmallWhateverTheFacesAre) {
  constexpr int faces = 30'000;
  for (const int corners : {0, 2, 3, 4, 60}) {
    SCOPED_TRACE(corners);
    const std::string path = file("faces.ply", equal_faces(faces, corners));
    const std::unique_ptr<ModelStream> stream = open_model_stream(path, {}, {});
    StreamPiece piece;
    std::uint64_t rows = 0, triangles = 0;
    while (stream->fetch(piece, 100)) {
      stream->parse(piece);
      rows += piece.row_count;
      triangles += piece.triangle_count;
    }
    EXPECT_LE(piece.bytes.capacity(), 20'000u);
    EXPECT_EQ(rows, std::uint64_t(faces));
    EXPECT_EQ(triangles, std::uint64_t(faces) * std::uint64_t(std::max(corners - 2, 0)));
    EXPECT_EQ(stream->scene().warnings.size(), corners < 3 ? 1u : 0u);
  }
}

// A polygon longer than a piece is read as a whole, in steps that double.
TEST_F(StreamFormats, APolygonMayBeLongerThanAPiece) {
  constexpr std::uint32_t count = 20'000;
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uint uchar vertex_indices\nend_header\n";
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  text.append(reinterpret_cast<const char*>(corners), sizeof corners);
  text.append(reinterpret_cast<const char*>(&count), 4);
  for (std::uint32_t i = 0; i < count; ++i) text += char(i * 4 / count);
  text += std::string("\3\0\0\0\0\1\2", 7);
  EXPECT_TRUE(fuzz_stream(file("long.ply", text), as_bytes(text), 1));
}

// A view that shows nothing examines all triangles, whatever the size of the pieces. Any other view examines none after
// the first visible one.
TEST_F(StreamFormats, WhatABlankViewDoesNotShowIsTold) {
  const Scene scene = load(seed("many_vertices.ply"));
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 32, 32);
  const auto told = [&](const View& looked) {
    std::atomic<std::size_t> count{0};
    Stream stream({seed("many_vertices.ply")}, {.load = {}, .triangles_at_once = 7});
    (void)stream.look({looked}, {.unseen = [&](CornerSpan corners) { count += corners.size(); }}, {.threads = 2});
    return count.load();
  };
  EXPECT_LT(told(view), 100u);
  view.world_from_eye[3] += glm::dvec4(view.forward() * 1e5, 0);
  EXPECT_EQ(told(view), surfaces.primitive_count());
}

}  // namespace
}  // namespace frontmost
