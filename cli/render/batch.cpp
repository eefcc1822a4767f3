// SPDX-License-Identifier: Apache-2.0
// Batch files are JSON whose keys are names of options, so that the table of options describes flags and keys alike.
//
// The text is parsed twice: once to check limits, without keeping values, and once to read. The library's parser with a
// callback would go through all views again for each view.
#include <fmt/format.h>
#include <frontmost/files.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/json.h"
#include "cli/option.h"
#include "cli/render/jobs.h"
#include "cli/values.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t most_views = 100'000;
constexpr std::size_t most_values = 8'000'000;
/// Limit of keys in one object. It exceeds the number of options, and is low because the search for repeated keys is
/// linear.
constexpr std::size_t most_keys = 256;
/// Limit of nesting. Views, a view, its outputs, kinds of ids, a matrix and its rows need six levels. The JSON library
/// copies and visits values by recursion, which very deep lists would crash.
constexpr std::size_t most_depth = 16;

/// Receives each value in turn and refuses files beyond the limits.
class BatchCheck final : public nlohmann::json_sax<Json> {
 public:
  BatchCheck(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  bool null() override { return take(); }
  bool boolean(bool) override { return take(); }
  bool number_integer(number_integer_t) override { return take(); }
  bool number_unsigned(number_unsigned_t) override { return take(); }
  bool number_float(number_float_t, const string_t&) override { return take(); }
  bool string(string_t&) override { return take(); }
  bool binary(binary_t&) override { return take(); }
  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& key) override {
    if (++keys_.back() > most_keys) refuse(fmt::format("an object has more than {} keys", most_keys));
    if (keys_.size() == 1) in_views_ = key == "views";
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) override {
    const std::size_t end = std::min(position, text_.size());
    const auto lines = std::count(text_.begin(), text_.begin() + std::ptrdiff_t(end > 0 ? end - 1 : 0), '\n');
    constexpr int number_overflow = 406;
    const std::string why =
        error.id == number_overflow ? shortened(token) + " is not a usable number" : "is not valid JSON";
    refuse(fmt::format("line {}: {}", lines + 1, why));
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw UsageError(name_ + ": " + why); }
  bool take() {
    if (in_views_ && keys_.size() == 2 && ++views_ > most_views) refuse(fmt::format("views: more than {}", most_views));
    if (++values_ > most_values) refuse(fmt::format("more than {} values", most_values));
    return true;
  }
  bool open() {
    take();
    keys_.push_back(0);
    if (keys_.size() > most_depth) refuse(fmt::format("is nested deeper than {}", most_depth));
    return true;
  }
  bool close() {
    keys_.pop_back();
    return true;
  }

  const std::string &text_, &name_;
  std::vector<std::size_t> keys_;  ///< number of keys so far, for each open object and list
  std::size_t views_ = 0, values_ = 0;
  bool in_views_ = false;
};

/// Parses a batch file. O(size of the text). \throws UsageError naming file and line for invalid JSON and for numbers
/// beyond double; naming the file for more views, values, keys of an object or levels than the limits above.
Json parse_batch_json(const std::string& text, const std::string& name) {
  BatchCheck check(text, name);
  Json::sax_parse(text, &check);
  return Json::parse(text);
}

constexpr std::uint64_t largest_batch_file = std::uint64_t(1) << 26;

/// A value and its place, such as "batch.json: views[2].resolution".
struct JsonPlace {
  const Json& value;
  std::string path;

  [[nodiscard]] JsonPlace at(const std::string& key) const {
    return {value.at(key), fmt::format("{}.{}", path, shortened(key))};
  }
  [[noreturn]] void refuse(std::string_view why) const { throw UsageError(fmt::format("{}: {}", path, why)); }
};

std::string number_text(const Json& value) {
  return value.is_number_integer() ? value.dump() : fmt::format("{}", value.get<double>());
}

/// Returns the value as it would be written on a command line.
std::string text_of(const JsonPlace& place) {
  const Json& value = place.value;
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return number_text(value);
  if (!value.is_array()) place.refuse("must be a string, a number or a list of numbers");
  std::string text;
  const auto append = [&](const Json& element) {
    if (!element.is_number()) place.refuse("must hold only numbers");
    if (!text.empty()) text += ',';
    text += number_text(element);
  };
  for (const Json& element : value) {
    // A matrix may be written as four rows.
    if (element.is_array())
      for (const Json& inner : element) append(inner);
    else
      append(element);
  }
  return text;
}

/// Throws an error for NUL characters, at which the system would end names.
void refuse_nul(const JsonPlace& place, const std::string& text) {
  if (text.find('\0') != std::string::npos) place.refuse("must not hold a NUL character");
}

void apply_at(const JsonPlace& place, const Option& option, const std::string& text, Settings& settings) {
  refuse_nul(place, text);
  try {
    apply_as_given(option, text, settings);
  } catch (const UsageError& error) {
    place.refuse(error.what());
  }
}

void apply_value(const JsonPlace& place, const Option& option, Settings& settings) {
  if (option.is_switch()) {
    if (!place.value.is_boolean()) place.refuse("must be true or false");
    if (place.value.get<bool>()) apply_at(place, option, {}, settings);
  } else if (option.name == "ids" && place.value.is_object()) {
    for (const auto& [kind, file] : place.value.items()) {
      const JsonPlace inner = place.at(kind);
      if (!file.is_string()) inner.refuse("must be a file name");
      apply_at(inner, option, kind + "=" + file.get<std::string>(), settings);
    }
  } else {
    apply_at(place, option, text_of(place), settings);
  }
}

bool belongs_to_view(const Option& option) {
  return option.group == Group::camera || option.group == Group::vision || option.group == Group::grid ||
         option.group == Group::depth;
}
bool belongs_to_outputs(const Option& option) { return option.group == Group::output || option.group == Group::look; }

/// Applies all keys of an object. `belongs` tells which options the object may hold.
template <class Belongs>
void apply_object(const JsonPlace& place, const Belongs& belongs, std::vector<std::string_view> other_keys,
                  Settings& settings) {
  if (!place.value.is_object()) place.refuse("must be an object");
  for (const auto& item : place.value.items()) {
    const std::string& key = item.key();  // clang 14 does not capture structured bindings
    bool known = std::find(other_keys.begin(), other_keys.end(), key) != other_keys.end();
    std::vector<std::string_view> names = other_keys;
    for_each_option([&](const Option& option) {
      if (!belongs(option) || !(option.commands & for_render)) return;
      names.push_back(option.name);
      if (known || option.name != key) return;
      known = true;
      apply_value(place.at(key), option, settings);
    });
    if (known) continue;
    const std::string_view nearest = nearest_word(key, names);
    place.at(key).refuse(nearest.empty() ? "is not known here"
                                         : fmt::format("is not known; did you mean {}?", nearest));
  }
}

Settings parse_view(const JsonPlace& place, const Settings& defaults) {
  Settings settings = defaults;
  apply_object(place, belongs_to_view, {"name", "outputs"}, settings);
  if (place.value.contains("name")) {
    const JsonPlace name = place.at("name");
    if (!name.value.is_string() || name.value.get<std::string>().empty()) name.refuse("must be a string");
    settings.view.name = name.value.get<std::string>();
    refuse_nul(name, settings.view.name);
    // The name becomes part of a file name and must not lead to another folder.
    if (settings.view.name.find('/') != std::string::npos) name.refuse("must not hold a /");
  }
  if (place.value.contains("outputs")) apply_object(place.at("outputs"), belongs_to_outputs, {}, settings);
  try {
    read_pose_file(settings.view);
  } catch (const UsageError& error) {
    place.refuse(error.what());
  }
  return settings;
}

}  // namespace

std::vector<Settings> parse_batch(const std::string& text, const std::string& name, const Settings& defaults) {
  const Json json = parse_batch_json(text, name);
  const JsonPlace root{json, name};
  if (!json.is_object()) root.refuse("must be an object with views");
  for (const auto& [key, value] : json.items()) {
    if (key != "views" && key != "outputs")
      root.refuse(fmt::format("{}: is not known; the known keys are views and outputs", shortened(key)));
  }
  Settings common = defaults;
  if (json.contains("outputs")) apply_object({json.at("outputs"), name + ": outputs"}, belongs_to_outputs, {}, common);
  if (!json.contains("views") || !json.at("views").is_array() || json.at("views").empty()) {
    root.refuse("views: must be a list of at least one view");
  }
  const Json& views = json.at("views");
  std::vector<Settings> result;
  result.reserve(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const JsonPlace place{views[i], fmt::format("{}: views[{}]", name, i)};
    result.push_back(parse_view(place, common));
    if (result.back().view.name.empty() && !views[i].contains("view")) result.back().view.name = std::to_string(i);
  }
  return result;
}

std::vector<Settings> read_batch(const std::string& path, const Settings& defaults) {
  return parse_batch(load_text(path, largest_batch_file), path, defaults);
}

}  // namespace frontmost::cli
