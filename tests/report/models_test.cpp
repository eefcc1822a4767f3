// SPDX-License-Identifier: Apache-2.0
// Models whose defects others have measured.
#include "support/models.h"

#include <gtest/gtest.h>

#include "frontmost/files.h"
#include "frontmost/report.h"

namespace frontmost {
namespace {

struct Known {
  const char* file;
  std::uint64_t triangles, pieces;
  Oddities odd;
  int genus;  // -1: unknown
};

class KnownModel : public testing::TestWithParam<Known> {};

TEST_P(KnownModel, IsInTheStateThatWasMeasured) {
  FRONTMOST_NEEDS_MODELS();
  const Known& known = GetParam();
  const SceneReport report = inspect(load(test::model(known.file)));
  EXPECT_EQ(report.triangles, known.triangles);
  EXPECT_EQ(report.odd, known.odd);
  ASSERT_EQ(report.meshes.size(), 1u);
  EXPECT_EQ(report.meshes[0].pieces, known.pieces);
  EXPECT_EQ(report.meshes[0].closed, known.odd.boundary_edges == 0);
  EXPECT_EQ(report.meshes[0].genus ? int(*report.meshes[0].genus) : -1, known.genus);
}

INSTANTIATE_TEST_SUITE_P(
    All, KnownModel,
    testing::Values(
        Known{"organic/stanford-bunny-binary.stl", 69451, 1, {.boundary_edges = 223}, -1},
        Known{"organic/stanford-bunny.obj", 69451, 1, {.boundary_edges = 223}, -1},
        Known{"organic/stanford-bunny-ascii.ply", 69451, 1, {.boundary_edges = 223}, -1},
        Known{"organic/armadillo-86k.obj", 86482, 1, {}, 0}, Known{"organic/lucy-100k.ply", 99970, 1, {}, 0},
        Known{"organic/dragon-800k.ply",
              798504,
              4,
              {.boundary_edges = 418, .non_manifold_edges = 224, .inconsistent_edges = 10},
              -1},
        Known{"cad/crank-arm.stl", 8458, 2, {.degenerate_triangles = 2, .boundary_edges = 32}, -1},
        Known{"cad/propeller-ascii.stl", 7375, 1, {.degenerate_triangles = 1, .inconsistent_edges = 12}, -1},
        Known{"cad/cycloidal-drive.ply", 43368, 100, {.non_manifold_edges = 242}, -1},
        Known{"cad/as1.stl", 9868, 6, {}, 22}, Known{"cad/fandisk.obj", 12946, 1, {}, 0},
        Known{"cad/rocker-arm.obj", 20088, 1, {}, 1}, Known{"cad/angle-block.stl", 704, 1, {.boundary_edges = 166}, -1},
        Known{"cad/featuretype.stl", 3476, 1, {.boundary_edges = 576}, -1},
        Known{"cad/two-cylinders.stl", 1916, 1, {}, 0}, Known{"cad/torus.stl", 28800, 1, {}, 1}),
    [](const auto& known) {
      std::string name = known.param.file;
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      return name;
    });

}  // namespace
}  // namespace frontmost
