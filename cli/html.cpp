// SPDX-License-Identifier: Apache-2.0
#include "cli/html.h"

#include <fmt/format.h>
#include <frontmost/base.h>
#include <frontmost/version.h>

#include <fstream>
#include <iterator>

namespace frontmost::cli {
namespace {

constexpr const char* page_style = R"(:root { color-scheme: light dark; --ground: #f6f5f2; --card: #fff; --ink: #1d1f23;
  --soft: #5d636e; --line: #e2e0da; --accent: #b4521b; --stage: radial-gradient(circle at 50% 35%, #fff, #e4e6ea); }
@media (prefers-color-scheme: dark) { :root { --ground: #15171b; --card: #1e2127; --ink: #eceae5; --soft: #9aa1ad;
  --line: #2e323a; --accent: #f0a06a; --stage: radial-gradient(circle at 50% 35%, #464c57, #23262d); } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink); font: 16px/1.55 system-ui, sans-serif; }
header, main, footer { max-width: 1280px; margin: 0 auto; padding: 0 24px; }
header { padding-top: 48px; }
h1 { font-size: clamp(2rem, 5vw, 3.2rem); letter-spacing: -0.03em; line-height: 1.05; margin: 0 0 12px;
  overflow-wrap: anywhere; }
h2 { font-size: 1.5rem; letter-spacing: -0.015em; margin: 48px 0 6px; }
h3 { font-size: 1.05rem; margin: 0 0 2px; }
p, li { margin: 0 0 10px; color: var(--soft); }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 14px;
  padding: 6px 20px; margin-top: 16px; }
code { font: 0.85rem ui-monospace, Menlo, monospace; }
footer { padding: 40px 24px; color: var(--soft); font-size: 0.9rem; }
)";

std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : printable_text(text)) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      default: result += c;
    }
  }
  return result;
}

std::string data_uri(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return "data:image/png;base64," + base64(bytes);
}

std::string html_head(std::string_view title, std::string_view style) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>{}</title><style>\n{}{}</style></head><body>\n",
      html_text(title), page_style, style);
}

std::string html_foot() { return "<footer>frontmost " FRONTMOST_VERSION "</footer></body></html>\n"; }

}  // namespace frontmost::cli
