// SPDX-License-Identifier: Apache-2.0
// Views: projections, depth conventions, cameras, and the pixel grid that a visibility method answers for.
//
// Eye space looks down -z, y up, x right. Screen space is in pixels: x right, y down, origin at the top left corner,
// pixel centres at +0.5. Depth given to users is -z_eye: planar distance, positive, in scene units.
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

  /// From the negative eye-space z values that Gortler's book uses: at_z(-0.1, -50).
  static ClipDistances at_z(double z_near, double z_far) { return {-z_near, -z_far}; }
};

/// A viewing volume: the rectangle [left, right] x [bottom, top] at unit distance before the eye (perspective), or in
/// scene units at every distance (orthographic), between two planes.
struct Projection {
  bool orthographic = false;
  double left = -1, right = 1, bottom = -1, top = 1;
  ClipDistances clip;
};

/// Perspective by the smaller field of view, in radians, of the two image directions. `aspect` is width / height.
/// (S. Gortler, Foundations of 3D Computer Graphics, chapter 10.) The functions below throw Error bad_argument on
/// non-finite, reversed or zero-sized values, and on near <= 0 in perspective or far <= near.
[[nodiscard]] Projection make_projection(double min_fov, double aspect, const ClipDistances& clip);
/// Perspective by frustum sides measured on the near plane, as glFrustum takes them.
[[nodiscard]] Projection make_frustum(double left, double right, double bottom, double top, const ClipDistances& clip);
/// Parallel projection of [left, right] x [bottom, top] in scene units.
[[nodiscard]] Projection make_orthographic(double left, double right, double bottom, double top,
                                           const ClipDistances& clip);

/// Where the vision world puts the centre of the first pixel.
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
/// The inverse. Precondition: perspective.
[[nodiscard]] Intrinsics intrinsics_of(const Projection& projection, int width, int height, PixelRule rule);

/// Which normalised depth the near and far planes map to: conventions as values.
struct DepthConvention {
  double at_near, at_far;
};
inline constexpr DepthConvention gortler_depth{1, -1};  ///< nearer is greater; compare with GREATER
inline constexpr DepthConvention opengl_depth{-1, 1};   ///< nearer is less; compare with LESS
inline constexpr DepthConvention zero_to_one_depth{0, 1};
inline constexpr DepthConvention reversed_depth{1, 0};  ///< nearer is greater; exact with floats

/// The 4x4 matrix to clip space. Infinite far planes are taken to their limit.
[[nodiscard]] glm::dmat4 clip_from_eye(const Projection& projection, const DepthConvention& depth = opengl_depth);
/// Planar distance of a normalised depth, the inverse of the map above. Infinite far gives +inf at at_far.
[[nodiscard]] double distance_of_depth(const Projection& projection, const DepthConvention& depth, double ndc_depth);

/// A rigid pose from eye position, target and up. Up need not be perpendicular; where it is parallel to the viewing
/// direction another axis is taken, deterministically.
/// \throws Error singular_camera when eye and target coincide or are not finite.
[[nodiscard]] glm::dmat4 look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// How a 4x4 pose is meant.
enum class PoseConvention : std::uint8_t {
  opengl_camera_to_world,  ///< the house's: x right, y up, looks down -z
  opengl_world_to_camera,
  opencv_camera_to_world,  ///< x right, y down, looks down +z
  opencv_world_to_camera,
  robot_camera_to_world,  ///< of sensors on robots (REP 103): x ahead, y left, z up
  robot_world_to_camera,
};
/// \throws Error singular_camera when the pose is not a rotation and a translation (to 1e-4).
[[nodiscard]] glm::dmat4 world_from_eye(const glm::dmat4& pose, PoseConvention convention);
[[nodiscard]] glm::dmat4 pose_of(const glm::dmat4& world_from_eye, PoseConvention convention);

/// Which triangles are left out by the way they face. Counter-clockwise on the screen is front. A triangle that is
/// seen edge-on (N.V = 0, zero area after snapping) faces nobody and covers nothing. `material`: those that face away
/// and whose material is not Material::double_sided, as glTF says; shadows go through them where the light is behind
/// them. The other modes leave shadows alone.
enum class Culling : std::uint8_t { none, back, front, both, material };

/// Width * height * samples of a view is at most this: 16384 x 16384 pixels of one sample, 2 GiB of ids and keys.
inline constexpr std::size_t most_samples = std::size_t(1) << 28;

/// A camera and a pixel grid: all that decides what is visible, beside the surfaces.
struct View {
  int width = 0, height = 0;       ///< pixels, 1 to 16384 each
  int samples = 1;                 ///< per pixel: 1, 2, 4, 8 or 16; positions as in sample_offsets()
  glm::dmat4 world_from_eye{1.0};  ///< about Scene::origin: an eye in the coordinates of a file is less by it
  Projection projection;
  Culling culling = Culling::none;

  // Copies with one thing changed, to be chained:
  //   make_view(intrinsics, 640, 480).placed(pose, PoseConvention::opencv_world_to_camera).between(0.1, 10)
  /// With this pose. \throws Error singular_camera as world_from_eye() does.
  [[nodiscard]] View placed(const glm::dmat4& pose, PoseConvention convention) const;
  /// At `from`, turned towards `target`. \throws Error singular_camera as look_at() does.
  [[nodiscard]] View looking(const glm::dvec3& from, const glm::dvec3& target, const glm::dvec3& up) const;
  /// With an eye that was told in the coordinates of a file, as a pose is, told about that scene's origin.
  [[nodiscard]] View about(const glm::dvec3& origin) const;
  /// With these near and far planes.
  [[nodiscard]] View between(double near, double far) const;
  /// With the near and far planes that fit_clip() finds for `bounds` from where the eye is now.
  [[nodiscard]] View enclosing(const Box& bounds) const;

  [[nodiscard]] glm::dvec3 eye() const { return glm::dvec3(world_from_eye[3]); }
  [[nodiscard]] glm::dvec3 forward() const { return -glm::dvec3(world_from_eye[2]); }
  [[nodiscard]] glm::dvec3 up() const { return glm::dvec3(world_from_eye[1]); }
  [[nodiscard]] glm::dvec3 right() const { return glm::dvec3(world_from_eye[0]); }
  [[nodiscard]] std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
  [[nodiscard]] std::size_t sample_count() const { return pixel_count() * std::size_t(samples); }
};

/// The view of a calibrated camera, at the origin, looking along -z, with one sample a pixel and the clip distances'
/// defaults. \throws Error bad_argument as make_projection() does.
[[nodiscard]] View make_view(const Intrinsics& intrinsics, int width, int height);
/// The same by the smaller field of view, in radians.
[[nodiscard]] View make_view(double min_fov, int width, int height);

/// \throws Error bad_argument, limit_exceeded or singular_camera, naming the field. Vertices are transformed in floats,
/// so a view must lie within their range: near at least 1.2e-38 in perspective, the eye within 3.4e38 of the origin.
/// Far planes beyond 8.5e37 in perspective count as that.
void validate(const View& view);

/// Sample positions within a pixel in 1/256 pixel from its top left corner: the standard rotated-grid patterns
/// (Direct3D 11.1 functional specification, 16.1), whose entries are multiples of 1/16 pixel.
/// One sample sits at the centre, (128, 128).
[[nodiscard]] std::span<const glm::ivec2> sample_offsets(int samples);

/// The named directions. `front` looks at the model's front: along +y for z-up models, along -z for the others.
enum class NamedView : std::uint8_t { front, back, left, right, top, bottom, iso, three_quarter };

/// What most of a scene's interest lies in, and what reaches far beyond that.
struct Subject {
  Box bounds;                           ///< of the former, in world space; empty where nothing can be seen
  std::vector<std::uint32_t> left_out;  ///< numbers of the latter in Scene::instances, ascending; mostly none
};

/// The subject of a scene, by objects. An object's interest is the fourth root of the number of its triangles. The
/// middle is, on each axis, the median of the objects' middles, weighted by their interest; an object reaches as far as
/// the corner of its bounds that is farthest from there. Where some objects have three fifths of all interest, and
/// every other one reaches eight times as far as all of them, or farther, the others are left out: a plane of two
/// kilometres under a village, the dome of a sky, a screw that was lost far away. The fewest objects for which that
/// holds are the subject. A scene of one object, or of objects without such a gap, is the subject as a whole. Of more
/// than 4096 objects, every so many give the middle. O(objects): 30 ms for a million.
[[nodiscard]] Subject find_subject(const Surfaces& surfaces);

/// Which objects frame() shows whole.
enum class FramedObjects : std::uint8_t {
  subject,  ///< those of find_subject(); others may reach out of the picture
  all,
};

struct FrameOptions {
  NamedView direction = NamedView::three_quarter;
  bool orthographic = false;
  double min_fov = 0.5235987755982988;  ///< radians (30 degrees), of the smaller image side
  double margin = 0.05;                 ///< of the picture on each side
  int samples = 1;
  Culling culling = Culling::none;
  /// Looks along this, with that upwards, where set; instead of the named direction's. Any length but zero.
  std::optional<glm::dvec3> forward = std::nullopt, up = std::nullopt;
  /// This point is in the middle of the picture, where set; instead of the model. About Scene::origin, as the eye is.
  std::optional<glm::dvec3> target = std::nullopt;
  /// The pinhole camera, where set; instead of min_fov. Its image may lie off the axis. Not with `orthographic`.
  std::optional<Intrinsics> intrinsics = std::nullopt;
  FramedObjects objects = FramedObjects::subject;
};

/// A view that shows the subject of `surfaces`, mostly all of them, from as near as the margin allows. Near and far
/// enclose everything, but in parallel projection what is left out of the subject and lies behind the eye, which then
/// stands twice the subject's diagonal before its middle. Empty surfaces: a unit box about the origin. 1 to 3 ms for a
/// million triangles.
/// \throws Error bad_argument for options out of range; as look_at(), make_projection() and validate() do.
[[nodiscard]] View frame(const Surfaces& surfaces, int width, int height, const FrameOptions& options = {});
/// The same of a box, all of it: where no one has the whole model, but its bounds are known. `up` is the model's.
[[nodiscard]] View frame(const Box& bounds, Axis up, int width, int height, const FrameOptions& options = {});

/// Near and far planes that enclose what of `bounds` lies before the eye, with 1 % to spare, and near at least
/// far / 10000 in perspective.
[[nodiscard]] ClipDistances fit_clip(const Box& bounds, const glm::dmat4& world_from_eye, bool orthographic);

// Curved surfaces as triangles, as fine as a view needs them: how the methods for triangles draw spheres and patches.
//
//         ____
//     .-~'    `~-.       the curved surface
//   /--------------\     a side of a triangle between two of its points
//          |
//          at most so many pixels, as the eye sees them: near parts are cut finely, distant ones coarsely

/// True when a mesh of the scene that is placed is curved.
[[nodiscard]] bool has_curved(const Scene& scene);

/// The scene with its curved meshes cut into triangles anew, so fine that in `view` no point of a triangle is farther
/// than `pixels` from the point of the curved surface that it stands for; so every outline is where it should be to
/// that many pixels. The bound is proven from second derivatives, and mostly two to four times too large; snapping of
/// corners to 1/256 pixel comes on top of it. What lies before the near plane does not count, and is cut coarsely.
/// (D. Filip, R. Magedson, R. Markot. Surface algorithms using bounds on derivatives. 1986.)
///
/// Every patch is a grid of its own fineness, a power of two each way. Patches of a mesh that share a whole edge, its
/// four control points to the bit in either order, are given the same points along it: nothing leaks between them.
/// Corners have the normals and texture coordinates of the surface. A sphere is a globe of rings.
///
/// Instances stay as they are, but for the number of their mesh: those that need another fineness have their own. The
/// meshes stay curved, and Mesh::face_ids says which curved primitive a triangle comes from; other meshes stay as they
/// are. O(size of the scene + triangles made).
/// \throws Error bad_argument unless pixels > 0; limit_exceeded beyond 2^26 triangles made, naming instance and mesh;
/// and as validate() does of scene and view.
[[nodiscard]] Scene tessellate(const Scene& scene, const View& view, double pixels);

// Visible: what every method answers, one primitive and one depth for every sample of a view.
//
//   primitives, keys   | sample 0 of all pixels          | sample 1 of all pixels          | ...
//                      | row 0       | row 1       | ... | row 0       | row 1       | ... |
//                        x = 0, 1, ...
//
// Sample 0 alone is thus a plane of its own, as maps want it. What is visible is the minimum over (depth, primitive
// id), so that parts of a scene can be answered one by one, in any order and on any machine, and merged.

/// The front-most primitive at every sample, and how deep it is. Planes are ordered [sample][y][x], top row first.
struct Visible {
  View view;
  Buffer<PrimitiveId> primitives;  ///< no_primitive where nothing is seen
  /// The depth that was compared: near / distance in perspective, (far - distance) / (far - near) in parallel
  /// projection, as a float in [0, 1], greater is nearer; 0 where nothing is seen.
  Buffer<float> keys;

  [[nodiscard]] std::size_t index(int x, int y, int sample = 0) const {
    return (std::size_t(sample) * std::size_t(view.height) + std::size_t(y)) * std::size_t(view.width) + std::size_t(x);
  }
};

/// Planar distance along the viewing axis for a key of `view`; +inf for key 0 in perspective.
[[nodiscard]] float depth_of_key(const View& view, float key);

/// Planar depth at every sample, in the order of Visible; +inf where nothing is seen.
[[nodiscard]] Buffer<float> depths_of(const Visible& visible);

/// A Visible of `view` in which nothing is seen: what merging begins with. \throws Error as validate(view) does.
[[nodiscard]] Visible nothing_visible(const View& view);

/// Lays what another part of a scene shows over `into`: at every sample the greater key stays, at equal keys the lower
/// id. That is commutative, associative and idempotent, so parts may come in any order and from any machine, and all of
/// them merged are to the bit what the whole scene shows. `first_id` is added to the ids of `other`: the place of its
/// first triangle among those of the whole. O(samples), in parallel.
/// \throws Error bad_argument unless both have the same view; limit_exceeded where an id would reach no_primitive, and
/// then `into` is merged in part.
void merge(Visible& into, const Visible& other, PrimitiveId first_id = 0, const Execution& execution = {});

/// Every sample as one number, of which the greater is what merge() keeps: the bits of the key in the upper half, those
/// of the id inverted in the lower; 0 where nothing is seen. So whatever knows the maximum of uint64, such as MPI_MAX,
/// merges parts that lie on different machines. `first_id` is added to ids, as by merge(). O(samples), in parallel.
/// \throws Error bad_argument for planes that are not of the size of their view; limit_exceeded where an id would reach
/// no_primitive.
[[nodiscard]] Buffer<std::uint64_t> pack(const Visible& visible, PrimitiveId first_id = 0,
                                         const Execution& execution = {});
/// The way back. \throws Error bad_argument unless there is a number for every sample of the view, and every key is in
/// [0, 1]; as validate(view) does.
[[nodiscard]] Visible unpack(const View& view, std::span<const std::uint64_t> packed, const Execution& execution = {});

/// A hash of ids and depths: equal for equal answers, on every machine and for any number of threads. FNV-1a over
/// the two planes, sample by sample. O(samples), on one thread.
[[nodiscard]] std::uint64_t content_hash(const Visible& visible);

// VisiblePixels: what a view of several samples shows, kept once wherever all samples of a pixel see the same.
//
//   first        | row 0     | row 1     | ...     what sample 0 of every pixel sees: primitive and key
//   mixed        0 0 0 1 1 0 0 ...                 a bit for each pixel whose samples see different primitives
//   others             | 1, 2, 3 | 1, 2, 3 |       for those alone what samples 1 and up see, as `places` tells
//
// Of most pictures it is a fifth of what a Visible takes, so that it is written and read in a fifth of the time: what
// colour needs, for which the depths of samples other than the first do not count.

/// The front-most primitive at every sample of a view.
struct VisiblePixels {
  static constexpr int run = 16;  ///< pixels of a row, from a multiple of as many on, that share a number of `mixed`

  View view;      ///< of all samples
  Visible first;  ///< of sample 0, as planes of one sample
  /// [y][x / run]: bit x % run is set where the samples of a pixel see different primitives.
  Buffer<std::uint16_t> mixed;
  /// [y][x / run]: where in `others` the first mixed pixel of the run is; undefined without one.
  Buffer<std::uint32_t> places;
  /// Ids of samples 1 and up of one mixed pixel after another; the first `other_count` are used.
  Buffer<PrimitiveId> others;
  std::size_t other_count = 0;

  [[nodiscard]] std::size_t runs_across() const { return std::size_t((view.width + run - 1) / run); }
};

/// The same of planes: runs follow each other as pixels do. O(samples).
[[nodiscard]] VisiblePixels pixels_of(const Visible& visible);

}  // namespace frontmost
