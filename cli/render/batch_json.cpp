// SPDX-License-Identifier: Apache-2.0
// The text is gone through twice: once to count, which keeps nothing, and once to read. The library's own parser with a
// callback goes through all views again for every one.
#include "cli/render/batch_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t most_views = 100'000;
constexpr std::size_t most_values = 8'000'000;
/// Of one object: there are fewer options than that, and each key is looked for among those before it.
constexpr std::size_t most_keys = 256;
/// Views, a view, its outputs, kinds of ids, a matrix and its rows: nothing is deeper than six. The JSON library copies
/// and follows what it has read by recursion, which far deeper lists in lists would end without a word.
constexpr std::size_t most_depth = 16;

/// Told of every value in turn; refuses what is too much.
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
  std::vector<std::size_t> keys_;  ///< so far, of each object and list that is open
  std::size_t views_ = 0, values_ = 0;
  bool in_views_ = false;
};

}  // namespace

Json parse_batch_json(const std::string& text, const std::string& name) {
  BatchCheck check(text, name);
  Json::sax_parse(text, &check);
  return Json::parse(text);
}

}  // namespace frontmost::cli
