// SPDX-License-Identifier: Apache-2.0
// A walk from face to face over the edges that exactly two faces have. Faces agree if their triangles run along the
// edge in opposite directions. Their outlines say less: those of some IGES files run the wrong way around the surface.
//
// Closed shells then show their outside. A closed shell that lies inside an odd number of others bounds a cavity:
//
//    ______________
//   |  __________  |   outer shell   in 0 others: outside out
//   | |   ____   | |   cavity        in 1 other:  turned
//   | |  |____|  | |   loose core    in 2 others: outside out
//   | |__________| |
//   |______________|
#include "import/winding.h"

#include <BRepBndLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <NCollection_IndexedDataMap.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
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

using Triangle = std::array<gp_XYZ, 3>;

constexpr double kRounding = 1e-12;  // share of the sum of all terms of a volume that is rounding noise

/// Six times the volume between a triangle and zero.
double volume_of(const Triangle& t) { return t[0].Dot(t[1].Crossed(t[2])); }

/// The triangles of a face.
class FaceTriangles {
 public:
  /// `zero`: a point near the face, from which places are measured.
  FaceTriangles(const TopoDS_Shape& face, const gp_XYZ& zero)
      : mesh_(BRep_Tool::Triangulation(TopoDS::Face(face), location_)) {
    if (mesh_.IsNull()) return;
    const gp_Trsf& placed = location_.Transformation();
    is_reversed_ = (face.Orientation() == TopAbs_REVERSED) != (placed.VectorialPart().Determinant() < 0);
    for (int i = 1; i <= mesh_->NbTriangles(); ++i) {
      const Poly_Triangle& triangle = mesh_->Triangle(i);
      Triangle& own = triangles.emplace_back();
      for (int k = 0; k < 3; ++k) {
        own[std::size_t(k)] = mesh_->Node(triangle(1 + k)).Transformed(placed).XYZ() - zero;
        sides_.insert(side(triangle(1 + k), triangle(1 + (k + 1) % 3)));
      }
      if (is_reversed_) std::swap(own[1], own[2]);
    }
  }
  /// Whether the triangles run along an edge as its curve does; none if no part of the edge is a side of triangles.
  [[nodiscard]] std::optional<bool> is_forward(const TopoDS_Edge& edge) const {
    if (mesh_.IsNull()) return std::nullopt;
    const Handle(Poly_PolygonOnTriangulation)& line = BRep_Tool::PolygonOnTriangulation(edge, mesh_, location_);
    for (int i = 1; !line.IsNull() && i < line->NbNodes(); ++i) {
      const int from = line->Node(i), to = line->Node(i + 1);
      const bool is_side = sides_.contains(side(from, to)), is_side_back = sides_.contains(side(to, from));
      if (is_side != is_side_back) return is_side != is_reversed_;
    }
    return std::nullopt;
  }

  std::vector<Triangle> triangles{};  ///< as RWMesh_FaceIterator winds them

 private:
  static std::uint64_t side(int from, int to) { return std::uint64_t(from) << 32 | std::uint32_t(to); }

  TopLoc_Location location_{};
  Handle(Poly_Triangulation) mesh_;
  bool is_reversed_ = false;  ///< whether RWMesh_FaceIterator reverses the triangles
  std::unordered_set<std::uint64_t> sides_{};
};

enum class Turn : char { unknown, as_is, reversed };

struct Face {
  TopoDS_Shape shape;
  std::vector<Triangle> triangles;
  std::vector<int> edges;  ///< those that are sides of its triangles
  bool is_open = false;    ///< an edge is no side of its triangles
  Turn turn = Turn::unknown;

  void reverse() { turn = turn == Turn::reversed ? Turn::as_is : Turn::reversed; }
};

/// A closed shell: its faces, and the box of its vertices.
struct ClosedShell {
  std::vector<std::size_t> faces;
  gp_XYZ low, high;
};

ClosedShell closed_shell(std::vector<std::size_t> numbers, const std::vector<Face>& faces) {
  ClosedShell shell{std::move(numbers), gp_XYZ(1, 1, 1) * HUGE_VAL, gp_XYZ(1, 1, 1) * -HUGE_VAL};
  for (const std::size_t face : shell.faces)
    for (const Triangle& triangle : faces[face].triangles)
      for (const gp_XYZ& p : triangle)
        for (int axis = 1; axis <= 3; ++axis) {
          shell.low.SetCoord(axis, std::min(shell.low.Coord(axis), p.Coord(axis)));
          shell.high.SetCoord(axis, std::max(shell.high.Coord(axis), p.Coord(axis)));
        }
  return shell;
}

/// A. Van Oosterom, J. Strackee. The Solid Angle of a Plane Triangle. 1983.
double solid_angle(const Triangle& t, const gp_XYZ& at) {
  const gp_XYZ a = t[0] - at, b = t[1] - at, c = t[2] - at;
  const double la = a.Modulus(), lb = b.Modulus(), lc = c.Modulus();
  return 2 * std::atan2(a.Dot(b.Crossed(c)), la * lb * lc + a.Dot(b) * lc + b.Dot(c) * la + c.Dot(a) * lb);
}

/// Whether a shell lies inside another. A shell that touches the other one from outside, as a pin in its hole, has a
/// face whose middle sees half of the other shell or less.
bool is_inside(const ClosedShell& inner, const ClosedShell& outer, const std::vector<Face>& faces) {
  for (int axis = 1; axis <= 3; ++axis)
    if (!(outer.low.Coord(axis) < inner.low.Coord(axis) && inner.high.Coord(axis) < outer.high.Coord(axis)))
      return false;
  return std::all_of(inner.faces.begin(), inner.faces.end(), [&](std::size_t number) {
    const std::vector<Triangle>& own = faces[number].triangles;
    if (own.empty()) return true;
    const auto area = [](const Triangle& t) { return (t[1] - t[0]).CrossSquareMagnitude(t[2] - t[0]); };
    const Triangle& largest = *std::max_element(
        own.begin(), own.end(), [&](const Triangle& a, const Triangle& b) { return area(a) < area(b); });
    const gp_XYZ middle = (largest[0] + largest[1] + largest[2]) / 3;
    double angle = 0;
    for (const std::size_t other : outer.faces)
      for (const Triangle& triangle : faces[other].triangles)
        angle += faces[other].turn == Turn::reversed ? -solid_angle(triangle, middle) : solid_angle(triangle, middle);
    return angle > 3 * std::numbers::pi;  // of 4
  });
}

/// Turns the shells that bound cavities of other shells. All shells show their outside before.
void turn_cavities(const std::vector<ClosedShell>& shells, std::vector<Face>& faces) {
  std::vector<const ClosedShell*> cavities;
  for (const ClosedShell& inner : shells)
    if (std::count_if(shells.begin(), shells.end(),
                      [&](const ClosedShell& outer) { return is_inside(inner, outer, faces); }) %
            2 ==
        1)
      cavities.push_back(&inner);
  for (const ClosedShell* cavity : cavities)
    for (const std::size_t face : cavity->faces) faces[face].reverse();
}

}  // namespace

TopoDS_Shape wound_alike(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  const gp_XYZ zero = box.IsVoid() ? gp_XYZ() : (box.CornerMin().XYZ() + box.CornerMax().XYZ()) / 2;
  std::vector<Face> faces;
  NCollection_IndexedDataMap<TopoDS_Shape, std::vector<EdgeUse>, TopTools_ShapeMapHasher> edges;
  for (TopExp_Explorer all(shape, TopAbs_FACE); all.More(); all.Next()) {
    FaceTriangles triangles(all.Current(), zero);
    Face& face = faces.emplace_back();
    face.shape = all.Current();
    for (TopExp_Explorer outline(face.shape, TopAbs_EDGE); outline.More(); outline.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(outline.Current());
      const std::optional<bool> is_forward = triangles.is_forward(edge);
      if (!is_forward) {
        face.is_open = face.is_open || !BRep_Tool::Degenerated(edge);
        continue;
      }
      int number = edges.FindIndex(edge);
      if (number == 0) number = edges.Add(edge, {});
      edges.ChangeFromIndex(number).push_back({faces.size() - 1, *is_forward});
      face.edges.push_back(number);
    }
    face.triangles = std::move(triangles.triangles);
  }

  std::vector<ClosedShell> closed;
  for (std::size_t first = 0; first < faces.size(); ++first) {
    if (faces[first].turn != Turn::unknown) continue;
    std::vector<std::size_t> shell{first};
    faces[first].turn = Turn::as_is;
    bool is_closed = true;
    double volume = 0, terms = 0;
    std::ptrdiff_t reversed = 0;  // triangles, less those that stay
    for (std::size_t at = 0; at < shell.size(); ++at) {
      const Face& face = faces[shell[at]];
      const bool is_reversed = face.turn == Turn::reversed;
      for (const Triangle& triangle : face.triangles) {
        const double own = volume_of(triangle);
        volume += is_reversed ? -own : own;
        terms += std::abs(own);
      }
      const auto count = std::ptrdiff_t(face.triangles.size());
      reversed += is_reversed ? count : -count;
      is_closed = is_closed && !face.is_open;
      for (const int edge : face.edges) {
        const std::vector<EdgeUse>& uses = edges(edge);
        is_closed = is_closed && uses.size() == 2;
        if (uses.size() != 2) continue;
        const std::size_t other = uses[0].face == shell[at] ? uses[1].face : uses[0].face;
        if (other == shell[at]) continue;  // beyond its seam
        const bool agree = uses[0].is_forward != uses[1].is_forward;
        const Turn wanted = is_reversed == agree ? Turn::reversed : Turn::as_is;
        if (faces[other].turn == Turn::unknown) {
          faces[other].turn = wanted;
          shell.push_back(other);
        }
        is_closed = is_closed && faces[other].turn == wanted;  // a Klein bottle has no inside
      }
    }
    is_closed = is_closed && std::abs(volume) > kRounding * terms;
    if (is_closed ? volume < 0 : reversed > 0)
      for (const std::size_t face : shell) faces[face].reverse();
    if (is_closed) closed.push_back(closed_shell(std::move(shell), faces));
  }
  turn_cavities(closed, faces);

  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const Face& face : faces) builder.Add(all, face.turn == Turn::reversed ? face.shape.Reversed() : face.shape);
  return all;
}

}  // namespace frontmost::import
