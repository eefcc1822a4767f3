// SPDX-License-Identifier: Apache-2.0
// Answers that cannot be read: missing planes, planes of another size, and ids without a triangle.
#include "view/answer.h"

#include <gmock/gmock.h>

#include "frontmost/image.h"
#include "frontmost/pictures.h"
#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;

/// Calls `read`, which must throw bad_argument with a reason.
template <class Read>
void expect_refused(const char* words, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument) << words;
    EXPECT_THAT(error.what(), HasSubstr(words));
    return;
  }
  ADD_FAILURE() << "not refused: " << words;
}

class Answer : public testing::Test {
 protected:
  Scene scene = builtin("cubes"), other = builtin("teapot");
  Surfaces surfaces{scene}, many{other};
  View view = frame(surfaces, 40, 30);
  Visible visible = zbuffer(surfaces, view);
};

TEST_F(Answer, PlanesThatWereMovedAwayAreRefusedByAllReaders) {
  Visible taken = std::move(visible);
  const Visible& gone = visible;  // NOLINT(bugprone-use-after-move): what is left is the question
  ASSERT_EQ(gone.view.width, 40);
  const char* const size = "the arrays do not match the size of their view";
  expect_refused(size, [&] { (void)depths_of(gone); });
  expect_refused(size, [&] { (void)depth_image(gone); });
  expect_refused(size, [&] { (void)ray_distance_image(gone); });
  for (const IdKind kind : {IdKind::primitive, IdKind::object, IdKind::material})
    expect_refused(size, [&] { (void)id_image(surfaces, gone, kind); });
  expect_refused(size, [&] { merge(taken, gone); });
  expect_refused(size, [&] {
    Visible into = gone;
    merge(into, taken);
  });
  for (const Shading shading :
       {Shading::lit, Shading::flat, Shading::normals, Shading::ids, Shading::depth, Shading::uv})
    expect_refused(size, [&] { (void)shade(surfaces, gone, {.shading = shading}); });
  expect_refused(size, [&] { (void)shade_bitmap(surfaces, gone); });
  expect_refused(size, [&] { (void)shade_deep(surfaces, gone); });
  expect_refused(size, [&] { (void)normal_image(surfaces, gone); });
  expect_refused(size, [&] { (void)key_light_view(gone, surfaces.bounds()); });
  expect_refused(size, [&] { (void)find_depth_fights(surfaces, find_exact_visible(surfaces, view), gone); });
}

TEST_F(Answer, PlanesOfAnotherSizeAreRefused) {
  visible.view.samples = 4;
  expect_refused("depths_of: the arrays", [&] { (void)depths_of(visible); });
  visible.view.samples = 1;
  visible.keys = Buffer<float>(visible.keys.size() - 1, 0.0f);
  expect_refused("depths_of: the arrays", [&] { (void)depths_of(visible); });
}

TEST_F(Answer, IdsOfOtherSurfacesAreRefused) {
  const Visible strange = zbuffer(many, view);
  ASSERT_GT(many.primitive_count(), 24u);
  const char* const other_surfaces = "the surfaces are not those of the Visible";
  for (const Shading shading :
       {Shading::lit, Shading::flat, Shading::normals, Shading::ids, Shading::depth, Shading::uv})
    expect_refused(other_surfaces, [&] { (void)shade(surfaces, strange, {.shading = shading}); });
  expect_refused(other_surfaces, [&] { (void)shade_bitmap(surfaces, strange); });
  expect_refused(other_surfaces, [&] { (void)shade_deep(surfaces, strange); });
  expect_refused(other_surfaces, [&] { (void)normal_image(surfaces, strange); });
  expect_refused(other_surfaces, [&] { (void)id_image(surfaces, strange, IdKind::object); });
  const ExactVisible exact = find_exact_visible(surfaces, view);
  expect_refused(other_surfaces, [&] { (void)find_depth_fights(surfaces, exact, strange); });
  ExactVisible strange_exact = find_exact_visible(many, view);
  expect_refused(other_surfaces, [&] { (void)find_depth_fights(surfaces, strange_exact, visible); });
}

TEST_F(Answer, TheLastIdAndNoIdAreFine) {
  const std::uint32_t count = surfaces.primitive_count();
  std::vector<PrimitiveId> ids(300'000, no_primitive);  // more than one part
  check_ids(ids, count, "test", {});
  ids.back() = count - 1;
  check_ids(ids, count, "test", {});
  check_ids({}, 0, "test", {});
  ids.back() = count;
  expect_refused("test: the surfaces", [&] { check_ids(ids, count, "test", {}); });
  ids.back() = no_primitive - 1;
  expect_refused("test: the surfaces", [&] { check_ids(ids, count, "test", {}); });
  // Without triangles there is nothing to look up, and only "no primitive" may be seen.
  ids.back() = 0;
  expect_refused("test: the surfaces", [&] { check_ids(ids, 0, "test", {}); });
}

}  // namespace
}  // namespace frontmost::test
