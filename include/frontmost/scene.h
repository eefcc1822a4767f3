// SPDX-License-Identifier: Apache-2.0
// Scene: meshes, materials, textures, placed instances, cameras and lights as plain values. Surfaces: a scene prepared
// for the visibility methods.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {

/// A mesh attribute, with one value per vertex or per triangle corner. Empty: the mesh lacks the attribute.
template <class T>
struct Attribute {
  std::vector<T> values;
  /// For every triangle, the indices into `values` of its three corners. Empty: those of Mesh::triangles apply.
  std::vector<glm::uvec3> triangles;

  [[nodiscard]] bool empty() const { return values.empty(); }
};

/// A sphere. Its outer side is the front. Texture coordinates run from 0 to 1: u once around from +x towards -z, v from
/// the top (+y) down to the bottom.
struct Sphere {
  glm::dvec3 centre{0};
  double radius = 1;
};

/// A bicubic Bezier patch: B_i(u) B_j(v) is the weight of points[4 * i + j], for u and v from 0 to 1. Its front is the
/// side that dP/dv x dP/du points to. Its texture coordinates are texture_low + (v, u) * texture_size.
struct BezierPatch {
  std::array<glm::dvec3, 16> points{};
  glm::dvec2 texture_low{0}, texture_size{1};
};

/// A circle, or an arc of it, that some edges of a mesh follow exactly.
struct EdgeCircle {
  glm::dvec3 centre{0}, axis{0, 0, 1};  ///< the axis has unit length
  double radius = 1;
  std::uint32_t first = 0, count = 0;  ///< range of Mesh::sharp_edges
};

/// The most sets of texture coordinates that a mesh may have.
inline constexpr std::uint32_t max_texcoord_sets = 4;

/// A triangle mesh in its own space. A triangle whose vertices run counter-clockwise faces the viewer.
///
/// A mesh with `spheres` or `patches` is curved. These curved primitives are numbered together, spheres first. The
/// triangles of a curved mesh only approximate its curved primitives; tessellate() makes them for a view. Curved
/// primitives that are not finite, and spheres whose radius is not positive, are never seen but keep their number. A
/// curved mesh has at most one material and one set of texture coordinates; colours of its triangles are ignored.
struct Mesh {
  std::string name;
  /// Vertex positions in any unit: the file's, minus `origin`. Non-finite positions are kept.
  std::vector<glm::vec3> positions;
  /// Offset that the reader subtracted in doubles: the file has origin + p where `positions` has p. The origin is zero
  /// except for models that lie far from zero for their size, in files with more digits than floats hold.
  glm::dvec3 origin{0};
  std::vector<glm::uvec3> triangles;  ///< indices into positions, in file order
  Attribute<glm::vec3> normals;       ///< need not have unit length; zero or non-finite ones count as missing
  Attribute<glm::vec2> texcoords;     ///< set 0; u right, v down from the image's first row (glTF's convention)
  std::vector<Attribute<glm::vec2>> further_texcoords;  ///< sets 1, 2 and 3, as far as present; some may be empty
  Attribute<glm::vec4> colors;                          ///< linear RGBA, multiplies the material's base colour
  std::vector<std::uint32_t> material_ids;  ///< one per triangle, one for all, or none; no_index: default material
  /// For each triangle, the polygon of the file that it came from, counted from 0 in the mesh. Empty: every polygon was
  /// one triangle, so both have the same number.
  std::vector<std::uint32_t> face_ids;
  /// Edges that the file states, as those of a CAD system: pairs of indices into positions, each a side of triangles.
  /// Smooth edges are seams where a surface goes on. draw_lines() draws sharp edges as creases. If a smooth edge is a
  /// side of its triangles, a mesh has no other creases; else it has those that angles show, too.
  std::vector<glm::uvec2> sharp_edges, smooth_edges;
  std::vector<EdgeCircle> edge_circles;  ///< with ranges that ascend and do not overlap
  std::vector<Sphere> spheres;
  std::vector<BezierPatch> patches;

  [[nodiscard]] bool is_curved() const { return !spheres.empty() || !patches.empty(); }
  /// \returns the set of texture coordinates with this TextureUse::set, or null if the mesh lacks it.
  [[nodiscard]] const Attribute<glm::vec2>* texcoord_set(std::uint32_t set) const {
    if (set > further_texcoords.size()) return nullptr;
    const Attribute<glm::vec2>& found = set == 0 ? texcoords : further_texcoords[set - 1];
    return found.empty() ? nullptr : &found;
  }
  /// Indices into `attribute.values` of a triangle's three corners.
  template <class T>
  [[nodiscard]] const glm::uvec3& corners(const Attribute<T>& attribute, std::uint32_t triangle) const {
    return attribute.triangles.empty() ? triangles[triangle] : attribute.triangles[triangle];
  }
  [[nodiscard]] std::uint32_t material_of(std::uint32_t triangle) const {
    if (material_ids.empty()) return no_index;
    return material_ids.size() == 1 ? material_ids[0] : material_ids[triangle];
  }
  [[nodiscard]] std::uint32_t face_of(std::uint32_t triangle) const {
    return face_ids.empty() ? triangle : face_ids[triangle];
  }
};

/// Decoded pixels, 8 bits a channel as stored in the file, first row on top.
struct Texture {
  enum class Wrap : std::uint8_t { repeat, mirror, clamp };
  std::string name;
  int width = 0, height = 0;
  std::vector<glm::u8vec4> pixels;  ///< width * height, straight alpha
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;  ///< no filtering, for textures that serve as palettes
};

/// A reference to a texture, with the transform that is applied to texture coordinates before the lookup.
struct TextureUse {
  std::uint32_t texture = no_index;
  glm::vec2 offset{0}, scale{1};  ///< uv' = offset + rotation * (scale * uv), as in KHR_texture_transform
  float rotation = 0;             ///< radians, counter-clockwise about the uv origin
  std::uint32_t set = 0;          ///< set of the mesh's texture coordinates; a missing set counts as all 0
  [[nodiscard]] bool is_set() const { return texture != no_index; }
};

/// The metallic-roughness material of glTF 2.0, with the layers of its extensions, which are off by default. Colours
/// are linear. Factors multiply the values of their textures. A number out of its range counts as the nearest number in
/// range, and NaN counts as the default.
struct Material {
  enum class Alpha : std::uint8_t { opaque, mask, blend };

  /// Strength of the reflection of non-metals. KHR_materials_specular.
  struct Specular {
    float factor = 1;           ///< 0 to 1: multiplies all reflected light
    TextureUse factor_texture;  ///< A
    glm::vec3 color{1};         ///< 0 and up: multiplies light reflected back to where it comes from
    TextureUse color_texture;   ///< sRGB
  };
  /// A clear varnish over the material. KHR_materials_clearcoat.
  struct Clearcoat {
    float factor = 0;              ///< 0 to 1: the part of the surface that is varnished
    TextureUse factor_texture;     ///< R
    float roughness = 0;           ///< 0 to 1
    TextureUse roughness_texture;  ///< G
    TextureUse normal_texture;     ///< tangent space; not set: the normal of the geometry, without the bumps beneath
    float normal_scale = 1;
  };
  /// The sheen of fibres that stand out of cloth. KHR_materials_sheen.
  struct Sheen {
    glm::vec3 color{0};            ///< 0 to 1; black: none
    TextureUse color_texture;      ///< sRGB
    float roughness = 0;           ///< 0 to 1: how far the directions of the fibres differ
    TextureUse roughness_texture;  ///< A
  };
  /// Glass: light that is not reflected passes through an infinitely thin wall, tinted by the base colour.
  /// KHR_materials_transmission.
  struct Transmission {
    float factor = 0;           ///< 0 to 1: the part of the unreflected light that passes
    TextureUse factor_texture;  ///< R
  };
  /// The medium in a closed mesh that transmits light: it fills the space behind the front sides. KHR_materials_volume.
  struct Volume {
    float thickness = 0;           ///< in the mesh's unit; 0: no medium, the surface is a thin wall
    TextureUse thickness_texture;  ///< G
    /// Distance in the world's unit after which white light has attenuation_color. Above 0; infinite: clear.
    float attenuation_distance = std::numeric_limits<float>::infinity();
    glm::vec3 attenuation_color{1};  ///< 0 to 1
  };

  std::string name;
  glm::vec4 base_color{1};
  TextureUse base_color_texture;  ///< sRGB; alpha is linear
  float metallic = 0, roughness = 0.6f;
  TextureUse metallic_roughness_texture;  ///< G roughness, B metallic
  TextureUse normal_texture;              ///< tangent space
  float normal_scale = 1;
  glm::vec3 emissive{0};
  TextureUse emissive_texture;   ///< sRGB
  TextureUse occlusion_texture;  ///< R
  float occlusion_strength = 1;
  Alpha alpha = Alpha::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit: the base colour as it is, without any layer
  float ior = 1.5f;    ///< index of refraction of non-metals, 1 and up; 0: infinite. KHR_materials_ior
  Specular specular;
  Clearcoat clearcoat;
  Sheen sheen;
  Transmission transmission;
  Volume volume;

  /// True if light comes through, because of the material's alpha or as through glass.
  [[nodiscard]] bool is_see_through() const { return alpha == Alpha::blend || (transmission.factor > 0 && !unlit); }
};

/// All texture uses of a material, including those that are not set.
[[nodiscard]] std::array<TextureUse*, 14> texture_uses_of(Material& material);
[[nodiscard]] std::array<const TextureUse*, 14> texture_uses_of(const Material& material);

/// A kind of object, as data sets define it.
struct Category {
  std::string name;
  std::uint32_t number = 0;  ///< number in the data set: the category_id of COCO, the obj_id of BOP
};

/// One mesh at one place: an object that can be seen, named and counted. World space is relative to Scene::origin.
struct Instance {
  std::string name;
  std::uint32_t mesh = 0;
  glm::dmat4 world_from_mesh{1.0};
  std::uint32_t category = no_index;  ///< index into Scene::categories; no_index: not stated
};

/// A camera of the file, relative to Scene::origin. It looks along its own -z, with y up.
struct Camera {
  std::string name;
  glm::dmat4 world_from_eye{1.0};
  bool orthographic = false;
  double vertical = 0.8;            ///< full vertical field of view in radians, or (orthographic) full height
  std::optional<double> aspect;     ///< width / height; none: that of the picture
  std::optional<double> near, far;  ///< positive distances; none: fitted, or infinite
};

/// A light of the file, relative to Scene::origin. Suns and spots shine along their own -z, point lights all around.
/// Intensities and cones are defined as in glTF's KHR_lights_punctual.
struct Light {
  enum class Kind : std::uint8_t {
    sun,    ///< infinitely far away; its position is ignored
    point,  ///< its orientation is ignored
    spot,
  };
  std::string name;
  Kind kind = Kind::point;
  glm::dmat4 world_from_light{1.0};  ///< rigid
  glm::vec3 color{1};                ///< linear, 0 and more; multiplies the intensity
  /// 0 and more. Suns: lux, lumens per square unit of length. Points and spots: candela, lumens per steradian; candela
  /// divided by the square of a distance in units of length give lux there. The unit of glTF is the metre.
  double intensity = 1;
  std::optional<double> range;  ///< points and spots: positive distance beyond which there is no light
  double inner_cone = 0;        ///< spots: angle from the axis, in radians, up to which the light is full; from 0 on
  double outer_cone = 0.7853981633974483;  ///< spots: angle from which on there is no light; inner_cone to pi / 2
};

/// The upward direction in the model's own space.
enum class Axis : std::uint8_t { x, y, z, minus_x, minus_y, minus_z };
[[nodiscard]] glm::dvec3 direction(Axis axis);

/// Formats of model files. `scene` is a scene file, which places models of the other formats. The program
/// frontmost-import reads step, iges, brep, and `foreign`: meshes of any other format that it knows.
enum class ModelFormat : std::uint8_t { stl, ply, obj, off, gltf, threemf, scene, step, iges, brep, foreign };

/// Facts about the files that a scene was read from. Scenes made by code have none.
struct SceneSource {
  std::optional<ModelFormat> format;  ///< format of the first model
  /// Length in metres of one unit of the coordinates, if the first model's file states it: 1 for glTF, the named unit
  /// for 3MF, STEP, IGES and FBX. No coordinate is scaled by this length.
  std::optional<double> metres_per_unit;
  /// Every file that was opened: the model, and the material libraries, buffers and textures that it names. Each is
  /// listed once per model, by its path without links, sorted by name.
  std::vector<std::filesystem::path> files;
  /// Names of nodes with a mesh that the files hide (glTF's KHR_node_visibility). Hidden nodes do not become instances.
  std::vector<std::string> hidden;
};

struct Scene {
  std::string name;  ///< file name without folder and suffix, or name of the built-in scene
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;  ///< their order is the order of primitive ids
  std::vector<Category> categories;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Axis up = Axis::y;
  /// Position of the world's zero in the coordinates of the file: world point p is origin + p in the file. The origin
  /// is zero except for models that lie so far from zero for their size that floats would lose their details.
  glm::dvec3 origin{0};
  std::vector<std::string> warnings;  ///< things that the reader skipped: "file: place: what"
  SceneSource source;
};

/// Number of triangles over all instances. O(instances).
[[nodiscard]] std::uint64_t triangle_count(const Scene& scene);

/// Adds a mesh and an instance of it with the mesh's name. Only instances are seen. \returns the instance's number in
/// Scene::instances. O(1).
std::uint32_t add(Scene& scene, Mesh mesh, const glm::dmat4& world_from_mesh = glm::dmat4(1.0));
/// Appends everything in `part` to the lists of `scene`: objects, materials, textures, cameras, lights, warnings,
/// files. Their numbers are raised accordingly. Categories that both scenes have are merged. `scene` keeps its name,
/// its up axis and its origin; transforms of the part are moved to that origin. A scene without objects, cameras and
/// lights takes the origin, format and unit of the part. O(size of part + product of the numbers of categories).
void add(Scene& scene, Scene part);

/// The origin about which floats keep the most details of a scene. A scene is far from zero if, on some axis, all of it
/// lies beyond four times its size and 1024 units, or beyond 128 times its size. The origin of a far scene is, on each
/// axis on which the scene is four sizes away, the roundest number nearby. Elsewhere it is zero. A model that was moved
/// by a round number is thus moved back to the bit. A few vertices suffice to recognise a scene near zero; otherwise
/// all are examined. Precondition: validate(scene) passes.
[[nodiscard]] glm::dvec3 fitting_origin(const Scene& scene);
/// The fitting origin of points in doubles. Points that are not finite as floats are ignored. O(points).
[[nodiscard]] glm::dvec3 fitting_origin(std::span<const glm::dvec3> points);
/// Moves the world's zero to `origin`, in coordinates of the file. Instances, cameras and lights stay in place: their
/// transforms are adjusted, in doubles. load() has already set the fitting origin. O(instances + cameras + lights).
void set_origin(Scene& scene, const glm::dvec3& origin);

/// Checks what every reader guarantees: array sizes that match, indices in range, lights within their bounds, at most
/// 2^32 - 2 triangles. O(size of the scene).
/// \throws Error file_malformed or limit_exceeded, naming the mesh and triangle.
void validate(const Scene& scene);

/// \returns a scene made by code: teapot, cubes, cycle, city, spheres or gallery.
/// \throws Error bad_argument, listing the known names.
[[nodiscard]] Scene builtin(std::string_view name);
/// Names that builtin() knows, in that order.
[[nodiscard]] std::span<const std::string_view> builtin_names();

// Surfaces: a scene prepared for every visibility method. Triangles are numbered over all instances, in scene order.
// Methods answer with these numbers only:
//
//   instance       0: a cube        1: the same cube again    2: a floor
//   triangle       0 ... 11         0 ... 11                  0    1
//   primitive id   0 ... 11         12 ... 23                 24   25          source(13) is instance 1, triangle 1

struct PlacedScene;  // src/core/surfaces/placed_scene.h: read by the methods
struct ClusterSet;   // src/core/surfaces/cluster_set.h: read by the methods

/// The instance, mesh and triangle that a primitive id stands for.
struct PrimitiveSource {
  std::uint32_t instance = no_index;
  std::uint32_t mesh = no_index;
  std::uint32_t triangle = no_index;  ///< within the mesh
};

/// All triangles of a scene in world space, with stable ids: a triangle's id is its number over all instances in scene
/// order. World space is relative to Scene::origin; so are all positions that methods take and return. Threads may
/// share Surfaces; only move() changes them. Triangles with a vertex that is not finite are never seen, but keep their
/// number. Singular transforms are allowed: they flatten their mesh. Only the first three rows of a transform count.
///
/// A triangle whose material has alpha mode MASK has holes where its alpha (base colour, texture and vertices) is below
/// the cutoff; the texture is looked up as stored. Every method that answers in samples sees through holes;
/// draw_lines() does not.
class Surfaces {
 public:
  /// Borrows `scene`, which must outlive the surfaces and stay unchanged. O(triangles), in parallel; half a byte a
  /// triangle. Methods that read the triangles often (a ZBuffer, rays, the A-buffer) first build clusters, once.
  /// Clusters take ten times as long to build, and 20 bytes a triangle, 40 while they are built.
  /// \throws Error as validate(scene) does, and bad_argument for a non-finite instance transform.
  explicit Surfaces(const Scene& scene, const Execution& execution = {});
  explicit Surfaces(Scene&&, const Execution& = {}) = delete;  // a temporary scene would be gone at once
  ~Surfaces();
  Surfaces(Surfaces&&) noexcept;
  Surfaces& operator=(Surfaces&&) noexcept;
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  /// Gives an instance another transform, in the scene and here. Later answers are those of surfaces made from the
  /// changed scene. An Occlusion and a Shader follow at their next call, a RayIndex by RayIndex::follow(). Nothing else
  /// may read the surfaces or the scene meanwhile. O(triangles of the instance + log(instances)); with clusters, the
  /// first call is O(triangles). Clusters keep their triangles, so pictures grow slower as old neighbours part.
  /// Clusters are rebuilt if vertices become finite or cease to be. If a RayIndex still uses triangles with holes, all
  /// of these are copied.
  /// \throws Error bad_argument for another scene, a missing instance or a non-finite transform; then nothing moves.
  void move(Scene& scene, std::uint32_t instance, const glm::dmat4& world_from_mesh, const Execution& execution = {});

  struct Placement {
    std::uint32_t instance;
    glm::dmat4 world_from_mesh;
  };
  /// Moves several instances, one after the other.
  /// \throws Error as above if any placement is wrong; then nothing moves.
  void move(Scene& scene, std::span<const Placement> placements, const Execution& execution = {});

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] std::uint32_t primitive_count() const;
  /// The instance, mesh and triangle of an id. O(log instances). Precondition: id < primitive_count().
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const;
  /// The first id of an instance, whose ids are consecutive.
  [[nodiscard]] PrimitiveId first_primitive(std::uint32_t instance) const;
  /// World-space bounds of all triangles with finite vertices, in the scene or in one instance.
  [[nodiscard]] const Box& bounds() const;
  [[nodiscard]] const Box& bounds(std::uint32_t instance) const;
  /// World-space vertices of a triangle, in the mesh's order: to the bit those that the methods draw.
  [[nodiscard]] std::array<glm::vec3, 3> corners(PrimitiveId id) const;
  /// True if the instance's transform mirrors. Front faces are then clockwise in the order of corners(): the outside of
  /// a mesh stays outside (glTF 2.0, 3.7.4).
  [[nodiscard]] bool is_mirrored(std::uint32_t instance) const;
  /// Bytes held besides the scene's own arrays, including clusters once they are built.
  [[nodiscard]] std::size_t byte_count() const;

  /// Builds the clusters now, unless they exist. Useful before several pictures by zbuffer(), which builds none.
  void make_clusters(const Execution& execution = {}) const;

 private:
  friend const PlacedScene& placed_scene(const Surfaces& surfaces);
  friend const ClusterSet& cluster_set(const Surfaces& surfaces, const Execution& execution);
  friend const ClusterSet* made_cluster_set(const Surfaces& surfaces);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
