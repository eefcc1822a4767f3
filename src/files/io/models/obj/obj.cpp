// SPDX-License-Identifier: Apache-2.0
// OBJ: polygons with separate indices for positions, texture coordinates and normals. Each run of faces under one `o`
// or `g` name becomes a mesh and its instance, in file order. Lines become the mesh's edges. Curves and points are
// skipped.
//
//   v 0 0 0              lists of the whole file: positions, perhaps with a colour, ...
//   vt 0.5 1             texture coordinates, ...
//   vn 0 0 1             normals
//   g lid                what follows belongs to an object of this name
//   usemtl steel
//   f 1/1/1 2/2/1 -1//1  corners: position/texture/normal, counted from 1, or backwards from the last one so far
//
// An index may exceed the current length of its list. The check comes at the end; errors name the line.
#include <algorithm>
#include <set>

#include "io/models/coordinates.h"
#include "io/models/mesh_building.h"
#include "io/models/obj/mtl.h"
#include "io/models/text.h"

namespace frontmost {
namespace {

constexpr std::uint64_t max_library_bytes = std::uint64_t(1) << 28;

/// The lists of values to which all faces of the file refer.
struct ObjPool {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec4> colors;  ///< as many as positions, or none
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec3> normals;
};

/// Appends corner indices for the newest triangles. The list starts with the first face that has any.
template <class T>
void add_corners(Attribute<T>& attribute, std::span<const glm::uvec3> triangles,
                 const std::vector<std::uint32_t>& corners, std::size_t triangles_before) {
  if (attribute.triangles.empty()) {
    bool any = false;
    for (const std::uint32_t corner : corners) any |= corner != no_index;
    if (!any) return;
    attribute.triangles.resize(triangles_before, glm::uvec3(no_index));
  }
  for (const glm::uvec3& t : triangles) attribute.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
}

/// Renumbers indices in the order of first use.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : numbers_(count, no_index) {}

  /// Renumbers all corners except missing ones. \returns the old numbers in the new order, valid until the next call.
  const std::vector<std::uint32_t>& apply(std::vector<glm::uvec3>& triangles) {
    // Only used entries are cleared, because a file may have as many groups as faces.
    for (const std::uint32_t old : used_) numbers_[old] = no_index;
    used_.clear();
    for (glm::uvec3& t : triangles)
      for (int k = 0; k < 3; ++k) {
        if (t[k] == no_index) continue;
        std::uint32_t& number = numbers_[t[k]];
        if (number == no_index) {
          number = std::uint32_t(used_.size());
          used_.push_back(t[k]);
        }
        t[k] = number;
      }
    return used_;
  }
  /// Renumbers the edges between entries that the last call of apply() has renumbered, and leaves out the others.
  void apply(std::vector<glm::uvec2>& edges) const {
    std::erase_if(edges,
                  [&](const glm::uvec2& edge) { return numbers_[edge.x] == no_index || numbers_[edge.y] == no_index; });
    for (glm::uvec2& edge : edges) edge = {numbers_[edge.x], numbers_[edge.y]};
  }

 private:
  std::vector<std::uint32_t> numbers_, used_;
};

template <class T>
std::vector<T> gather(const std::vector<T>& pool, const std::vector<std::uint32_t>& numbers) {
  std::vector<T> values;
  values.reserve(numbers.size());
  for (const std::uint32_t number : numbers) values.push_back(pool[number]);
  return values;
}

/// Completes an attribute. Corners without a value get one that counts as missing. The list of indices is dropped if
/// they equal those of the positions.
template <class T>
void complete(Attribute<T>& attribute, const Mesh& mesh) {
  if (attribute.triangles.empty()) {
    attribute.values = std::vector<T>();
    return;
  }
  const auto missing = std::uint32_t(attribute.values.size());
  bool any = false;
  for (glm::uvec3& t : attribute.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] == no_index) t[k] = missing, any = true;
  if (any) attribute.values.push_back(T(0));
  if (attribute.values.size() >= mesh.positions.size() && attribute.triangles == mesh.triangles)
    attribute.triangles = std::vector<glm::uvec3>();
}

/// Gives each mesh its part of the pool, renumbered in the order of first use, mesh by mesh. A single mesh keeps the
/// file's own numbering, with unused vertices, so that vertex numbers are those of the file.
void finish_meshes(Scene& scene, ObjPool pool) {
  if (scene.meshes.size() == 1) {
    Mesh& mesh = scene.meshes[0];
    mesh.positions = std::move(pool.positions);
    mesh.colors.values = std::move(pool.colors);
    mesh.texcoords.values = std::move(pool.texcoords);
    mesh.normals.values = std::move(pool.normals);
  } else {
    Renumbering positions(pool.positions.size()), texcoords(pool.texcoords.size()), normals(pool.normals.size());
    for (Mesh& mesh : scene.meshes) {
      const auto& used = positions.apply(mesh.triangles);
      mesh.positions = gather(pool.positions, used);
      positions.apply(mesh.sharp_edges);
      if (!pool.colors.empty()) mesh.colors.values = gather(pool.colors, used);
      mesh.texcoords.values = gather(pool.texcoords, texcoords.apply(mesh.texcoords.triangles));
      mesh.normals.values = gather(pool.normals, normals.apply(mesh.normals.triangles));
    }
  }
  for (Mesh& mesh : scene.meshes) {
    // This step needs the final positions: their number decides whether a list of corners is needed.
    complete(mesh.texcoords, mesh);
    complete(mesh.normals, mesh);
    if (mesh.material_ids.size() == 1 && mesh.material_ids[0] == no_index) mesh.material_ids.clear();
  }
}

/// The indices of a polygon's corners into one list of the file, and the greatest index so far, which may name an
/// element that the file defines later.
struct IndexList {
  const char* what;
  std::vector<std::uint32_t> corners;
  std::uint32_t greatest = 0;
  std::size_t greatest_line = 0;
};

class ObjReader {
 public:
  ObjReader(Bytes bytes, const ModelSource& source, Coordinates& coordinates)
      : text_(bytes, source, TextScanner::Comments::hash),
        source_(source),
        coordinates_(coordinates),
        materials_(source, scene_),
        textures_(source, scene_) {}

  Scene read() {
    do statement(text_.word());
    while (text_.next_line());
    finish();
    return std::move(scene_);
  }

 private:
  void statement(std::string_view word) {
    // The most frequent statements come first.
    if (word == "v") {
      vertex();
    } else if (word == "f" || word == "fo") {
      face();
    } else if (word == "vt") {
      glm::vec2 uv(0);
      if (!text_.number(uv.x)) text_.fail("a texture coordinate needs a number");
      (void)text_.number(uv.y);
      // v points down from the top, as in glTF; in the file it points up.
      pool_.texcoords.emplace_back(uv.x, 1.0f - uv.y);
    } else if (word == "vn") {
      normal();
    } else if (!word.empty()) {
      rare_statement(word);
    }
  }

  void rare_statement(std::string_view word) {
    if (word == "usemtl") {
      material_ = materials_.number(name_of(text_.rest()));
    } else if (word == "mtllib") {
      library(std::string(text_.rest()));
    } else if (word == "o") {
      object_ = name_of(text_.rest());
      start_group(object_);
    } else if (word == "g") {
      const std::string name = name_of(text_.rest());
      start_group(name.empty() || name == "default" || name == "off" ? object_ : name);
    } else if (word == "l" && !is_new_group_ && !scene_.meshes.empty()) {
      line();
    } else if (word != "s") {
      pass_over(word);
    }
  }

  void normal() {
    glm::vec3& normal = pool_.normals.emplace_back();
    for (int k = 0; k < 3; ++k)
      if (!text_.number(normal[k])) text_.fail("a normal needs three numbers");
  }

  /// Reads v x y z, v x y z w, v x y z r g b, or v x y z w r g b.
  void vertex() {
    glm::vec3 rounded;
    glm::dvec3 exact;
    for (int k = 0; k < 3; ++k)
      if (!text_.number(rounded[k], exact[k])) text_.fail("a vertex needs three numbers");
    pool_.positions.push_back(coordinates_(rounded, exact));
    if (!text_.at_line_end()) vertex_color();
    if (!pool_.colors.empty() && pool_.colors.size() < pool_.positions.size())
      pool_.colors.resize(pool_.positions.size(), glm::vec4(1));
  }

  void vertex_color() {
    float extra[4];
    int count = 0;
    while (count < 4 && text_.number(extra[count])) ++count;
    if (count < 3) return;
    // Four numbers are a weight and a colour. The weight belongs to rational curves and is not used.
    const float* rgb = extra + count - 3;
    pool_.colors.resize(pool_.positions.size() - 1, glm::vec4(1));
    pool_.colors.push_back(linear_color({rgb[0], rgb[1], rgb[2], 1}));
  }

  void start_group(const std::string& name) {
    // The next face begins the group, so that groups without faces leave no empty objects.
    is_new_group_ = is_new_group_ || name != group_;
    group_ = name;
  }

  /// Appends an index of the file. The index counts from 1, or backwards from the last element defined so far.
  void append(IndexList& list, std::int64_t index, std::size_t count) {
    if (index < 0) index += std::int64_t(count) + 1;
    if (index < 1 || index >= std::int64_t(no_index))
      text_.fail(std::string(list.what) + " index out of range, there are " + std::to_string(count) + " so far");
    const auto number = std::uint32_t(index - 1);
    if (number > list.greatest || list.greatest_line == 0) {
      list.greatest = number;
      list.greatest_line = text_.line();
    }
    list.corners.push_back(number);
  }

  /// Reads v, v/vt, v//vn or v/vt/vn. Omitted indices become no_index.
  bool corner() {
    std::int64_t index = 0;
    if (text_.at_line_end()) return false;
    if (!text_.integer(index)) text_.fail("not a corner of a face");
    append(vertices_, index, pool_.positions.size());
    uvs_.corners.push_back(no_index);
    normals_.corners.push_back(no_index);
    if (text_.take('/')) {
      if (text_.integer_here(index)) {
        uvs_.corners.pop_back();
        append(uvs_, index, pool_.texcoords.size());
      }
      if (text_.take('/') && text_.integer_here(index)) {
        normals_.corners.pop_back();
        append(normals_, index, pool_.normals.size());
      }
    }
    if (!text_.at_blank()) text_.fail("not a corner of a face");
    return true;
  }

  void face() {
    vertices_.corners.clear();
    uvs_.corners.clear();
    normals_.corners.clear();
    while (corner()) {
    }
    if (is_new_group_ || scene_.meshes.empty()) {
      add_object(scene_, group_, source_, text_.place());
      polygons_.restart();
      is_new_group_ = false;
    }
    Mesh& mesh = scene_.meshes.back();
    const std::size_t skipped = polygons_.skipped_count();
    const auto triangles = polygons_.add(vertices_.corners, pool_.positions, mesh);
    if (polygons_.skipped_count() == 1 && skipped == 0)
      scene_.warnings.push_back(text_.place() + ": a face with fewer than three corners was passed over");
    // Indices are those of the pool until the end.
    const std::size_t before = mesh.triangles.size() - triangles.size();
    add_corners(mesh.texcoords, triangles, uvs_.corners, before);
    add_corners(mesh.normals, triangles, normals_.corners, before);
    append_material(mesh.material_ids, before, triangles.size(), material_);
  }

  /// Reads l v v v ..., edges of the object; v may be v/vt.
  void line() {
    for (IndexList* const list : {&vertices_, &uvs_, &normals_}) list->corners.clear();
    while (corner()) {
    }
    for (std::size_t i = 1; i < vertices_.corners.size(); ++i)
      scene_.meshes.back().sharp_edges.emplace_back(vertices_.corners[i - 1], vertices_.corners[i]);
  }

  void pass_over(std::string_view word) {
    const std::string keyword(word.substr(0, 40));
    constexpr std::size_t most = 16;
    // Each keyword causes one warning, up to a limit: a file of another format would cause one for each line.
    if (passed_over_.size() >= most || !passed_over_.insert(keyword).second) return;
    if (first_odd_line_ == 0) first_odd_line_ = text_.line();
    scene_.warnings.push_back(text_.place() + ": statements " + in_quotes(word) + " are passed over");
  }

  /// Reads the libraries of a statement. Its text is tried as one name with blanks first, then as several names.
  void library(const std::string& names) {
    const std::string place = text_.place();
    if (names.empty()) return;
    if (!source_.has_folder()) {
      scene_.warnings.push_back(place + ": " + printable(names) +
                                " is not read, because the model does not come from a file");
      return;
    }
    std::string reason;
    if (read_library(names, reason)) return;
    std::size_t begin = names.find_first_of(" \t");
    if (begin != std::string::npos) {
      reason.clear();
      for (begin = 0; begin < names.size();) {
        const std::size_t end = std::min(names.find_first_of(" \t", begin), names.size());
        if (end > begin) read_library(names.substr(begin, end - begin), reason);
        begin = end + 1;
      }
    }
    if (!reason.empty()) scene_.warnings.push_back(place + ": material library left out: " + reason);
  }

  bool read_library(const std::string& name, std::string& reason) {
    constexpr std::size_t most = 256;
    // The model names these files, and must not make this machine open thousands of them.
    if (libraries_.size() >= most) return true;
    try {
      if (!libraries_.insert(name).second) return true;
      const InputFile file = source_.open(name, max_library_bytes);
      const ModelSource library(source_.name() + ": " + printable(name), source_.execution());
      read_mtl(file.bytes(), library, std::filesystem::path(name).parent_path().generic_string(), textures_,
               materials_);
      return true;
    } catch (const Error& error) {
      // A model without colours is better than none, so all errors but cancellation become warnings.
      if (error.code() == ErrorCode::cancelled) throw;
      reason = source_.without_name(error);
      return false;
    }
  }

  void check_greatest(const IndexList& list, std::size_t count) const {
    if (list.greatest_line == 0 || list.greatest < count) return;
    source_.fail("line " + std::to_string(list.greatest_line),
                 std::string(list.what) + " index " + std::to_string(std::uint64_t(list.greatest) + 1) +
                     " is out of range, there are " + std::to_string(count));
  }

  void finish() {
    // Without this check, any text would be an OBJ file with some warnings.
    if (pool_.positions.empty() && first_odd_line_ != 0)
      source_.fail("line " + std::to_string(first_odd_line_), "not an OBJ statement");
    check_greatest(vertices_, pool_.positions.size());
    check_greatest(uvs_, pool_.texcoords.size());
    check_greatest(normals_, pool_.normals.size());
    // A file of only points and lines keeps its positions, as PLY files do, so that a warning can count them.
    if (scene_.meshes.empty() && !pool_.positions.empty()) add_object(scene_, group_, source_, text_.place());
    finish_meshes(scene_, std::move(pool_));
    materials_.finish();
  }

  TextScanner text_;
  const ModelSource& source_;
  Coordinates& coordinates_;
  Scene scene_;
  NamedMaterials materials_;
  TextureFiles textures_;
  ObjPool pool_;
  IndexList vertices_{"vertex", {}, 0, 0}, uvs_{"texture coordinate", {}, 0, 0}, normals_{"normal", {}, 0, 0};
  PolygonWriter polygons_;
  std::string object_, group_;
  bool is_new_group_ = false;
  std::uint32_t material_ = no_index;
  std::set<std::string> passed_over_, libraries_;
  std::size_t first_odd_line_ = 0;
};

}  // namespace

Scene read_obj(Bytes bytes, const ModelSource& source) {
  return read_about_origin([&](Coordinates& coordinates) { return ObjReader(bytes, source, coordinates).read(); });
}

}  // namespace frontmost
