// SPDX-License-Identifier: Apache-2.0
// A city for occlusion: a grid of streets, blocks of four lots, towers in the middle and houses at the rim, parks with
// trees, cars. A few meshes are placed many times. One unit is a metre. Hashes of places decide what stands where.
#include <array>
#include <cmath>

#include "scene/compose.h"
#include "scene/shapes.h"

namespace frontmost {
namespace {

constexpr int kBlocks = 13;     // blocks along each side
constexpr double kBlock = 46;   // side length of a block's pavement
constexpr double kStreet = 14;  // width of the street between two pavements
constexpr double kPitch = kBlock + kStreet;
constexpr double kKerb = 0.15;
constexpr double kFloorHeight = 3.6;

// A hash of a place (x, y) and of the number of a question about the place.
std::uint32_t hash(int x, int y, int question) {
  std::uint32_t h =
      std::uint32_t(x) * 0x9E3779B1u + std::uint32_t(y) * 0x85EBCA77u + std::uint32_t(question) * 0xC2B2AE3Du;
  h = (h ^ (h >> 16)) * 0x7FEB352Du;
  h = (h ^ (h >> 15)) * 0x846CA68Bu;
  return h ^ (h >> 16);
}

struct Paints {
  std::uint32_t asphalt, marking, pavement, grass, roof, glass, trunk;
  std::array<std::uint32_t, 4> walls, cars;
  std::array<std::uint32_t, 2> leaves;
};

Paints add_paints(Scene& scene) {
  Paints p{};
  p.asphalt = add(scene, paint("asphalt", 0x54585C, 0.95f));
  p.marking = add(scene, paint("road marking", 0xE6E3DA, 0.8f));
  p.pavement = add(scene, paint("pavement", 0xBDB8AE, 0.9f));
  p.grass = add(scene, paint("grass", 0x86A05A, 1));
  p.roof = add(scene, paint("roof", 0x7C7871, 0.9f));
  p.glass = add(scene, paint("window glass", 0x405968, 0.15f, 0.2f));
  p.trunk = add(scene, paint("bark", 0x6B5240, 0.95f));
  p.walls = {add(scene, paint("sandstone", 0xDDCBAA, 0.85f)), add(scene, paint("brick", 0xB0644A, 0.9f)),
             add(scene, paint("concrete", 0xD3D3CE, 0.8f)), add(scene, paint("slate", 0x6F7F8C, 0.7f))};
  p.cars = {add(scene, paint("white car", 0xF0EFEA, 0.25f)), add(scene, paint("red car", 0xB5322D, 0.25f)),
            add(scene, paint("blue car", 0x2F5D8A, 0.25f)), add(scene, paint("yellow car", 0xE3B23C, 0.25f))};
  p.leaves = {add(scene, paint("lime tree", 0x6E9450, 0.95f)), add(scene, paint("maple tree", 0xB98A3E, 0.95f))};
  return p;
}

// A building on a square of 18 m: floors of a wall band over a set-back window band, and a hut on the roof. Towers step
// back by 2 m at two fifths of their height.
Mesh building(int floors, std::uint32_t wall, const Paints& paints) {
  Mesh mesh;
  const int step = floors > 12 ? floors * 2 / 5 : floors;
  const auto band = [&](double half, double from, double to, std::uint32_t material) {
    append(mesh, box({-half, from, -half}, {half, to, half}), material);
  };
  for (int floor = 0; floor < floors; ++floor) {
    const double y = floor * kFloorHeight, sill = y + (floor == 0 ? 0.5 : 1.5);
    band(floor <= step ? 9 : 7, y, sill, wall);  // the band at the step is its ledge
    band(floor < step ? 8.7 : 6.7, sill, y + kFloorHeight, paints.glass);
  }
  const double top = floors * kFloorHeight;
  band(floors > step ? 7 : 9, top, top + 0.9, wall);
  append(mesh, box({-3.5, top + 0.9, -2.5}, {2, top + 3.4, 3}), paints.roof);
  return mesh;
}

// A house with a pitched roof, ridge along x.
Mesh house(std::uint32_t wall, const Paints& paints) {
  Mesh mesh;
  append(mesh, box({-7, 0, -5}, {7, 5.6, 5}), wall);
  append(mesh, box({-5, 1, -5.06}, {5, 4.4, 5.06}), paints.glass);
  // The slope is a 3-4-5 triangle: 5.6 across and 4.2 up make 7 along.
  const glm::dmat4 front = moved({0, 9.35, 0}) * glm::dmat4(1, 0, 0, 0, 0, 0.8, 0.6, 0, 0, -0.6, 0.8, 0, 0, 0, 0, 1);
  const glm::dmat4 back = turned(1, 2);
  const Mesh slope = box({-7.5, -0.3, 0}, {7.5, 0, 7});
  append(mesh, slope, paints.roof, front);
  append(mesh, slope, paints.roof, back * front);
  return mesh;
}

Mesh tree(std::uint32_t leaves, const Paints& paints) {
  Mesh mesh;
  append(mesh, box({-0.2, 0, -0.2}, {0.2, 2.4, 0.2}), paints.trunk);
  append(mesh, sphere(5), leaves, moved({0, 4.1, 0}) * scaled(2.1));
  return mesh;
}

Mesh car(std::uint32_t paint, const Paints& paints) {
  Mesh mesh;
  append(mesh, box({-2.1, 0.3, -0.9}, {2.1, 0.95, 0.9}), paint);
  append(mesh, box({-1.2, 0.95, -0.8}, {1.0, 1.5, 0.8}), paints.glass);
  return mesh;
}

constexpr std::array<int, 9> kFloors{2, 3, 4, 5, 6, 8, 11, 18, 34};
constexpr std::size_t kTowers = 7;  // index of the first tower: towers are of concrete and slate only

// The meshes, each stored once.
struct Stock {
  std::array<std::array<std::uint32_t, 4>, kFloors.size()> buildings;  // by number of floors and wall
  std::array<std::uint32_t, 4> houses, cars;
  std::array<std::uint32_t, 2> trees;
  std::uint32_t pavement, lawn, dash, ground;
};

std::uint32_t store(Scene& scene, std::string name, Mesh mesh) {
  mesh.name = std::move(name);
  scene.meshes.push_back(std::move(mesh));
  return std::uint32_t(scene.meshes.size() - 1);
}

Stock add_stock(Scene& scene, const Paints& paints) {
  constexpr std::array<const char*, 4> kWalls{"sandstone", "brick", "concrete", "slate"};
  constexpr std::array<const char*, 4> kCars{"white", "red", "blue", "yellow"};
  Stock stock{};
  const double side = kBlocks * kPitch + kStreet, half = kBlock / 2;
  stock.ground = add(scene, "ground", floor(side, side), paints.asphalt);
  stock.pavement = add(scene, "pavement", box({-half, 0, -half}, {half, kKerb, half}), paints.pavement);
  stock.lawn = add(scene, "lawn", box({4 - half, kKerb, 4 - half}, {half - 4, kKerb + 0.1, half - 4}), paints.grass);
  stock.dash = add(scene, "dash", floor(3, 0.3), paints.marking);
  for (std::size_t w = 0; w < 4; ++w) {
    for (std::size_t f = 0; f < (w < 2 ? kTowers : kFloors.size()); ++f)
      stock.buildings[f][w] = store(scene, std::string(kWalls[w]) + " building of " + std::to_string(kFloors[f]),
                                    building(kFloors[f], paints.walls[w], paints));
    stock.houses[w] = store(scene, std::string(kWalls[w]) + " house", house(paints.walls[w], paints));
    stock.cars[w] = store(scene, std::string(kCars[w]) + " car", car(paints.cars[w], paints));
  }
  stock.trees = {store(scene, "lime tree", tree(paints.leaves[0], paints)),
                 store(scene, "maple tree", tree(paints.leaves[1], paints))};
  return stock;
}

// The middle of block (i, j).
glm::dvec3 block_place(int i, int j) { return {(i - kBlocks / 2) * kPitch, 0, (j - kBlocks / 2) * kPitch}; }

std::string label(const char* what, int i, int j) {
  return std::string(what) + " " + std::to_string(i) + "-" + std::to_string(j);
}

void add_park(Scene& scene, const Stock& stock, int i, int j) {
  const glm::dvec3 at = block_place(i, j);
  place(scene, label("lawn", i, j), stock.lawn, moved(at));
  for (int k = 0; k < 12; ++k) {
    const glm::dvec3 cell(k % 4 * 10 - 15, kKerb + 0.1, k / 4 * 12 - 12);
    const std::uint32_t h = hash(i * 16 + k, j, 5);
    const glm::dvec3 nudge(int(h % 64) / 16.0 - 2, 0, int(h / 64 % 64) / 16.0 - 2);
    place(scene, label("tree", i, j) + " " + std::to_string(k + 1), stock.trees[h / 4096 % 4 == 0],
          moved(at + cell + nudge) * scaled(0.8 + int(h >> 24) / 640.0));
  }
}

// Adds a lot's building: tall in the middle, low at the rim, and never quite the same.
void add_lot(Scene& scene, const Stock& stock, const glm::ivec2& block, int lot) {
  const std::uint32_t h = hash(block.x * 4 + lot, block.y, 1);
  const glm::dvec3 at = block_place(block.x, block.y) + glm::dvec3(lot % 2 * 22 - 11, kKerb, lot / 2 * 22 - 11);
  const glm::dmat4 facing = moved(at) * turned(int(h % 4), 4);
  const std::string name = label("lot", block.x, block.y) + " " + std::to_string(lot + 1);
  const int ring = std::max(std::abs(block.x - kBlocks / 2), std::abs(block.y - kBlocks / 2));
  if (ring >= 5 && h / 128 % 4 != 0) {
    place(scene, name, stock.houses[h / 32 % 4], facing);
  } else {
    const int floors = std::clamp(8 - ring - int(h / 512 % 4) + int(h / 2048 % 3), 0, int(kFloors.size()) - 1);
    const std::uint32_t wall = std::size_t(floors) >= kTowers ? 2 + h / 32 % 2 : h / 32 % 4;
    place(scene, name, stock.buildings[std::size_t(floors)][wall], facing);
  }
}

// Adds cars and dashes along the street on the far side of a block, in both directions.
void add_street(Scene& scene, const Stock& stock, int i, int j) {
  const glm::dvec3 corner = block_place(i, j) + glm::dvec3(-kPitch / 2, 0.02, -kPitch / 2);
  for (const bool along_z : {false, true}) {
    const glm::dmat4 street = moved(corner) * turned(along_z ? 3 : 0, 4);
    const std::string name = label(along_z ? "avenue" : "street", i, j);
    for (int k = 0; k < 5; ++k)
      place(scene, name + " dash " + std::to_string(k + 1), stock.dash, street * moved({k * 8.5 + 12.0, 0, 0}));
    const std::uint32_t h = hash(i, j, along_z ? 8 : 7);
    if (h % 4 == 0) continue;
    const bool back = h / 4 % 2 == 1;
    const double z = back ? -3 : 3, x = 12 + int(h / 8 % 32);
    place(scene, name + " car", stock.cars[h / 256 % 4], street * moved({x, 0, z}) * turned(back, 2));
  }
}

}  // namespace

Scene make_city() {
  Scene scene;
  const Paints paints = add_paints(scene);
  const Stock stock = add_stock(scene, paints);
  place(scene, "ground", stock.ground);
  for (int j = 0; j < kBlocks; ++j)
    for (int i = 0; i < kBlocks; ++i) {
      place(scene, label("block", i, j), stock.pavement, moved(block_place(i, j)));
      add_street(scene, stock, i, j);
      if (hash(i, j, 2) % 9 == 0) {
        add_park(scene, stock, i, j);
        continue;
      }
      for (int lot = 0; lot < 4; ++lot) add_lot(scene, stock, {i, j}, lot);
    }
  const double street = -kPitch / 2;
  scene.cameras.push_back(camera_at("aerial", {430, 400, 660}, {0, 0, 25}, 40));
  scene.cameras.push_back(camera_at("street", {street - 3.2, 2.2, 395}, {street + 6, 26, 0}, 50));
  scene.cameras.push_back(camera_at("rooftop", {-250, 74, 270}, {0, 32, 0}, 44));
  return scene;
}

}  // namespace frontmost
