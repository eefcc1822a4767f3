// SPDX-License-Identifier: Apache-2.0
// 3MF piece by piece: small generated packages with known answers.
#include <zlib.h>

#include <cmath>
#include <optional>

#include "base/srgb.h"
#include "model_bytes.h"
#include "support/effort.h"
#include "support/threemf_maker.h"

namespace frontmost {
namespace {

using test::load_text;
using test::model_of;
using test::package_of;
using test::tetrahedron;
using test::ZipMaker;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Scene read(const ZipMaker& zip) { return load_text(zip.bytes(), ModelFormat::threemf); }
Scene read(const std::string& model) { return read(package_of(model)); }
std::string error_of(const ZipMaker& zip) { return test::error_of(zip.bytes(), ModelFormat::threemf); }
std::string error_of(const std::string& model) { return error_of(package_of(model)); }

/// A package of one object, a tetrahedron, with a build item.
std::string one_object(const std::string& attributes = {}, const std::string& resources = {}) {
  return "<resources>" + resources + R"(<object id="1" type="model" )" + attributes + ">" + tetrahedron +
         R"(</object></resources><build><item objectid="1"/></build>)";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ThreeMf, MeshesAreReadInTheirOrder) {
  const Scene scene = load_text(package_of(model_of(one_object(R"(name="tip")"))).bytes());
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_THAT(scene.meshes[0].positions,
              ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)));
  EXPECT_THAT(scene.meshes[0].triangles,
              ElementsAre(glm::uvec3(0, 2, 1), glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3), glm::uvec3(0, 3, 2)));
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "tip");
  EXPECT_EQ(scene.instances[0].world_from_mesh, glm::dmat4(1.0));
  EXPECT_EQ(scene.up, Axis::z);
  EXPECT_THAT(scene.warnings, ElementsAre());
}

TEST(ThreeMf, TheUnitIsThatOfTheFile) {
  const std::pair<const char*, double> units[] = {{"", 1e-3},
                                                  {R"(unit="micron")", 1e-6},
                                                  {R"(unit="millimeter")", 1e-3},
                                                  {R"(unit="centimeter")", 1e-2},
                                                  {R"(unit="inch")", 0.0254},
                                                  {R"(unit="foot")", 0.3048},
                                                  {R"(unit="meter")", 1}};
  for (const auto& [attribute, metres] : units) {
    const std::string bytes = package_of(model_of(one_object(), attribute)).bytes();
    const Scene scene = load(test::bytes_of(bytes), "model.3mf");
    EXPECT_EQ(scene.source.metres_per_unit, metres);
    EXPECT_EQ(scene.meshes[0].positions[1], glm::vec3(1, 0, 0)) << "nothing is scaled";
  }
  const Scene scene = read(model_of(one_object(), R"(unit="mm")"));
  EXPECT_EQ(scene.source.metres_per_unit, 1e-3);
  EXPECT_THAT(scene.warnings,
              ElementsAre(R"(model: 3D/3dmodel.model: line 2: unit "mm" is not a unit of 3MF; millimeter is assumed)"));
}

TEST(ThreeMf, TheNamespaceMayBeMissing) {
  const std::string good = model_of(one_object());
  for (const char* space : {"", R"( xmlns="http://schemas.microsoft.com/3dmanufacturing/2013/01")"}) {
    const Scene scene =
        read(replaced(good, R"( xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02")", space));
    EXPECT_EQ(triangle_count(scene), 4u) << space;
    EXPECT_THAT(
        scene.warnings,
        ElementsAre("model: 3D/3dmodel.model: line 2: model is not in the namespace of 3MF; it is read as if it were"));
  }
}

// Transforms act on row vectors: the last three numbers are the translation, and a component's transform acts before
// its parent's.
TEST(ThreeMf, ItemsAndComponentsAreTransformed) {
  const std::string resources =
      R"(<object id="1">)" + tetrahedron +
      R"(</object><object id="2" name="pair"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>
<component objectid="1"/></components></object>)";
  const Scene scene = read(model_of("<resources>" + resources + R"(</resources><build>
<item objectid="2" transform="0 2 0  -2 0 0  0 0 2  0 0 7"/><item objectid="1"/></build>)"));
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 3u);
  const auto placed = [&](int i, const glm::dvec3& p) {
    return glm::dvec3(scene.instances[std::size_t(i)].world_from_mesh * glm::dvec4(p, 1));
  };
  EXPECT_EQ(placed(0, {0, 0, 0}), glm::dvec3(0, 10, 7));  // moved along x, then turned to y, twice as large
  EXPECT_EQ(placed(0, {0, 1, 0}), glm::dvec3(-2, 10, 7));
  EXPECT_EQ(placed(1, {1, 0, 0}), glm::dvec3(0, 2, 7));
  EXPECT_EQ(placed(2, {1, 2, 3}), glm::dvec3(1, 2, 3));
  EXPECT_EQ(scene.instances[0].name, "pair") << "the nearest name above";
  EXPECT_EQ(scene.instances[2].name, "object 1");
}

// A model far from zero for its size keeps its details, as in every format.
TEST(ThreeMf, LargeCoordinatesKeepTheirDetails) {
  std::string model = model_of(one_object());
  for (const auto& [from, to] : {std::pair{R"(x="0")", R"(x="100000000.01")"},
                                 {R"(x="1")", R"(x="100000000.26")"},
                                 {R"(x="0")", R"(x="100000000.01")"},
                                 {R"(x="0")", R"(x="100000000.01")"}})
    model = replaced(model, from, to);
  const Scene scene = read(model);
  const auto place = [&](std::uint32_t i) {
    return scene.origin.x +
           glm::dvec3(scene.instances[0].world_from_mesh * glm::dvec4(scene.meshes[0].positions[i], 1)).x;
  };
  EXPECT_NEAR(place(1) - place(0), 0.25, 1e-7);
  EXPECT_NEAR(place(0), 1e8 + 0.01, 1e-7);
}

TEST(ThreeMf, PartsNameObjectsOfOthers) {
  ZipMaker zip = package_of(model_of(
      R"(<resources><object id="1" name="case"><components><component p:path="/3D/Objects/half.model" objectid="9"/>
</components></object></resources><build><item objectid="1"/><item p:path="/3D/objects/HALF.model" objectid="9"/></build>)",
      R"(requiredextensions="p")"));
  zip.add("3D/Objects/half.model",
          model_of(R"(<resources><object id="9">)" + tetrahedron + "</object></resources>", R"(unit="inch")"));
  const Scene scene = read(zip);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].name, "case");
  EXPECT_DOUBLE_EQ(scene.instances[0].world_from_mesh[0][0], 25.4) << "inches, in a model of millimetres";
}

// Numbers have the spelling of OBJ and all other text formats.
TEST(ThreeMf, NumbersAreSpeltAsInEveryFormat) {
  for (const char* number :
       {"1", "+.5", "-1.5e-3", "  2 ", "1e400", "-1e999", "1e-400", "nan", "-INF", "1.#INF", "1.#QNAN", "nan(ind)",
        "0.1000000000000000055511151231257827", "+-1", "--1", "1.5x", "0x10", ""}) {
    const std::string vertex = std::string("x=\"") + number + "\"";
    const std::string model = replaced(model_of(one_object()), "x=\"1\"", vertex);
    const auto read_obj = [&] {
      return load_text(std::string("v 0 0 0\nv ") + number + " 0 0\nv 0 1 0\nf 1 2 3\n", ModelFormat::obj);
    };
    std::optional<float> wanted;
    try {
      wanted = read_obj().meshes.at(0).positions.at(1).x;
    } catch (const Error&) {
      EXPECT_THAT(error_of(model), HasSubstr("x")) << number;
      continue;
    }
    const float found = read(model).meshes.at(0).positions.at(1).x;
    EXPECT_TRUE(found == *wanted || (std::isnan(found) && std::isnan(*wanted))) << number << ": " << found;
  }
}

TEST(ThreeMf, WithoutAnItemWhatNoneHoldsIsShown) {
  const Scene scene = read(model_of(R"(<resources><object id="1">)" + tetrahedron +
                                    R"(</object><object id="2"><components><component objectid="1"/></components>
</object></resources><build/>)"));
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_THAT(scene.warnings,
              ElementsAre("model: 3D/3dmodel.model: the build list is empty, so all objects are shown"));
}

const std::string two_materials =
    R"(<basematerials id="5"><base name="red" displaycolor="#FF0000"/><base name="pane" displaycolor="#0000ff80"/>
</basematerials>)";

TEST(ThreeMf, BaseMaterialsAreMaterials) {
  std::string model = model_of(one_object(R"(pid="5" pindex="0")", two_materials));
  model = replaced(model, R"(<triangle v1="1" v2="2" v3="3"/>)", R"(<triangle v1="1" v2="2" v3="3" pid="5" p1="1"/>)");
  const Scene scene = read(model);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "red");
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(scene.materials[0].alpha, Material::Alpha::opaque);
  EXPECT_EQ(scene.materials[1].base_color, glm::vec4(0, 0, 1, 128 / 255.0f));
  EXPECT_EQ(scene.materials[1].alpha, Material::Alpha::blend);
  EXPECT_THAT(scene.meshes[0].material_ids, ElementsAre(0, 0, 1, 0));
}

TEST(ThreeMf, ColoursAreThoseOfCorners) {
  std::string model =
      model_of(one_object(R"(pid="5" pindex="0")", two_materials + R"(<m:colorgroup id="6"><m:color color="#808080"/>
<m:color color="#00FF00"/><m:color color="#0000FF7F"/></m:colorgroup>)"));
  model = replaced(model, R"(<triangle v1="1" v2="2" v3="3"/>)",
                   R"(<triangle v1="1" v2="2" v3="3" pid="6" p1="0" p2="1" p3="0"/>)");
  model = replaced(model, R"(<triangle v1="0" v2="3" v3="2"/>)", R"(<triangle v1="0" v2="3" v3="2" pid="6" p1="2"/>)");
  const Scene scene = read(model);
  const Mesh& mesh = scene.meshes.at(0);
  const auto color = [&](std::uint32_t t, int k) { return mesh.colors.values[mesh.corners(mesh.colors, t)[k]]; };
  EXPECT_EQ(color(2, 0), glm::vec4(glm::vec3(linear_of_srgb8(128)), 1));
  EXPECT_EQ(color(2, 1), glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(color(2, 2), color(2, 0));
  EXPECT_EQ(color(3, 1), glm::vec4(0, 0, 1, 127 / 255.0f));
  EXPECT_EQ(color(0, 0), glm::vec4(1)) << "under a material";
  EXPECT_EQ(scene.materials[mesh.material_of(0)].name, "red");
  EXPECT_EQ(scene.materials[mesh.material_of(2)].base_color, glm::vec4(1));
  EXPECT_EQ(scene.materials[mesh.material_of(2)].alpha, Material::Alpha::opaque);
  EXPECT_EQ(scene.materials[mesh.material_of(3)].alpha, Material::Alpha::blend);
}

TEST(ThreeMf, WhatIsNotReadIsTold) {
  std::string model =
      model_of(one_object(R"(pid="7" pindex="0")",
                          R"(<m:texture2dgroup id="7" texid="8"><m:tex2coord u="0" v="0"/></m:texture2dgroup>)"),
               R"(xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02")");
  model = replaced(model, "</triangles>", "</triangles><b:beamlattice><b:beams/></b:beamlattice>");
  EXPECT_THAT(read(model).warnings,
              ElementsAre(HasSubstr(R"(line 6: "beamlattice" is not read)"),
                          "model: 3D/3dmodel.model: group 7: colours of a texture2dgroup are not read"));
  EXPECT_THAT(
      error_of(replaced(model, "xmlns:b", R"(requiredextensions="p b" xmlns:b)")),
      HasSubstr(
          R"(line 2: requires the extension http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02, which)"));
}

// A model without its colours is better than none.
TEST(ThreeMf, WrongLooksAreWarnings) {
  const auto warnings = [](const std::string& attributes, const std::string& resources) {
    const Scene scene = read(model_of(one_object(attributes, resources)));
    EXPECT_EQ(triangle_count(scene), 4u);
    return scene.warnings;
  };
  const std::string line = "model: 3D/3dmodel.model: line 4: ";
  EXPECT_THAT(warnings(R"(pid="3" pindex="0")", {}),
              ElementsAre(line + "triangle 0 of the object: property group 3 does not exist"));
  EXPECT_THAT(warnings(R"(pid="5" pindex="2")",
                       R"(<basematerials id="5"><base name="a" displaycolor="#123456"/></basematerials>)"),
              ElementsAre(line + "triangle 0 of the object: property 2 does not exist, group 5 has 1"));
  EXPECT_THAT(warnings(R"(pid="five" pindex="first")", {}),
              ElementsAre(line + "pid \"five\" is not a whole number below 4294967295",
                          line + "pindex \"first\" is not a whole number below 4294967295"));
  EXPECT_THAT(
      warnings(
          {},
          R"(<basematerials id="5"/><basematerials id="5"><base name="a" displaycolor="#000000"/></basematerials>)"),
      ElementsAre(line + "id \"5\" is also the id of an earlier group, which is used"));
  EXPECT_THAT(warnings(R"(pid="5" pindex="0")", R"(<basematerials><base/></basematerials>)"),
              ElementsAre(line + "displaycolor is missing",
                          line + "triangle 0 of the object: property group 5 does not exist"));

  const std::string colors =
      R"(<basematerials id="5"><base name="a" displaycolor="red"/><base name="b" displaycolor="#12"/><base displaycolor="#FF0000"/></basematerials>)";
  const Scene scene = read(model_of(one_object(R"(pid="5" pindex="0")", colors)));
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1));
  EXPECT_EQ(scene.materials[2].base_color, glm::vec4(1, 0, 0, 1));
  EXPECT_THAT(scene.meshes.at(0).material_ids, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(scene.warnings, ElementsAre(line + "displaycolor \"red\" is not a colour such as #RRGGBB or #RRGGBBAA"))
      << "the first of its kind";
  const Scene corner =
      read(replaced(model_of(one_object({}, R"(<m:colorgroup id="6"><m:color color="#00FF00"/></m:colorgroup>)")),
                    R"(<triangle v1="1")", R"(<triangle pid="6" p1="0" p2="x" v1="1")"));
  EXPECT_EQ(corner.meshes.at(0).colors.values.size(), 2u);
  EXPECT_THAT(corner.warnings, ElementsAre(HasSubstr("p2 \"x\" is not a whole number")));
}

TEST(ThreeMf, ErrorsNameThePartAndTheLine) {
  const std::string good = model_of(one_object());
  const auto error = [&](const std::string& from, const std::string& to) { return error_of(replaced(good, from, to)); };
  EXPECT_EQ(error(R"(v3="3")", R"(v3="4")"),
            "model: 3D/3dmodel.model: line 5: v3 is 4, but there are only 4 vertices before");
  EXPECT_EQ(error(R"(y="1")", R"(y="one")"), "model: 3D/3dmodel.model: line 4: y \"one\" is not a number");
  EXPECT_EQ(error(R"(y="1")", ""), "model: 3D/3dmodel.model: line 4: y is missing");
  EXPECT_EQ(error(R"(v1="1")", R"(v1="-1")"),
            "model: 3D/3dmodel.model: line 6: v1 \"-1\" is not a whole number below 4294967295");
  EXPECT_EQ(error("</mesh>", ""), "model: 3D/3dmodel.model: line 6: mismatched tag");
  EXPECT_EQ(error(R"(<item objectid="1")", R"(<item objectid="2")"),
            "model: 3D/3dmodel.model: line 6: object 2 does not exist");
  EXPECT_EQ(error(R"(<item objectid="1")", R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0")"),
            "model: 3D/3dmodel.model: line 6: transform \"1 0 0 0 1 0 0 0 1 0 0\" is not twelve finite numbers");
  EXPECT_EQ(error(R"(<item objectid="1")", R"(<item objectid="1" p:path="/no.model")"),
            "model: no.model: there is no such part in the archive");
  EXPECT_EQ(error_of(std::string("<html/>")), "model: 3D/3dmodel.model: is no 3MF model: its first tag is not model");
}

TEST(ThreeMf, ThePackageNamesItsModel) {
  const std::string model = model_of(one_object());
  ZipMaker elsewhere;
  elsewhere.add("_RELS/.rels", replaced(test::relationships, "/3D/3dmodel.model", "a\\thing.model"))
      .add("A/thing.model", model);
  EXPECT_EQ(triangle_count(read(elsewhere)), 4u) << "names are told apart without case";

  ZipMaker by_type;
  by_type.add("[Content_Types].xml", R"(<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Override PartName="/m.model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)");
  by_type.add("m.model", model);
  EXPECT_EQ(triangle_count(read(by_type)), 4u);

  EXPECT_EQ(error_of(ZipMaker().add("word/document.xml", "<a/>")),
            "model: _rels/.rels: the archive names no part as its 3D model, so the file is not 3MF");
  EXPECT_EQ(error_of(ZipMaker().add("_rels/.rels", test::relationships)),
            "model: 3D/3dmodel.model: there is no such part in the archive");
}

// A file that ends early has lost its table of contents, whatever else is left of it.
TEST(ThreeMf, EveryPrefixIsAnError) {
  const std::string bytes = package_of(model_of(one_object())).bytes();
  for (std::size_t size = 1; size < bytes.size(); ++size) {
    const std::string error = test::error_of(bytes.substr(0, size), ModelFormat::threemf);
    EXPECT_THAT(error, StartsWith("model: zip archive: ")) << size;
  }
  std::string damaged = bytes;
  damaged[damaged.find("<vertex ") + 1] = 'w';
  EXPECT_THAT(test::error_of(damaged, ModelFormat::threemf), HasSubstr("3D/3dmodel.model: "));
}

/// Raw deflate.
std::string deflated(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, uLong(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

TEST(ThreeMf, PackedPartsAreUnpacked) {
  const std::string model = model_of(one_object());
  ZipMaker zip;
  zip.add("_rels/.rels", test::relationships);
  zip.add_as(test::model_part_name, deflated(model), {8, test::crc_of(model), std::uint32_t(model.size())});
  EXPECT_EQ(triangle_count(read(zip)), 4u);
}

// 300 MB of blanks in 300 kB: refused by the size that the archive states or, if that lies, by the unpacked size.
TEST(ThreeMf, PartsThatUnpackToFarTooMuchAreRefused) {
  const std::string blanks(300'000'000, ' ');
  const std::string packed = deflated(model_of("<resources>" + blanks + "</resources>"));
  ASSERT_LT(packed.size(), 400'000u);
  for (const std::uint32_t stated : {300'000'000u, 1000u}) {
    ZipMaker zip;
    zip.add("_rels/.rels", test::relationships).add_as(test::model_part_name, packed, {8, 0, stated});
    EXPECT_THAT(error_of(zip), HasSubstr("3D/3dmodel.model: unpacks to ")) << stated;
  }
}

TEST(ThreeMf, XmlThatGrowsIsRefused) {
  std::string laughs = "<?xml version=\"1.0\"?>\n<!DOCTYPE model [<!ENTITY a0 \"ha\">";
  for (int i = 1; i < 30; ++i)
    laughs +=
        "<!ENTITY a" + std::to_string(i) + " \"&a" + std::to_string(i - 1) + ";&a" + std::to_string(i - 1) + ";\">";
  EXPECT_EQ(error_of(laughs + "]><model>&a29;</model>"),
            "model: 3D/3dmodel.model: line 2: has a document type, which 3MF forbids");

  std::string nested, names, attributes;
  for (int i = 0; i < 1000; ++i) nested += "<a>";
  EXPECT_THAT(error_of(model_of(nested)), HasSubstr("tags within more than 256 others"));
  for (int i = 0; i < 5000; ++i) names += "<a" + std::to_string(i) + "/>";
  EXPECT_THAT(error_of(model_of(names)), HasSubstr("more than 4096 different names"));
  for (int i = 0; i < 5000; ++i) attributes += " b" + std::to_string(i) + "=''";
  EXPECT_THAT(error_of(model_of("<a" + attributes + "/>")), HasSubstr("more than 4096 different names"));
  EXPECT_THAT(error_of(model_of("<a b='" + std::string(3 << 20, 'x') + "'/>")),
              HasSubstr("a tag is longer than a megabyte"));
}

TEST(ThreeMf, ComponentsOfComponentsAreBounded) {
  std::string objects = R"(<object id="0">)" + tetrahedron + "</object>";
  for (int i = 1; i < 60; ++i) {
    const std::string below = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    objects += "<object id=\"" + std::to_string(i) + "\"><components>" + below + below + "</components></object>";
  }
  EXPECT_THAT(error_of(model_of("<resources>" + objects + R"(</resources><build><item objectid="59"/></build>)")),
              HasSubstr("too many "));
  EXPECT_THAT(error_of(model_of(R"(<resources><object id="1"><components><component objectid="1"/></components></object>
</resources><build><item objectid="1"/></build>)")),
              HasSubstr("or within themselves"));
}

TEST(ThreeMf, ReadingCanBeStopped) {
  std::string vertices;
  for (int i = 0; i < 100'000; ++i) vertices += R"(<vertex x="1" y="2" z="3"/>)";
  const std::string bytes = package_of(replaced(model_of(one_object()), "<vertices>", "<vertices>" + vertices)).bytes();
  const test::CountingWatch watch(21);
  EXPECT_THROW(
      {
        try {
          (void)load(test::bytes_of(bytes), "model.3mf", {}, watch.execution());
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::cancelled);
          throw;
        }
      },
      Error);
}

}  // namespace
}  // namespace frontmost
