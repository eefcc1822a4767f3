// SPDX-License-Identifier: Apache-2.0
// Names that are not UTF-8, or that terminals would obey, are shown with escapes: \xE9, \x1B.
#include <gmock/gmock.h>

#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A Latin-1 name with an escape sequence that colours a terminal, and a line feed.
const std::string odd = "caf\xE9\x1B[31m\n";
const char* const shown = R"(caf\xE9\x1B[31m\x0A)";

class Names : public ProgramTest {
 protected:
  Names() {
    write(odd + ".obj", "o " + std::string("tr\xE9s\x1B[1m") + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl a\n");
    write(odd + ".stl", cube_stl());
  }
  void expect_harmless(const std::string& text) const {
    EXPECT_THAT(text, Not(HasSubstr("\xE9")));
    EXPECT_THAT(text, Not(HasSubstr("\x1B")));
  }
};

TEST_F(Names, OnTerminalsAndInMessages) {
  const Outcome info = run({"info", odd + ".obj"});
  EXPECT_THAT(info.out, HasSubstr(shown));
  EXPECT_THAT(info.out, HasSubstr(R"(tr\xE9s\x1B[1m)"));
  expect_harmless(info.out);
  const Outcome missing = run({"info", "none-" + odd});
  EXPECT_THAT(missing.err, HasSubstr(std::string("frontmost: none-") + shown + ": cannot open"));
  expect_harmless(missing.err);
  const Outcome blocked = run({"sight", odd + ".obj", "--from", "0.2,0.2,1", "--to", "0.2,0.2,-1"});
  EXPECT_THAT(blocked.out, HasSubstr(R"(tr\xE9s\x1B[1m)"));
  const Outcome hash = run({"render", odd + ".stl", "-o", odd + ".png", "--resolution", "8,8", "--hash"});
  EXPECT_THAT(hash.out, HasSubstr(std::string(shown) + ".png\n"));
  EXPECT_EQ(std::count(hash.out.begin(), hash.out.end(), '\n'), 2) << "a line for each";
}

TEST_F(Names, InJson) {
  const Outcome info = run({"info", odd + ".obj", "--json"});
  EXPECT_EQ(info.json()["name"], "caf\\xE9\x1B[31m\n") << "JSON has its own way to write control characters";
  EXPECT_THAT(info.json()["objects"][0]["name"].get<std::string>(), HasSubstr("tr\\xE9s"));
  const Outcome render = run({"render", odd + ".stl", "-o", odd + ".png", "--resolution", "8,8", "--json"});
  EXPECT_THAT(render.json()["model"].get<std::string>(), HasSubstr("caf\\xE9"));
}

TEST_F(Names, InPagesAndDrawings) {
  ASSERT_EQ(run({"compare", odd + ".stl", "--resolution", "16,16", "--runs", "1", "-o", "page"}).status, 0);
  EXPECT_THAT(read("page/index.html"), HasSubstr(std::string("<h1>") + shown + ".stl</h1>"));
  expect_harmless(read("page/index.html"));
  for (const char* suffix : {"svg", "pdf", "dxf", "json"}) {
    const std::string file = std::string("a.") + suffix;
    ASSERT_EQ(run({"lines", odd + ".obj", "-o", file}).status, 0) << suffix;
    if (std::string(suffix) != "pdf") expect_harmless(read(file));  // streams of a PDF hold arbitrary bytes
  }
  EXPECT_THAT(read("a.svg"), HasSubstr(R"(tr\xE9s\x1B[1m)"));
  ASSERT_EQ(run({"render", odd + ".obj", "-o", "b.svg", "-q"}).status, 0);
  expect_harmless(read("b.svg"));
  EXPECT_EQ(run({"precision", odd + ".obj", "--format", "D8", "--plot", "c.svg"}).status, 0);
  expect_harmless(read("c.svg"));
}

}  // namespace
}  // namespace frontmost::test
