// SPDX-License-Identifier: Apache-2.0
// The promise of reading in pieces for any bytes: the result equals load()'s, or is refused with a reason. Shared by
// the fuzz target and the tests.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "io/models/model_stream.h"

namespace frontmost {

/// A model as one list of triangles, corner by corner.
struct Flat {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec4> colors;
  std::vector<std::uint32_t> materials;
  std::vector<std::string> warnings;
};

template <class T>
void flatten(const Mesh& mesh, const Attribute<T>& attribute, std::uint32_t triangle, std::vector<T>& to) {
  if (attribute.empty()) return;
  for (int k = 0; k < 3; ++k) to.push_back(attribute.values[mesh.corners(attribute, triangle)[k]]);
}

inline void flatten(const Mesh& mesh, Flat& flat) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) flat.positions.push_back(mesh.positions[mesh.triangles[t][k]]);
    flatten(mesh, mesh.normals, t, flat.normals);
    flatten(mesh, mesh.texcoords, t, flat.texcoords);
    flatten(mesh, mesh.colors, t, flat.colors);
    flat.materials.push_back(mesh.material_of(t));
  }
}

/// Compares to the bit, so that NaN equals NaN.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool same(const Flat& a, const Flat& b) {
  return same_bits(a.positions, b.positions) && same_bits(a.normals, b.normals) &&
         same_bits(a.texcoords, b.texcoords) && same_bits(a.colors, b.colors) && same_bits(a.materials, b.materials);
}

/// \throws Error
inline Flat read_in_pieces(const std::string& path, const LoadOptions& options, std::uint64_t triangles) {
  Flat flat;
  const std::unique_ptr<ModelStream> stream = open_model_stream(path, options, {.threads = 1});
  const auto read = [&] {
    flat = {};
    StreamPiece piece;
    std::uint64_t first = 0;
    while (stream->fetch(piece, triangles)) {
      stream->parse(piece);
      // The counts given before parsing must be right.
      if (piece.first_triangle != first || piece.mesh.triangles.size() != piece.triangle_count) std::abort();
      first += piece.triangle_count;
      flatten(piece.mesh, flat);
    }
  };
  read();
  if (stream->can_rewind()) {
    const Flat once = flat;
    stream->rewind();
    read();
    if (!same(once, flat)) std::abort();
  }
  flat.warnings = stream->scene().warnings;
  return flat;
}

/// The bytes in a pipe, which holds at least 64 KiB.
class FullPipe {
 public:
  explicit FullPipe(std::span<const std::byte> bytes) {
    int ends[2];
    if (::pipe(ends) != 0) std::abort();
    end_ = ends[0];
    if (::write(ends[1], bytes.data(), bytes.size()) != ssize_t(bytes.size())) std::abort();
    ::close(ends[1]);
  }
  ~FullPipe() { ::close(end_); }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(end_); }

 private:
  int end_ = -1;
};

/// Compares streams of the file `path`, which has these bytes, and of a pipe of them with load(). Ends the program if
/// they differ. \returns whether the bytes were read in pieces.
inline bool fuzz_stream(const std::string& path, std::span<const std::byte> bytes, std::uint64_t triangles) {
  const bool is_ply = bytes.size() > 3 && std::memcmp(bytes.data(), "ply", 3) == 0;
  const LoadOptions options{.format = is_ply ? ModelFormat::ply : ModelFormat::stl, .up = {}};
  std::optional<Flat> whole;
  try {
    const Scene scene = load(bytes, path, options, {.threads = 1});
    whole.emplace();
    for (const Mesh& mesh : scene.meshes) flatten(mesh, *whole);
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): what the stream says is looked at below
  }
  // A pipe without a count that ends in half a triangle may be malformed, as its intended end is unknown.
  const auto may_fail = [&](ErrorCode code, bool is_pipe) {
    return code == ErrorCode::unsupported || code == ErrorCode::limit_exceeded ||
           (is_pipe && !is_ply && code == ErrorCode::file_malformed);
  };
  const auto agrees = [&](const std::string& source, bool is_pipe) {
    try {
      // If load() failed, the stream may have ended before the fault, as it ignores anything after the faces.
      const Flat pieces = read_in_pieces(source, options, triangles);
      if (whole && !same(*whole, pieces)) std::abort();
      return true;
    } catch (const Error& error) {
      if (!std::string_view(error.what()).starts_with(source + ": ")) std::abort();
      if (whole && !may_fail(error.code(), is_pipe)) std::abort();
      return false;
    }
  };
  const bool file = agrees(path, false);
  constexpr std::size_t room = std::size_t(1) << 16;
  if (bytes.size() <= room) {
    const FullPipe pipe(bytes);
    (void)agrees(pipe.path(), true);
  }
  return file;
}

}  // namespace frontmost
