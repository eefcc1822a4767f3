// SPDX-License-Identifier: Apache-2.0
// STEP, IGES and BREP files by OpenCASCADE: parts with their places, names and colours; triangles of their faces; and
// their edges, each sharp or smooth, on the vertices of the triangles.
//
//   file --transfer--> document of parts --one mesh for each part--> triangles of every face
//                          |                                             | the polygon of an edge on them
//                          +--places, names, colours--> Model <----------+
#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <Bnd_Box.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <RWMesh_FaceIterator.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "import/answer.h"
#include "import/glb.h"
#include "import/winding.h"

namespace frontmost::import {
namespace {

constexpr double kShareOfDiagonal = 0.0005;
constexpr double kSmooth = 0.99985;       // the cosine of 1 degree
constexpr double kSewn = 1e-5;            // share of the diagonal: edges of faces that lie this near are one edge
constexpr double kOnCircle = 2e-5;        // share of the radius by which a curve may leave its circle
constexpr int kCirclePoints = 17;         // points of a curve that are held against a circle
constexpr double kWidestCircle = 1e4;     // diagonals: a circle of a greater radius counts as a line
constexpr double kRoundedToZero = 1e-12;  // share of the diagonal: a coordinate below this is rounding noise
constexpr double kReadShare = 0.3, kTransferShare = 0.4;  // of all time

/// Tells the progress of OpenCASCADE as a part of all progress.
class Progress : public Message_ProgressIndicator {
 public:
  Progress(Answer& answer, double from, double share) : answer_(answer), from_(from), share_(share) {}

 protected:
  void Show(const Message_ProgressScope&, const Standard_Boolean) override {
    answer_.progress(from_ + share_ * GetPosition());
  }

 private:
  Answer& answer_;
  double from_, share_;
};

/// A document and the unit of its file. OpenCASCADE gives millimetres; `millimetres` is the length of the file's unit.
struct Document {
  Handle(TDocStd_Document) parts = new TDocStd_Document("BinXCAF");
  double millimetres = 1;
  bool has_unit = false;
  bool is_loose = false;     ///< faces share no edges
  bool names_files = false;  ///< further files, from which parts may come

  Document() { XCAFDoc_DocumentTool::Set(parts->Main()); }
  [[nodiscard]] Handle(XCAFDoc_ShapeTool) shapes() const { return XCAFDoc_DocumentTool::ShapeTool(parts->Main()); }
};

/// The length in millimetres of a unit as STEP names it, or nothing.
std::optional<double> millimetres_of(TCollection_AsciiString name) {
  static const std::map<std::string, double> known{
      {"metre", 1000},      {"meter", 1000},      {"millimetre", 1}, {"millimeter", 1}, {"centimetre", 10},
      {"centimeter", 10},   {"kilometre", 1e6},   {"inch", 25.4},    {"foot", 304.8},   {"feet", 304.8},
      {"micrometre", 1e-3}, {"micrometer", 1e-3}, {"mile", 1609344}, {"yard", 914.4},   {"mil", 0.0254},
      {"decimetre", 100},   {"micron", 1e-3},     {"mm", 1},         {"cm", 10},        {"m", 1000},
      {"in", 25.4},         {"ft", 304.8}};
  name.LowerCase();
  const auto found = known.find(name.ToCString());
  return found == known.end() ? std::nullopt : std::optional(found->second);
}

void check(bool is_read, const char* format) {
  if (!is_read) throw Unreadable(std::string("not a ") + format + " file that OpenCASCADE can read");
}

void read_step(const std::string& path, Answer& answer, Document& document) {
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  check(reader.ReadFile(path.c_str()) == IFSelect_RetDone, "STEP");
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  const auto unit = lengths.IsEmpty() ? std::nullopt : millimetres_of(lengths.First());
  document.has_unit = unit.has_value();
  document.millimetres = unit.value_or(1);
  STEPConstruct_ExternRefs references(reader.Reader().WS());
  references.LoadExternRefs();
  document.names_files = references.NbExternRefs() > 0;
  Handle(Progress) progress = new Progress(answer, kReadShare, kTransferShare);
  check(reader.Transfer(document.parts, progress->Start()), "STEP");
}

void read_iges(const std::string& path, Answer& answer, Document& document) {
  IGESCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  check(reader.ReadFile(path.c_str()) == IFSelect_RetDone, "IGES");
  const double millimetres = reader.IGESModel()->GlobalSection().UnitValue();
  document.has_unit = millimetres > 0;
  if (document.has_unit) document.millimetres = millimetres;
  document.is_loose = true;
  Handle(Progress) progress = new Progress(answer, kReadShare, kTransferShare);
  check(reader.Transfer(document.parts, progress->Start()), "IGES");
}

void read_brep(const std::string& path, Document& document) {
  TopoDS_Shape shape;
  BRep_Builder builder;
  const bool is_read = BRepTools::Read(shape, path.c_str(), builder) || BinTools::Read(shape, path.c_str());
  check(is_read && !shape.IsNull(), "BREP");
  // Children of a compound become parts, each once.
  document.shapes()->AddShape(shape, shape.ShapeType() == TopAbs_COMPOUND);
}

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  return TCollection_AsciiString(name->Get(), 0).ToCString();  // UTF-8
}

std::optional<EdgeCircle> circle_of(const gp_Circ& circle) {
  const gp_Pnt& c = circle.Location();
  const gp_Dir& a = circle.Axis().Direction();
  return EdgeCircle{{c.X(), c.Y(), c.Z()}, {a.X(), a.Y(), a.Z()}, circle.Radius(), 0, 0};
}

/// The circle on which the curve of an edge lies. Some exporters write circles as splines, so the points of other
/// curves are held against the circle through three of them.
std::optional<EdgeCircle> circle_of(const TopoDS_Edge& edge, double diagonal) {
  const BRepAdaptor_Curve curve(edge);
  if (curve.GetType() == GeomAbs_Circle) return circle_of(curve.Circle());
  const bool may_be_circle = curve.GetType() == GeomAbs_BSplineCurve || curve.GetType() == GeomAbs_BezierCurve ||
                             curve.GetType() == GeomAbs_Ellipse || curve.GetType() == GeomAbs_OtherCurve;
  const double from = curve.FirstParameter(), to = curve.LastParameter();
  if (!may_be_circle || Precision::IsInfinite(from) || Precision::IsInfinite(to)) return std::nullopt;
  const auto at = [&](double share) { return curve.Value(from + (to - from) * share); };
  // A third, and not the end, because closed curves end where they begin.
  const gp_Pnt a = at(0), b = at(1.0 / 3), c = at(2.0 / 3);
  const gp_Vec u(a, b), v(a, c), normal = u.Crossed(v);
  const double square = normal.SquareMagnitude();
  if (!(square > 1e-12 * u.SquareMagnitude() * v.SquareMagnitude())) return std::nullopt;
  const gp_Vec to_centre = (v * u.SquareMagnitude() - u * v.SquareMagnitude()).Crossed(normal) / (2 * square);
  const gp_Circ circle(gp_Ax2(a.Translated(to_centre), gp_Dir(normal)), to_centre.Magnitude());
  if (!(circle.Radius() < kWidestCircle * diagonal)) return std::nullopt;
  const double slack = kOnCircle * circle.Radius() + Precision::Confusion();
  for (int i = 0; i < kCirclePoints; ++i)
    if (!(circle.Distance(at(double(i) / (kCirclePoints - 1))) <= slack)) return std::nullopt;
  return circle_of(circle);
}

/// Makes a part of a shape that has triangles.
class PartMaker {
 public:
  PartMaker(Model& model, double scale, double diagonal) : model_(model), scale_(scale), diagonal_(diagonal) {}

  Part make(RWMesh_FaceIterator faces, std::string name) {
    part_.name = std::move(name);
    const TopoDS_Shape shape = faces.ExploredShape();
    for (; faces.More(); faces.Next()) add(faces);
    for (TopExp_Explorer all(shape, TopAbs_FACE); all.More(); all.Next())
      bare_faces += !first_of_face_.IsBound(all.Current());
    TopTools_IndexedDataMapOfShapeListOfShape edges;
    TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) add_edge(TopoDS::Edge(edges.FindKey(i)), edges(i));
    return std::move(part_);
  }

  std::size_t bare_faces = 0;  ///< faces that OpenCASCADE could not divide into triangles

 private:
  void add(const RWMesh_FaceIterator& face) {
    if (face.IsEmptyMesh()) return;
    const auto first = std::uint32_t(part_.positions.size() / 3);
    first_of_face_.Bind(face.Face(), int(first));
    for (int i = face.NodeLower(); i <= face.NodeUpper(); ++i) {
      const gp_Pnt p = face.NodeTransformed(i);
      const gp_Dir n = face.NormalTransformed(i);
      for (int axis = 1; axis <= 3; ++axis) {
        // Faces that meet at 0 have coordinates of 1e-16, which differ as floats.
        const bool is_zero = std::abs(p.Coord(axis)) < kRoundedToZero * diagonal_;
        part_.positions.push_back(is_zero ? 0 : float(p.Coord(axis) * scale_));
        part_.normals.push_back(float(n.Coord(axis)));
      }
    }
    std::vector<std::uint32_t>& corners = faces_of(face.HasFaceColor() ? material_of(face.FaceColor()) : kNoMaterial);
    for (int i = face.ElemLower(); i <= face.ElemUpper(); ++i) {
      const Poly_Triangle triangle = face.TriangleOriented(i);
      for (int k = 1; k <= 3; ++k) corners.push_back(first + std::uint32_t(triangle(k) - face.NodeLower()));
    }
  }

  std::uint32_t material_of(const Quantity_ColorRGBA& color) {
    const Color wanted{float(color.GetRGB().Red()), float(color.GetRGB().Green()), float(color.GetRGB().Blue()),
                       color.Alpha()};
    const auto found = std::find(model_.materials.begin(), model_.materials.end(), wanted);
    const auto number = std::uint32_t(found - model_.materials.begin());
    if (found == model_.materials.end()) model_.materials.push_back(wanted);
    return number;
  }

  std::vector<std::uint32_t>& faces_of(std::uint32_t material) {
    for (Faces& faces : part_.faces)
      if (faces.material == material) return faces.corners;
    return part_.faces.emplace_back(Faces{material, {}}).corners;
  }

  /// The vertices of an edge on the triangles of a face; empty if there are none.
  [[nodiscard]] std::vector<std::uint32_t> vertices_on(const TopoDS_Edge& edge, const TopoDS_Shape& face) const {
    std::vector<std::uint32_t> vertices;
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& triangles = BRep_Tool::Triangulation(TopoDS::Face(face), location);
    if (triangles.IsNull() || !first_of_face_.IsBound(face)) return vertices;
    const Handle(Poly_PolygonOnTriangulation)& polygon = BRep_Tool::PolygonOnTriangulation(edge, triangles, location);
    if (polygon.IsNull()) return vertices;
    const int first = first_of_face_.Find(face);
    for (int i = 1; i <= polygon->NbNodes(); ++i) vertices.push_back(std::uint32_t(first + polygon->Node(i) - 1));
    return vertices;
  }

  /// Whether the normals of both faces agree all along their edge.
  [[nodiscard]] bool agree(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) const {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const float *n = &part_.normals[3 * a[i]], *m = &part_.normals[3 * b[i]];
      const float squares = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
      // The tip of a cone has no normal.
      if (squares > 0 && n[0] * m[0] + n[1] * m[1] + n[2] * m[2] < float(kSmooth)) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_smooth(const TopoDS_Edge& edge, const TopoDS_Face& a, const TopoDS_Face& b) const {
    if (BRep_Tool::HasContinuity(edge, a, b) && BRep_Tool::Continuity(edge, a, b) >= GeomAbs_G1) return true;
    return agree(vertices_on(edge, a), vertices_on(edge, b));
  }

  void add_edge(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
    if (BRep_Tool::Degenerated(edge) || faces.IsEmpty()) return;
    const TopoDS_Face face = TopoDS::Face(faces.First());
    // A face that ends at a border is no edge between faces; lines find borders themselves.
    const bool is_seam = faces.Extent() == 1;
    if (is_seam && !BRep_Tool::IsClosed(edge, face)) return;
    const std::vector<std::uint32_t> vertices = vertices_on(edge, face);
    const bool is_smooth_edge = is_seam ? agree(vertices, vertices_on(TopoDS::Edge(edge.Reversed()), face))
                                        : faces.Extent() == 2 && is_smooth(edge, face, TopoDS::Face(faces.Last()));
    std::vector<std::uint32_t>& edges = is_smooth_edge ? part_.smooth : part_.sharp;
    const std::size_t before = edges.size();
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      edges.push_back(vertices[i - 1]);
      edges.push_back(vertices[i]);
    }
    if (is_smooth_edge || edges.size() == before) return;
    std::optional<EdgeCircle> circle = circle_of(edge, diagonal_);
    if (!circle) return;
    for (double& number : circle->centre) number *= scale_;
    circle->radius *= scale_;
    circle->first = std::uint32_t(before / 2);
    circle->count = std::uint32_t((edges.size() - before) / 2);
    part_.circles.push_back(*circle);
  }

  Model& model_;
  const double scale_, diagonal_;
  Part part_;
  NCollection_DataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> first_of_face_;  ///< its first vertex
};

std::array<double, 16> matrix_of(const gp_Trsf& t, double scale) {
  std::array<double, 16> matrix{};
  for (int row = 1; row <= 3; ++row)
    for (int column = 1; column <= 4; ++column)
      matrix[std::size_t(4 * (column - 1) + row - 1)] = t.Value(row, column) * (column == 4 ? scale : 1);
  matrix[15] = 1;
  return matrix;
}

/// A shape whose faces share the edges at which they meet.
TopoDS_Shape sewn(const TopoDS_Shape& shape, double tolerance) {
  BRepBuilderAPI_Sewing sewing(tolerance);
  sewing.Add(shape);
  sewing.Perform();
  return sewing.SewedShape().IsNull() ? shape : sewing.SewedShape();
}

/// Turns the leaves of the document's tree into parts and places.
void take_parts(const Document& document, const Tessellation& wanted, Answer& answer, Model& model) {
  TDF_LabelSequence roots;
  document.shapes()->GetFreeShapes(roots);
  Bnd_Box box;
  for (const TDF_Label& root : roots) BRepBndLib::Add(XCAFDoc_ShapeTool::GetShape(root), box, false);
  if (box.IsVoid()) throw Unreadable("the file has no shapes");
  const double diagonal = std::sqrt(box.SquareExtent());
  IMeshTools_Parameters parameters;
  parameters.Deflection = wanted.tolerance > 0 ? wanted.tolerance : kShareOfDiagonal * diagonal;
  parameters.Angle = wanted.angle;
  parameters.InParallel = wanted.in_parallel;
  parameters.AllowQualityDecrease = true;

  std::vector<XCAFPrs_DocumentNode> leaves;
  for (XCAFPrs_DocumentExplorer explorer(document.parts, roots, XCAFPrs_DocumentExplorerFlags_OnlyLeafNodes);
       explorer.More(); explorer.Next())
    leaves.push_back(explorer.Current());
  struct Made {
    XCAFPrs_Style style;
    std::uint32_t part;
  };
  std::map<std::string, std::vector<Made>> made;  // by label
  std::size_t bare_faces = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    answer.progress(kReadShare + kTransferShare +
                    (1 - kReadShare - kTransferShare) * double(i) / double(leaves.size()));
    const XCAFPrs_DocumentNode& leaf = leaves[i];
    TCollection_AsciiString entry;
    TDF_Tool::Entry(leaf.RefLabel, entry);
    std::vector<Made>& alike = made[entry.ToCString()];
    auto found = std::find_if(alike.begin(), alike.end(), [&](const Made& m) { return m.style.IsEqual(leaf.Style); });
    if (found == alike.end()) {
      TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(leaf.RefLabel);
      if (document.is_loose) shape = sewn(shape, kSewn * diagonal);
      BRepMesh_IncrementalMesh mesher(shape, parameters);
      if (document.is_loose) shape = wound_alike(shape);
      PartMaker maker(model, 1 / document.millimetres, diagonal);
      found = alike.insert(alike.end(), {leaf.Style, std::uint32_t(model.parts.size())});
      model.parts.push_back(maker.make(document.is_loose
                                           ? RWMesh_FaceIterator(shape, leaf.Style)
                                           : RWMesh_FaceIterator(leaf.RefLabel, TopLoc_Location(), true, leaf.Style),
                                       name_of(leaf.RefLabel)));
      bare_faces += maker.bare_faces;
    }
    // A part may hold nothing but points and curves.
    if (model.parts[found->part].faces.empty()) continue;
    const std::string own = name_of(leaf.Label), part_name = name_of(leaf.RefLabel);
    model.placed.push_back({own.empty() || own.front() == '=' ? part_name : own, found->part,
                            matrix_of(leaf.Location.Transformation(), 1 / document.millimetres)});
  }
  if (model.placed.empty()) throw Unreadable("the file has no faces");
  if (bare_faces > 0)
    answer.warning(bare_faces == 1 ? "1 face is left out, because OpenCASCADE finds no triangles for it"
                                   : std::to_string(bare_faces) +
                                         " faces are left out, because OpenCASCADE finds no triangles for them");
}

}  // namespace

void read_shapes(const std::string& path, std::string_view format, const Tessellation& tessellation, Answer& answer) {
  // Messages about entities that OpenCASCADE cannot use are of no use to anybody.
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  Document document;
  if (format == "step")
    read_step(path, answer, document);
  else if (format == "iges")
    read_iges(path, answer, document);
  else
    read_brep(path, document);
  Model model;
  take_parts(document, tessellation, answer, model);
  if (document.names_files)
    answer.warning("the file names other files: parts in these are read only if their paths are absolute");
  else
    answer.files();
  answer.space(document.has_unit ? document.millimetres / 1000 : 0, "z");
  answer.model(glb_of(model));
}

}  // namespace frontmost::import
