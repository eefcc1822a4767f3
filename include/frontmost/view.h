// SPDX-License-Identifier: Apache-2.0
// Views: projections, depth conventions, cameras, and the pixel grid that visibility methods answer for.
//
// Eye space: x right, y up, the eye looks down -z. Screen space, in pixels: x right, y down, origin at the top left
// corner, pixel centres at +0.5. Depth is always given as -z_eye: planar distance, positive, in scene units.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/scene.h"

namespace frontmost {

/// Positive distances of the near and far planes along the viewing axis. `far` may be infinite.
struct ClipDistances {
  double near = 0.1;
  double far = std::numeric_limits<double>::infinity();

  /// Clip distances from negative eye-space z values, as in Gortler's book: at_z(-0.1, -50).
  static ClipDistances at_z(double z_near, double z_far) { return {-z_near, -z_far}; }
};

/// A viewing volume between the near and far planes. Its cross-section is the rectangle [left, right] x [bottom, top]:
/// at unit distance before the eye in perspective, in scene units at every distance in orthographic projection.
struct Projection {
  bool orthographic = false;
  double left = -1, right = 1, bottom = -1, top = 1;
  ClipDistances clip;
};

/// Perspective with field of view `min_fov`, in radians, along the shorter side of the image. `aspect` is width /
/// height. (S. Gortler, Foundations of 3D Computer Graphics, chapter 10.) This function and the next ones throw Error
/// bad_argument on non-finite, reversed or zero-sized values, near <= 0 in perspective, and far <= near.
[[nodiscard]] Projection make_projection(double min_fov, double aspect, const ClipDistances& clip);
/// Perspective from the frustum's sides, measured on the near plane as in glFrustum.
[[nodiscard]] Projection make_frustum(double left, double right, double bottom, double top, const ClipDistances& clip);
/// Parallel projection of [left, right] x [bottom, top], in scene units.
[[nodiscard]] Projection make_orthographic(double left, double right, double bottom, double top,
                                           const ClipDistances& clip);

/// Image coordinates that a calibration gives to the centre of the first pixel.
enum class PixelRule : std::uint8_t {
  centre_at_half,     ///< (0.5, 0.5): OpenGL, Frontmost
  centre_at_integer,  ///< (0, 0): OpenCV, most calibration tools
};

/// A pinhole camera matrix K = [fx 0 cx; 0 fy cy; 0 0 1], x right, y down, in pixels.
struct Intrinsics {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  PixelRule rule = PixelRule::centre_at_integer;
};
[[nodiscard]] Projection make_projection(const Intrinsics& intrinsics, int width, int height,
                                         const ClipDistances& clip);
/// The inverse of the function above. Precondition: perspective.
[[nodiscard]] Intrinsics intrinsics_of(const Projection& projection, int width, int height, PixelRule rule);

/// Normalised depths that the near and far planes are mapped to.
struct DepthConvention {
  double at_near, at_far;
};
inline constexpr DepthConvention gortler_depth{1, -1};  ///< nearer is greater; compare with GREATER
inline constexpr DepthConvention opengl_depth{-1, 1};   ///< nearer is less; compare with LESS
inline constexpr DepthConvention zero_to_one_depth{0, 1};
inline constexpr DepthConvention reversed_depth{1, 0};  ///< nearer is greater; exact with floats

/// The 4x4 matrix from eye space to clip space. For an infinite far plane it is the limit of the matrix.
[[nodiscard]] glm::dmat4 clip_from_eye(const Projection& projection, const DepthConvention& depth = opengl_depth);
/// Planar distance of a normalised depth: the inverse of clip_from_eye(). Infinite far gives +inf at at_far.
[[nodiscard]] double distance_of_depth(const Projection& projection, const DepthConvention& depth, double ndc_depth);

/// The rigid pose of an eye at `eye` that looks at `target`. `up` need not be perpendicular to the viewing direction;
/// if parallel to it, another axis is used, always the same one.
/// \throws Error singular_camera if eye and target coincide or are not finite.
[[nodiscard]] glm::dmat4 look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// Axes and direction of a 4x4 pose.
enum class PoseConvention : std::uint8_t {
  opengl_camera_to_world,  ///< Frontmost's own: x right, y up, looks down -z
  opengl_world_to_camera,
  opencv_camera_to_world,  ///< x right, y down, looks down +z
  opencv_world_to_camera,
  robot_camera_to_world,  ///< sensors on robots (REP 103): x ahead, y left, z up
  robot_world_to_camera,
};
/// \throws Error singular_camera if the pose is not a rotation and a translation (to 1e-4).
[[nodiscard]] glm::dmat4 world_from_eye(const glm::dmat4& pose, PoseConvention convention);
[[nodiscard]] glm::dmat4 pose_of(const glm::dmat4& world_from_eye, PoseConvention convention);

/// Triangles that are left out because of the way they face. Counter-clockwise on the screen is front. A triangle that
/// is seen edge-on (N.V = 0, zero area after snapping) is neither front nor back and covers nothing. `material` leaves
/// out back faces whose material is not Material::double_sided, as glTF specifies; light passes through such a triangle
/// if it comes from behind it. The other modes do not change shadows.
enum class Culling : std::uint8_t { none, back, front, both, material };

/// The greatest width * height * samples of a view: 16384 x 16384 pixels of one sample, 2 GiB of ids and keys.
inline constexpr std::size_t most_samples = std::size_t(1) << 28;

/// A camera and a pixel grid. The view and the surfaces together decide what is visible.
struct View {
  int width = 0, height = 0;       ///< pixels, 1 to 16384 each
  int samples = 1;                 ///< per pixel: 1, 2, 4, 8 or 16; positions as in sample_offsets()
  glm::dmat4 world_from_eye{1.0};  ///< relative to Scene::origin: subtract it from an eye in file coordinates
  Projection projection;
  Culling culling = Culling::none;

  // Copies with one change each, which can be chained:
  //   make_view(intrinsics, 640, 480).placed(pose, PoseConvention::opencv_world_to_camera).between(0.1, 10)
  /// Copy with this pose.
  /// \throws Error singular_camera as world_from_eye() does.
  [[nodiscard]] View placed(const glm::dmat4& pose, PoseConvention convention) const;
  /// Copy that looks from `from` at `target`.
  /// \throws Error singular_camera as look_at() does.
  [[nodiscard]] View looking(const glm::dvec3& from, const glm::dvec3& target, const glm::dvec3& up) const;
  /// Copy relative to a scene's `origin`, for a view whose eye is in coordinates of the file.
  [[nodiscard]] View about(const glm::dvec3& origin) const;
  /// Copy with these near and far planes.
  [[nodiscard]] View between(double near, double far) const;
  /// Copy with the near and far planes that fit_clip() finds for `bounds` from the present eye.
  [[nodiscard]] View enclosing(const Box& bounds) const;

  [[nodiscard]] glm::dvec3 eye() const { return glm::dvec3(world_from_eye[3]); }
  [[nodiscard]] glm::dvec3 forward() const { return -glm::dvec3(world_from_eye[2]); }
  [[nodiscard]] glm::dvec3 up() const { return glm::dvec3(world_from_eye[1]); }
  [[nodiscard]] glm::dvec3 right() const { return glm::dvec3(world_from_eye[0]); }
  [[nodiscard]] std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
  [[nodiscard]] std::size_t sample_count() const { return pixel_count() * std::size_t(samples); }
};

/// The view of a calibrated camera at the origin, looking along -z, with one sample a pixel and default clip distances.
/// \throws Error bad_argument as make_projection() does.
[[nodiscard]] View make_view(const Intrinsics& intrinsics, int width, int height);
/// The view of a camera with field of view `min_fov`, in radians, along the shorter side; otherwise as above.
[[nodiscard]] View make_view(double min_fov, int width, int height);

/// Checks every field. Vertices are transformed in floats, so near must be at least 1.2e-38 in perspective, and the eye
/// within 3.4e38 of the origin. In perspective a far plane beyond 8.5e37 counts as 8.5e37.
/// \throws Error bad_argument, limit_exceeded or singular_camera, naming the field.
void validate(const View& view);

/// Positions of the samples within a pixel, in 1/256 pixel from its top left corner. They are the standard rotated-grid
/// patterns, with multiples of 1/16 pixel (Direct3D 11.1 functional specification, 16.1). A single sample lies at the
/// centre, (128, 128).
[[nodiscard]] std::span<const glm::ivec2> sample_offsets(int samples);

/// Viewing directions by name. `front` looks along +y at z-up models, and along -z at all others.
enum class NamedView : std::uint8_t { front, back, left, right, top, bottom, iso, three_quarter };

/// The part of a scene that a picture is about, and the objects that reach far beyond it.
struct Subject {
  Box bounds;                           ///< bounds of the subject, in world space; empty if nothing can be seen
  std::vector<std::uint32_t> left_out;  ///< objects beyond it, by number in Scene::instances, ascending; mostly none
};

/// Finds the subject of a scene. An object's interest is the fourth root of its number of triangles. The middle is, on
/// each axis, the median of the objects' middles, weighted by interest. An object's reach is the distance from the
/// middle to the farthest corner of its bounds. The subject is the smallest set of objects with three fifths of all
/// interest whose greatest reach is at most an eighth of any other object's. The others, such as a ground plane of two
/// kilometres, a sky dome or a lost screw, are left out. Without such a gap, all objects are the subject. Beyond 4096
/// objects, the middle is found from a regular selection. O(objects): 30 ms for a million.
[[nodiscard]] Subject find_subject(const Surfaces& surfaces);

/// Objects that frame() shows whole.
enum class FramedObjects : std::uint8_t {
  subject,  ///< objects of find_subject(); others may reach out of the picture
  all,
};

struct FrameOptions {
  NamedView direction = NamedView::three_quarter;
  bool orthographic = false;
  double min_fov = 0.5235987755982988;  ///< field of view along the shorter side of the image, in radians (30 degrees)
  double margin = 0.05;                 ///< margin on each side, as a fraction of the picture
  int samples = 1;
  Culling culling = Culling::none;
  /// Viewing and upward direction; if set, they replace those of `direction`. Any length but zero.
  std::optional<glm::dvec3> forward = std::nullopt, up = std::nullopt;
  /// Point in the middle of the picture, relative to Scene::origin; if set, it replaces the model's.
  std::optional<glm::dvec3> target = std::nullopt;
  /// Pinhole camera; if set, it replaces min_fov. Its image may lie off the axis. Not with `orthographic`.
  std::optional<Intrinsics> intrinsics = std::nullopt;
  FramedObjects objects = FramedObjects::subject;
};

/// A view that shows the subject of `surfaces`, mostly all objects, from as near as the margin allows. Near and far
/// enclose everything. In parallel projection with objects left out, the eye stands twice the subject's diagonal before
/// its middle, and left-out objects behind the eye are cut off. Empty surfaces are framed as a unit box about the
/// origin. 1 to 3 ms for a million triangles.
/// \throws Error bad_argument for options out of range, and as look_at(), make_projection() and validate() do.
[[nodiscard]] View frame(const Surfaces& surfaces, int width, int height, const FrameOptions& options = {});
/// A view that shows all of `bounds`, for models of which only the bounds are known. `up` is the model's up axis.
[[nodiscard]] View frame(const Box& bounds, Axis up, int width, int height, const FrameOptions& options = {});

/// Near and far planes that enclose the part of `bounds` before the eye, with 1 % to spare. In perspective near is at
/// least far / 10000.
[[nodiscard]] ClipDistances fit_clip(const Box& bounds, const glm::dmat4& world_from_eye, bool orthographic);

// Tessellation: curved surfaces become triangles as fine as a view needs, for the methods that draw triangles.
//
//         ____
//     .-~'    `~-.       the curved surface
//   /--------------\     an edge of a triangle, between two points of the surface
//          |
//          at most `pixels` apart in the picture: near parts are cut finely, distant ones coarsely
//
// Every patch becomes a grid of its own fineness, a power of two each way. Patches of a mesh share an edge if its four
// control points are equal to the bit, in either order. Both patches then get the same points along the edge, so
// nothing leaks between them. A sphere becomes a globe of rings. Vertices have the surface's normals and texture
// coordinates.

/// True if an instance of the scene has a curved mesh.
[[nodiscard]] bool has_curved(const Scene& scene);

/// \returns the scene with its curved meshes cut into new triangles. In `view`, a point of a triangle is at most
/// `pixels` away from the corresponding point of the curved surface. So outlines are right to `pixels`, plus snapping
/// to 1/256 pixel. The bound is proven from second derivatives; the true error is mostly two to four times smaller.
/// Parts before the near plane are cut coarsely. Instances that need different fineness get different meshes. Meshes
/// stay curved; Mesh::face_ids names each triangle's curved primitive. O(size of the scene + triangles made).
/// \throws Error bad_argument unless pixels > 0; limit_exceeded beyond 2^26 triangles made, naming instance and mesh;
/// and as validate() does. (D. Filip, R. Magedson, R. Markot. Surface algorithms using bounds on derivatives. 1986.)
[[nodiscard]] Scene tessellate(const Scene& scene, const View& view, double pixels);

// Visible: the answer of every method, with one primitive and one depth for every sample of a view.
//
//   primitives, keys   | sample 0 of all pixels          | sample 1 of all pixels          | ...
//                      | row 0       | row 1       | ... | row 0       | row 1       | ... |
//                        x = 0, 1, ...
//
// Sample 0 of all pixels is a plane of its own, from which maps are made. The visible primitive is the minimum over
// (depth, primitive id). Parts of a scene can therefore be answered one by one, in any order and on any machine, and
// merged.

/// The front-most primitive at every sample, and its depth. Planes are ordered [sample][y][x], top row first.
struct Visible {
  View view;
  Buffer<PrimitiveId> primitives;  ///< no_primitive where nothing is seen
  /// The compared depth, a float in [0, 1]; greater is nearer; 0 where nothing is seen. Perspective: near / distance;
  /// parallel projection: (far - distance) / (far - near).
  Buffer<float> keys;

  [[nodiscard]] std::size_t index(int x, int y, int sample = 0) const {
    return (std::size_t(sample) * std::size_t(view.height) + std::size_t(y)) * std::size_t(view.width) + std::size_t(x);
  }
};

/// Planar distance along the viewing axis for a key of `view`; +inf for key 0 in perspective.
[[nodiscard]] float depth_of_key(const View& view, float key);

/// Planar depth at every sample, in the order of Visible; +inf where nothing is seen.
[[nodiscard]] Buffer<float> depths_of(const Visible& visible);

/// A Visible of `view` in which nothing is seen, to begin merging with.
/// \throws Error as validate(view) does.
[[nodiscard]] Visible nothing_visible(const View& view);

/// Merges `other`, the answer for another part of a scene, into `into`. At every sample the greater key wins; at equal
/// keys the lower id. Merging is commutative, associative and idempotent, so parts may come in any order and from any
/// machine. All parts merged equal the whole scene's answer to the bit. `first_id` is added to the ids of `other`: the
/// whole scene's id of the part's first triangle. O(samples), in parallel.
/// \throws Error bad_argument unless both have the same view; limit_exceeded if an id would reach no_primitive, and
/// then `into` is merged in part.
void merge(Visible& into, const Visible& other, PrimitiveId first_id = 0, const Execution& execution = {});

/// Packs every sample into one number, of which merge() keeps the greater. The upper half is the key's bits, the lower
/// half the inverted id; 0 where nothing is seen. A maximum of uint64, such as MPI_MAX, thus merges parts on different
/// machines. `first_id` is added to ids, as in merge(). O(samples), in parallel.
/// \throws Error bad_argument if the arrays do not match the size of their view; limit_exceeded if an id would reach
/// no_primitive.
[[nodiscard]] Buffer<std::uint64_t> pack(const Visible& visible, PrimitiveId first_id = 0,
                                         const Execution& execution = {});
/// The inverse of pack().
/// \throws Error bad_argument unless there is one number for every sample of the view and every key is in [0, 1]; and
/// as validate(view) does.
[[nodiscard]] Visible unpack(const View& view, std::span<const std::uint64_t> packed, const Execution& execution = {});

/// A hash of size, ids and keys: equal answers have equal hashes on every machine and for any number of threads. FNV-1a
/// on words of 64 bits, one per sample. O(samples), on one thread.
[[nodiscard]] std::uint64_t content_hash(const Visible& visible);

// VisiblePixels: the answer for a view of several samples, stored once for a pixel whose samples all see the same.
//
//   first        | row 0     | row 1     | ...     sample 0 of every pixel: primitive and key
//   mixed        0 0 0 1 1 0 0 ...                 a bit for each pixel whose samples see different primitives
//   others             | 1, 2, 3 | 1, 2, 3 |       samples 1 and up of these pixels alone, found by `places`
//
// VisiblePixels mostly take a fifth of the memory of a Visible, and a fifth of the time to write and read. They hold
// what colours need: depths of samples other than the first are not kept.

/// The front-most primitive at every sample of a view.
struct VisiblePixels {
  static constexpr int run = 16;  ///< pixels of a row that share one entry of `mixed`, from a multiple of 16 on

  View view;      ///< the view with all of its samples
  Visible first;  ///< sample 0, as a Visible of one sample
  /// [y][x / run]: bit x % run is set if the samples of the pixel see different primitives.
  Buffer<std::uint16_t> mixed;
  /// [y][x / run]: index in `others` of the first mixed pixel of the run; undefined if the run has none.
  Buffer<std::uint32_t> places;
  /// Ids of samples 1 and up, one mixed pixel after another; the first `other_count` are used.
  Buffer<PrimitiveId> others;
  std::size_t other_count = 0;

  [[nodiscard]] std::size_t runs_across() const { return std::size_t((view.width + run - 1) / run); }
};

/// The pixels of a Visible; runs follow one another in the order of pixels. O(samples).
[[nodiscard]] VisiblePixels pixels_of(const Visible& visible);

}  // namespace frontmost
