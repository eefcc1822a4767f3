// SPDX-License-Identifier: Apache-2.0
// Content of the page of frontmost report. report_page.py clicks on it.
#include <gmock/gmock.h>

#include <map>

#include "report_squares.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

using ReportPage = ReportTest;

/// Text between `before` and `behind`; empty if either is missing.
std::string between(const std::string& text, const std::string& before, const std::string& behind) {
  const std::size_t begin = text.find(before);
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + before.size(), end = text.find(behind, from);
  return end == std::string::npos ? "" : text.substr(from, end - from);
}

/// The first element that is unclosed or closed in the wrong place, or an attribute without quotes; empty if all is
/// well. Scripts and styles are skipped.
std::string fault_of(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) return "no end: " + page.substr(at, 40);
    const std::string tag = page.substr(at + 1, end - at - 1), name = tag.substr(0, tag.find_first_of(" /"));
    at = end + 1;
    if (tag[0] == '!') continue;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "closed: " + tag;
      open.pop_back();
      continue;
    }
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "quotes: " + tag;
    if (tag.back() == '/' || name == "meta" || name == "img" || name == "input") continue;
    open.push_back(name);
    if (name == "script" || name == "style") at = page.find("</" + name + ">", at);
  }
  return open.empty() ? "" : "open: " + open.back();
}

/// The numbers that the page embeds.
json data_of(const std::string& page) { return json::parse(between(page, "id=\"data\">", "</script>")); }

TEST_F(ReportPage, ThePageHasThePictureTheNumbersAndTheMasks) {
  const json told = succeed(std::string("report squares.obj -o page.html --json") + view).json();
  EXPECT_EQ(told["files"], json({"page.html"}));
  const std::string page = read("page.html");
  EXPECT_EQ(fault_of(page), "");
  EXPECT_THAT(page, HasSubstr("<img src=\"data:image/png;base64,iVBORw0KGgo"));
  EXPECT_THAT(page, HasSubstr("<td>33</td><td>36</td><td>36</td><td>91.7 %</td><td>8.3 %</td><td>0.0 %</td>"));
  const json data = data_of(page);
  ASSERT_EQ(data["objects"].size(), 3u);
  EXPECT_FALSE(data["objects"][2].contains("mask")) << "it is far away";
  EXPECT_EQ(data["objects"][0]["hidden_by"], json({{1, 3}}));
  EXPECT_EQ(data["objects"][0]["alone"], told["objects"][0]["alone"]);
  // A mask of 6 x 6 pixels; the last pixels of the first, second and third row are hidden.
  EXPECT_EQ(data["objects"][0]["mask"], json({0, 0, 5, 0, 1, 5, 0, 1, 5, 0, 1, 18}));
  std::map<int, int> shown;
  for (std::size_t i = 0; i < data["map"].size(); i += 2) shown[data["map"][i]] += int(data["map"][i + 1]);
  EXPECT_EQ(shown, (std::map<int, int>{{0, 55}, {1, 33}, {2, 12}}));
  EXPECT_THAT(page, HasSubstr("<title>near hides 3 samples of far</title>"));
  EXPECT_EQ(files(), (std::vector<std::string>{"page.html", "squares.obj"}));
}

TEST_F(ReportPage, ThePageNeedsNothingElse) {
  ASSERT_EQ(run({"report", "squares.obj", "-o", "page.html"}).status, 0);
  const std::string page = read("page.html");
  for (const char* word : {"http:", "https:", "href", "@import", "src=\"/", "fetch(", "eval(", "innerHTML"})
    EXPECT_THAT(page, Not(HasSubstr(word)));
  EXPECT_THAT(page, HasSubstr("prefers-color-scheme: dark"));
  EXPECT_THAT(page, HasSubstr("name=\"viewport\" content=\"width=device-width"));
}

TEST_F(ReportPage, NamesInThePageAreText) {
  const std::string name = "</script><b onclick='x'>\"&\xff\x01";
  write("a<i>.obj", "o " + name + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(run({"report", "a<i>.obj", "--resolution", "32,24", "-o", "page.html"}).status, 0);
  const std::string page = read("page.html");
  EXPECT_EQ(fault_of(page), "");
  EXPECT_THAT(page, Not(HasSubstr("<b ")));
  EXPECT_THAT(page, Not(HasSubstr("<i>.obj")));
  EXPECT_THAT(page, HasSubstr("<h1>a&lt;i&gt;.obj</h1>"));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;b onclick=&#39;x&#39;&gt;&quot;&amp;\\xFF\\x01"));
  EXPECT_EQ(data_of(page)["objects"][0]["name"], "</script><b onclick='x'>\"&\\xFF\\x01");
}

TEST_F(ReportPage, ThePageIsWrittenWholeOrNotAtAll) {
  write("old.html", "old");
  expect_failure("report squares.obj -o squares.obj", 2, "is the model itself");
  expect_failure("report squares.obj -o none/page.html", 1, "none");
  expect_failure("report squares.obj --json -o -", 2, "both write to standard output");
  expect_failure("report missing.obj -o old.html", 1, "missing.obj");
  EXPECT_EQ(read("old.html"), "old");
  EXPECT_THAT(run({"report", "squares.obj", "-o", "-"}).out, testing::EndsWith("</html>\n"));
}

TEST_F(ReportPage, AnEmptyPageIsAPageToo) {
  write("empty.obj", "v 0 0 0\n");
  ASSERT_EQ(run({"report", "empty.obj", "--resolution", "10,10", "-o", "page.html"}).status, 0);
  EXPECT_EQ(fault_of(read("page.html")), "");
  EXPECT_THAT(read("page.html"), Not(HasSubstr("Who hides whom")));
}

}  // namespace
}  // namespace frontmost::test
