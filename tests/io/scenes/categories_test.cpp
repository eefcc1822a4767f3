// SPDX-License-Identifier: Apache-2.0
// A file of categories assigns one to each object; errors name their place in the file.
#include "io/scenes/scene_folder.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void give(const std::string& text, Scene& scene) {
  load_categories(std::as_bytes(std::span(text)), "kinds.json", scene);
}

/// For each object, the name and the number of its category.
std::vector<std::string> categories_of(const Scene& scene) {
  std::vector<std::string> categories;
  for (const Instance& instance : scene.instances) {
    const bool has_one = instance.category != no_index;
    categories.push_back(has_one ? scene.categories[instance.category].name + " " +
                                       std::to_string(scene.categories[instance.category].number)
                                 : "none");
  }
  return categories;
}

Scene three_objects() {
  SceneFolder folder;
  return folder.load_objects(R"({"model": "corner.off", "name": "a", "category": "old"},
      {"model": "corner.off", "name": "b"}, {"model": "corner.off", "name": "a"})");
}

TEST(Categories, AreThoseThatTheFileNamesAndNoOthers) {
  Scene scene = three_objects();
  EXPECT_THAT(categories_of(scene), ElementsAre("old 1", "none", "none"));
  give(R"({"objects": {"b": "bolt"}})", scene);
  EXPECT_THAT(categories_of(scene), ElementsAre("none", "bolt 1", "none")) << "the scene's own are gone";
  EXPECT_EQ(scene.categories.size(), 1u);
  give(R"({"objects": {"b": "bolt", "a": "arm"}})", scene);
  EXPECT_THAT(categories_of(scene), ElementsAre("arm 1", "bolt 2", "arm 1")) << "in the order of the objects' names";
  give(
      "\xEF\xBB\xBF"
      R"({"categories": ["bolt", {"name": "arm", "number": 40}], "objects": {"a": "arm"}})",
      scene);
  EXPECT_THAT(categories_of(scene), ElementsAre("arm 40", "none", "arm 40"));
  EXPECT_EQ(scene.categories.size(), 2u);
  EXPECT_THAT(scene.warnings, IsEmpty());
  give(R"({"objects": {"c": "bolt"}})", scene);
  EXPECT_THAT(scene.warnings, ElementsAre(R"(kinds.json: objects: no object has the name "c")"));
}

TEST(Categories, WhatIsWrongIsToldWithThePlaceAndChangesNothing) {
  Scene scene = three_objects();
  const auto error = [&](const std::string& text) -> std::string {
    try {
      give(text, scene);
      return "read";
    } catch (const Error& found) {
      return found.what();
    }
  };
  EXPECT_EQ(error("{}"), "kinds.json: JSON: 'objects' is missing");
  EXPECT_EQ(error(R"({"objects": ["a"]})"), "kinds.json: objects: an object is expected, not array");
  EXPECT_EQ(error(R"({"objects": {"a": 3}})"), "kinds.json: objects.a: a string is expected, not number");
  EXPECT_EQ(error(R"({"objects": {"a": ""}})"), "kinds.json: objects.a: the name is empty");
  EXPECT_EQ(error(R"({"categories": ["x"], "objects": {"a": "y"}})"),
            R"(kinds.json: objects.a: "y" is none of the file's categories)");
  EXPECT_EQ(error(R"({"categories": ["x", "x"], "objects": {}})"),
            "kinds.json: categories[1]: the name is there twice");
  EXPECT_EQ(error(R"({"objects": {"a": "x", "a": "y"}})"), R"(kinds.json: objects: "a" is there twice)");
  EXPECT_THAT(error(R"({"object": {}})"), HasSubstr(R"("object" is not known here; known are categories, objects)"));
  EXPECT_THAT(error(R"({"objects": )"), HasSubstr("kinds.json: JSON: parse error at line 1"));
  EXPECT_THAT(categories_of(scene), ElementsAre("old 1", "none", "none"));
}

}  // namespace
}  // namespace frontmost::test
