// SPDX-License-Identifier: Apache-2.0
// Every method on every model: where methods differ, exact arithmetic allows both answers.

#include <iostream>

#include "frontmost/frontmost.h"
#include "support/models.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

struct Totals {
  std::uint64_t samples = 0, edge = 0, depth = 0, translucent = 0;

  void add(const Agreement& agreement) {
    EXPECT_EQ(agreement.count(Difference::unexplained), 0u);
    samples += agreement.differences.size();
    edge += agreement.count(Difference::edge);
    depth += agreement.count(Difference::depth);
    translucent += agreement.count(Difference::translucent);
  }
};

TEST(AllModels, AreSeenAlikeByEveryMethod) {
  FRONTMOST_NEEDS_MODELS();
  Totals rays, layers;
  for (const std::string& name : good_models()) {
    SCOPED_TRACE(name);
    const Scene scene = load(model(name));
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 240, 180);
    const Visible reference = zbuffer(surfaces, view);
    rays.add(check_agreement(surfaces, reference, raycast(surfaces, view)));
    const std::vector<Visible> layer = visible_layers(surfaces, view, 2);
    Agreement of_layers = check_agreement(surfaces, reference, layer[0]);
    EXPECT_EQ(of_layers.differing(), 0u) << "the nearest layer is the z-buffer's";
    see_through(of_layers, surfaces, layer[0], layer[1]);
    layers.add(of_layers);
  }
  EXPECT_LT(rays.edge, rays.samples / 1000) << "reasons have become the excuse";
  EXPECT_GT(layers.translucent, 0u);
  std::cout << rays.samples << " samples: " << rays.edge << " differ by edges, " << rays.depth << " by depths; through "
            << layers.translucent << " more is seen\n";
}

TEST(AllModels, AreDrawnAlikeWithAndWithoutClusters) {
  FRONTMOST_NEEDS_MODELS();
  for (const std::string& name : good_models()) {
    SCOPED_TRACE(name);
    const Scene scene = load(model(name));
    const Surfaces surfaces(scene);
    View view = frame(surfaces, 480, 360);
    (void)draw_both_ways(surfaces, view);
    view.samples = 4;
    view.culling = Culling::back;
    view.projection.clip.near = (view.projection.clip.near + view.projection.clip.far) / 2;  // through the model
    (void)draw_both_ways(surfaces, view);
  }
}

}  // namespace
}  // namespace frontmost::test
