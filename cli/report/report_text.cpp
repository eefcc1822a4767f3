// SPDX-License-Identifier: Apache-2.0
// The report as a table on the terminal, sorted by visible samples. Each object is listed with its main hider.
#include <fmt/format.h>

#include <algorithm>

#include "cli/console.h"
#include "cli/report/report_run.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t rows_shown = 40, longest_name = 28;

std::string short_text(const std::string& name) { return shortened(printable_name(name), longest_name); }

std::string short_name(const ReportRun& run, std::uint32_t object) {
  return short_text(run.scene().instances[object].name);
}

std::string share_text(double share) { return fmt::format("{:.1f} %", 100 * share); }

/// The columns of a row. The name's column is as wide as the longest name.
constexpr std::string_view layout = "{:>6}  {:<{}}  {:>10}  {:>10}  {:>8}  {:>8}  {:>8}  {:>9}  {}";

std::string row_text(const ReportRun& run, std::uint32_t number, std::size_t width) {
  const ObjectAccount& object = run.accounts.objects[number];
  const std::string row =
      fmt::format(layout, number, short_name(run, number), width, grouped(object.visible.count),
                  grouped(object.alone.count), share_text(object.visible_share()), share_text(object.hidden_share()),
                  share_text(object.cut_share()), distance_text(object), why_text(run, number));
  return row + '\n';
}

}  // namespace

std::string shortened(const std::string& name, std::size_t longest) {
  if (name.size() <= longest) return name;
  std::size_t end = longest - 2;
  while (end > 0 && (std::uint8_t(name[end]) & 0xC0) == 0x80) --end;
  return name.substr(0, end) + "..";
}

std::string report_summary(const ReportRun& run) {
  std::size_t seen = 0, hidden = 0, beyond = 0, nowhere = 0;
  for (const ObjectAccount& object : run.accounts.objects)
    ++(object.visible.count > 0    ? seen
       : object.in_frame.count > 0 ? hidden
       : object.alone.count > 0    ? beyond
                                   : nowhere);
  const std::size_t by_file = run.scene().source.hidden.size();
  const View& view = run.view();
  const PixelBox& canvas = run.accounts.canvas;
  return fmt::format(
      "{} x {} pixels, on a canvas of {} x {}: {} see an object, {} see none\n"
      "{} object{}: {} seen, {} hidden, {} beyond the frame, {} cover no sample{}\n",
      view.width, view.height, canvas.width, canvas.height, grouped(view.pixel_count() - run.accounts.background),
      grouped(run.accounts.background), grouped(run.accounts.objects.size()),
      run.accounts.objects.size() == 1 ? "" : "s", grouped(seen), grouped(hidden), grouped(beyond), grouped(nowhere),
      by_file == 0 ? "" : fmt::format("; {} hidden by the file", grouped(by_file)));
}

std::string distance_text(const ObjectAccount& object) {
  return object.visible.count == 0 ? "" : fmt::format("{:.4g}", object.distance);
}

std::string why_text(const ReportRun& run, std::uint32_t object) {
  const std::string remedy = remedy_text(run.why[object], run.names);
  return reason_text(run.why[object], run.names) + (remedy.empty() ? "" : ": " + remedy);
}

std::string why_text(const ReportRun& run) {
  std::string text;
  for (const std::uint32_t object : objects_asked_for(run.settings, run.scene()))
    text += sentence(run.why[object], run.names) + '\n';
  for (const std::string& name : hidden_asked_for(run.settings, run.scene()))
    text += printable_name(name) + " is hidden by the file.\n";
  return text;
}

std::string report_text(const ReportRun& run) {
  std::string text = report_summary(run);
  std::vector<std::uint32_t> numbers = objects_by_sight(run.accounts);
  const std::vector<std::string>& hidden = run.scene().source.hidden;
  if (numbers.empty() && hidden.empty()) return text;
  const std::size_t shown = std::min(numbers.size(), rows_shown);
  const std::size_t shown_hidden = std::min(hidden.size(), rows_shown);
  std::size_t width = 4;
  for (std::size_t i = 0; i < shown; ++i) width = std::max(width, short_name(run, numbers[i]).size());
  for (std::size_t i = 0; i < shown_hidden; ++i) width = std::max(width, short_text(hidden[i]).size());
  text +=
      '\n' +
      fmt::format(layout, "object", "name", width, "samples", "alone", "visible", "hidden", "cut", "distance", "why") +
      '\n';
  for (std::size_t i = 0; i < shown; ++i) text += row_text(run, numbers[i], width);
  for (std::size_t i = 0; i < shown_hidden; ++i)
    text += fmt::format(layout, "-", short_text(hidden[i]), width, "", "", "", "", "", "", "hidden by the file") + '\n';
  const std::size_t more = numbers.size() - shown + hidden.size() - shown_hidden;
  if (more > 0) text += fmt::format("{} more; --json has all\n", grouped(more));
  return text;
}

}  // namespace frontmost::cli
