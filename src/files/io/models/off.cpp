// SPDX-License-Identifier: Apache-2.0
// OFF in text form, with Geomview's optional colours, normals and texture coordinates: [ST][C][N]OFF. Prefixes may come
// in any order, as other programs write them.
//
//   COFF
//   4 2 0                        vertices, faces, edges (which are not used)
//   0 0 0   1 0 0 1              a vertex; behind it with N a normal, with C a colour, with ST u v
//   ...
//   3 0 1 2   0.5 0.5 0.5        a face: the number of corners, the corners, and perhaps a colour of its own
//
// Colours range from 0 to 1 or from 0 to 255; only the greatest value of all tells which. Counts are checked against
// the file's length before memory is allocated.
#include <algorithm>
#include <cmath>

#include "io/models/coordinates.h"
#include "io/models/mesh_building.h"
#include "io/models/text.h"

namespace frontmost {
namespace {

/// Colours as the file states them, from 0 to 255 or from 0 to 1. The range is known after all were read.
class RawColors {
 public:
  void add(const glm::vec4& color) {
    for (int k = 0; k < 4; ++k) {
      greatest_ = std::max(greatest_, color[k]);
      least_ = std::min(least_, color[k]);
    }
    constexpr float tolerance = 0.01f;
    may_be_normals_ = may_be_normals_ && std::isnan(color.a) && std::abs(glm::length(glm::vec3(color)) - 1) < tolerance;
    has_none_ = has_none_ || std::isnan(color.r);
    colors_.push_back(color);
  }
  /// Whether the numbers can only be colours, even if the keyword does not announce them.
  [[nodiscard]] bool are_unmistakable() const { return least_ >= 0 && !may_be_normals_ && !has_none_; }
  [[nodiscard]] std::size_t size() const { return colors_.size(); }
  std::vector<glm::vec4> take_linear() {
    const float range = greatest_ > 1 ? 255.0f : 1.0f;
    for (glm::vec4& color : colors_) color = linear_color(color / range);
    return std::move(colors_);
  }
  /// Returns a value for no colour. NaN stands for opaque white, because the scale of the colours is not known yet.
  static glm::vec4 none() { return glm::vec4(std::numeric_limits<float>::quiet_NaN()); }

 private:
  std::vector<glm::vec4> colors_;
  float greatest_ = 0, least_ = 0;
  bool may_be_normals_ = true, has_none_ = false;
};

class OffReader {
 public:
  OffReader(Bytes bytes, const ModelSource& source, Coordinates& coordinates)
      : text_(bytes, source, TextScanner::Comments::hash), source_(source), coordinates_(coordinates) {}

  Scene read() {
    read_header();
    Mesh& mesh = add_object(scene_, "", source_, text_.place());
    read_vertices(mesh);
    read_faces(mesh);
    return std::move(scene_);
  }

 private:
  void read_header() {
    if (!text_.to_word()) text_.fail("the file ends before the header");
    std::int64_t count = 0;
    TextScanner ahead = text_;
    // Geomview's manual allows files without a keyword, which begin with the number of vertices.
    const bool has_keyword = !ahead.integer(count) || !ahead.at_blank();
    if (has_keyword) read_keyword();
    if (!text_.to_word() || !text_.integer(count)) text_.fail("the number of vertices was expected");
    vertex_count_ = checked(count, has_normals_ ? 6 : 3, "vertices");
    if (!text_.integer(count)) text_.fail("the number of faces was expected");
    face_count_ = checked(count, 1, "faces");
    (void)text_.integer(count);  // edges are not used, and some files leave them out
    if (!text_.at_line_end()) text_.fail("the header holds three counts: vertices, faces, edges");
  }

  /// Reads letter by letter, because files of ModelNet have no blank between the keyword and the number of vertices.
  void read_keyword() {
    const std::string word = in_quotes(TextScanner(text_).word());
    bool is_supported = true, is_known = true;
    while (is_known && !text_.take('O')) {
      if (text_.take('C')) {
        has_colors_ = true;
        is_normal_named_first_ = has_normals_;
      } else if (text_.take('N')) {
        has_normals_ = true;
      } else if (text_.take('4') || text_.take('n')) {
        is_supported = false;
      } else {
        is_known = has_texcoords_ = text_.take('S') && text_.take('T');
      }
    }
    if (!is_known || !text_.take('F') || !text_.take('F')) text_.fail(word + " where \"OFF\" was expected");
    if (!is_supported || text_.next_is('B'))
      throw Error(ErrorCode::unsupported, source_.name(), text_.place(),
                  "four-dimensional and binary OFF files are not supported");
  }

  /// Checks a count before memory is allocated: the rest of the file must have room for the rows, at two characters a
  /// value.
  std::size_t checked(std::int64_t count, std::uint64_t values, const char* what) const {
    if (count < 0) text_.fail(std::string("a negative number of ") + what);
    if (std::uint64_t(count) > (text_.bytes_left() + 1) / (2 * values))
      text_.fail(std::to_string(count) + " " + what + " do not fit into the " + std::to_string(text_.bytes_left()) +
                 " bytes that follow");
    if (count >= std::int64_t(no_index)) source_.fail_limit(text_.place(), std::string("too many ") + what);
    return std::size_t(count);
  }

  /// Reads the next three numbers of a vertex, as floats and as doubles.
  glm::vec3 three_numbers(glm::dvec3& exact) {
    glm::vec3 rounded(0);
    for (int k = 0; k < 3; ++k) {
      if (!text_.to_word()) text_.fail("the file ends within the vertices");
      if (!text_.number(rounded[k], exact[k]) || !text_.at_blank()) text_.fail("not a number");
    }
    return rounded;
  }

  void read_vertices(Mesh& mesh) {
    RawColors colors;
    mesh.positions.reserve(vertex_count_);
    for (std::size_t i = 0; i < vertex_count_; ++i) {
      if (!text_.next_line()) text_.fail("the file ends within the vertices");
      glm::dvec3 exact(0);
      const glm::vec3 rounded = three_numbers(exact);
      mesh.positions.push_back(coordinates_(rounded, exact));
      glm::vec3 normal(0);
      if (has_normals_) normal = three_numbers(exact);
      float extra[6];
      int count = rest_of_row(extra);
      if (has_texcoords_) {
        if (count < 2) text_.fail("texture coordinates were expected");
        count -= 2;
        mesh.texcoords.values.emplace_back(extra[count], 1.0f - extra[count + 1]);
      }
      // MeshLab's NCOFF has the colour first, with an alpha of 255; other programs write the normal first.
      const auto is_unit = [](float value) { return std::abs(value) <= 1; };
      if (is_normal_named_first_ && count == 4 && extra[0] > 1 && std::all_of(extra + 1, extra + 4, is_unit)) {
        colors.add({normal, extra[0]});
        normal = {extra[1], extra[2], extra[3]};
      } else if (has_colors_ || count > 0) {
        colors.add(color(extra, count));
      }
      if (has_normals_) mesh.normals.values.push_back(normal);
    }
    if (has_colors_ || (colors.size() == vertex_count_ && colors.are_unmistakable()))
      mesh.colors.values = colors.take_linear();
    else if (colors.size() > 0)
      scene_.warnings.emplace_back(
          "vertices: the numbers after the coordinates are not read; C, N or ST before OFF would say what they are");
  }

  /// Reads the remaining numbers of the line, at most six. \returns their number.
  int rest_of_row(float (&values)[6]) {
    int count = 0;
    while (count < 6 && !text_.at_line_end() && text_.number(values[count])) ++count;
    return count;
  }
  /// Returns a colour of three or four components. Other counts, such as an index of a colour map, give no colour.
  static glm::vec4 color(const float (&values)[6], int count) {
    if (count != 3 && count != 4) return RawColors::none();
    return {values[0], values[1], values[2], count == 4 ? values[3] : std::numeric_limits<float>::quiet_NaN()};
  }

  void read_faces(Mesh& mesh) {
    RawColors colors;
    PolygonWriter polygons;
    std::vector<std::uint32_t> corners;
    std::vector<glm::uvec3> color_corners;
    mesh.triangles.reserve(face_count_);
    for (std::size_t i = 0; i < face_count_; ++i) {
      if (!text_.next_line() || !text_.to_word()) text_.fail("the file ends before face " + std::to_string(i));
      read_corners(corners);
      const std::size_t before = mesh.triangles.size();
      polygons.add(corners, mesh.positions, mesh);
      // Colours of vertices have precedence over those of faces.
      if (!mesh.colors.empty() || (text_.at_line_end() && colors.size() == 0)) continue;
      // At the first face with a colour, the faces before it get the colour that means none.
      if (colors.size() == 0) {
        colors.add(RawColors::none());
        color_corners.resize(before, glm::uvec3(0));
      }
      float extra[6];
      const int count = rest_of_row(extra);
      color_corners.resize(mesh.triangles.size(), glm::uvec3(std::uint32_t(colors.size())));
      colors.add(color(extra, count));
    }
    if (polygons.skipped_count() > 0) scene_.warnings.push_back(skipped_faces_warning(polygons.skipped_count()));
    if (colors.size() > 0) mesh.colors = {colors.take_linear(), std::move(color_corners)};
  }

  void read_corners(std::vector<std::uint32_t>& corners) {
    std::int64_t count = 0, index = 0;
    if (!text_.integer(count) || count < 0 || !text_.at_blank()) text_.fail("the number of corners was expected");
    if (std::uint64_t(count) > (text_.bytes_left() + 1) / 2) text_.fail("the file ends within the face");
    corners.resize(std::size_t(count));
    for (std::uint32_t& corner : corners) {
      if (!text_.integer(index) || !text_.at_blank())
        text_.fail("a face of " + std::to_string(count) + " corners has too few");
      if (index < 0 || std::uint64_t(index) >= vertex_count_)
        text_.fail("vertex " + std::to_string(index) + " is out of range, there are " + std::to_string(vertex_count_));
      corner = std::uint32_t(index);
    }
  }

  TextScanner text_;
  const ModelSource& source_;
  Coordinates& coordinates_;
  Scene scene_;
  bool has_texcoords_ = false, has_colors_ = false, has_normals_ = false, is_normal_named_first_ = false;
  std::size_t vertex_count_ = 0, face_count_ = 0;
};

}  // namespace

Scene read_off(Bytes bytes, const ModelSource& source) {
  return read_about_origin([&](Coordinates& coordinates) { return OffReader(bytes, source, coordinates).read(); });
}

}  // namespace frontmost
