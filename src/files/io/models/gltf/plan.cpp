// SPDX-License-Identifier: Apache-2.0
// Checks the parts of meshes before any data is read.
//
//   mesh --> primitives --> attributes --> accessors: number of components, type, equal counts
//                       --> indices, morph targets, joints and weights
//
// The resulting MeshPlan can be read without further checks.
#include <algorithm>
#include <utility>

#include "io/models/gltf/nodes.h"

namespace frontmost::gltf {
namespace {

/// Greatest number of sets of joints. A set has four joints, and real files have one set, rarely two.
constexpr std::size_t max_joint_sets = 16;

/// The kinds of accessors that an attribute may be read from.
struct Allowed {
  int least_components, most_components;
  bool integers;  ///< only unsigned integers
};

/// Reads the attributes of one primitive or morph target. `decoded` holds its compressed attributes, if any.
class AttributeReader {
 public:
  AttributeReader(const JsonValue& json, const Data& data, const DecodedPrimitive* decoded = nullptr)
      : json_(json), data_(data), decoded_(decoded) {}

  /// Returns the number of an attribute's accessor, or no_index if the attribute is absent. \throws Error if the
  /// accessor is not allowed.
  std::uint32_t find(const std::string& name, Allowed allowed) {
    const std::optional<JsonValue> found = json_.find(name.c_str());
    if (!found) return no_index;
    const std::uint32_t id = accessor_of(name, *found);
    const Accessor& accessor = data_.accessor(id);
    if (accessor.components < allowed.least_components || accessor.components > allowed.most_components)
      found->fail("has " + std::to_string(accessor.components) + " components");
    if (accessor.rows != accessor.components) found->fail("holds matrices, which are not allowed here");
    if (allowed.integers && accessor.component != Component::u8 && accessor.component != Component::u16)
      found->fail("is not of unsigned bytes or shorts");
    if (count && *count != accessor.count)
      found->fail(std::to_string(accessor.count) + " elements where others have " + std::to_string(*count));
    count = accessor.count;
    return id;
  }

  VertexSources read_sources() {
    VertexSources sources;
    sources.position = find("POSITION", {3, 3, false});
    sources.normal = find("NORMAL", {3, 3, false});
    sources.color = find("COLOR_0", {3, 4, false});
    for (std::size_t set = 0; set < sources.texcoords.size(); ++set)
      sources.texcoords[set] = find("TEXCOORD_" + std::to_string(set), {2, 2, false});
    return sources;
  }

  std::optional<std::size_t> count;  ///< elements of all attributes; none if no attribute was found yet

 private:
  [[nodiscard]] std::uint32_t accessor_of(const std::string& name, const JsonValue& json) const {
    if (decoded_ == nullptr) return data_.readable_accessor(json);
    const auto found = decoded_->attributes.find(name);
    return found != decoded_->attributes.end() ? found->second : data_.readable_accessor(json);
  }

  const JsonValue& json_;
  const Data& data_;
  const DecodedPrimitive* decoded_;
};

class Planner {
 public:
  Planner(const JsonValue& json, const Data& data, DracoPrimitives& compressed, const MaterialList& materials,
          std::vector<std::string>& warnings)
      : json_(json), data_(data), compressed_(compressed), materials_(materials), warnings_(warnings) {}

  MeshPlan plan() {
    MeshPlan plan;
    plan.place = json_.place();
    plan.name = json_.name();
    plan.weights.resize(json_.count("weights"));
    json_.read_numbers("weights", plan.weights);
    const JsonValue primitives = json_.require("primitives");
    std::optional<std::size_t> target_count;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      std::optional<Primitive> primitive = read(primitives[i]);
      if (!primitive) continue;
      if (primitive->mode < Mode::triangles) {
        plan.edges.push_back(*std::move(primitive));
        continue;
      }
      const std::size_t targets = primitive->vertices.targets.size();
      if (target_count.value_or(targets) != targets)
        primitives[i].fail(std::to_string(targets) + " morph targets where others have " +
                           std::to_string(*target_count));
      target_count = targets;
      if (primitive->material != no_index) plan.texcoord_sets |= texcoord_sets_of(*primitive);
      plan.has_joints |= !primitive->vertices.joints.empty();
      plan.primitives.push_back(*std::move(primitive));
    }
    plan.target_count = target_count.value_or(0);
    if (plan.primitives.empty())
      for (const Primitive& lines : std::exchange(plan.edges, {}))
        warnings_.push_back(lines.place + ": lines are not drawn");
    // In a mesh of only points and lines, no morph targets were counted.
    if (!plan.weights.empty() && !plan.primitives.empty() && plan.weights.size() != plan.target_count)
      json_.fail(std::to_string(plan.weights.size()) + " weights for " + std::to_string(plan.target_count) +
                 " morph targets");
    return plan;
  }

 private:
  std::optional<Primitive> skip(const JsonValue& json, const std::string& reason) {
    warnings_.push_back(json.place() + ": " + reason);
    return std::nullopt;
  }

  std::optional<Primitive> read(const JsonValue& json) {
    Primitive primitive;
    primitive.place = json.place();
    const std::uint64_t mode = json.unsigned_or("mode", 4);
    primitive.material = json.index_or_none("material", materials_.materials.size());
    const std::optional<DecodedPrimitive> decoded = compressed_.decode(json);
    // Points and lines are checked too, although they are not drawn, so that errors in a file are always found.
    read_vertices(json, decoded ? &*decoded : nullptr, primitive);
    if (decoded)
      primitive.indices = decoded->indices;
    else if (const auto indices = json.find("indices"))
      primitive.indices = read_indices(*indices);
    const std::size_t points =
        primitive.indices == no_index ? primitive.vertex_count : data_.accessor(primitive.indices).count;
    if (mode == 0) return skip(json, "its " + std::to_string(points) + " points are not drawn");
    if (mode > 6) return skip(json, "mode " + std::to_string(mode) + " is unknown");
    if (decoded && mode < 4) return skip(json, "lines are not drawn");
    primitive.mode = decoded ? Mode::triangles : Mode(mode);  // Draco stores strips as lists, too
    if (primitive.vertices.base.position == no_index) return skip(json, "has no POSITION, nothing to draw");
    if (primitive.mode < Mode::triangles) read_edges(json, primitive);
    if (!decoded && json.extension("KHR_draco_mesh_compression"))
      warnings_.push_back(json.place() + ": the uncompressed data are taken");
    return primitive;
  }

  static void read_edges(const JsonValue& json, Primitive& primitive) {
    const std::optional<JsonValue> edges = json.extension("FRONTMOST_edges");
    if (!edges) return;
    primitive.is_smooth = edges->bool_or("smooth", false);
    edges->each("circles", [&](const JsonValue& circle) {
      EdgeCircle& read = primitive.circles.emplace_back();
      circle.read_vector("centre", read.centre);
      circle.read_vector("axis", read.axis);
      read.radius = circle.number_or("radius", 0);
      read.first = circle.index_or_none("first", no_index);
      read.count = circle.index_or_none("count", no_index);
    });
  }

  /// Returns the sets of texture coordinates that the primitive's material uses, a bit for each.
  std::uint32_t texcoord_sets_of(const Primitive& primitive) {
    const std::uint32_t sets = materials_.texcoord_sets[primitive.material];
    // Set 0 is often absent, with textures of a single colour, so its absence causes no warning.
    for (std::uint32_t set = 1; set < max_texcoord_sets; ++set)
      if (sets >> set & 1 && primitive.vertices.base.texcoords[set] == no_index)
        warnings_.push_back(primitive.place + ": has no TEXCOORD_" + std::to_string(set) +
                            ", which its material's textures use; they are looked up at 0, 0");
    return sets;
  }

  void read_vertices(const JsonValue& json, const DecodedPrimitive* decoded, Primitive& primitive) {
    const JsonValue attributes = json.require("attributes");
    AttributeReader reader(attributes, data_, decoded);
    VertexSet& vertices = primitive.vertices;
    vertices.base = reader.read_sources();
    for (std::size_t set = 0; set < max_joint_sets; ++set) {
      const std::uint32_t joints = reader.find("JOINTS_" + std::to_string(set), {4, 4, true});
      const std::uint32_t weights = reader.find("WEIGHTS_" + std::to_string(set), {4, 4, false});
      if ((joints == no_index) != (weights == no_index))
        attributes.fail("joints without weights, or weights without joints");
      // Sets are numbered without gaps; sets behind a gap are ignored.
      if (joints == no_index) break;
      vertices.joints.push_back(joints);
      vertices.weights.push_back(weights);
    }
    primitive.vertex_count = reader.count.value_or(0);
    json.each("targets", [&](const JsonValue& target) {
      AttributeReader target_reader(target, data_);
      // Displacements are read by the same ranges as the vertices, so their counts must agree.
      target_reader.count = primitive.vertex_count;
      vertices.targets.push_back(target_reader.read_sources());
    });
  }

  std::uint32_t read_indices(const JsonValue& json) const {
    const std::uint32_t id = data_.readable_accessor(json);
    const Accessor& accessor = data_.accessor(id);
    const bool is_unsigned = accessor.component == Component::u8 || accessor.component == Component::u16 ||
                             accessor.component == Component::u32;
    if (accessor.components != 1 || !is_unsigned) json.fail("the accessor is not of unsigned scalars");
    return id;
  }

  const JsonValue& json_;
  const Data& data_;
  DracoPrimitives& compressed_;
  const MaterialList& materials_;
  std::vector<std::string>& warnings_;
};

}  // namespace

std::vector<MeshPlan> plan_meshes(const JsonValue& root, Data& data, const MaterialList& materials,
                                  std::vector<std::string>& warnings) {
  DracoPrimitives compressed(data);
  std::vector<MeshPlan> plans;
  root.each("meshes", [&](const JsonValue& json) {
    plans.push_back(Planner(json, data, compressed, materials, warnings).plan());
  });
  return plans;
}

}  // namespace frontmost::gltf
