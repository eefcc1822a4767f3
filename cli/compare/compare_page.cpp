// SPDX-License-Identifier: Apache-2.0
// The page: one HTML file that embeds everything (styles, tables, pictures as data URIs), so that it can be mailed or
// archived.
//
// Pictures are also separate files. All files are written into a hidden folder and moved when all are complete, because
// a page with pictures of another run would be worse than none.
#include <fmt/format.h>
#include <frontmost/base.h>
#include <frontmost/files.h>
#include <frontmost/pictures.h>

#include <algorithm>
#include <utility>

#include "cli/compare/compare_report.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/html.h"

namespace frontmost::cli {
namespace {

constexpr const char* style = R"(.lead { font-size: 1.15rem; max-width: 46em; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr)); gap: 24px;
  margin-top: 20px; }
.card { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 14px; overflow: hidden; }
.card img { display: block; width: 100%; height: auto; background: var(--stage); }
.card figcaption { padding: 16px 20px 10px; }
table { border-collapse: collapse; width: 100%; min-width: 700px; table-layout: fixed; font-variant-numeric: tabular-nums; }
th, td { padding: 7px 0 7px 14px; border-bottom: 1px solid var(--line); text-align: right; font-weight: 400;
  white-space: nowrap; }
th:first-child { padding-left: 0; text-align: left; color: var(--soft); white-space: normal; width: 26%; }
thead th { font-weight: 650; white-space: normal; vertical-align: bottom; line-height: 1.25; }
tr:last-child > * { border-bottom: 0; }
.part th:first-child { padding-left: 20px; }
.bar { display: block; height: 6px; border-radius: 3px; background: var(--accent); margin: 3px 0 0 auto; }
.key { display: inline-block; width: 12px; height: 12px; border-radius: 3px; margin: 0 6px -1px 0; }
.legend span { margin-right: 22px; white-space: nowrap; }
)";

struct Cause {
  Difference difference;
  bool of_naive;    ///< whether it is counted only for methods that are known to be wrong
  glm::vec3 color;  // sRGB
  const char* text;

  [[nodiscard]] std::uint64_t count(const Compared& c) const {
    if (difference != Difference::unexplained) return c.agreement.count(difference);
    return of_naive ? c.wrong_by_design() : c.unexplained();
  }
};
// Colours that can be told apart on dark grey with either kind of colour blindness.
constexpr Cause causes[] = {
    {Difference::edge, false, {0.99f, 0.72f, 0.15f}, "edge within 1/128 pixel"},
    {Difference::depth, false, {0.31f, 0.70f, 1.0f}, "depths closer than floats resolve"},
    {Difference::translucent, false, {0.62f, 0.87f, 0.47f}, "seen through something translucent"},
    {Difference::unexplained, true, {0.80f, 0.80f, 0.86f}, "wrong by design"},
    {Difference::unexplained, false, {1.0f, 0.15f, 0.45f}, "unexplained"}};

float linear(float srgb) { return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f); }

/// Marks differing samples by squares, because a single pixel is invisible in a small picture. Rarer and worse
/// differences go on top.
void mark(const Compared& compared, Image& map) {
  const Agreement& agreement = compared.agreement;
  const int reach = std::max(map.width, map.height) / 320;
  for (const Cause& cause : causes) {
    if (cause.count(compared) == 0) continue;
    // If many samples differ, single pixels are visible enough.
    const int side = cause.count(compared) > agreement.view.sample_count() / 100 ? 0 : reach;
    for (std::size_t sample = 0; sample < agreement.view.sample_count(); ++sample) {
      if (agreement.differences[sample] != cause.difference) continue;
      const auto pixel = int(sample % agreement.view.pixel_count()), x = pixel % map.width, y = pixel / map.width;
      for (int j = std::max(y - side, 0); j <= std::min(y + side, map.height - 1); ++j)
        for (int i = std::max(x - side, 0); i <= std::min(x + side, map.width - 1); ++i)
          for (std::size_t c = 0; c < 3; ++c)
            map.channels[c].floats()[std::size_t(j) * std::size_t(map.width) + std::size_t(i)] =
                linear(cause.color[int(c)]);
    }
  }
}

/// Returns the differing pixels over the picture, which becomes dim grey.
Image difference_map(const Compared& compared, const Image& picture) {
  Image map{picture.width, picture.height, {}};
  for (const char* channel : {"R", "G", "B", "A"})
    map.channels.push_back({channel, Buffer<float>(compared.agreement.view.pixel_count(), 1.0f)});
  const auto &red = picture.find("R")->floats(), &green = picture.find("G")->floats(),
             &blue = picture.find("B")->floats();
  for (std::size_t i = 0; i < red.size(); ++i) {
    const float grey = 0.015f + 0.14f * (0.2126f * red[i] + 0.7152f * green[i] + 0.0722f * blue[i]);
    for (std::size_t c = 0; c < 3; ++c) map.channels[c].floats()[i] = grey;
  }
  mark(compared, map);
  return map;
}

std::string row(std::string_view label, const std::vector<std::string>& cells, std::string_view kind = "") {
  std::string text = fmt::format("<tr{}><th scope=\"row\">{}</th>", kind, label);
  for (const std::string& cell : cells) text += "<td>" + cell + "</td>";
  return text + "</tr>\n";
}

/// Returns a row of numbers, with bars that show the share of each number in the greatest one of the row.
template <class Number, class Text>
std::string bar_row(const Comparisons& all, std::string_view label, const Number& number, const Text& text) {
  double greatest = 0;
  for (const Compared& c : all.methods) greatest = std::max(greatest, number(c).value_or(0));
  std::vector<std::string> cells;
  for (const Compared& c : all.methods) {
    const std::optional<double> value = number(c);
    cells.push_back(!value ? ""
                           : fmt::format("{}<span class=\"bar\" style=\"width:{:.1f}%\"></span>", text(*value),
                                         greatest > 0 ? 100 * *value / greatest : 0));
  }
  return row(label, cells);
}

std::string table_of(const Comparisons& all) {
  std::string text = "<div class=\"scroll\"><table><thead><tr><th></th>";
  for (const Compared& c : all.methods) text += fmt::format("<th scope=\"col\">{}</th>", c.run.method->title);
  text += "</tr></thead><tbody>\n";
  for (const std::string& stage : stage_names(all.methods))
    text += bar_row(
        all, stage, [&](const Compared& c) { return c.run.median_of(stage); },
        [](double ms) { return fmt::format("{:.2f} ms", ms); });
  text += bar_row(
      all, "memory beside the model", [](const Compared& c) { return std::optional(double(c.run.peak_bytes)); },
      [](double bytes) { return mebibytes(std::uint64_t(bytes)); });
  constexpr std::string_view part = " class=\"part\"";
  const auto plain = [&](std::string_view label, const auto& number, std::string_view kind = "") {
    std::vector<std::string> cells;
    for (const Compared& c : all.methods) cells.push_back(grouped(number(c)));
    text += row(label, cells, kind);
  };
  plain("triangles worked on", [](const Compared& c) { return c.run.answer.primitives; });
  plain("samples", [&](const Compared&) { return all.view.sample_count(); });
  plain(
      "covered", [](const Compared& c) { return covered_samples(c.run.answer.visible); }, part);
  const auto of_lists = [&](std::string_view label, std::uint64_t KeptLists::*number, std::string_view kind = "") {
    std::vector<std::string> cells;
    for (const Compared& c : all.methods) cells.push_back(c.run.lists ? grouped(*c.run.lists.*number) : "");
    text += row(label, cells, kind);
  };
  of_lists("fragments", &KeptLists::fragments);
  of_lists("most of a pixel", &KeptLists::longest, part);
  plain(fmt::format("{} that differ", spots(all.view)), [](const Compared& c) { return c.agreement.differing(); });
  for (const Cause& cause : causes)
    plain(
        fmt::format("<span class=\"key\" style=\"background:rgb({:.0f},{:.0f},{:.0f})\"></span>{}", 255 * cause.color.r,
                    255 * cause.color.g, 255 * cause.color.b, cause.text),
        [&](const Compared& c) { return cause.count(c); }, part);
  return text + "</tbody></table></div>\n";
}

std::string card(const std::string& image, std::string_view title, std::string_view words) {
  return fmt::format(
      "<figure class=\"card\"><img src=\"{}\" alt=\"{}\"><figcaption><h3>{}</h3><p>{}</p></figcaption></figure>\n",
      image, title, title, words);
}

std::string legend() {
  std::string text = "<p class=\"legend\">";
  for (const Cause& cause : causes)
    text += fmt::format("<span><i class=\"key\" style=\"background:rgb({:.0f},{:.0f},{:.0f})\"></i>{}</span> ",
                        255 * cause.color.r, 255 * cause.color.g, 255 * cause.color.b, cause.text);
  return text + "</p>";
}

std::string picture_name(const ComparedMethod& method) { return std::string(method.name) + ".png"; }
std::string map_name(const ComparedMethod& method) { return std::string(method.name) + "-differences.png"; }

/// Saves the pictures and difference maps of the methods. The first method has no difference map.
void save_pictures(const Comparisons& all, const StagedFolder& folder, const Execution& execution) {
  bool is_first = true;
  for (const Compared& compared : all.methods) {
    const ComparedMethod& method = *compared.run.method;
    // A method that keeps lists sees through glass, so its picture does, too.
    const ShadeOptions options{.background = std::nullopt,
                               .layers = {.see_through = method.lists ? SeeThrough::always : SeeThrough::never}};
    const Image picture = shade(all.surfaces, compared.run.answer.visible, options, execution);
    save(picture, folder.path(picture_name(method)), {}, execution);
    if (!std::exchange(is_first, false))
      save(difference_map(compared, picture), folder.path(map_name(method)), {}, execution);
  }
}

std::string page(const Comparisons& all, const StagedFolder& folder) {
  const std::string model = html_text(all.settings.model);
  std::string text = html_head(all.settings.model + " by all methods", style);
  text += fmt::format(
      "<header><h1>{}</h1><p class=\"lead\">The same question to every visibility method: what can be seen from here? "
      "{} triangles, {}, {}, each method in a process of its own.</p></header><main>\n",
      model, grouped(all.surfaces.primitive_count()), grid_of(all.view, "×"), runs_of(all));
  text += table_of(all);
  text += "<p>" + html_text(culling_text(all)) + "</p>\n";
  text += "<h2>In words</h2><ul>";
  for (const std::string& sentence : advice(all)) text += "<li>" + html_text(sentence) + "</li>";
  text += "</ul>\n<h2>What they see</h2><div class=\"cards\">\n";
  for (const Compared& c : all.methods)
    text += card(data_uri(folder.path(picture_name(*c.run.method))), c.run.method->title, c.run.method->how);
  text += "</div>\n<h2>Where they differ</h2>" + legend() + "<div class=\"cards\">\n";
  for (std::size_t i = 1; i < all.methods.size(); ++i) {
    const Compared& c = all.methods[i];
    text += card(data_uri(folder.path(map_name(*c.run.method))),
                 fmt::format("{} and {}", c.run.method->title, all.methods[0].run.method->title),
                 fmt::format("{} {} differ; each is marked larger than it is.", grouped(c.agreement.differing()),
                             spots(all.view)));
  }
  return text + "</div></main>" + html_foot();
}

}  // namespace

std::vector<std::string> page_names() {
  std::vector<std::string> names;
  for (const ComparedMethod& method : compared_methods()) {
    names.push_back(picture_name(method));
    if (&method != compared_methods().data()) names.push_back(map_name(method));
  }
  names.emplace_back("index.html");
  return names;
}

void write_page(const Comparisons& all, const std::string& folder, const Execution& execution) {
  // One object covers all files, so that an interruption between files removes the finished ones, too.
  const WritingFiles writing;
  const StagedFolder staged(folder);
  try {
    save_pictures(all, staged, execution);
    save_text(page(all, staged), staged.path("index.html"));
  } catch (const Error& error) {
    throw Error(error.code(), staged.told(error.file()), error.place(), error.reason());
  }
  staged.commit(page_names());
}

}  // namespace frontmost::cli
