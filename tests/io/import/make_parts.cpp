// SPDX-License-Identifier: Apache-2.0
// Writes CAD files for tests, by OpenCASCADE, into the folder that it is given:
//
//   fixture.step        a plate with four holes and a rounded upper edge, 120 x 80 x 12 mm, and a pin in two of them
//   fixture-inch.step   the same in inches
//   plate.igs, plate.brep, plate-far.step (400 m from zero)
//   turned.igs          the faces of the plate apart, every second one reversed
//   hollow.igs          a box of 40 mm with a cavity of 20 mm, in which a box of 6 mm lies; faces apart
//   two.igs             two boxes of 10 mm, 1 km from zero
//   pin.igs             a box of 20 mm with a hole, and a pin of the same radius in it that ends inside the hole
//   open.igs            a box of 10 mm without its last face, two faces inside out
//   fin.igs             the box with its last face, and with a fin at one of its edges
//   moebius.igs         a strip that is twisted once
//   bare-1.brep, bare-2.brep (a pin, and one or two faces whose outlines are open)
//   apart.step          the pin alone, in a file of its own, apart-pin.stp
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Wire.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <string>

namespace {

constexpr double kWidth = 120, kDepth = 80, kHeight = 12, kHole = 6, kFillet = 3;

gp_Ax2 upright(double x, double y, double z) { return {gp_Pnt(x, y, z), gp_Dir(0, 0, 1)}; }

TopoDS_Shape plate() {
  TopoDS_Shape shape = BRepPrimAPI_MakeBox(kWidth, kDepth, kHeight).Shape();
  // The upper edge at the front.
  BRepFilletAPI_MakeFillet fillet(shape);
  for (TopExp_Explorer edges(shape, TopAbs_EDGE); edges.More(); edges.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(edges.Current());
    const gp_Pnt a = BRep_Tool::Pnt(TopExp::FirstVertex(edge)), b = BRep_Tool::Pnt(TopExp::LastVertex(edge));
    if (a.Y() == 0 && b.Y() == 0 && a.Z() == kHeight && b.Z() == kHeight) {
      fillet.Add(kFillet, edge);
      break;
    }
  }
  shape = fillet.Shape();
  for (const double x : {20.0, 100.0})
    for (const double y : {20.0, 60.0})
      shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(upright(x, y, -1), kHole, kHeight + 2).Shape()).Shape();
  return shape;
}

Handle(TDocStd_Document) fixture() {
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(document->Main());
  Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  Handle(XCAFDoc_ColorTool) colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const TDF_Label base = shapes->AddShape(plate(), false);
  const TDF_Label pin = shapes->AddShape(BRepPrimAPI_MakeCylinder(kHole, 30).Shape(), false);
  const TDF_Label whole = shapes->NewShape();
  TDataStd_Name::Set(base, "plate");
  TDataStd_Name::Set(pin, "pin");
  TDataStd_Name::Set(whole, "fixture");
  colors->SetColor(base, Quantity_Color(1, 0, 0, Quantity_TOC_RGB), XCAFDoc_ColorSurf);
  colors->SetColor(pin, Quantity_Color(0, 0, 1, Quantity_TOC_RGB), XCAFDoc_ColorSurf);
  const auto place = [&](const TDF_Label& part, const gp_Vec& by, const char* name) {
    gp_Trsf move;
    move.SetTranslation(by);
    TDataStd_Name::Set(shapes->AddComponent(whole, part, TopLoc_Location(move)), name);
  };
  place(base, gp_Vec(0, 0, 0), "base");
  place(pin, gp_Vec(20, 20, 0), "pin left");
  place(pin, gp_Vec(100, 60, 0), "pin right");
  shapes->UpdateAssemblies();
  return document;
}

bool write_step(const Handle(TDocStd_Document) & document, const std::string& path, const char* unit) {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit);
  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  writer.SetColorMode(true);
  return writer.Transfer(document) && writer.Write(path.c_str()) == IFSelect_RetDone;
}

Handle(TDocStd_Document) far_plate() {
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(document->Main());
  gp_Trsf move;
  move.SetTranslation(gp_Vec(400000, 0, 0));
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(plate().Moved(TopLoc_Location(move)), false);
  return document;
}

TopoDS_Shape turned_faces() {
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  bool is_reversed = false;
  for (TopExp_Explorer all(plate(), TopAbs_FACE); all.More(); all.Next(), is_reversed = !is_reversed)
    builder.Add(faces, is_reversed ? all.Current().Reversed() : all.Current());
  return faces;
}

/// Adds the faces of a shape to a compound; of these, `turns(i)` are reversed.
template <class Turns>
void add_faces(const TopoDS_Shape& shape, const Turns& turns, TopoDS_Compound& faces) {
  int i = 0;
  for (TopExp_Explorer all(shape, TopAbs_FACE); all.More(); all.Next(), ++i)
    BRep_Builder().Add(faces, turns(i) ? all.Current().Reversed() : all.Current());
}

TopoDS_Compound nothing() {
  TopoDS_Compound compound;
  BRep_Builder().MakeCompound(compound);
  return compound;
}

TopoDS_Shape cube(double at, double size) {
  return BRepPrimAPI_MakeBox(gp_Pnt(at, at, at), gp_Pnt(at + size, at + size, at + size)).Shape();
}

TopoDS_Shape hollow() {
  TopoDS_Compound faces = nothing();
  add_faces(
      cube(0, 40), [](int i) { return i % 2 == 0; }, faces);
  add_faces(
      cube(10, 20), [](int i) { return i % 3 == 0; }, faces);
  add_faces(
      cube(17, 6), [](int) { return true; }, faces);
  return faces;
}

TopoDS_Shape two() {
  TopoDS_Compound faces = nothing();
  add_faces(
      cube(1e6, 10), [](int) { return true; }, faces);
  add_faces(
      cube(1e6 + 30, 10), [](int) { return false; }, faces);
  return faces;
}

TopoDS_Shape pin_in_hole() {
  TopoDS_Compound faces = nothing();
  const TopoDS_Shape hole = BRepPrimAPI_MakeCylinder(upright(10, 10, -1), kHole, 22).Shape();
  add_faces(
      BRepAlgoAPI_Cut(cube(0, 20), hole).Shape(), [](int) { return false; }, faces);
  add_faces(
      BRepPrimAPI_MakeCylinder(upright(10, 10, 3), kHole, 9).Shape(), [](int) { return true; }, faces);
  return faces;
}

/// The first `count` faces of a box of 10 mm about zero. Planes of the first two have their normals inside, because
/// IGES keeps no other orientation of faces.
TopoDS_Compound sides_of_box(int count) {
  TopoDS_Compound faces = nothing();
  const gp_XYZ normals[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (int i = 0; i < count; ++i) {
    const gp_Pln plane(gp_Pnt(normals[i] * 5), gp_Dir(normals[i] * (i < 2 ? -1 : 1)));
    BRep_Builder().Add(faces, BRepBuilderAPI_MakeFace(plane, -5, 5, -5, 5).Face());
  }
  return faces;
}

TopoDS_Shape box_with_fin() {
  TopoDS_Compound faces = sides_of_box(6);
  // From the edge at x = -5, y = -5.
  const double half = 5 * std::sqrt(2.0);
  const gp_Pln fin(gp_Ax3(gp_Pnt(-7.5, -7.5, 0), gp_Dir(1, -1, 0), gp_Dir(0, 0, 1)));
  BRep_Builder().Add(faces, BRepBuilderAPI_MakeFace(fin, -5, 5, -half / 2, half / 2).Face());
  return faces;
}

TopoDS_Shape moebius_strip() {
  TopoDS_Compound faces = nothing();
  constexpr int sides = 12;
  const auto at = [](int i, double across) {
    const double around = 2 * M_PI * i / sides, radius = 20 + across * std::cos(around / 2);
    return gp_Pnt(radius * std::cos(around), radius * std::sin(around), across * std::sin(around / 2));
  };
  for (int i = 0; i < sides; ++i) {
    const gp_Pnt a = at(i, -5), b = at(i, 5), c = at(i + 1, -5), d = at(i + 1, 5);
    for (const TopoDS_Wire& wire :
         {BRepBuilderAPI_MakePolygon(a, b, c, true).Wire(), BRepBuilderAPI_MakePolygon(b, d, c, true).Wire()})
      BRep_Builder().Add(faces, BRepBuilderAPI_MakeFace(wire).Face());
  }
  return faces;
}

/// A part of a pin and of faces that no triangles can fill.
bool write_bare(const std::string& path, int faces) {
  TopoDS_Compound part, file;
  BRep_Builder builder;
  builder.MakeCompound(part);
  builder.MakeCompound(file);
  builder.Add(part, BRepPrimAPI_MakeCylinder(kHole, 30).Shape());
  for (int i = 0; i < faces; ++i) {
    const double z = 40 + i;
    TopoDS_Wire open;
    builder.MakeWire(open);
    builder.Add(open, BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, z), gp_Pnt(1, 0, z)).Edge());
    builder.Add(open, BRepBuilderAPI_MakeEdge(gp_Pnt(1, 0, z), gp_Pnt(1, 1, z)).Edge());
    builder.Add(part, BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), open, false).Face());
  }
  builder.Add(file, part);
  return BRepTools::Write(file, path.c_str());
}

/// An assembly of one part, which is in a file beside it.
bool write_apart(const std::string& folder) {
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(document->Main());
  Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label pin = shapes->AddShape(BRepPrimAPI_MakeCylinder(kHole, 30).Shape(), false),
                  whole = shapes->NewShape();
  TDataStd_Name::Set(pin, "pin");
  TDataStd_Name::Set(whole, "whole");
  shapes->AddComponent(whole, pin, TopLoc_Location());
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  return writer.Transfer(document, STEPControl_AsIs, "apart-") &&
         writer.Write((folder + "apart.step").c_str()) == IFSelect_RetDone;
}

}  // namespace

int main(int, char** words) {
  const std::string folder = std::string(words[1]) + "/";
  bool is_written = write_step(fixture(), folder + "fixture.step", "MM");
  is_written = is_written && write_step(fixture(), folder + "fixture-inch.step", "INCH");
  is_written = is_written && write_step(far_plate(), folder + "plate-far.step", "MM");
  is_written = is_written && write_apart(folder);
  is_written = is_written && write_bare(folder + "bare-1.brep", 1) && write_bare(folder + "bare-2.brep", 2);
  const auto write_iges = [&](const TopoDS_Shape& shape, const char* name) {
    IGESControl_Writer iges("MM", 0);
    return iges.AddShape(shape) && iges.Write((folder + name).c_str());
  };
  is_written = is_written && write_iges(plate(), "plate.igs") && write_iges(turned_faces(), "turned.igs");
  is_written = is_written && write_iges(hollow(), "hollow.igs") && write_iges(two(), "two.igs") &&
               write_iges(pin_in_hole(), "pin.igs") && write_iges(sides_of_box(5), "open.igs") &&
               write_iges(box_with_fin(), "fin.igs") && write_iges(moebius_strip(), "moebius.igs");
  return is_written && BRepTools::Write(plate(), (folder + "plate.brep").c_str()) ? 0 : 1;
}
