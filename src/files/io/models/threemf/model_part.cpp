// SPDX-License-Identifier: Apache-2.0
// The tags of a model part. Tags of the core specification, colours of the materials extension and paths of the
// production extension are read; all other tags, with their contents, are skipped.
//
//   <model unit="millimeter">
//     <resources>
//       <basematerials id="1"> <base .../> </basematerials>       <m:colorgroup id="2"> ...
//       <object id="3"> <mesh> <vertices> ... <triangles> ...     or <components>
//     </resources>
//     <build> <item objectid="3" transform="..."/> </build>
//   </model>
//
// The stack of open tags decides the meaning of a tag. An unknown tag is skipped with all its contents.
#include <algorithm>
#include <cmath>
#include <set>

#include "io/models/mesh_building.h"
#include "io/models/reader.h"
#include "io/models/text.h"
#include "io/models/threemf/threemf.h"
#include "scene/origin.h"

namespace frontmost::threemf {
namespace {

/// Extensions that are implemented, or that change nothing visible.
constexpr std::string_view supported[] = {
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
};
/// Tags beside meshes that change nothing visible, or that groups refer to.
constexpr std::string_view invisible[] = {"metadatagroup",
                                          "trianglesets",
                                          "texture2d",
                                          "pbmetallicdisplayproperties",
                                          "pbspeculardisplayproperties",
                                          "translucentdisplayproperties"};

constexpr std::string_view core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02|";
constexpr std::string_view materials = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02|";
constexpr std::string_view production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06|";

enum class Tag : std::uint8_t {
  document,
  model,
  resources,
  base_materials,
  base,
  color_group,
  color,
  unknown_group,
  object,
  mesh,
  vertices,
  vertex,
  triangles,
  triangle,
  components,
  component,
  build,
  item,
  passed_over
};

struct Rule {
  Tag parent;
  std::string_view space, name;
  Tag tag;
};
constexpr Rule rules[] = {
    {Tag::triangles, core, "triangle", Tag::triangle},
    {Tag::vertices, core, "vertex", Tag::vertex},
    {Tag::document, core, "model", Tag::model},
    {Tag::model, core, "resources", Tag::resources},
    {Tag::model, core, "build", Tag::build},
    {Tag::resources, core, "basematerials", Tag::base_materials},
    {Tag::resources, materials, "colorgroup", Tag::color_group},
    {Tag::resources, materials, "texture2dgroup", Tag::unknown_group},
    {Tag::resources, materials, "compositematerials", Tag::unknown_group},
    {Tag::resources, materials, "multiproperties", Tag::unknown_group},
    {Tag::resources, core, "object", Tag::object},
    {Tag::base_materials, core, "base", Tag::base},
    {Tag::color_group, materials, "color", Tag::color},
    {Tag::object, core, "mesh", Tag::mesh},
    {Tag::object, core, "components", Tag::components},
    {Tag::mesh, core, "vertices", Tag::vertices},
    {Tag::mesh, core, "triangles", Tag::triangles},
    {Tag::components, core, "component", Tag::component},
    {Tag::build, core, "item", Tag::item},
};

/// Returns the meaning of a tag within `parent`. `core_space` is the prefix of core tags in this file.
Tag tag_of(Tag parent, std::string_view name, std::string_view core_space) {
  for (const Rule& rule : rules) {
    if (rule.parent != parent || !name.ends_with(rule.name)) continue;
    const std::string_view space = rule.space == core ? core_space : rule.space;
    if (name.size() == space.size() + rule.name.size() && name.starts_with(space)) return rule.tag;
  }
  return Tag::passed_over;
}

struct Unit {
  std::string_view name;
  double metres;
};
constexpr Unit units[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
                          {"inch", 0.0254}, {"foot", 0.3048},     {"meter", 1}};

// Values of attributes are read as strictly as the schema defines except for blanks around them. A value with anything
// behind it is refused, because half of a transform would place an object somewhere.

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Returns a number, which may be infinite or NaN: such vertices are kept, as in all formats.
std::optional<double> parse_number(std::string_view text) {
  const std::string_view word = trimmed(text);
  double value = 0;
  const char* const end = word.data() + word.size();
  return parse_double(word.data(), end, value) == end ? std::optional(value) : std::nullopt;
}

/// Returns a whole number below no_index.
std::optional<std::uint32_t> parse_index(std::string_view text) {
  const std::string_view word = trimmed(text);
  std::int64_t value = 0;
  const char* const end = word.data() + word.size();
  if (parse_integer(word.data(), end, value) != end || value < 0 || value >= std::int64_t(no_index))
    return std::nullopt;
  return std::uint32_t(value);
}

/// Returns a colour #RRGGBB or #RRGGBBAA in sRGB, converted to linear light.
std::optional<glm::vec4> parse_color(std::string_view text) {
  const std::string_view word = trimmed(text);
  if ((word.size() != 7 && word.size() != 9) || word[0] != '#') return std::nullopt;
  glm::vec4 srgb(1);
  for (std::size_t k = 0; 2 * k + 1 < word.size(); ++k) {
    const int high = hex_digit(word[2 * k + 1]), low = hex_digit(word[2 * k + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    srgb[int(k)] = float(16 * high + low) / 255.0f;
  }
  return linear_color(srgb);
}

/// Returns a transform by twelve finite numbers: the rows of a matrix for row vectors, without its last column.
std::optional<glm::dmat4> parse_transform(std::string_view text) {
  glm::dmat4 matrix(1.0);
  for (int i = 0; i < 12; ++i) {
    text = trimmed(text);
    const std::size_t size = std::min(text.find_first_of(blanks), text.size());
    const std::optional<double> value = parse_number(text.substr(0, size));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    matrix[i / 3][i % 3] = *value;
    text.remove_prefix(size);
  }
  return trimmed(text).empty() ? std::optional(matrix) : std::nullopt;
}

class ModelPartReader : public XmlPart {
 public:
  ModelPartReader(const std::string& name, const ModelSource& source, Scene& scene)
      : XmlPart(name, source), scene_(scene) {
    part_.name = name;
  }

  ModelPart read(Package& package) {
    XmlPart::read(package);
    if (!has_model_) source().fail(name(), "is no 3MF model: its first tag is not model");
    return std::move(part_);
  }

 protected:
  void start(std::string_view name, const Attributes& attributes) override {
    const Tag parent = path_.empty() ? Tag::document : path_.back();
    if (parent == Tag::document) core_space_ = name.substr(0, name.rfind('|') + 1);
    const Tag tag = tag_of(parent, name, core_space_);
    path_.push_back(tag);
    const TagReader tags(attributes, *this);
    switch (tag) {
      case Tag::triangle: return read_triangle(tags);
      case Tag::vertex: return read_vertex(tags);
      case Tag::model: return read_model(tags);
      case Tag::base_materials: return start_group(PropertyGroup::Kind::materials, tags, name);
      case Tag::color_group: return start_group(PropertyGroup::Kind::colors, tags, name);
      case Tag::unknown_group: return start_group(PropertyGroup::Kind::unknown, tags, name);
      case Tag::base: return read_base(tags);
      case Tag::color: return read_color(tags);
      case Tag::object: return start_object(tags);
      case Tag::mesh: return start_mesh();
      case Tag::component: return object_->components.push_back(read_placed(tags));
      case Tag::item: return part_.items.push_back(read_placed(tags));
      case Tag::passed_over: return pass_over(parent, name);
      default: return;
    }
  }

  void declare(std::string_view prefix, std::string_view space) override {
    if (path_.empty()) spaces_.emplace(prefix, space);
  }

  void end() override {
    if (path_.back() == Tag::vertices) end_vertices();
    path_.pop_back();
  }

 private:
  /// Reads the values of a tag. Its messages name the tag.
  class TagReader {
   public:
    TagReader(const Attributes& attributes, ModelPartReader& reader) : attributes_(attributes), reader_(reader) {}

    [[nodiscard]] const char* find(std::string_view name) const { return attributes_.find(name); }
    [[nodiscard]] const char* require(std::string_view name) const {
      const char* const value = attributes_.find(name);
      if (value == nullptr) reader_.fail(std::string(name) + " is missing");
      return value;
    }
    [[nodiscard]] double number(std::string_view name) const {
      const std::optional<double> value = parse_number(require(name));
      if (!value) fail(name, "is not a number");
      return *value;
    }
    [[nodiscard]] std::uint32_t index(std::string_view name) const {
      const std::optional<std::uint32_t> value = parse_index(require(name));
      if (!value) fail(name, no_index_reason);
      return *value;
    }
    /// Returns an index that only affects appearance. A wrong one causes a warning and counts as absent.
    [[nodiscard]] std::uint32_t look_index_or(std::string_view name, std::uint32_t absent) const {
      const std::optional<std::uint32_t> value = find(name) == nullptr ? absent : parse_index(require(name));
      if (!value) warn(name, no_index_reason);
      return value.value_or(absent);
    }
    [[noreturn]] void fail(std::string_view name, const std::string& reason) const {
      reader_.fail(complaint(name, reason));
    }
    void warn(std::string_view name, const std::string& reason) const {
      reader_.warn_once(std::string(name), complaint(name, reason));
    }

   private:
    [[nodiscard]] std::string complaint(std::string_view name, const std::string& reason) const {
      const char* const value = find(name);
      return std::string(name) + " " + (value == nullptr ? "is missing" : in_quotes(value) + " " + reason);
    }
    static constexpr const char* no_index_reason = "is not a whole number below 4294967295";
    const Attributes& attributes_;
    ModelPartReader& reader_;
  };

  /// Warns about the first fault of each kind, because a file may hold millions.
  void warn_once(const std::string& kind, const std::string& what) {
    if (warned_.insert(kind).second) part_.warnings.push_back(place() + ": " + what);
  }

  void read_model(const TagReader& tags) {
    has_model_ = true;
    if (core_space_ != core)
      part_.warnings.push_back(place() + ": model is not in the namespace of 3MF; it is read as if it were");
    if (const char* const required = tags.find("requiredextensions")) check_extensions(required);
    if (const char* const unit = tags.find("unit")) {
      const auto known =
          std::find_if(std::begin(units), std::end(units), [&](const Unit& u) { return u.name == unit; });
      if (known == std::end(units))
        tags.warn("unit", "is not a unit of 3MF; millimeter is assumed");
      else
        part_.metres_per_unit = known->metres;
    }
  }

  void check_extensions(std::string_view prefixes) const {
    while (!prefixes.empty()) {
      const std::size_t size = std::min(prefixes.find_first_of(blanks), prefixes.size());
      const auto space = spaces_.find(std::string(prefixes.substr(0, size)));
      const std::string name = space == spaces_.end() ? "" : space->second;
      if (size > 0 && std::find(std::begin(supported), std::end(supported), name) == std::end(supported))
        throw Error(ErrorCode::unsupported, source().name(), place(),
                    "requires the extension " + printable(name.empty() ? prefixes.substr(0, size) : name) +
                        ", which is not supported");
      prefixes.remove_prefix(std::min(size + 1, prefixes.size()));
    }
  }

  /// Warns about an unknown tag that may have visible contents.
  void pass_over(Tag parent, std::string_view name) {
    if (parent != Tag::resources && parent != Tag::object && parent != Tag::mesh) return;
    const std::string local(name.substr(name.rfind('|') + 1));
    if (std::find(std::begin(invisible), std::end(invisible), local) != std::end(invisible)) return;
    warn_once(local, in_quotes(local) + " is not read");
  }

  void start_group(PropertyGroup::Kind kind, const TagReader& tags, std::string_view name) {
    const auto [entry, is_new] = part_.groups.try_emplace(tags.look_index_or("id", no_index));
    if (!is_new) tags.warn("id", "is also the id of an earlier group, which is used");
    group_ = is_new ? &entry->second : &repeated_group_;
    group_->kind = kind;
    group_->first_material = std::uint32_t(scene_.materials.size());
    group_->element = name.substr(name.rfind('|') + 1);
  }

  /// Reads a colour. \returns white if the value is no colour.
  static glm::vec4 color(const TagReader& tags, std::string_view name) {
    const char* const value = tags.find(name);
    const std::optional<glm::vec4> color = value == nullptr ? std::nullopt : parse_color(value);
    if (!color) tags.warn(name, "is not a colour such as #RRGGBB or #RRGGBBAA");
    return color.value_or(glm::vec4(1));
  }

  void read_base(const TagReader& tags) {
    if (scene_.materials.size() >= max_objects) source().fail_limit(place(), "too many materials");
    Material& material = scene_.materials.emplace_back();
    if (const char* const name = tags.find("name")) material.name = name_of(name);
    material.base_color = color(tags, "displaycolor");
    if (material.base_color.a < 1) material.alpha = Material::Alpha::blend;
    ++group_->count;
  }

  void read_color(const TagReader& tags) {
    group_->colors.push_back(color(tags, "color"));
    ++group_->count;
  }

  void start_object(const TagReader& tags) {
    const auto [entry, is_new] = part_.objects.try_emplace(tags.index("id"));
    if (!is_new) tags.fail("id", "is already used by an earlier object");
    if (part_.objects.size() > max_objects) source().fail_limit(place(), "too many objects");
    object_ = &entry->second;
    object_->line = line();
    if (const char* const name = tags.find("name")) object_->name = name_of(name);
    object_->property.group = tags.look_index_or("pid", no_index);
    object_->property.corners.fill(tags.look_index_or("pindex", no_index));
  }

  void start_mesh() {
    if (object_->mesh != no_index) fail("a second mesh in one object");
    if (scene_.meshes.size() >= max_objects) source().fail_limit(place(), "too many meshes");
    object_->mesh = std::uint32_t(scene_.meshes.size());
    scene_.meshes.emplace_back().name = object_->name;
  }
  Mesh& mesh() { return scene_.meshes[object_->mesh]; }

  void read_vertex(const TagReader& tags) {
    if (vertices_.size() >= no_index) source().fail_limit(place(), "too many vertices");
    vertices_.emplace_back(tags.number("x"), tags.number("y"), tags.number("z"));
  }
  /// Ends the list of a mesh's vertices and converts the vertices to floats. They are doubles until then, because the
  /// best origin for the floats depends on all vertices.
  void end_vertices() {
    Mesh& mesh = this->mesh();
    if (!mesh.positions.empty()) fail("a second list of vertices in one mesh");
    OriginSearch search;
    for (const glm::dvec3& vertex : vertices_) search.include(vertex);
    mesh.origin = search.origin();
    mesh.positions.reserve(vertices_.size());
    for (const glm::dvec3& vertex : vertices_) mesh.positions.emplace_back(vertex - mesh.origin);
    vertices_ = {};
  }

  void read_triangle(const TagReader& tags) {
    Mesh& mesh = this->mesh();
    const glm::uvec3 corners(tags.index("v1"), tags.index("v2"), tags.index("v3"));
    for (int k = 0; k < 3; ++k)
      if (corners[k] >= mesh.positions.size())
        fail("v" + std::to_string(k + 1) + " is " + std::to_string(corners[k]) + ", but there are only " +
             std::to_string(mesh.positions.size()) + " vertices before");
    mesh.triangles.push_back(corners);
    if (tags.find("pid") == nullptr && tags.find("p1") == nullptr && object_->triangle_properties.empty()) return;
    Property property = object_->property;
    property.group = tags.look_index_or("pid", property.group);
    if (tags.find("p1") != nullptr) {
      const std::uint32_t first = tags.look_index_or("p1", no_index);
      property.corners = {first, tags.look_index_or("p2", first), tags.look_index_or("p3", first)};
    }
    object_->triangle_properties.resize(mesh.triangles.size() - 1, object_->property);
    object_->triangle_properties.push_back(property);
  }

  PlacedObject read_placed(const TagReader& tags) {
    if (++placed_count_ > max_objects) source().fail_limit(place(), "too many components and items");
    PlacedObject placed;
    placed.object = tags.index("objectid");
    placed.line = line();
    static const std::string path_name = std::string(production) + "path";
    if (const char* const path = tags.find(path_name)) placed.part = part_name(path);
    if (const char* const transform = tags.find("transform")) {
      const std::optional<glm::dmat4> matrix = parse_transform(transform);
      if (!matrix) tags.fail("transform", "is not twelve finite numbers");
      placed.outer_from_object = *matrix;
    }
    return placed;
  }

  Scene& scene_;
  ModelPart part_;
  std::map<std::string, std::string> spaces_;  ///< declared by the first tag, by prefix
  std::string core_space_;                     ///< the namespace of the first tag, with a | behind it if there is one
  std::set<std::string> warned_;               ///< kinds of warnings that were given
  std::vector<Tag> path_;
  bool has_model_ = false;
  PropertyGroup* group_ = nullptr;
  PropertyGroup repeated_group_;  ///< receives a group whose number is taken
  Object* object_ = nullptr;
  std::vector<glm::dvec3> vertices_;  ///< vertices of the current mesh
  std::size_t placed_count_ = 0;
};

}  // namespace

ModelPart read_model_part(const std::string& name, Package& package, const ModelSource& source, Scene& scene) {
  return ModelPartReader(name, source, scene).read(package);
}

}  // namespace frontmost::threemf
