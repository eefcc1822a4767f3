// SPDX-License-Identifier: Apache-2.0
// Sections: a scene cut by a plane, with the faces of the cut, and how drafters hatch them.
//
//       taken away  |  what is left           seen from the side that is taken away
//                  _|__________
//    viewer       | |          |                +-----------+
//      >          | |    ...   |                |/ / ___ / /|     the face of the cut, hatched
//                 |_|__________|                | / |   | / |     around a hole in it
//                   |                           |/ /|___|/ /|
//                   at                          +-----------+
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frontmost/hatching.h"
#include "frontmost/surfaces.h"

namespace frontmost {

/// A plane across an axis of world space. For one at an angle turn the scene: by the transforms of its instances.
struct CuttingPlane {
  Axis towards = Axis::z;  ///< what lies on this side of it is taken away; that is where a viewer stands
  double at = 0;           ///< its coordinate along that axis, also of a minus axis; rounded to a float
};

/// What the plane cuts of one object.
struct CutFace {
  std::uint32_t instance = no_index;
  std::uint32_t material = no_index;  ///< of its triangles and no others, in Section::scene
  /// Closed lines in the plane, without crossings where the object has none: counter-clockwise around what is cut, as
  /// seen from the side that is taken away, clockwise around holes in it.
  std::vector<std::vector<glm::vec3>> outlines{};
  double area = 0;             ///< without the holes
  std::size_t open_count = 0;  ///< lines that do not close, as of meshes with holes: they bound nothing
};

struct Section {
  /// What is left. Instances have the numbers and names that they had, without transforms, each its own mesh with
  /// positions in world space; materials keep their numbers and lose their textures, and those of the faces follow.
  Scene scene;
  std::vector<CutFace> faces;  ///< by instance; none of what the plane misses
};

/// Cuts every object by the plane. Where an object is closed so is what is left of it: the cut is filled with triangles
/// that lie in the plane exactly, between the corners of the cut triangles, the same bits on both sides of an edge.
///
/// What touches the plane from behind counts as cut, what touches it from before is gone, so that a face in the plane
/// is cut just if its object lies behind it. Of an object whose triangles are wound alike, all that its outlines wind
/// around is filled (nonzero rule), of another what an odd number of outlines goes around. Sides that two triangles
/// have in opposite directions are none. Ends that lie nearer to each other than a hundred thousandth of the cut's size
/// are joined: T-junctions leave such gaps. Outlines that cross themselves are filled by triangles that may overlap.
/// Normals, texture coordinates and colours of vertices are not kept. Triangles with a corner that is not finite are
/// left out. O(triangles), and of the corners of each cut n log n where it looks like a part; combs and mazes may take
/// n * n. (G. Meisters. Polygons Have Ears. 1975.) \throws Error bad_argument for a plane that is not finite as a
/// float.
[[nodiscard]] Section cut(const Surfaces& surfaces, const CuttingPlane& plane, const Execution& execution = {});

/// By instance, in which of six ways an object is hatched in all of these sections: another one than the objects before
/// it that it may touch in one of them, as boxes around their faces tell, as far as six are enough. 0 of what is not
/// cut. Each face is held against 2048 before it at most.
[[nodiscard]] std::vector<std::uint8_t> hatch_styles(std::span<const Section* const> sections);

struct SectionHatching {
  double spacing = 30;       ///< pixels from line to line
  double solid_spacing = 2;  ///< pixels: of lines that leave no paper between them
  double thinnest = 0;       ///< in the scene's unit: faces that are thinner on an average are solid
};

/// Sets of hatch() for the faces of a section: continuous lines at 45 degrees to one side or the other, as far apart as
/// said, or 0.7 or 1.4 times that, by the styles of hatch_styles() (ISO 128-50). section_tone() goes with them: faces
/// are hatched wherever they are seen, whatever the light. O(faces).
[[nodiscard]] std::vector<HatchSet> section_hatch_sets(const Section& section, std::span<const std::uint8_t> styles,
                                                       const SectionHatching& options = {});
/// A light in the plane of the cut, without shadows.
[[nodiscard]] ToneOptions section_tone(const CuttingPlane& plane);

}  // namespace frontmost
