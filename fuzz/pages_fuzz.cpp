// SPDX-License-Identifier: Apache-2.0
// Writes arbitrary pages with texts and dimensions in every format. A valid page is written, any other is an Error. SVG
// and DXF have an element for each text; DXF is pairs of a code and a value, with finite numbers and distinct handles.
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "frontmost/sheets.h"

using namespace frontmost;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// The bytes of an input; zeros follow its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  [[nodiscard]] bool is_empty() const { return left_ == 0; }
  template <class Value>
  Value take() {
    Value value{};
    const std::size_t count = std::min(sizeof value, left_);
    if (count > 0) std::memcpy(&value, data_, count);
    data_ += count;
    left_ -= count;
    return value;
  }
  std::uint8_t below(int end) { return std::uint8_t(take<std::uint8_t>() % end); }
  /// A number of up to 256, or any float: NaN, infinities and huge values all occur.
  double number() { return below(16) == 15 ? double(take<float>()) : take<std::int16_t>() / 128.0; }
  glm::dvec2 point() {
    const double x = number();
    return {x, number()};
  }
  PageColor color() { return {below(256), below(256), below(256), below(256)}; }
  std::string text() {
    std::string text(below(16), ' ');
    for (char& c : text) c = take<char>();
    return text;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

PageGroup group_from(Input& in) {
  PageGroup group{in.text(), {std::abs(in.number()), in.color()}};
  group.pen.dashes.resize(in.below(5));
  for (double& dash : group.pen.dashes) dash = std::abs(in.number());
  group.opacity = in.below(256);
  return group;
}

void add_path(PageGroup& group, Input& in) {
  std::vector<glm::dvec2> points(in.below(6));
  for (glm::dvec2& p : points) p = in.point();
  const std::uint8_t flags = in.below(256);
  group.add(points, flags & 1, flags & 2);
  if (flags & 4) group.bulges.resize(group.points.size(), in.number() / 16);
  if (flags & 8) group.fills.resize(group.paths.size(), in.color());
}

Page page_from(Input& in) {
  Page page{std::abs(in.number()), std::abs(in.number()), in.text(), {{in.text(), {group_from(in)}}}};
  while (!in.is_empty()) {
    PageGroup& group = page.layers.back().groups.back();
    switch (in.below(5)) {
      case 0: add_path(group, in); break;
      case 1: {
        const std::string text = in.text();
        const glm::dvec2 at = in.point();
        const double height = std::abs(in.number()), angle = in.number();
        group.texts.push_back({text, at, {height, angle, TextAlign(in.below(3)), TextLine(in.below(3))}});
        break;
      }
      case 2: {
        PageDimension one{DimensionKind(in.below(4)), in.point(), in.point(), in.point(), in.number()};
        one.factor = std::pow(10.0, in.number() / 8);
        one.first_path = in.below(8);
        one.path_count = in.below(4);
        one.text = in.below(8);
        group.dimensions.push_back(one);
        break;
      }
      case 3: page.layers.back().groups.push_back(group_from(in)); break;
      default: page.layers.push_back({in.text(), {group_from(in)}});
    }
  }
  return page;
}

std::string written(const Page& page, PageFormat format) {
  static const std::string path =
      std::filesystem::temp_directory_path() / ("frontmost_pages_fuzz_" + std::to_string(::getpid()));
  save(page, path, format);
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::filesystem::remove(path);
  return bytes;
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

template <class Number>
Number whole(const std::string& text, int base) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  require(error == std::errc() && end == text.data() + text.size());
  return value;
}

/// Checks codes and handles. \returns the number of TEXT entities.
std::size_t check_dxf(const std::string& dxf) {
  std::istringstream in(dxf);
  std::set<std::uint64_t> handles;
  std::uint64_t seed = 0;
  std::size_t texts = 0;
  std::string line, value, last;
  while (std::getline(in, line)) {
    require(bool(std::getline(in, value)));
    const int code = whole<int>(line, 10);
    if (code == 0) texts += value == "TEXT";
    if ((code >= 10 && code < 60) || (code >= 140 && code < 150)) {
      char* end = nullptr;
      require(std::isfinite(std::strtod(value.c_str(), &end)) && *end == 0 && !value.empty());
    }
    if (code == 5 && last == "$HANDSEED")
      seed = whole<std::uint64_t>(value, 16);
    else if (code == 5 || code == 105)
      require(handles.insert(whole<std::uint64_t>(value, 16)).second);
    last = value;
  }
  require(*handles.rbegin() < seed);
  return texts;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input in(data, size);
  const Page page = page_from(in);
  try {
    validate(page);
  } catch (const Error&) {
    return 0;
  }
  std::size_t all = 0, shown = 0, in_dxf = 0;
  bool has_fills = false;
  for (const PageLayer& layer : page.layers)
    for (const PageGroup& group : layer.groups) {
      for (const PlacedText& text : group.texts) {
        ++all;
        shown += !text.text.empty();
        in_dxf += !text.text.empty() && group.pen.color.opacity > 0;
      }
      has_fills |= !group.fills.empty();
    }
  require(count_of(written(page, PageFormat::svg), "<text ") == shown);
  require(count_of(written(page, PageFormat::json), "{\"text\": ") == all);
  require(written(page, PageFormat::pdf).ends_with("%%EOF\n"));
  if (!has_fills) require(check_dxf(written(page, PageFormat::dxf)) == in_dxf);
  return 0;
}
