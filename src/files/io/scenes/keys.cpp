// SPDX-License-Identifier: Apache-2.0
// Errors for keys that a scene file must not have: unknown keys, which are mostly typing mistakes, and repeated keys.
// The JSON library silently drops all but the last of a repeated key, so the text is parsed once more to find them.
#include <nlohmann/json.hpp>
#include <set>

#include "io/scenes/scene_file.h"

namespace frontmost {
namespace {

/// Receives each value in turn and keeps the stack of open objects and arrays.
class RepeatedKeyCheck final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit RepeatedKeyCheck(const ModelSource& source) : source_(source) {}

  bool null() override { return step(); }
  bool boolean(bool) override { return step(); }
  bool number_integer(number_integer_t) override { return step(); }
  bool number_unsigned(number_unsigned_t) override { return step(); }
  bool number_float(number_float_t, const string_t&) override { return step(); }
  bool string(string_t&) override { return step(); }
  bool binary(binary_t&) override { return step(); }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& key) override {
    if (!open_.back().keys.insert(key).second) source_.fail(place(), in_quotes(key) + " is there twice");
    open_.back().key = key;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  struct Open {
    bool is_array;
    std::size_t values = 0;      ///< so far, in an array
    std::string key;             ///< the last key, in an object
    std::set<std::string> keys;  ///< all keys so far
  };

  bool step() {
    if (!open_.empty()) ++open_.back().values;
    return true;
  }
  bool open(bool is_array) {
    step();
    open_.push_back({is_array, 0, {}, {}});
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  /// The place of the innermost object, written as JsonValue writes places.
  [[nodiscard]] std::string place() const {
    std::string place;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      const Open& around = open_[i];
      if (around.is_array)
        place += "[" + std::to_string(around.values - 1) + "]";
      else
        place += (place.empty() ? "" : ".") + printable(around.key);
    }
    return place.empty() ? "JSON" : place;
  }

  const ModelSource& source_;
  std::vector<Open> open_;
};

}  // namespace

void refuse_repeated_keys(std::string_view text, const ModelSource& source) {
  RepeatedKeyCheck check(source);
  nlohmann::json::sax_parse(text.begin(), text.end(), &check);
}

void check_keys(const gltf::JsonValue& object, std::initializer_list<std::string_view> known) {
  for (const std::string& key : object.keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (const std::string_view one : known) list += (list.empty() ? "" : ", ") + std::string(one);
    object.fail(in_quotes(key) + " is not known here; known are " + list);
  }
}

bool has(const gltf::JsonValue& object, const char* key) { return object.find(key).has_value(); }

}  // namespace frontmost
