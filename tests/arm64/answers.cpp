// SPDX-License-Identifier: Apache-2.0
// Prints the answers of each method for the built-in scenes from five sides, as hashes. The lines are the same on every
// machine.
#include <frontmost/frontmost.h>

#include <array>
#include <cstdio>
#include <cstring>

using namespace frontmost;

namespace {

struct Side {
  NamedView direction;
  const char* name;
  int width, height;
  bool orthographic = false;
};
constexpr std::array<Side, 5> sides{{{NamedView::three_quarter, "three-quarter", 640, 480},
                                     {NamedView::front, "front", 333, 217},
                                     {NamedView::top, "top", 512, 512},
                                     {NamedView::iso, "iso", 800, 450, true},
                                     {NamedView::left, "left", 97, 301}}};

/// FNV-1a over the bytes of numbers in memory.
class Hash {
 public:
  template <class Number>
  Hash& add(const Number& number) {
    std::array<unsigned char, sizeof number> bytes;
    std::memcpy(bytes.data(), &number, sizeof number);
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 1099511628211u;
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

std::uint64_t hash_of(const Drawing& drawing) {
  Hash hash;
  for (const DrawnPart& part : drawing.parts)
    hash.add(part.edge).add(part.begin).add(part.end).add(part.from).add(part.to);
  return hash.value();
}

std::uint64_t hash_of(const PaintOrder& order) {
  Hash hash;
  for (const PaintPolygon& polygon : order.polygons) hash.add(polygon.id).add(polygon.corner_count);
  for (const PaintCorner& corner : order.corners) hash.add(corner.at);
  return hash.value();
}

void print(const char* what, std::uint64_t hash) { std::printf(" %s %016llx", what, (unsigned long long)hash); }

View view_of(const Surfaces& surfaces, const Side& side, int width, int height) {
  return frame(surfaces, width, height, {.direction = side.direction, .orthographic = side.orthographic});
}

/// Prints answers of the slower methods, in a small picture.
void print_other_answers(const Surfaces& surfaces, const Side& side) {
  const View view = view_of(surfaces, side, 96, 72);
  const Visible visible = zbuffer(surfaces, view);
  print("raycast", content_hash(raycast(surfaces, view)));
  print("layer", content_hash(visible_layers(surfaces, view, 2, {.opacity = 0.5f}).back()));
  print("depth", content_hash(depth_image(visible)));
  print("normals", content_hash(shade(surfaces, visible, {.shading = Shading::normals})));
  print("lit", content_hash(shade(surfaces, visible)));
  print("lines", hash_of(draw_lines(surfaces, view)));
  print("painter", hash_of(painter(surfaces, view)));
}

}  // namespace

int main() {
  for (const std::string_view name : builtin_names()) {
    const Scene scene = builtin(std::string(name));
    const Surfaces surfaces(scene);
    for (const Side& side : sides) {
      std::printf("%s %s", scene.name.c_str(), side.name);
      print("zbuffer", content_hash(zbuffer(surfaces, view_of(surfaces, side, side.width, side.height))));
      const bool is_small = surfaces.primitive_count() < 10'000;
      if (side.direction == NamedView::three_quarter || (side.orthographic && is_small))
        print_other_answers(surfaces, side);
      std::printf("\n");
    }
  }
}
