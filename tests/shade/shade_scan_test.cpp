// SPDX-License-Identifier: Apache-2.0
// Pictures of scans: colours computed by hand, and colours of a Visible where both mean the same.
#include <gmock/gmock.h>

#include <cmath>

#include "frontmost/pictures.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "shade/scan/scan.h"
#include "shade/support.h"
#include "support/odd_numbers.h"

namespace frontmost::test {
namespace {

constexpr double half_turn = 3.14159265358979323846;

/// A wall of one colour at z = -1, wide enough to fill the view ahead.
Scene wall(const glm::vec4& color) {
  Mesh mesh;
  add_triangle(mesh, {-1000, -1000, -1}, {1000, -1000, -1}, {0, 2000, -1});
  return scene_of(mesh, colored(color));
}

struct Scanned {
  Scanned(Scene what, const RayCamera& camera) : scene(std::move(what)), scan(frontmost::scan(index, camera)) {}
  [[nodiscard]] Image picture(const ShadeOptions& options, const Execution& execution = {}) const {
    return shade(surfaces, ScanInput{&scan, &index}, options, execution);
  }

  Scene scene;
  Surfaces surfaces{scene};
  RayIndex index{surfaces};
  RangeScan scan;
};

void expect_color(const Image& image, int x, int y, const glm::vec4& expected, float tolerance = 1e-6f) {
  const glm::vec4 color = color_at(image, x, y);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(color[k], expected[k], tolerance) << "channel " << k;
}

/// A fisheye of 9 x 9: the middle looks straight at the wall, pixel 6 at 60 degrees; the corners are outside the
/// circle.
const RayCamera kNine{Fisheye{9, 9, half_turn}};

TEST(ShadeScan, FlatNormalsAndTheBackground) {
  const Scanned of(wall({0.5f, 0.25f, 0.75f, 1}), kNine);
  const Image flat = of.picture({.shading = Shading::flat});
  expect_color(flat, 7, 4, {0.5f, 0.25f, 0.75f, 1});
  expect_color(flat, 0, 0, {1, 1, 1, 1});
  expect_color(of.picture({.shading = Shading::flat, .background = std::nullopt}), 0, 0, {0, 0, 0, 0});
  // The wall's normal is +z, which is shown as (0.5, 0.5, 1) in sRGB: 0.2140 in linear light.
  const glm::vec4 normal = color_at(of.picture({.shading = Shading::normals}), 7, 4);
  EXPECT_NEAR(normal.x, 0.2140f, 1e-3);
  EXPECT_NEAR(normal.z, 1, 1e-6);
}

TEST(ShadeScan, NearIsBrighterThanFarAlongTheRay) {
  const Scanned of(wall({1, 1, 1, 1}), kNine);
  const Image depth = of.picture({.shading = Shading::depth});
  EXPECT_GT(color_at(depth, 4, 4).x, color_at(depth, 6, 4).x);
}

TEST(ShadeScan, ObjectsHaveTheColoursOfOtherPictures) {
  const Scanned of(wall({1, 1, 1, 1}), kNine);
  View view;
  view.width = view.height = 9;
  view.projection = make_projection(1, 1, {0.1, 10});
  const Image other = shade(of.surfaces, raycast(of.surfaces, view), {.shading = Shading::ids});
  expect_color(of.picture({.shading = Shading::ids}), 4, 4, color_at(other, 4, 4));
}

/// A room with six textured sides and a textured ball in it, whose vertices have normals and colours.
Scene furnished_room() {
  Scene scene;
  Texture ramp;
  ramp.width = ramp.height = 32;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const auto wave = [](int i, double turns) {
        return std::uint8_t(std::lround(128 + 100 * std::sin(i * turns * half_turn / 16)));
      };
      ramp.pixels.emplace_back(wave(x, 1), wave(y, 1), wave(x + y, 1), 255);
    }
  scene.textures.push_back(ramp);
  for (glm::u8vec4& p : ramp.pixels) p = glm::u8vec4(128 + (p.r - 128) / 4, 128 + (p.g - 128) / 4, 230, 255);
  scene.textures.push_back(ramp);
  Material& material = scene.materials.emplace_back();
  material.base_color_texture.texture = 0;
  material.normal_texture.texture = 1;
  material.metallic = 0.2f;
  material.roughness = 0.5f;
  Mesh& side = scene.meshes.emplace_back(square());
  side.material_ids = {0};
  for (int k = 0; k < 6; ++k) {
    glm::dmat4 place(0.0);
    const double sign = k % 2 == 0 ? 1 : -1;
    place[0][(k / 2 + 1) % 3] = 3 * sign;
    place[1][(k / 2 + 2) % 3] = 3;
    place[2][k / 2] = 3 * sign;
    place[3] = glm::dvec4(0, 0, 0, 1);
    place[3][k / 2] = -3 * sign;
    scene.instances.push_back({"side", 0, place});
  }
  Mesh& ball = scene.meshes.emplace_back();
  constexpr int rings = 12, steps = 24;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s <= steps; ++s) {
      const double e = half_turn * r / rings, a = 2 * half_turn * s / steps;
      const glm::vec3 n(glm::dvec3(std::sin(e) * std::cos(a), std::cos(e), std::sin(e) * std::sin(a)));
      ball.positions.push_back(0.6f * n);
      ball.normals.values.push_back(n);
      ball.texcoords.values.emplace_back(float(s) / steps, float(r) / rings);
      ball.colors.values.emplace_back(0.6f + 0.4f * n.x, 0.8f, 0.7f - 0.3f * n.y, 1.0f);
    }
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < steps; ++s) {
      const auto a = std::uint32_t(r * (steps + 1) + s), b = a + steps + 1;
      if (r > 0) ball.triangles.emplace_back(a, a + 1, b + 1);
      if (r + 1 < rings) ball.triangles.emplace_back(a, b + 1, b);
    }
  ball.material_ids = {0};
  glm::dmat4 place(1.0);
  place[3] = {0.4, -0.3, -1.6, 1};
  scene.instances.push_back({"ball", 1, place});
  return scene;
}

float shown(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

/// Screen position of a point in a perspective view, if the pixels around show its triangle.
std::optional<glm::dvec2> seen_at(const Visible& visible, const glm::dvec3& point, PrimitiveId id) {
  const View& view = visible.view;
  const glm::dvec4 eye = glm::inverse(view.world_from_eye) * glm::dvec4(point, 1);
  if (!(eye.z < 0)) return std::nullopt;
  const Projection& p = view.projection;
  const glm::dvec2 at((eye.x / -eye.z - p.left) / (p.right - p.left) * view.width,
                      (p.top - eye.y / -eye.z) / (p.top - p.bottom) * view.height);
  const int x = int(std::floor(at.x)), y = int(std::floor(at.y));
  if (x < 2 || y < 2 || x > view.width - 3 || y > view.height - 3) return std::nullopt;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx)
      if (visible.primitives[visible.index(x + dx, y + dy)] != id) return std::nullopt;
  return at;
}

glm::vec4 bilinear(const Image& image, const glm::dvec2& at) {
  const glm::dvec2 corner = glm::floor(at - 0.5), t = at - 0.5 - corner;
  const int x = int(corner.x), y = int(corner.y);
  const glm::vec2 f(t);
  return glm::mix(glm::mix(color_at(image, x, y), color_at(image, x + 1, y), f.x),
                  glm::mix(color_at(image, x, y + 1), color_at(image, x + 1, y + 1), f.x), f.y);
}

struct PictureDifference {
  int count = 0;
  double mean = 0, most = 0;
};

/// Difference of colours at the same points, in steps of 8 bits, away from edges.
PictureDifference difference(const Scanned& of, const Image& around, const Visible& visible, const Image& flat) {
  PictureDifference result;
  const RangeScan& scan = of.scan;
  for (int y = 0; y < scan.height; ++y)
    for (int x = 0; x < scan.width; ++x) {
      const PrimitiveId id = scan.primitives[scan.index(x, y)];
      if (id == no_primitive) continue;
      const std::optional<glm::dvec2> at = seen_at(visible, point_of(scan, x, y), id);
      if (!at) continue;
      const glm::vec4 a = color_at(around, x, y), b = bilinear(flat, *at);
      for (int k = 0; k < 3; ++k) {
        const double steps = 255 * std::abs(shown(a[k]) - shown(b[k]));
        result.mean += steps;
        result.most = std::max(result.most, steps);
      }
      ++result.count;
    }
  result.mean /= 3 * result.count;
  return result;
}

TEST(ShadeScan, AgreesWithAPinholesPictureOfTheSamePose) {
  const glm::dmat4 pose = look_at({0.2, 0.5, 1.5}, {0.3, -0.1, -1}, {0, 1, 0});
  View view;
  view.width = view.height = 400;
  view.world_from_eye = pose;
  view.projection = make_projection(half_turn / 2, 1, {0.01, 100});
  const RayCamera cameras[] = {{Fisheye{400, 400, 0.9 * half_turn}, pose}, {Panorama{800, 400}, pose}};
  for (const RayCamera& camera : cameras)
    for (const ShadeOptions& options :
         {ShadeOptions{.light = {.shadows = Shadows::off}}, ShadeOptions{.light = {.shadows = Shadows::rays}},
          ShadeOptions{}, ShadeOptions{.shading = Shading::flat}, ShadeOptions{.shading = Shading::normals}}) {
      SCOPED_TRACE(testing::Message() << "model " << camera.model.index() << " shading " << int(options.shading)
                                      << " shadows " << int(options.light.shadows));
      const Scanned of(furnished_room(), camera);
      const Visible visible = zbuffer(of.surfaces, view);
      const PictureDifference found =
          difference(of, of.picture(options), visible, shade(of.surfaces, visible, options));
      EXPECT_GT(found.count, 30'000);
      EXPECT_LT(found.mean, 0.6);
      // Edges of shadows cross triangles; other edges do not.
      if (options.shading != Shading::lit || options.light.shadows == Shadows::off) {
        EXPECT_LT(found.most, 5);
      }
    }
}

/// Texture footprint that a colorist receives for a pixel.
struct Footprint {
  glm::vec2 texcoord{kNan}, dx{0}, dy{0};
};

std::vector<Footprint> footprints(const Scanned& of) {
  const shading::TriangleStore store(of.surfaces);
  const shading::ScanFaces faces(store, of.scan.camera, nullptr, true);
  const shading::ScanDirections directions(of.scan.camera);
  const shading::ScanLayer layer{faces, directions, of.scan, true, true, nullptr, of.surfaces, 1.0f};
  std::vector<Footprint> found(of.scan.index(0, of.scan.height)), arrived;
  shading::ScanTileWork work;
  const shading::FragmentShader::Colorist colorist = [&](const auto&, shading::FragmentBatch& batch) {
    const shading::Geometry& g = batch.geometry;
    for (int i = 0; i < batch.coverage.count; ++i) {
      batch.light.set(i, {float(arrived.size()), 0, 0});
      batch.material.alpha[i] = 1;
      arrived.push_back({g.texcoord.value.at(i), g.texcoord.dx.at(i), g.texcoord.dy.at(i)});
    }
  };
  work.begin(layer, colorist, Isa::best);
  for (int y = 0; y < of.scan.height; y += shading::tile_height)
    for (int x = 0; x < of.scan.width; x += shading::tile_width) {
      const shading::TileRectangle tile{x, y, std::min(shading::tile_width, of.scan.width - x),
                                        std::min(shading::tile_height, of.scan.height - y)};
      if (!work.shade(tile)) continue;
      for (int row = 0; row < tile.height; ++row)
        for (int column = 0; column < tile.width; ++column) {
          const glm::vec4& pixel = work.pixels()[std::size_t(row * tile.width + column)];
          if (pixel.a > 0) found[of.scan.index(x + column, y + row)] = arrived[std::size_t(std::lround(pixel.x))];
        }
    }
  return found;
}

TEST(ShadeScan, TexturesChangeAsNeighbouringRaysDo) {
  const glm::dmat4 pose = look_at({0.2, 0.1, 0.3}, {1, 0.7, -0.5}, {0, 1, 0});
  for (const RayCamera& camera : {RayCamera{Panorama{512, 256}, pose}, RayCamera{Fisheye{256, 256, 5}, pose}}) {
    const Scanned of(furnished_room(), camera);
    const std::vector<Footprint> found = footprints(of);
    int compared = 0;
    for (int y = 1; y + 1 < of.scan.height; ++y)
      for (int x = 1; x + 1 < of.scan.width; ++x) {
        const auto id = [&](int dx, int dy) { return of.scan.primitives[of.scan.index(x + dx, y + dy)]; };
        if (id(0, 0) == no_primitive || id(-1, 0) != id(0, 0) || id(1, 0) != id(0, 0) || id(0, -1) != id(0, 0) ||
            id(0, 1) != id(0, 0))
          continue;
        const auto at = [&](int dx, int dy) -> const Footprint& { return found[of.scan.index(x + dx, y + dy)]; };
        const glm::vec2 dx = (at(1, 0).texcoord - at(-1, 0).texcoord) * 0.5f;
        const glm::vec2 dy = (at(0, 1).texcoord - at(0, -1).texcoord) * 0.5f;
        const float size = glm::length(dx) + glm::length(dy);
        ASSERT_LT(glm::distance(at(0, 0).dx, dx), 0.2f * size + 1e-5f) << x << "," << y;
        ASSERT_LT(glm::distance(at(0, 0).dy, dy), 0.2f * size + 1e-5f) << x << "," << y;
        ++compared;
      }
    EXPECT_GT(compared, 20'000);
  }
}

TEST(ShadeScan, FineStripesFarAwayAreGrey) {
  Scene scene = wall({1, 1, 1, 1});
  Texture stripes = texture_of(2, 1, {{0, 0, 0, 255}, {255, 255, 255, 255}});
  stripes.nearest = false;
  scene.textures.push_back(stripes);
  scene.materials[0].base_color_texture.texture = 0;
  scene.meshes[0].texcoords.values = {{0, 0}, {200000, 0}, {100000, 0}};
  const Scanned of(std::move(scene), {Fisheye{33, 33, half_turn}});
  expect_color(of.picture({.shading = Shading::flat}), 20, 16, {0.5f, 0.5f, 0.5f, 1}, 0.01f);
}

TEST(ShadeScan, SamplesAreTheMeanOfTheirRays) {
  Mesh mesh = random_mesh(Kind::soup, 60, 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.material_ids.push_back(std::uint32_t(t % 3));
  Scene scene = scene_of(std::move(mesh));
  for (const glm::vec4& color : {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0.5f, 1), glm::vec4(0.2f, 0.1f, 1, 1)})
    scene.materials.push_back(colored(color));
  for (const RayCamera& camera :
       {RayCamera{Panorama{40, 20}, glm::dmat4(1.0), 4}, RayCamera{Fisheye{31, 24, 6}, glm::dmat4(1.0), 16}}) {
    const Scanned of(scene, camera);
    const Image image = of.picture({.shading = Shading::flat, .background = std::nullopt});
    for (int y = 0; y < of.scan.height; ++y)
      for (int x = 0; x < of.scan.width; ++x) {
        glm::vec4 sum(0);
        for (int s = 0; s < camera.samples; ++s) {
          const PrimitiveId id = of.scan.primitives[of.scan.index(x, y, s)];
          if (id != no_primitive) sum += of.scene.materials[id % 3].base_color;
        }
        expect_color(image, x, y, sum / float(camera.samples), 2e-6f);
      }
  }
}

TEST(ShadeScan, WhatIsSeenThroughLiesOverWhatIsBehind) {
  // From (0, 0, 10), the green glass at z = 0 is in front of the blue square at z = -1.
  const glm::vec4 green(0, 1, 0, 0.25f);
  const RayCamera camera{Fisheye{15, 15, 0.5}, look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}), 4};
  const Scanned of(layered_scene(Material::Alpha::blend, green), camera);
  const ShadeOptions flat{.shading = Shading::flat};
  expect_color(of.picture(flat), 7, 7, {0, 0.25f, 0.75f, 1});
  // The page behind both contributes a quarter of three quarters.
  ShadeOptions faint = flat;
  faint.opacity = 0.5f;
  expect_color(of.picture(faint), 7, 7,
               glm::vec4(0, 0.125f, 0.875f * 0.5f, 0) + 0.4375f * glm::vec4(1) + glm::vec4(0, 0, 0, 0.5625f));
  ShadeOptions front = flat;
  front.layers.see_through = SeeThrough::never;
  expect_color(of.picture(front), 7, 7, {0.75f, 1, 0.75f, 1});
  // Without the caller's index, the picture is the same.
  const Image own = shade(of.surfaces, of.scan, flat);
  EXPECT_EQ(content_hash(own), content_hash(of.picture(flat)));
}

TEST(ShadeScan, ARoofThrowsItsShadowByMapAndByRays) {
  Scene scene = scene_of(square(), colored({1, 1, 1, 1}));
  scene.instances[0].world_from_mesh = glm::dmat4(4.0);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  scene.instances.push_back({"roof", 0, glm::dmat4(0.5)});
  scene.instances[1].world_from_mesh[3] = {-1, 1, 1, 1};
  const RayCamera camera{Panorama{512, 256}, look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0})};
  const Scanned of(scene, camera);
  const Image lit = of.picture({.light = {.shadows = Shadows::off}}), map = of.picture({}),
              rays = of.picture({.light = {.shadows = Shadows::rays}});
  int dark = 0, other = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 512; ++x) {
      const bool is_dark = color_at(rays, x, y).g < color_at(lit, x, y).g - 0.1f;
      dark += is_dark;
      other += is_dark != (color_at(map, x, y).g < color_at(lit, x, y).g - 0.1f);
    }
  EXPECT_GT(dark, 400);
  EXPECT_LT(other, dark / 5);  // along the edges, which are soft by the map
}

TEST(ShadeScan, AShaderGivesTheSamePicturesOneAfterAnother) {
  const Scene scene = furnished_room();
  const Surfaces surfaces(scene);
  const RayIndex index(surfaces);
  Shader shader(surfaces);
  for (const double turn : {0.0, 1.0, 0.0}) {
    const glm::dmat4 pose = look_at({0, 0, 0}, {std::sin(turn), 0, -std::cos(turn)}, {0, 1, 0});
    const RangeScan around = scan(index, {Panorama{96, 48}, pose, 4});
    for (const Shadows shadows : {Shadows::map, Shadows::rays, Shadows::off}) {
      const Image& kept = shader.shade({.scan = &around}, {.light = {.shadows = shadows}});
      EXPECT_EQ(content_hash(kept), content_hash(shade(surfaces, around, {.light = {.shadows = shadows}})));
    }
  }
}

TEST(ShadeScan, ThreadsAndInstructionSetsChangeNoBit) {
  const Scanned of(furnished_room(), {Panorama{90, 45}, glm::dmat4(1.0), 4});
  const auto first = content_hash(of.picture({}, {.threads = 1, .isa = Isa::scalar}));
  for (const Isa isa : available_isas())
    for (const int threads : {1, 4}) EXPECT_EQ(content_hash(of.picture({}, {.threads = threads, .isa = isa})), first);
}

TEST(ShadeScan, RefusesScansThatDoNotFit) {
  const Scanned of(wall({1, 1, 1, 1}), kNine);
  RangeScan other = scan(of.index, kNine);
  other.primitives[5] = 1;
  EXPECT_THROW((void)shade(of.surfaces, other), Error);
  other = scan(of.index, kNine);
  other.width = 8;
  EXPECT_THROW((void)shade(of.surfaces, other), Error);
  other = scan(of.index, kNine);
  other.camera.samples = 4;
  EXPECT_THROW((void)shade(of.surfaces, other), Error);
  EXPECT_THROW((void)of.picture({.opacity = 2}), Error);
}

TEST(ShadeScan, IdsOfAnyGrid) {
  const Scanned of(wall({1, 1, 1, 1}), kNine);
  const std::vector<PrimitiveId> ids = {0, no_primitive};
  const Image image = id_image(of.surfaces, {2, 1}, ids, IdKind::material);
  EXPECT_EQ(image.channels[0].integers()[0], 0u);
  EXPECT_EQ(image.channels[0].integers()[1], no_index);
  EXPECT_THROW((void)id_image(of.surfaces, {3, 1}, ids, IdKind::object), Error);
}

}  // namespace
}  // namespace frontmost::test
