// SPDX-License-Identifier: Apache-2.0
// A walk from face to face over the edges that exactly two faces have. Faces agree if their triangles run along the
// edge in opposite directions. Their outlines say less: those of some IGES files run the wrong way around the surface.
#include "import/winding.h"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <NCollection_IndexedDataMap.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

namespace frontmost::import {
namespace {

/// An edge of a face's triangles.
struct EdgeUse {
  std::size_t face;
  bool is_forward;  ///< whether the triangles run along the edge as its curve does
};

/// The triangles of a face.
class FaceTriangles {
 public:
  explicit FaceTriangles(const TopoDS_Shape& face) : mesh_(BRep_Tool::Triangulation(TopoDS::Face(face), location_)) {
    if (mesh_.IsNull()) return;
    const gp_Trsf& placed = location_.Transformation();
    is_reversed_ = (face.Orientation() == TopAbs_REVERSED) != (placed.VectorialPart().Determinant() < 0);
    for (count = 0; count < mesh_->NbTriangles(); ++count) {
      const Poly_Triangle& triangle = mesh_->Triangle(count + 1);
      const gp_XYZ a = mesh_->Node(triangle(1)).Transformed(placed).XYZ(),
                   b = mesh_->Node(triangle(2)).Transformed(placed).XYZ(),
                   c = mesh_->Node(triangle(3)).Transformed(placed).XYZ();
      volume += is_reversed_ ? -a.Dot(b.Crossed(c)) : a.Dot(b.Crossed(c));
      for (int k = 0; k < 3; ++k) sides_.insert(side(triangle(1 + k), triangle(1 + (k + 1) % 3)));
    }
  }
  /// Whether the triangles run along an edge as its curve does; none if the edge is no side of triangles.
  [[nodiscard]] std::optional<bool> is_forward(const TopoDS_Edge& edge) const {
    TopLoc_Location location = location_;
    const Handle(Poly_PolygonOnTriangulation)& line = BRep_Tool::PolygonOnTriangulation(edge, mesh_, location);
    if (mesh_.IsNull() || line.IsNull() || line->NbNodes() < 2) return std::nullopt;
    const int from = line->Node(1), to = line->Node(2);
    if (sides_.contains(side(from, to))) return !is_reversed_;
    return sides_.contains(side(to, from)) ? std::optional(is_reversed_) : std::nullopt;
  }

  int count = 0;
  double volume = 0;  ///< six times the volume between the triangles and the origin

 private:
  static std::uint64_t side(int from, int to) { return std::uint64_t(from) << 32 | std::uint32_t(to); }

  TopLoc_Location location_;
  Handle(Poly_Triangulation) mesh_;
  bool is_reversed_ = false;  ///< whether RWMesh_FaceIterator reverses the triangles
  std::unordered_set<std::uint64_t> sides_;
};

}  // namespace

TopoDS_Shape wound_alike(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> faces;
  std::vector<int> counts;
  std::vector<double> volumes;
  NCollection_IndexedDataMap<TopoDS_Shape, std::vector<EdgeUse>, TopTools_ShapeMapHasher> edges;
  std::vector<std::vector<int>> edges_of;
  for (TopExp_Explorer all(shape, TopAbs_FACE); all.More(); all.Next()) {
    const FaceTriangles triangles(all.Current());
    std::vector<int>& own = edges_of.emplace_back();
    for (TopExp_Explorer outline(all.Current(), TopAbs_EDGE); outline.More(); outline.Next()) {
      const std::optional<bool> is_forward = triangles.is_forward(TopoDS::Edge(outline.Current()));
      if (!is_forward) continue;
      int number = edges.FindIndex(outline.Current());
      if (number == 0) number = edges.Add(outline.Current(), {});
      edges.ChangeFromIndex(number).push_back({faces.size(), *is_forward});
      own.push_back(number);
    }
    faces.push_back(all.Current());
    counts.push_back(triangles.count);
    volumes.push_back(triangles.volume);
  }

  enum class Turn : char { unknown, as_is, reversed };
  std::vector<Turn> turns(faces.size(), Turn::unknown);
  for (std::size_t first = 0; first < faces.size(); ++first) {
    if (turns[first] != Turn::unknown) continue;
    std::vector<std::size_t> shell{first};
    turns[first] = Turn::as_is;
    bool is_closed = true;
    double volume = 0;
    int reversed = 0;  // triangles, less those that stay
    for (std::size_t at = 0; at < shell.size(); ++at) {
      const std::size_t face = shell[at];
      const bool is_reversed = turns[face] == Turn::reversed;
      volume += is_reversed ? -volumes[face] : volumes[face];
      reversed += is_reversed ? counts[face] : -counts[face];
      for (const int edge : edges_of[face]) {
        const std::vector<EdgeUse>& uses = edges(edge);
        is_closed = is_closed && uses.size() == 2;
        if (uses.size() != 2) continue;
        const std::size_t other = uses[0].face == face ? uses[1].face : uses[0].face;
        if (turns[other] != Turn::unknown) continue;  // the face itself, too, beyond its seam
        const bool agree = uses[0].is_forward != uses[1].is_forward;
        turns[other] = is_reversed == agree ? Turn::reversed : Turn::as_is;
        shell.push_back(other);
      }
    }
    if (is_closed ? volume >= 0 : reversed <= 0) continue;
    for (const std::size_t face : shell) turns[face] = turns[face] == Turn::reversed ? Turn::as_is : Turn::reversed;
  }

  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (std::size_t i = 0; i < faces.size(); ++i)
    builder.Add(all, turns[i] == Turn::reversed ? faces[i].Reversed() : faces[i]);
  return all;
}

}  // namespace frontmost::import
