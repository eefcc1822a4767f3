// SPDX-License-Identifier: Apache-2.0
// Makes small glTF files for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "frontmost/files.h"

namespace frontmost::test {

/// Type of an accessor's elements: shape and component type.
struct Type {
  const char* shape = "VEC3";
  int component = 5126;
  std::string more = {};  ///< further members, as JSON
};

/// A file whose arrays are filled with JSON texts and whose numbers lie in one buffer.
class GltfMaker {
 public:
  /// Adds an element to a top-level array. \returns its index.
  int add(const std::string& array, const std::string& json) {
    arrays_[array].push_back(json);
    return int(arrays_[array].size()) - 1;
  }
  /// Sets a top-level member.
  void set(const std::string& member, const std::string& json) { members_[member] = json; }

  /// Adds bytes to the buffer. \returns the index of their buffer view.
  int view(const void* data, std::size_t size, const std::string& more = {}) {
    binary_.resize((binary_.size() + 3) & ~std::size_t(3));
    const std::size_t offset = binary_.size();
    binary_.resize(offset + size);
    std::memcpy(binary_.data() + offset, data, size);
    return add("bufferViews", R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" +
                                  std::to_string(size) + more + "}");
  }
  template <class T>
  int accessor(const std::vector<T>& values, const Type& type, std::size_t count) {
    const int id = view(values.data(), values.size() * sizeof(T));
    return bare_accessor(type, count, R"(,"bufferView":)" + std::to_string(id));
  }
  int bare_accessor(const Type& type, std::size_t count, const std::string& more = {}) {
    return add("accessors", R"({"count":)" + std::to_string(count) + R"(,"type":")" + type.shape +
                                R"(","componentType":)" + std::to_string(type.component) + type.more + more + "}");
  }
  int floats(const std::vector<float>& values, const char* shape = "VEC3") {
    const int width = std::strcmp(shape, "SCALAR") == 0 ? 1 : std::strcmp(shape, "MAT4") == 0 ? 16 : shape[3] - '0';
    return accessor(values, {shape, 5126, ""}, values.size() / std::size_t(width));
  }
  int shorts(const std::vector<std::uint16_t>& values) { return accessor(values, {"SCALAR", 5123, ""}, values.size()); }
  /// Adds a mesh of one primitive, and a scene of one node that shows it.
  void show(const std::string& primitive) {
    add("meshes", R"({"primitives":[)" + primitive + "]}");
    add("nodes", R"({"mesh":0})");
    add("scenes", R"({"nodes":[0]})");
  }

  [[nodiscard]] std::string json(const std::string& buffer_more = {}) const {
    std::string text = R"({"asset":{"version":"2.0"})";
    for (const auto& [member, value] : members_) text += ",\"" + member + "\":" + value;
    for (const auto& [array, elements] : arrays_) {
      text += ",\"" + array + "\":[";
      for (std::size_t i = 0; i < elements.size(); ++i) text += (i == 0 ? "" : ",") + elements[i];
      text += "]";
    }
    if (!binary_.empty()) text += R"(,"buffers":[{"byteLength":)" + std::to_string(binary_.size()) + buffer_more + "}]";
    return text + "}";
  }
  [[nodiscard]] std::vector<std::byte> glb() const { return glb_of(json(), binary_); }
  [[nodiscard]] const std::vector<std::byte>& binary() const { return binary_; }

  static std::vector<std::byte> glb_of(std::string json, std::vector<std::byte> binary) {
    json.resize((json.size() + 3) & ~std::size_t(3), ' ');
    binary.resize((binary.size() + 3) & ~std::size_t(3));
    std::vector<std::byte> out;
    const auto put = [&out](std::size_t value) {
      for (int i = 0; i < 4; ++i) out.push_back(std::byte(value >> (8 * i)));
    };
    put(0x46546C67);
    put(2);
    put(12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
    put(json.size());
    put(0x4E4F534A);
    for (const char c : json) out.push_back(std::byte(c));
    if (binary.empty()) return out;
    put(binary.size());
    put(0x004E4942);
    out.insert(out.end(), binary.begin(), binary.end());
    return out;
  }

 private:
  std::map<std::string, std::vector<std::string>> arrays_;
  std::map<std::string, std::string> members_;
  std::vector<std::byte> binary_;
};

inline std::vector<std::byte> byte_vector(const std::string& text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

inline Scene load_glb(const GltfMaker& maker) { return load(maker.glb(), "t.glb"); }

}  // namespace frontmost::test
