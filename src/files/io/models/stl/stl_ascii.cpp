// SPDX-License-Identifier: Apache-2.0
// ASCII STL. Each solid becomes a mesh. Words may be in any case and anywhere on a line, as in files from the wild.
//
//   solid NAME
//     facet normal nx ny nz           normals are dropped: they follow from the corners
//       outer loop
//         vertex x y z                three of them
//       endloop
//     endfacet
//   endsolid NAME
#include "io/models/coordinates.h"
#include "io/models/mesh_building.h"
#include "io/models/model_source.h"
#include "io/models/stl/stl.h"
#include "io/models/text/text_scanner.h"

namespace frontmost {
namespace {

bool same_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] | 0x20) != lower[i]) return false;
  return true;
}

class AsciiStl {
 public:
  AsciiStl(Bytes bytes, const ModelSource& source, Coordinates& coordinates)
      : text_(bytes, source), coordinates_(coordinates) {}

  Scene read() {
    while (text_.to_word()) statement(text_.word());
    if (in_solid_) text_.fail("the file ends within a solid, before \"endsolid\"");
    return std::move(scene_);
  }

 private:
  void statement(std::string_view word) {
    if (same_word(word, "facet")) {
      facet();
    } else if (same_word(word, "solid")) {
      if (in_solid_) text_.fail("\"solid\" within a solid");
      begin_solid();
    } else if (same_word(word, "endsolid")) {
      text_.rest();
      in_solid_ = false;
    } else if (same_word(word, "color")) {
      text_.rest();
    } else {
      text_.fail(in_quotes(word) + " where \"facet\" or \"endsolid\" was expected");
    }
  }

  void begin_solid() {
    in_solid_ = true;
    const std::string name = name_of(text_.rest());
    add_object(scene_, name, text_.source(), text_.place());
  }

  void expect(std::string_view lower) {
    if (!text_.to_word()) text_.fail("the file ends within a triangle, before " + in_quotes(lower));
    const std::string_view word = text_.word();
    if (!same_word(word, lower)) text_.fail(in_quotes(word) + " where " + in_quotes(lower) + " was expected");
  }

  /// Reads facet normal X Y Z outer loop (vertex X Y Z) x 3 endloop endfacet.
  void facet() {
    if (!in_solid_) begin_solid_without_name();
    Mesh& mesh = scene_.meshes.back();
    expect("normal");
    // The normal follows from the corners; any three words in its place are skipped.
    for (int k = 0; k < 3 && text_.to_word(); ++k) text_.word();
    expect("outer");
    expect("loop");
    const auto first = std::uint32_t(mesh.positions.size());
    for (int k = 0; k < 3; ++k) {
      expect("vertex");
      mesh.positions.push_back(vertex());
    }
    expect("endloop");
    expect("endfacet");
    if (first > no_index - 6) text_.source().fail_limit(text_.place(), "too many triangles");
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }

  void begin_solid_without_name() {
    in_solid_ = true;
    if (!scene_.meshes.empty()) text_.fail("\"facet\" outside a solid");
    add_object(scene_, "", text_.source(), text_.place());
  }

  glm::vec3 vertex() {
    glm::vec3 rounded{0};
    glm::dvec3 exact{0};
    for (int k = 0; k < 3; ++k)
      if (!text_.to_word() || !text_.number(rounded[k], exact[k]) || !text_.at_blank())
        text_.fail("a vertex needs three numbers");
    return coordinates_(rounded, exact);
  }

  TextScanner text_;
  Coordinates& coordinates_;
  Scene scene_;
  bool in_solid_ = false;
};

}  // namespace

Scene read_ascii_stl(Bytes bytes, const ModelSource& source) {
  return read_about_origin([&](Coordinates& coordinates) { return AsciiStl(bytes, source, coordinates).read(); });
}

}  // namespace frontmost
