// SPDX-License-Identifier: Apache-2.0
// A scene: meshes, materials, textures, placed instances, cameras and lights, as plain values; and Surfaces, a scene
// made ready for the methods.
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

/// One value per vertex, or per corner. Empty: the mesh has no such attribute.
template <class T>
struct Attribute {
  std::vector<T> values;
  /// For every triangle, which values its corners take. Empty: the same numbers as in Mesh::triangles.
  std::vector<glm::uvec3> triangles;

  [[nodiscard]] bool empty() const { return values.empty(); }
};

/// A sphere. Its parameters are its texture coordinates: u once around from +x towards -z, v from the top (+y) down to
/// the bottom, both 0 to 1. Its outer side is the front.
struct Sphere {
  glm::dvec3 centre{0};
  double radius = 1;
};

/// A bicubic Bezier patch: points[4 * i + j] weighs B_i(u) B_j(v), for u and v from 0 to 1. Its front is the side that
/// dP/dv x dP/du points to. Its texture coordinates are texture_low + (v, u) * texture_size.
struct BezierPatch {
  std::array<glm::dvec3, 16> points{};
  glm::dvec2 texture_low{0}, texture_size{1};
};

/// Sets of texture coordinates that a mesh may have.
inline constexpr std::uint32_t max_texcoord_sets = 4;

/// A triangle mesh in its own space. Counter-clockwise corners face the viewer.
///
/// A mesh may be curved: then `spheres` and `patches` are what it is, in this order its curved primitives, and its
/// triangles are only a tessellation of them; tessellate() makes one for a view. Curved primitives that are not finite,
/// and spheres whose radius is not positive, are never seen, but keep their number. A curved mesh has one material at
/// most and one set of texture coordinates, and colours of its triangles do not count.
struct Mesh {
  std::string name;
  /// Any unit; as in the file, but for what the reader took off, non-finite ones included.
  std::vector<glm::vec3> positions;
  /// What a reader took off in doubles, so that the file has origin + p where positions have p. Zero, but for models
  /// that lie far from zero for their size, of which the file holds more than floats.
  glm::dvec3 origin{0};
  std::vector<glm::uvec3> triangles;  ///< corners, indices into positions, in file order
  Attribute<glm::vec3> normals;       ///< unit length is not required; zero or non-finite ones count as missing
  Attribute<glm::vec2> texcoords;     ///< u right, v down from the image's first row (glTF's convention); set 0
  std::vector<Attribute<glm::vec2>> further_texcoords;  ///< sets 1, 2 and 3, as far as there are any; some may be empty
  Attribute<glm::vec4> colors;                          ///< linear RGBA, multiplies the material's base colour
  std::vector<std::uint32_t> material_ids;  ///< one per triangle, or one for all, or none; no_index: default material
  /// The polygon of the file that each triangle came from (counted from 0 in the mesh). Empty: every polygon was one
  /// triangle, so the triangle's number is the polygon's.
  std::vector<std::uint32_t> face_ids;
  std::vector<Sphere> spheres;
  std::vector<BezierPatch> patches;

  [[nodiscard]] bool is_curved() const { return !spheres.empty() || !patches.empty(); }
  /// A set of texture coordinates as TextureUse::set numbers it; null where the mesh has none.
  [[nodiscard]] const Attribute<glm::vec2>* texcoord_set(std::uint32_t set) const {
    if (set > further_texcoords.size()) return nullptr;
    const Attribute<glm::vec2>& found = set == 0 ? texcoords : further_texcoords[set - 1];
    return found.empty() ? nullptr : &found;
  }
  /// Corner numbers of one triangle into `attribute.values`.
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

/// Decoded pixels, 8 bits a channel as the file stores them, first row on top.
struct Texture {
  enum class Wrap : std::uint8_t { repeat, mirror, clamp };
  std::string name;
  int width = 0, height = 0;
  std::vector<glm::u8vec4> pixels;  ///< width * height, straight alpha
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;  ///< no filtering, as palettes want it
};

/// A use of a texture: which one, and how its coordinates are turned before looking up.
struct TextureUse {
  std::uint32_t texture = no_index;
  glm::vec2 offset{0}, scale{1};  ///< uv' = offset + rotation * (scale * uv), as KHR_texture_transform
  float rotation = 0;             ///< radians, counter-clockwise about the uv origin
  std::uint32_t set = 0;          ///< of the mesh's texture coordinates; all are 0 where the mesh has no such set
  [[nodiscard]] bool is_set() const { return texture != no_index; }
};

/// Metallic-roughness, as glTF 2.0 defines it, with the layers of its extensions, which by default are not there.
/// Colours are linear. Factors multiply what their textures hold. Where a number is out of its range the nearest in
/// range counts, and where it is not a number the default.
struct Material {
  enum class Alpha : std::uint8_t { opaque, mask, blend };

  /// How strongly the surface of what is no metal mirrors. KHR_materials_specular.
  struct Specular {
    float factor = 1;           ///< 0 to 1: of all mirrored light
    TextureUse factor_texture;  ///< A
    glm::vec3 color{1};         ///< 0 and up: of light mirrored towards where it comes from
    TextureUse color_texture;   ///< sRGB
  };
  /// A clear varnish. KHR_materials_clearcoat.
  struct Clearcoat {
    float factor = 0;              ///< 0 to 1: none to all of the surface is varnished
    TextureUse factor_texture;     ///< R
    float roughness = 0;           ///< 0 to 1
    TextureUse roughness_texture;  ///< G
    TextureUse normal_texture;     ///< tangent space; not set: the normal of the geometry, without the bumps beneath
    float normal_scale = 1;
  };
  /// The shine of fibres that stand out of cloth. KHR_materials_sheen.
  struct Sheen {
    glm::vec3 color{0};            ///< 0 to 1; black: none
    TextureUse color_texture;      ///< sRGB
    float roughness = 0;           ///< 0 to 1: of how one way all fibres stand
    TextureUse roughness_texture;  ///< A
  };
  /// Glass: light that is not mirrored passes, tinted by the base colour, through a wall of no thickness.
  /// KHR_materials_transmission.
  struct Transmission {
    float factor = 0;           ///< 0 to 1: the part of the light below the surface that passes
    TextureUse factor_texture;  ///< R
  };
  /// What fills a closed mesh that transmits light, behind its front sides. KHR_materials_volume.
  struct Volume {
    float thickness = 0;           ///< in the mesh's unit; 0: nothing, the surface is a thin wall
    TextureUse thickness_texture;  ///< G
    /// In the world's unit: after so long a way through it white light has attenuation_color. Above 0; infinite: clear.
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
  bool unlit = false;  ///< KHR_materials_unlit: base colour as it is, without any of the layers
  float ior = 1.5f;    ///< index of refraction, 1 and up, of what is no metal; 0: infinite. KHR_materials_ior
  Specular specular;
  Clearcoat clearcoat;
  Sheen sheen;
  Transmission transmission;
  Volume volume;

  /// Whether light comes through, by its alpha or as through glass.
  [[nodiscard]] bool is_see_through() const { return alpha == Alpha::blend || (transmission.factor > 0 && !unlit); }
};

/// All uses of textures of a material, those that are not set, too.
[[nodiscard]] std::array<TextureUse*, 14> texture_uses_of(Material& material);
[[nodiscard]] std::array<const TextureUse*, 14> texture_uses_of(const Material& material);

/// A kind of thing that objects are of, as data sets count them.
struct Category {
  std::string name;
  std::uint32_t number = 0;  ///< the data set's own: the category_id of COCO, the obj_id of BOP
};

/// One mesh at one place: an object that can be seen, named and counted. World space is about Scene::origin.
struct Instance {
  std::string name;
  std::uint32_t mesh = 0;
  glm::dmat4 world_from_mesh{1.0};
  std::uint32_t category = no_index;  ///< in Scene::categories; no_index: nothing is said of it
};

/// A camera of the file, about Scene::origin. Looks down its own -z, y up.
struct Camera {
  std::string name;
  glm::dmat4 world_from_eye{1.0};
  bool orthographic = false;
  double vertical = 0.8;            ///< full vertical field of view in radians, or (orthographic) full height
  std::optional<double> aspect;     ///< width / height; none: the picture's
  std::optional<double> near, far;  ///< positive distances; none: fitted, or infinite
};

/// A light of the file, about Scene::origin. Suns and spots shine down its own -z, points all around. What it says of
/// intensities and cones is what glTF's KHR_lights_punctual says.
struct Light {
  enum class Kind : std::uint8_t {
    sun,    ///< from infinitely far away; where it stands does not matter
    point,  ///< which way it is turned does not matter
    spot,
  };
  std::string name;
  Kind kind = Kind::point;
  glm::dmat4 world_from_light{1.0};  ///< rigid
  glm::vec3 color{1};                ///< linear, 0 and more; multiplies the intensity
  /// 0 and more. Of suns lux, lumens per square unit of length; of points and spots candela, lumens per steradian,
  /// which divided by the square of a distance in units of length are lux there. A unit of glTF is a metre.
  double intensity = 1;
  std::optional<double> range;             ///< positive: of points and spots, beyond it there is no light
  double inner_cone = 0;                   ///< of spots: radians from the axis up to which the light is full, from 0 on
  double outer_cone = 0.7853981633974483;  ///< and from which on there is none: from inner_cone on, at most pi / 2
};

/// Which way is up in the model's own space.
enum class Axis : std::uint8_t { x, y, z, minus_x, minus_y, minus_z };
[[nodiscard]] glm::dvec3 direction(Axis axis);

/// `scene` is that of files that place models of the others.
enum class ModelFormat : std::uint8_t { stl, ply, obj, off, gltf, threemf, scene };

/// What is known of the files that a scene was read from; nothing of a scene that was made.
struct SceneSource {
  std::optional<ModelFormat> format;  ///< of the first model
  /// How long a unit of the coordinates is, where the first model's file says: 1 for glTF, what it names for 3MF.
  /// Nothing is scaled by it.
  std::optional<double> metres_per_unit;
  /// Every file that was opened: the model, and the material libraries, buffers and textures that the model names. Each
  /// once for each model, by its path without links, in the order of their names.
  std::vector<std::filesystem::path> files;
  /// Names of nodes with a mesh that the files hide (glTF's KHR_node_visibility). Hidden nodes are no instances.
  std::vector<std::string> hidden;
};

struct Scene {
  std::string name;  ///< the file's name without folder and suffix, or the built-in scene's
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;  ///< the order that primitive ids follow
  std::vector<Category> categories;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Axis up = Axis::y;
  /// Where the zero of world space lies in the coordinates of the file: what is at p in the world is at origin + p
  /// there. Zero, but for models that lie far from it for their size, whose details floats could not hold there.
  glm::dvec3 origin{0};
  std::vector<std::string> warnings;  ///< what the reader passed over: "file: place: what"
  SceneSource source;
};

/// Triangles over all instances. O(instances).
[[nodiscard]] std::uint64_t triangle_count(const Scene& scene);

/// Adds a mesh and places it, as an object named as the mesh is. Meshes that are not placed are not seen.
/// \returns the object's number in Scene::instances. O(1).
std::uint32_t add(Scene& scene, Mesh mesh, const glm::dmat4& world_from_mesh = glm::dmat4(1.0));
/// Adds all that `part` holds to `scene`: objects, materials, textures, cameras, lights, warnings and files after its
/// own, with their numbers counted on. Categories that both have are one. Name and up stay as they are, and so does the
/// origin, of which what is added is moved to tell the same place. A scene without objects, cameras and lights takes
/// the origin, the format and the unit of the part. O(size of part + product of the numbers of categories).
void add(Scene& scene, Scene part);

/// The origin with which floats hold the most of a scene that was put together: zero unless on some axis all of it lies
/// farther from zero than four times its size and 1024 units, or than 128 times its size; else, on axes on which it is
/// four sizes away, the roundest number near it. So a model moved by a round number is put back to the bit. Of what
/// lies near zero a few vertices are looked at, else all. Precondition: validate(scene) passes.
[[nodiscard]] glm::dvec3 fitting_origin(const Scene& scene);
/// Moves zero to `origin`, in the coordinates of the file, and leaves everything where it is: instances, cameras and
/// lights are told from there, in doubles. load() has done it with the fitting origin. O(instances + cameras + lights).
void set_origin(Scene& scene, const glm::dvec3& origin);

/// Checks what a reader promises: array sizes that belong together, indices in range, lights within their bounds, at
/// most 2^32 - 2 triangles. \throws Error file_malformed or limit_exceeded naming the mesh and triangle. O(size of the
/// scene).
void validate(const Scene& scene);

/// A scene made by code: teapot, cubes, cycle, city, spheres, gallery.
/// \throws Error bad_argument naming the known ones.
[[nodiscard]] Scene builtin(std::string_view name);
/// The names that builtin() knows, in that order.
[[nodiscard]] std::span<const std::string_view> builtin_names();

// Surfaces: a scene made ready for every visibility method. Its triangles are numbered over all instances, in the order
// of the scene, and these numbers are all that methods answer with:
//
//   instance       0: a cube        1: the same cube again    2: a floor
//   triangle       0 ... 11         0 ... 11                  0    1
//   primitive id   0 ... 11         12 ... 23                 24   25          source(13) is instance 1, triangle 1

struct PlacedScene;  // src/core/surfaces/placed_scene.h, and
struct ClusterSet;   // src/core/surfaces/cluster_set.h: what the methods read

/// Where a primitive id comes from.
struct PrimitiveSource {
  std::uint32_t instance = no_index;
  std::uint32_t mesh = no_index;
  std::uint32_t triangle = no_index;  ///< within the mesh
};

/// All triangles of a scene in world space, flattened over instances, with stable ids: the id of a triangle is its
/// running number over all instances in scene order. World space is about Scene::origin, which models
/// far from zero have: so are all places that are given to methods, and that they answer with. Safe to share between
/// threads, but for move(), which is all that changes them. Triangles with a corner that is not finite in world space
/// are never seen, but keep their number. Singular transforms are no error: they flatten what they place. Only the
/// first three rows of a transform count. Triangles whose material is of alpha mode MASK have holes wherever their
/// alpha (base colour, texture and vertices) is below the cutoff; the texture is looked up as it is stored. Every
/// method that answers in samples sees through holes; draw_lines() does not.
class Surfaces {
 public:
  /// Borrows `scene`, which must outlive the surfaces and stay as it is.
  /// O(triangles), in parallel; half a byte a triangle. Whatever looks at the triangles often (a ZBuffer, rays, the
  /// third zbuffer()) first brings them into clusters, once, which takes ten times as long and 20 bytes a triangle, 40
  /// while they are made.
  /// \throws Error as validate(scene) does, and bad_argument for a non-finite instance transform.
  explicit Surfaces(const Scene& scene, const Execution& execution = {});
  explicit Surfaces(Scene&&, const Execution& = {}) = delete;  // it would be gone at once
  ~Surfaces();
  Surfaces(Surfaces&&) noexcept;
  Surfaces& operator=(Surfaces&&) noexcept;
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  /// Gives an instance another transform, in the scene and here: from then on everything answers as if these surfaces
  /// had been made of the scene as it is now. An Occlusion and a Shader of these surfaces follow by themselves at their
  /// next call; a RayIndex by RayIndex::follow(). O(triangles of the instance + log(instances)); the first time
  /// O(triangles), where there are clusters, to list what is where. Clusters stay as
  /// they were cut, so that pictures grow slower the less of the old neighbourhoods is left; they are made anew where
  /// corners become finite, or are so no more. Where an index shares triangles with holes, all of these are copied.
  /// Not while anything else reads the surfaces or the scene. \param scene the one that the surfaces were made of.
  /// \throws Error bad_argument for another scene, an instance that is not there, and a transform that is not finite;
  /// nothing has moved then.
  void move(Scene& scene, std::uint32_t instance, const glm::dmat4& world_from_mesh, const Execution& execution = {});

  struct Placement {
    std::uint32_t instance;
    glm::dmat4 world_from_mesh;
  };
  /// Moves many instances, one after the other, each as above. \throws Error as above if any placement is wrong; no
  /// instance has moved then.
  void move(Scene& scene, std::span<const Placement> placements, const Execution& execution = {});

  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] std::uint32_t primitive_count() const;
  /// The instance, mesh and triangle behind an id. O(log instances). Precondition: id < primitive_count().
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const;
  /// The first id of an instance; its ids are consecutive.
  [[nodiscard]] PrimitiveId first_primitive(std::uint32_t instance) const;
  /// World-space bounds of all triangles with finite corners; of one instance.
  [[nodiscard]] const Box& bounds() const;
  [[nodiscard]] const Box& bounds(std::uint32_t instance) const;
  /// World-space corners of one triangle, in the mesh's order, to the bit those that the methods draw.
  [[nodiscard]] std::array<glm::vec3, 3> corners(PrimitiveId id) const;
  /// True when the instance's transform mirrors. Its front faces are then clockwise in the order of corners(): what is
  /// outside of a mesh stays outside (glTF 2.0, 3.7.4).
  [[nodiscard]] bool is_mirrored(std::uint32_t instance) const;
  /// Bytes held beside the scene's own arrays; those of the clusters count once they are made.
  [[nodiscard]] std::size_t byte_count() const;

  /// Brings the triangles into clusters now, for whoever will show many pictures.
  void make_clusters(const Execution& execution = {}) const;

 private:
  friend const PlacedScene& placed_scene(const Surfaces& surfaces);
  friend const ClusterSet& cluster_set(const Surfaces& surfaces, const Execution& execution);
  friend const ClusterSet* made_cluster_set(const Surfaces& surfaces);
  friend const ClusterSet* cluster_set_for_picture(const Surfaces& surfaces, const Execution& execution);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
