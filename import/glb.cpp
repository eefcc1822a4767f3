// SPDX-License-Identifier: Apache-2.0
//   mesh
//     primitives[0 ...]   triangles, one primitive for each colour  |
//     primitives[...]     lines: sharp edges, with their circles    | indices into the vertices of the part
//     primitives[...]     lines: smooth edges                       |
#include "import/glb.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

namespace frontmost::import {
namespace {

using Json = nlohmann::json;

constexpr int kFloat = 5126, kIndex = 5125, kLines = 1, kTriangles = 4;
constexpr std::uint32_t kGlb = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

class Writer {
 public:
  explicit Writer(const Model& model) {
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "frontmost-import"}}},
             {"scene", 0},
             {"extensionsUsed", {"FRONTMOST_edges"}}};
    for (const Color& color : model.materials) add_material(color);
    for (const Part& part : model.parts) add_mesh(part);
    Json roots = Json::array();
    for (const Placed& placed : model.placed) {
      roots.push_back(roots.size());
      json_["nodes"].push_back({{"name", placed.name}, {"mesh", placed.part}, {"matrix", placed.matrix}});
    }
    json_["scenes"] = {{{"nodes", roots}}};
    json_["buffers"] = {{{"byteLength", binary_.size()}}};
  }

  [[nodiscard]] std::string file() const {
    // Names of files are in many encodings.
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t size = 12 + 8 + text.size() + 8 + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max()) throw std::length_error("the model has more than 4 GiB");
    std::string out;
    out.reserve(size);
    const auto append = [&](std::uint32_t number) {
      out.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    for (const std::uint32_t number : {kGlb, 2u, std::uint32_t(size), std::uint32_t(text.size()), kJson})
      append(number);
    out += text;
    for (const std::uint32_t number : {std::uint32_t(binary_.size()), kBinary}) append(number);
    out += binary_;
    return out;
  }

 private:
  void add_material(const Color& color) {
    Json material = {{"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 0}}},
                     {"doubleSided", true}};
    if (color[3] < 1) material["alphaMode"] = "BLEND";
    json_["materials"].push_back(material);
  }

  void add_mesh(const Part& part) {
    Json attributes = {{"POSITION", add_vectors(part.positions, true)}};
    if (!part.normals.empty()) attributes["NORMAL"] = add_vectors(part.normals, false);
    Json primitives = Json::array();
    for (const Faces& faces : part.faces) {
      Json& primitive = primitives.emplace_back(
          Json{{"mode", kTriangles}, {"attributes", attributes}, {"indices", add_indices(faces.corners)}});
      if (faces.material != kNoMaterial) primitive["material"] = faces.material;
    }
    if (!part.sharp.empty()) {
      Json circles = Json::array();
      for (const EdgeCircle& c : part.circles)
        circles.push_back(
            {{"centre", c.centre}, {"axis", c.axis}, {"radius", c.radius}, {"first", c.first}, {"count", c.count}});
      primitives.push_back(lines(attributes, part.sharp, {{"circles", circles}}));
    }
    if (!part.smooth.empty()) primitives.push_back(lines(attributes, part.smooth, {{"smooth", true}}));
    json_["meshes"].push_back({{"name", part.name}, {"primitives", primitives}});
  }

  Json lines(const Json& attributes, const std::vector<std::uint32_t>& edges, const Json& stated) {
    return {{"mode", kLines},
            {"attributes", attributes},
            {"indices", add_indices(edges)},
            {"extensions", {{"FRONTMOST_edges", stated}}}};
  }

  template <class T>
  std::size_t add_view(std::span<const T> values) {
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", values.size_bytes()}});
    binary_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    return json_["bufferViews"].size() - 1;
  }

  std::size_t add_vectors(const std::vector<float>& values, bool has_bounds) {
    Json accessor = {{"bufferView", add_view(std::span(values))},
                     {"componentType", kFloat},
                     {"count", values.size() / 3},
                     {"type", "VEC3"}};
    if (has_bounds) {
      constexpr float infinity = std::numeric_limits<float>::infinity();
      std::array<float, 3> low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
      for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], values[i]);
        high[i % 3] = std::max(high[i % 3], values[i]);
      }
      accessor["min"] = low;
      accessor["max"] = high;
    }
    json_["accessors"].push_back(accessor);
    return json_["accessors"].size() - 1;
  }

  std::size_t add_indices(const std::vector<std::uint32_t>& values) {
    json_["accessors"].push_back({{"bufferView", add_view(std::span(values))},
                                  {"componentType", kIndex},
                                  {"count", values.size()},
                                  {"type", "SCALAR"}});
    return json_["accessors"].size() - 1;
  }

  Json json_;
  std::string binary_;
};

}  // namespace

std::string glb_of(const Model& model) { return Writer(model).file(); }

}  // namespace frontmost::import
