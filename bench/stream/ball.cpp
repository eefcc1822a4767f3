// SPDX-License-Identifier: Apache-2.0
#include "stream/ball.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace frontmost::bench {
namespace {

struct Vertex {
  float x, y, z;
};

/// A ball of rings between the poles; each ring has twice as many vertices as there are rings.
class Ball {
 public:
  explicit Ball(std::uint64_t about) : rings_(std::uint32_t(std::max(2.0, std::round(std::sqrt(double(about) / 4))))) {
    for (std::uint32_t j = 0; j < columns(); ++j) {
      const double angle = 2 * pi * j / columns();
      around_.push_back({float(std::cos(angle)), float(std::sin(angle)), 0.002f * float(std::sin(37 * angle))});
    }
  }

  [[nodiscard]] std::uint32_t rings() const { return rings_; }
  [[nodiscard]] std::uint32_t columns() const { return 2 * rings_; }
  [[nodiscard]] std::vector<Vertex> ring(std::uint32_t i) const {
    const double angle = pi * i / rings_;
    const auto height = float(std::cos(angle)), width = float(std::sin(angle)), bump = float(std::sin(31 * angle));
    std::vector<Vertex> ring;
    for (const Vertex& a : around_) {
      const float radius = 1 + a.z * bump;
      ring.push_back({radius * width * a.x, radius * width * a.y, radius * height});
    }
    return ring;
  }

 private:
  static constexpr double pi = 3.14159265358979323846;
  std::uint32_t rings_;
  std::vector<Vertex> around_;  ///< cosine, sine, roughness
};

class Writer {
 public:
  explicit Writer(const std::string& path) : file_(path == "-" ? stdout : std::fopen(path.c_str(), "wb")) {}
  ~Writer() {
    if (file_ && file_ != stdout) std::fclose(file_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  bool write(const void* data, std::size_t size) { return file_ && std::fwrite(data, 1, size, file_) == size; }
  bool write(const std::string& text) { return write(text.data(), text.size()); }
  bool write(const std::vector<char>& bytes) { return write(bytes.data(), bytes.size()); }
  bool finish() { return file_ && std::fflush(file_) == 0; }

 private:
  std::FILE* file_;
};

template <class T>
void put(std::vector<char>& bytes, const T& value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void put_facet(std::vector<char>& bytes, const Vertex& a, const Vertex& b, const Vertex& c) {
  for (const Vertex& v : {Vertex{}, a, b, c}) put(bytes, v);
  put(bytes, std::uint16_t(0));
}

bool write_stl(const Ball& ball, Writer& out) {
  std::vector<char> bytes(80);
  put(bytes, 2 * ball.rings() * ball.columns());
  bool is_open = out.write(bytes);
  std::vector<Vertex> above = ball.ring(0);
  for (std::uint32_t i = 1; is_open && i <= ball.rings(); ++i) {
    const std::vector<Vertex> below = ball.ring(i);
    bytes.clear();
    for (std::uint32_t j = 0, k = 1; j < ball.columns(); ++j, k = (j + 1) % ball.columns()) {
      put_facet(bytes, above[j], below[j], below[k]);
      put_facet(bytes, above[j], below[k], above[k]);
    }
    is_open = out.write(bytes);
    above = below;
  }
  return is_open && out.finish();
}

void put_face(std::vector<char>& bytes, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  put(bytes, std::uint8_t(3));
  for (const std::uint32_t corner : {a, b, c}) put(bytes, corner);
}

bool write_ply(const Ball& ball, Writer& out) {
  const std::uint64_t columns = ball.columns(), vertices = (ball.rings() + 1) * columns;
  bool is_open =
      out.write("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                std::to_string(2 * ball.rings() * columns) + "\nproperty list uchar uint vertex_indices\nend_header\n");
  for (std::uint32_t i = 0; is_open && i <= ball.rings(); ++i) {
    const std::vector<Vertex> ring = ball.ring(i);
    is_open = out.write(ring.data(), ring.size() * sizeof(Vertex));
  }
  std::vector<char> bytes;
  for (std::uint32_t i = 0; is_open && i < ball.rings(); ++i) {
    bytes.clear();
    const std::uint32_t above = i * ball.columns(), below = above + ball.columns();
    for (std::uint32_t j = 0, k = 1; j < columns; ++j, k = (j + 1) % ball.columns()) {
      put_face(bytes, above + j, below + j, below + k);
      put_face(bytes, above + j, below + k, above + k);
    }
    is_open = out.write(bytes);
  }
  return is_open && out.finish();
}

}  // namespace

std::uint64_t ball_triangle_count(std::uint64_t about) {
  const Ball ball(about);
  return 2 * std::uint64_t(ball.rings()) * ball.columns();
}

bool write_ball(std::uint64_t about, bool ply, const std::string& path) {
  const Ball ball(about);
  Writer out(path);
  return ply ? write_ply(ball, out) : write_stl(ball, out);
}

}  // namespace frontmost::bench
