// SPDX-License-Identifier: Apache-2.0
// Models that frontmost-import reads: parts made for the tests by OpenCASCADE, files that are broken, and importers
// that are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "frontmost/frontmost.h"
#include "io/import/impostor.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/random_scene.h"
#include "support/scratch_folder.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
TEST(Import, WithoutTheProgramTheErrorNamesAConverter) {
  const ScratchFolder folder;
  const Importer none(folder.file("none"));
  std::ofstream(folder.file("part.step")) << "ISO-10303-21;";
  EXPECT_EQ(error_of(folder.file("part.step")),
            folder.file("part.step") +
                ": STEP is read where frontmost-import is installed; or convert it first: gmsh -2 "
                "-clcurv 48 " +
                folder.file("part.step") + " -o " + folder.file("part.stl") + " (Debian package gmsh)");
}

TEST(Import, AnImporterThatCrashesOrSaysNothingIsAnError) {
  EXPECT_EQ(Impostor("kill -SEGV $$").error(), "could not be read: frontmost-import crashed (Segmentation fault)");
  EXPECT_EQ(Impostor("exit 0").error(), "could not be read: frontmost-import ended without an answer");
  EXPECT_EQ(Impostor(frame_of('p', "0.5") + "exit 3").error(),
            "could not be read: frontmost-import ended without an answer");
  EXPECT_EQ(Impostor(frame_of('e', "the file has no shapes")).error(), "could not be read: the file has no shapes");
}

TEST(Import, NothingOfTheImporterIsLeft) {
  // Its output is closed, but it goes on; and a process of its own goes on after it.
  LoadOptions options;
  options.import.seconds = 0.2;
  EXPECT_THAT(Impostor("exec >&-; sleep 1000").error(options), HasSubstr("could not be read within 0.2 seconds"));
  const Impostor leaves_one("sleep 1000 >/dev/null 2>&1 & echo $! > \"$0.id\"; exit 0");
  EXPECT_EQ(leaves_one.error(), "could not be read: frontmost-import ended without an answer");
  std::ifstream id(leaves_one / "import.id");
  pid_t number = 0;
  ASSERT_TRUE(id >> number);
  // A killed process goes on for a moment, and stays until its parent waits for it.
  for (std::string state = "R"; state != "" && state != "Z";) {
    std::ifstream status("/proc/" + std::to_string(number) + "/stat");
    std::string id_text, name;
    if (!(status >> id_text >> name >> state)) state = "";
    usleep(1000);
  }
}

TEST(Import, AnImporterMaySendAnything) {
  EXPECT_EQ(Impostor("printf 'hello, world'").error(), "frontmost-import sends a frame of 8031923835658595429 bytes");
  EXPECT_EQ(Impostor(frame_of('z', "?")).error(), "frontmost-import sends a frame of unknown kind \"z\"");
  EXPECT_THAT(Impostor("printf 'p\\001\\000\\000\\000\\000\\000\\000'").error(), HasSubstr("without an answer"));
  // Sizes that are only claimed take no memory.
  EXPECT_THAT(Impostor("printf 'm\\000\\000\\000\\377\\000\\000\\000\\000'").error(), HasSubstr("without an answer"));
  EXPECT_THAT(Impostor("printf 'm\\000\\000\\000\\000\\377\\000\\000\\000'").error(), HasSubstr("sends a frame of"));
  EXPECT_THAT(Impostor(frame_of('m', "glTF is not this")).error(), HasSubstr("GLB header"));
  EXPECT_THAT(Impostor(frame_of('e', "\x1b[31mred")).error(), HasSubstr("could not be read: \\x1B[31mred"));
  // Many progresses and warnings, and numbers that are none.
  EXPECT_THAT(Impostor("for i in $(seq 500); do " + frame_of('p', "nan") + frame_of('w', "odd") + frame_of('s', "") +
                       frame_of('s', "inf q") + "done; " + frame_of('e', "over"))
                  .error(),
              HasSubstr("over"));
}

TEST(Import, TimeIsLimitedAndTheImporterGoes) {
  LoadOptions options;
  options.import.seconds = 0.2;
  const Impostor impostor("echo $$ > \"$0.id\"; sleep 1000");
  EXPECT_EQ(impostor.error(options), "could not be read within 0.2 seconds (--import-seconds)");
  std::ifstream id(impostor / "import.id");
  // It may have been ended before its first line.
  if (pid_t number = 0; id >> number) {
    EXPECT_NE(kill(number, 0), 0);
  }
}

TEST(Import, ACancelledLoadEndsTheImporter) {
  const CountingWatch watch(3);
  EXPECT_EQ(error_of(Impostor("sleep 1000").part(), {}, watch.execution()), "cancelled");
}

TEST(Import, OptionsAreChecked) {
  const Impostor impostor("exit 0");
  LoadOptions options;
  options.import.angle = 0;
  EXPECT_THAT(error_of(impostor.part(), options), HasSubstr("angle: must be above"));
  options.import = {.tolerance = -1};
  EXPECT_THAT(error_of(impostor.part(), options), HasSubstr("tolerance: must be"));
}

double volume_of(const Surfaces& surfaces) {
  double six_times = 0;
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    const auto t = surfaces.corners(id);
    six_times += glm::dot(glm::dvec3(t[0]), glm::cross(glm::dvec3(t[1]), glm::dvec3(t[2])));
  }
  return six_times / 6;
}

#ifdef FRONTMOST_IMPORT_POLYGONS

/// A triangle (0, 0, 0), (1, 0, 0), (0, 2, 0), written by hand in each format.
TEST(Import, ForeignMeshesAreRead) {
  const Importer importer(FRONTMOST_IMPORT_BUILT);
  struct Known {
    const char* suffix;
    Axis up;
    std::optional<double> metres;
    double scale;  ///< what assimp makes of the file's unit
  };
  for (const Known& known : {Known{"ac", Axis::y, {}, 1}, Known{"ase", Axis::y, {}, 1}, Known{"dae", Axis::y, 1, 0.01},
                             Known{"dxf", Axis::y, {}, 1}, Known{"fbx", Axis::z, 1, 1}, Known{"x", Axis::y, {}, 1},
                             Known{"x3d", Axis::y, {}, 1}}) {
    SCOPED_TRACE(known.suffix);
    const Scene scene = load(std::string(FRONTMOST_MESHES "/triangle.") + known.suffix);
    EXPECT_EQ(scene.source.format, ModelFormat::foreign);
    EXPECT_EQ(scene.up, known.up);
    ASSERT_EQ(scene.source.metres_per_unit.has_value(), known.metres.has_value());
    EXPECT_NEAR(scene.source.metres_per_unit.value_or(0), known.metres.value_or(0), 1e-9);
    ASSERT_EQ(triangle_count(scene), 1u);
    EXPECT_EQ(scene.instances[0].name.find('$'), std::string::npos) << scene.instances[0].name;
    const Surfaces surfaces(scene);
    const auto t = surfaces.corners(0);
    EXPECT_NEAR(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])), 2 * known.scale * known.scale, 1e-6);
  }
}

/// A crane in each format: `base`, a red box of 4 x 2 x 1 at zero, and `jib`, a blue one of twice its size, turned by
/// 90 degrees about z, at (1, 1, 6), where the format has places by way of `mast` at (1, 1, 1). The texts are written
/// by hand; crane.fbx, .3ds and .lwo are binary, made from the formats' descriptions.
struct Crane {
  const char* suffix;
  glm::dmat3 turned;  ///< what assimp does to make y the upward axis, or the space right-handed; columns
  Axis up = Axis::y;
  std::optional<double> metres{};
  double scale = 1;
  const char *base = "base", *jib = "jib";
  bool has_colors = true;
};

const glm::dmat3 as_is(1), z_to_y({1, 0, 0}, {0, 0, -1}, {0, 1, 0}), z_back({1, 0, 0}, {0, 1, 0}, {0, 0, -1});

class ForeignCrane : public testing::TestWithParam<Crane> {};

TEST_P(ForeignCrane, ArrivesWithPlacesNamesAndColours) {
  const Crane& crane = GetParam();
  const Importer importer(FRONTMOST_IMPORT_BUILT);
  const Scene scene = load(std::string(FRONTMOST_MESHES "/crane.") + crane.suffix);
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
  EXPECT_EQ(scene.up, crane.up);
  EXPECT_EQ(scene.source.metres_per_unit, crane.metres);
  ASSERT_EQ(scene.instances.size(), 2u);
  const Surfaces surfaces(scene);
  for (const Instance& instance : scene.instances) {
    const bool is_base = instance.name == crane.base;
    EXPECT_EQ(instance.name, is_base ? crane.base : crane.jib);
    const Mesh& mesh = scene.meshes[instance.mesh];
    EXPECT_EQ(mesh.triangles.size(), 12u);
    glm::dvec3 low(1e9), high(-1e9);
    for (const glm::vec3& p : mesh.positions) {
      const glm::dvec3 at(instance.world_from_mesh * glm::dvec4(glm::dvec3(p), 1));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    const glm::dvec3 a = crane.turned * (is_base ? glm::dvec3(0) : glm::dvec3(-3, 1, 6)) * crane.scale,
                     b = crane.turned * (is_base ? glm::dvec3(4, 2, 1) : glm::dvec3(1, 9, 8)) * crane.scale;
    EXPECT_LT(glm::distance(low, glm::min(a, b)), 1e-5) << instance.name;
    EXPECT_LT(glm::distance(high, glm::max(a, b)), 1e-5) << instance.name;
    if (!crane.has_colors) continue;
    const std::uint32_t number = mesh.material_of(0);
    glm::vec4 color = number == no_index ? glm::vec4(1) : scene.materials[number].base_color;
    if (!mesh.colors.empty()) color *= mesh.colors.values[mesh.corners(mesh.colors, 0).x];
    EXPECT_GT(color[is_base ? 0 : 2], 0.5) << instance.name;
    EXPECT_EQ(color[is_base ? 2 : 0] + color[1], 0) << instance.name;
  }
  EXPECT_NEAR(volume_of(surfaces), (8 + 64) * std::pow(crane.scale, 3), 1e-4) << "outside out";
}

INSTANTIATE_TEST_SUITE_P(Formats, ForeignCrane,
                         testing::Values(Crane{"3ds", z_to_y}, Crane{"ac", as_is},
                                         Crane{"amf", as_is, Axis::y, {}, 1, "0", "1"},
                                         Crane{"dae", z_to_y, Axis::y, 1, 0.0254},
                                         // assimp numbers the colours of DXF in its own way.
                                         Crane{"dxf", z_to_y, Axis::y, {}, 1, "base", "jib", false},
                                         Crane{"fbx", as_is, Axis::z, 0.0254}, Crane{"lwo", z_back}, Crane{"x", z_back},
                                         Crane{"x3d", as_is}),
                         [](const auto& crane) { return std::string(crane.param.suffix); });

TEST(Import, TurnedObjectsOfAmfAreAWarning) {
  const Importer importer(FRONTMOST_IMPORT_BUILT);
  const ScratchFolder folder;
  const std::string text = read_text(FRONTMOST_MESHES "/crane.amf");
  const auto warnings_with = [&](const std::string& turn) {
    std::string turned = text;
    turned.insert(turned.find("</instance>"), turn);
    write_text(folder.file("crane.amf"), turned);
    return load(folder.file("crane.amf")).warnings;
  };
  for (const char* const turn : {"<rz>90</rz>", "<rx >\n -1e-3 </rx >", "<!-- <rx> --><ry>+45</ry>"})
    EXPECT_THAT(warnings_with(turn),
                testing::ElementsAre(HasSubstr("objects that the file turns stand at wrong places")))
        << turn;
  for (const char* const turn : {"<rx>0</rx>", "<ry> -0.0 </ry>", "<!-- <rx>90</rx> -->", "<rz></rz>"})
    EXPECT_THAT(warnings_with(turn), testing::IsEmpty()) << turn;
}

#endif

#ifdef FRONTMOST_MAKE_PARTS

/// The parts of make_parts.cpp.
class CadFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    ASSERT_EQ(std::system((std::string(FRONTMOST_MAKE_PARTS " ") + folder_->path().string() + " > /dev/null").c_str()),
              0);
  }
  static void TearDownTestSuite() { delete std::exchange(folder_, nullptr); }
  [[nodiscard]] static std::string file(const std::string& name) { return folder_->file(name); }

  static inline ScratchFolder* folder_ = nullptr;
  Importer importer_{FRONTMOST_IMPORT_BUILT};
};

double area_of(const Surfaces& surfaces) {
  double area = 0;
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    const auto t = surfaces.corners(id);
    area += 0.5 * glm::length(glm::cross(glm::dvec3(t[1] - t[0]), glm::dvec3(t[2] - t[0])));
  }
  return area;
}

constexpr double kPi = std::numbers::pi;
/// A plate of 120 x 80 x 12 mm with four holes of radius 6 and a fillet of radius 3.
const double plate_volume = 120 * 80 * 12 - 4 * kPi * 36 * 12 - 120 * (1 - kPi / 4) * 9;
const double plate_area = 2 * 120 * 80 + 2 * (120 + 80) * 12 - 2 * 120 * 3 + 120 * kPi * 3 / 2 - 2 * (1 - kPi / 4) * 9 -
                          8 * kPi * 36 + 4 * 2 * kPi * 6 * 12;

TEST_F(CadFiles, AnAssemblyKeepsNamesPlacesColoursAndItsUnit) {
  const Scene scene = load(file("fixture.step"));
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[0].name, "base");
  EXPECT_EQ(scene.instances[1].name, "pin left");
  EXPECT_EQ(scene.instances[2].name, "pin right");
  EXPECT_EQ(scene.meshes.size(), 2u) << "a part that is placed twice is there once";
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[2].mesh);
  EXPECT_EQ(glm::dvec3(scene.instances[2].world_from_mesh[3]), glm::dvec3(100, 60, 0));
  EXPECT_EQ(scene.source.format, ModelFormat::step);
  EXPECT_EQ(scene.source.metres_per_unit, 0.001);
  EXPECT_EQ(scene.up, Axis::z);
  const Material& red = scene.materials[scene.meshes[0].material_of(0)];
  EXPECT_EQ(red.base_color, glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(scene.materials[scene.meshes[scene.instances[1].mesh].material_of(0)].base_color, glm::vec4(0, 0, 1, 1));
  const double pins = 2 * kPi * 36 * 30;
  EXPECT_NEAR(volume_of(Surfaces(scene)), plate_volume + pins, 0.01 * plate_volume);
}

TEST_F(CadFiles, CoordinatesAreThoseOfTheFile) {
  const Scene inch = load(file("fixture-inch.step"));
  EXPECT_EQ(inch.source.metres_per_unit, 0.0254);
  const Surfaces surfaces(inch);
  EXPECT_NEAR(surfaces.bounds().high.x, 120 / 25.4, 1e-5);
  // 400 m away, where floats have steps of 0.03 mm.
  const Scene far = load(file("plate-far.step"));
  EXPECT_NEAR(volume_of(Surfaces(far)), plate_volume, 0.01 * plate_volume);
  const Drawing drawing = draw_lines(Surfaces(far), frontmost::frame(Surfaces(far), 400, 300));
  EXPECT_GT(drawing.parts.size(), 20u);
}

TEST_F(CadFiles, IgesAndBrepHoldTheSamePlate) {
  for (const std::string name : {"plate.igs", "turned.igs", "plate.brep"}) {
    const Scene scene = load(file(name));
    EXPECT_EQ(scene.source.format, name == "plate.brep" ? ModelFormat::brep : ModelFormat::iges);
    EXPECT_EQ(scene.up, Axis::z);
    EXPECT_FALSE(inspect(scene).meshes[0].odd.any()) << name << ": closed, and wound alike";
    EXPECT_NEAR(volume_of(Surfaces(scene)), plate_volume, 0.01 * plate_volume) << name << ": outside out";
    EXPECT_NEAR(area_of(Surfaces(scene)), plate_area, 0.01 * plate_area) << name;
    EXPECT_EQ(scene.meshes[0].edge_circles.size(), 10u) << name << ": a rim at either end of a hole, and of the fillet";
    EXPECT_FALSE(scene.meshes[0].smooth_edges.empty()) << name << ": the fillet's borders";
  }
}

TEST_F(CadFiles, CavitiesOfIgesStayCavities) {
  const Scene scene = load(file("hollow.igs"));
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_NEAR(volume_of(Surfaces(scene)), 40 * 40 * 40 - 20 * 20 * 20 + 6 * 6 * 6, 0.01);
  const Section section = cut(Surfaces(scene), {Axis::z, 20});
  ASSERT_EQ(section.faces.size(), 1u);
  EXPECT_NEAR(section.faces[0].area, 40 * 40 - 20 * 20 + 6 * 6, 0.001);
  EXPECT_EQ(section.faces[0].outlines.size(), 3u);
}

TEST_F(CadFiles, ClosedShellsOfIgesAreOutsideOut) {
  const Scene two = load(file("two.igs")), filled = load(file("pin.igs"));
  EXPECT_NEAR(volume_of(Surfaces(two)), 2 * 1000, 1);
  const double hole = kPi * 36 * 20, pin = kPi * 36 * 9;
  EXPECT_NEAR(volume_of(Surfaces(filled)), 8000 - hole + pin, 10) << "what fills a hole is no cavity";
}

TEST_F(CadFiles, OpenShellsOfIgesAreWoundAlike) {
  for (const char* const name : {"open.igs", "fin.igs"}) {
    SCOPED_TRACE(name);
    const Scene scene = load(file(name));
    const Surfaces surfaces(scene);
    int outwards = 0, inwards = 0;
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const auto t = surfaces.corners(id);
      const glm::dvec3 middle = glm::dvec3(t[0] + t[1] + t[2]) / 3.0;
      if (std::min(middle.x, middle.y) < -5.1) continue;  // the fin
      const double out = glm::dot(glm::dvec3(glm::cross(t[1] - t[0], t[2] - t[0])), middle);
      (out > 0 ? outwards : inwards)++;
    }
    EXPECT_EQ(std::min(outwards, inwards), 0) << "wound alike";
    // Sewing has turned the faces of an open shell like its first one.
    EXPECT_EQ(outwards + inwards, name == std::string("open.igs") ? 10 : 12);
    EXPECT_TRUE(inwards == 0 || name == std::string("open.igs")) << "most faces show their outside";
  }
  const Scene strip = load(file("moebius.igs"));
  EXPECT_EQ(triangle_count(strip), 24u) << "which has no two sides";
}

TEST_F(CadFiles, FacesWithoutTrianglesAreCounted) {
  for (int i = 0; i < 2; ++i) {  // the second time from the cache
    const Scene one = load(file("bare-1.brep")), two = load(file("bare-2.brep"));
    EXPECT_THAT(one.warnings,
                testing::ElementsAre(file("bare-1.brep") +
                                     ": 1 face is left out, because OpenCASCADE finds no triangles for it"));
    EXPECT_THAT(two.warnings,
                testing::ElementsAre(file("bare-2.brep") +
                                     ": 2 faces are left out, because OpenCASCADE finds no triangles for them"));
    EXPECT_NEAR(volume_of(Surfaces(two)), kPi * 36 * 30, 0.01 * kPi * 36 * 30) << "the pin alone";
  }
  EXPECT_THAT(load(file("fixture.step")).warnings, testing::IsEmpty());
}

TEST_F(CadFiles, KeptTrianglesAreTheSame) {
  for (const char* name : {"fixture.step", "plate.igs", "plate.brep"}) {
    SCOPED_TRACE(name);
    const std::size_t before = importer_.entries().size();
    const Scene first = load(file(name));
    EXPECT_EQ(importer_.entries().size(), before + 1);
    const Scene second = load(file(name));
    EXPECT_EQ(importer_.entries().size(), before + 1);
    ASSERT_EQ(first.meshes.size(), second.meshes.size());
    for (std::size_t i = 0; i < first.meshes.size(); ++i) {
      EXPECT_EQ(first.meshes[i].positions, second.meshes[i].positions);
      EXPECT_EQ(first.meshes[i].triangles, second.meshes[i].triangles);
      EXPECT_EQ(first.meshes[i].sharp_edges, second.meshes[i].sharp_edges);
      EXPECT_EQ(first.meshes[i].edge_circles.size(), second.meshes[i].edge_circles.size());
    }
    EXPECT_EQ(first.instances.size(), second.instances.size());
    EXPECT_EQ(first.source.metres_per_unit, second.source.metres_per_unit);
    EXPECT_EQ(first.up, second.up);
  }
}

TEST_F(CadFiles, APartInAnotherFileIsNeitherKeptNorForgotten) {
  const ScratchFolder folder;
  const auto place_pin = [&](const std::string& path) {
    std::string text = load_text(file("apart.step"), 1 << 20);
    const std::string name = "'apart-pin.stp'";
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
      text.replace(at, name.size(), "'" + path + "'");
    write_text(folder.file("apart.step"), text);
    return load(folder.file("apart.step"));
  };
  fs::copy_file(file("apart-pin.stp"), folder.file("apart-pin.stp"));
  const Scene scene = place_pin(folder.file("apart-pin.stp"));
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_THAT(scene.warnings,
              testing::ElementsAre(
                  HasSubstr("the file names other files: parts in these are read only if their paths are absolute")));
  EXPECT_TRUE(importer_.entries().empty()) << "the other file may change";
  EXPECT_THAT(error_of(file("apart.step")), HasSubstr("the file has no shapes"));
}

TEST_F(CadFiles, BytesInMemoryAreRecognized) {
  const std::string bytes = load_text(file("fixture.step"), 1 << 20);
  EXPECT_EQ(load(std::as_bytes(std::span(bytes)), "memory").instances.size(), 3u);
}

TEST_F(CadFiles, EdgesAreSharpWhereTheSurfacesTurn) {
  const Scene scene = load(file("plate.brep"));
  const Mesh& mesh = scene.meshes[0];
  // Sides of the box (12, less one rounded edge that becomes two lines and two arcs), and rims.
  double sharp = 0;
  for (const glm::uvec2& edge : mesh.sharp_edges)
    sharp += glm::distance(mesh.positions[edge.x], mesh.positions[edge.y]);
  const double box = 4 * (120 + 80 + 12) - 120 - 4 * 3, arcs = 2 * 3 * kPi / 2, rims = 8 * 2 * kPi * 6;
  EXPECT_NEAR(sharp, box + arcs + rims, 0.005 * (box + arcs + rims));
  double smooth = 0;
  for (const glm::uvec2& edge : mesh.smooth_edges)
    smooth += glm::distance(mesh.positions[edge.x], mesh.positions[edge.y]);
  EXPECT_NEAR(smooth, 2 * 120 + 4 * 12, 0.01) << "along the fillet, and the seams of the holes";
  for (const EdgeCircle& circle : mesh.edge_circles)
    EXPECT_TRUE(std::abs(circle.radius - 6) < 1e-9 || std::abs(circle.radius - 3) < 1e-9) << circle.radius;
}

TEST_F(CadFiles, DrawingsHaveTheSharpEdgesAlone) {
  const Scene scene = load(file("plate.brep"));
  const Surfaces surfaces(scene);
  // From above: the outline, the rims, and nothing along the fillet, whose edges are smooth.
  const View view = frontmost::frame(surfaces, 1000, 1000, {.orthographic = true, .forward = glm::dvec3(0, 0, -1)});
  const double unit = (view.projection.right - view.projection.left) / view.width;
  double length = 0;
  const Drawing drawing = draw_lines(surfaces, view);
  for (const DrawnPart& part : drawing.parts)
    if (part.hidden_by == 0) length += glm::distance(part.from, part.to) * unit;
  EXPECT_NEAR(length, 2 * (120 + 80) + 4 * 2 * kPi * 6, 0.3);
  // An angle that is asked for judges the edges of triangles instead.
  const Drawing judged = draw_lines(surfaces, view, {.crease_angle = 0.01});
  EXPECT_GT(judged.parts.size(), drawing.parts.size());
  const Rounds rounds = find_rounds(surfaces);
  const auto rims = std::count_if(rounds.rounds.begin(), rounds.rounds.end(), [](const Round& round) {
    return round.kind == RoundKind::circle && round.radius == 6 && std::abs(round.turn - 2 * kPi) < 1e-6;
  });
  EXPECT_EQ(rims, 8) << "with the radius of the file, to the last bit";
}

TEST_F(CadFiles, SectionsHaveTheSharpEdgesAlone) {
  LoadOptions coarse;  // facets that meet at 45 degrees, which angles alone would call sharp
  coarse.import = {.tolerance = 100, .angle = 1.5};
  const Scene scene = load(file("plate.brep"), coarse);
  // Through the axes of two holes; the half with y above 20 is left.
  const Section section = cut(Surfaces(scene), {Axis::minus_y, 20});
  validate(section.scene);
  const Surfaces left(section.scene);
  for (const DrawnEdge& edge : draw_lines(left, frontmost::frame(left, 400, 400)).edges) {
    if (edge.kind != EdgeKind::crease) continue;
    const bool is_upright = std::abs(edge.from.z - edge.to.z) > 1e-6;
    const bool is_outer = std::abs(edge.from.x - 60) > 59.9 && edge.from.y > 79.9;
    EXPECT_FALSE(is_upright && !is_outer) << "a facet of a hole at " << edge.from.x << ", " << edge.from.y;
  }
  const Rounds rounds = find_rounds(left);
  double turns = 0;
  for (const Round& round : rounds.rounds) {
    if (round.kind != RoundKind::circle) continue;
    EXPECT_EQ(round.radius, 6);
    turns += round.turn / (2 * kPi);
  }
  EXPECT_NEAR(turns, 4 + 2, 0.01) << "four whole rims, and four halves";
}

TEST_F(CadFiles, TheToleranceIsKept) {
  LoadOptions fine;
  fine.import.tolerance = 0.001;
  const Scene coarse_scene = load(file("plate.brep")), fine_scene = load(file("plate.brep"), fine);
  EXPECT_GT(triangle_count(fine_scene), 2 * triangle_count(coarse_scene));
  // Middles of rims' edges leave the circle by the tolerance at most.
  for (const auto& [scene, most] :
       {std::pair(&coarse_scene, 0.0005 * std::sqrt(120 * 120 + 80 * 80 + 12 * 12)), std::pair(&fine_scene, 0.001)}) {
    const Mesh& mesh = scene->meshes[0];
    for (const EdgeCircle& circle : mesh.edge_circles)
      for (std::uint32_t i = circle.first; i < circle.first + circle.count; ++i) {
        const glm::dvec3 middle =
            (glm::dvec3(mesh.positions[mesh.sharp_edges[i].x]) + glm::dvec3(mesh.positions[mesh.sharp_edges[i].y])) *
            0.5;
        EXPECT_NEAR(glm::distance(middle, circle.centre), circle.radius, 1.1 * most);
      }
  }
}

TEST_F(CadFiles, MemoryIsLimited) {
  LoadOptions small;
  small.import.bytes = std::uint64_t(64) << 20;
  EXPECT_THAT(error_of(file("fixture.step"), small), HasSubstr("fixture.step: could not be read: "));
}

/// Loads mutations of the fixture. \returns how many were read.
int load_mutations(const std::string& original, std::uint64_t first, std::uint64_t count) {
  const ScratchFolder folder;
  LoadOptions options;
  options.import = {.seconds = 60, .bytes = std::uint64_t(2) << 30};
  int read = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::string bytes = original;
    const int changes = 1 + random.below(8);
    for (int i = 0; i < changes; ++i) {
      const auto at = std::size_t(random.below(int(bytes.size())));
      switch (random.below(4)) {
        case 0: bytes[at] = char(random.below(256)); break;
        case 1: bytes.erase(at, std::size_t(random.below(40))); break;
        case 2:
          bytes.insert(at, bytes.substr(std::size_t(random.below(int(bytes.size()))), std::size_t(random.below(60))));
          break;
        default:
          // Numbers of entities and sizes are what readers trust.
          if (const std::size_t digit = bytes.find_first_of("0123456789", at); digit != std::string::npos)
            bytes[digit] = char('0' + random.below(10));
      }
    }
    std::ofstream(folder.file("part.step"), std::ios::binary) << bytes;
    try {
      (void)load(folder.file("part.step"), options);
      ++read;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("part.step: "));
    }
  }
  return read;
}

TEST_F(CadFiles, BrokenFilesAreErrorsOrModels) {
  const std::string original = load_text(file("fixture.step"), 1 << 20);
  const int read = load_mutations(original, 1, seeds(24));
  std::cout << read << " of " << seeds(24) << " broken files are read nevertheless\n";
}

TEST_F(CadFiles, TwoThousandBrokenFilesAreErrorsOrModels) {
  const std::string original = load_text(file("fixture.step"), 1 << 20);
  std::cout << load_mutations(original, 100, 2000) << " of 2000 broken files are read nevertheless\n";
}

TEST_F(CadFiles, CollectedFilesAreRead) {
  FRONTMOST_NEEDS_MODELS();
  struct Known {
    const char* name;
    std::size_t objects, least_triangles;
  };
  for (const Known& known :
       {Known{"brep/as1-oc-214.stp", 18, 8000}, Known{"brep/CrankArm.brep", 2, 5000}, Known{"brep/screw.step", 1, 1000},
        Known{"brep/bearing.iges", 1, 20000}, Known{"brep/surf114.igs", 4, 10000},
        Known{"brep/linkrods.step", 1, 10000}, Known{"brep/Ventilator.stp", 1, 30000},
        Known{"brep/face_recognition_sample_part.stp", 1, 500}}) {
    SCOPED_TRACE(known.name);
    const Scene scene = load(model(known.name));
    EXPECT_EQ(scene.instances.size(), known.objects);
    EXPECT_GT(triangle_count(scene), known.least_triangles);
    EXPECT_FALSE(draw_lines(Surfaces(scene), frontmost::frame(Surfaces(scene), 200, 200)).parts.empty());
  }
}

#endif

}  // namespace
}  // namespace frontmost::test
