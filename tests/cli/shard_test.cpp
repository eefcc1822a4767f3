// SPDX-License-Identifier: Apache-2.0
// Shards of a batch: together they make the batch; finished views are not drawn again, and unfinished ones are.
#include <gmock/gmock.h>

#include <map>

#include "cli/render/manifest.h"
#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::string shard_line = "render cube.stl --batch v.json --resolution 40,30 --samples 1 ";

class Shards : public ProgramTest {
 protected:
  Shards() {
    write("cube.stl", cube_stl());
    write_views(10);
  }

  void write_views(int count, const std::string& of_third = "") const {
    std::string views;
    for (int i = 0; i < count; ++i)
      views += (i ? ",\n" : "") + std::string(R"({"camera-direction": [1, )") + std::to_string(i) + ", -2]" +
               (i == 3 ? of_third : "") + "}";
    write("v.json",
          "{\"views\": [" + views + "], \"outputs\": {\"output\": \"{model}_{view}.pfm\", \"depth\": \"{view}.npy\"}}");
  }

  /// Numbers of the views that a run draws, without those that were finished before.
  std::vector<std::string> drawn(const std::string& options) const {
    std::vector<std::string> names;
    const nlohmann::json report = succeed(shard_line + options + " --json").json();
    for (const auto& view : report["views"]) names.push_back(view["name"]);
    return names;
  }
  /// All files that were made, except manifests.
  [[nodiscard]] std::map<std::string, std::string> made() const {
    std::map<std::string, std::string> result;
    for (const std::string& name : files())
      if (name.ends_with(".npy") || name.ends_with(".pfm")) result[name] = read(name);
    return result;
  }
  void remove_made() const {
    for (const std::string& name : files())
      if (name != "cube.stl" && name != "v.json") std::filesystem::remove(path(name));
  }
};

const std::vector<std::string> first_third = {"0", "3", "6", "9"};

TEST_F(Shards, MakeTheBatchTogether) {
  succeed(shard_line);
  const auto whole = made();
  ASSERT_EQ(whole.size(), 20u);
  remove_made();
  EXPECT_EQ(drawn("--shard 1/3"), first_third);
  EXPECT_EQ(made().size(), 8u);
  EXPECT_EQ(drawn("--shard 2/3"), (std::vector<std::string>{"1", "4", "7"}));
  EXPECT_EQ(drawn("--shard 3/3"), (std::vector<std::string>{"2", "5", "8"}));
  EXPECT_EQ(made(), whole);
  EXPECT_THAT(succeed("batch-merge .").out, HasSubstr("10 views, 20 files, "));
  EXPECT_THAT(drawn("--shard 12/20"), IsEmpty());  // more shards than views
}

TEST_F(Shards, StreamsAndWholeModelsAreTheSame) {
  EXPECT_EQ(drawn("--shard 1/3"), first_third);
  EXPECT_THAT(drawn("--shard 1/3 --stream"), IsEmpty());
}

TEST_F(Shards, FinishedViewsAreSkipped) {
  EXPECT_EQ(drawn("--shard 1/3"), first_third);
  const std::string manifest = read("cube.v.1-of-3.jsonl");
  for (const char* same : {"", "--threads 2", "--isa scalar", "--hash", "--quiet"}) {
    EXPECT_THAT(succeed(shard_line + "--shard 1/3 " + same).out, IsEmpty());
    EXPECT_EQ(read("cube.v.1-of-3.jsonl"), manifest);
  }
  EXPECT_EQ(succeed(shard_line + "--shard 1/3 --json").json()["finished_before"], 4);
}

TEST_F(Shards, WhatIsChangedIsMadeAgain) {
  EXPECT_EQ(drawn("--shard 1/3"), first_third);
  std::filesystem::remove(path("3.npy"));
  EXPECT_EQ(drawn("--shard 1/3"), (std::vector<std::string>{"3"}));
  std::string depths = read("6.npy");
  depths.back() ^= 1;  // of the same length as before
  write("6.npy", depths);
  EXPECT_EQ(drawn("--shard 1/3"), (std::vector<std::string>{"6"}));
  write_views(10, ", \"cull\": \"back\"");
  EXPECT_EQ(drawn("--shard 1/3"), (std::vector<std::string>{"3"}));
  EXPECT_EQ(drawn("--shard 1/3 --shading flat"), first_third);
  EXPECT_THAT(drawn("--shard 1/3 --shading flat"), IsEmpty());
  EXPECT_EQ(drawn("--shard 1/3"), first_third);
  write("cube.stl", cube_stl(0.25f));  // of the same length as before
  EXPECT_EQ(drawn("--shard 1/3"), first_third);
  EXPECT_THAT(drawn("--shard 1/3"), IsEmpty());
}

// A changed file counts, although its name is the same.
TEST_F(Shards, PosesAndEnvironmentsInFilesCount) {
  const auto pose = [&](const char* x) { write("pose.txt", "1 0 0 " + std::string(x) + " 0 1 0 0 0 0 1 5 0 0 0 1\n"); };
  const std::string posed =
      "--batch p.json --shard 1/1 --pose pose.txt --pose-convention opencv-world-to-camera --intrinsics 30,30,20,15 ";
  write("p.json", R"({"views": [{}], "outputs": {"output": "p.png"}})");
  const auto is_drawn = [&](const std::string& options) {
    return !succeed("render cube.stl --resolution 40,30 --json " + options).json()["views"].empty();
  };
  pose("0");
  EXPECT_TRUE(is_drawn(posed));
  EXPECT_FALSE(is_drawn(posed));
  pose("1");
  EXPECT_TRUE(is_drawn(posed));
  succeed("render cube.stl --resolution 16,8 -o sky.pfm");
  const std::string lit = "--batch p.json --shard 1/1 --environment sky.pfm";
  EXPECT_TRUE(is_drawn(lit));
  EXPECT_FALSE(is_drawn(lit));
  succeed("render cube.stl --resolution 16,8 -o sky.pfm --background black");
  EXPECT_TRUE(is_drawn(lit));
}

// A line counts only with its last byte, wherever a run ended.
TEST_F(Shards, ManifestsThatAreCutShortLoseTheirLastView) {
  succeed(shard_line + "--shard 1/5");
  const auto whole = made();
  const std::string name = "cube.v.1-of-5.jsonl", manifest = read(name);
  const std::size_t first = manifest.find('\n') + 1, second = manifest.find('\n', first) + 1;
  ASSERT_EQ(manifest.find('\n', second), manifest.size() - 1);
  for (const auto& [size, count] : std::map<std::size_t, std::size_t>{
           {0, 2}, {first, 2}, {first + 9, 2}, {second - 1, 2}, {second, 1}, {manifest.size() - 1, 1}}) {
    write(name, manifest.substr(0, size));
    EXPECT_EQ(drawn("--shard 1/5").size(), count) << size;
    EXPECT_EQ(read(name), manifest);
    EXPECT_EQ(made(), whole);
  }
  std::string broken = manifest;
  broken[first + 3] = '\0';
  write(name, broken);
  EXPECT_EQ(drawn("--shard 1/5").size(), 1u);
}

TEST_F(Shards, KilledRunsGoOnWhereTheyEnded) {
  write_views(120);
  succeed(shard_line + "--shard 1/2");
  const auto whole = made();
  remove_made();
  for (const char* seconds : {"0.01", "0.05", "0.1"}) {
    const std::string command = "cd '" + path("") + "' && timeout -s KILL " + seconds + " " FRONTMOST_PROGRAM " " +
                                shard_line + "--shard 1/2 2> err";
    (void)std::system(command.c_str());
    for (const auto& [name, bytes] : made()) EXPECT_EQ(bytes, whole.at(name)) << name;
  }
  succeed(shard_line + "--shard 1/2");
  EXPECT_EQ(made(), whole);
}

TEST_F(Shards, AreRefusedWhereNothingCouldBeTold) {
  expect_failure("render cube.stl -o c.png --shard 1/2", 2, "--shard needs --batch");
  expect_failure(shard_line + "--shard 0/2", 2, "--shard: 0 is not between 1 and");
  expect_failure(shard_line + "--shard 3/2", 2, "--shard: 3/2: there are only 2 shards");
  expect_failure(shard_line + "--shard 3", 2, "'3' is not K/N, such as 3/16");
  expect_failure(shard_line + "--shard 1/2 --reference cube.png", 2, "view 0 has a --reference");
  expect_failure("render - --batch v.json --shard 1/2", 2, "a model from standard input");
  write("none.json", R"({"views": [{"outputs": {"hash": true}}]})");
  expect_failure("render cube.stl --batch none.json --shard 1/2", 2, "view 0 has no output file");
  write("cube.v.1-of-2.jsonl", "my own\n");
  expect_failure(shard_line + "--shard 1/2", 1, "cube.v.1-of-2.jsonl: line 1: this is not a manifest");
  EXPECT_EQ(read("cube.v.1-of-2.jsonl"), "my own\n");
  write("taken.json", R"({"views": [{}], "outputs": {"depth": "cube.taken.1-of-1.jsonl"}})");
  expect_failure("render cube.stl --batch taken.json --shard 1/1 --format npy", 2, "would be written twice");
}

class Merging : public Shards {
 protected:
  Merging() {
    for (const char* folder : {"a", "b"}) std::filesystem::create_directory(path(folder));
    for (const char* shard : {"1/3", "3/3"}) draw("a", shard);
    draw("b", "2/3");
  }
  void draw(const std::string& folder, const std::string& shard, const std::string& options = "") const {
    const std::string command = "cd '" + path(folder) +
                                "' && " FRONTMOST_PROGRAM
                                " render ../cube.stl --batch ../v.json "
                                "--resolution 40,30 --samples 1 --shard " +
                                shard + " " + options;
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
};

TEST_F(Merging, GathersTheFilesOfAllFolders) {
  expect_failure("batch-merge a", 1, "3 of 10 views are not finished: views[1], views[4], views[7]");
  const auto merged = succeed("batch-merge a b -o all/of/them --json").json();
  EXPECT_EQ(merged["views"], 10);
  EXPECT_EQ(merged["files"], 20);
  EXPECT_EQ(merged["manifests"].size(), 3u);
  succeed(shard_line);
  for (const auto& [name, content] : made()) EXPECT_EQ(read("all/of/them/" + name), content) << name;
  EXPECT_FALSE(exists("all/of/them/cube.v.1-of-3.jsonl"));
  const std::string before = read("all/of/them/cube.v.1-of-1.jsonl");
  // All views count as finished, from whatever folder the batch file and the model are named.
  for (const char* name : {"cube.stl", "v.json"}) std::filesystem::copy_file(path(name), path("all/of/") + name);
  draw("all/of/them", "1/1");
  EXPECT_EQ(read("all/of/them/cube.v.1-of-1.jsonl"), before);
  // Manifests are copied singly; over existing ones; and into one of the source folders.
  for (const char* to : {"all/of/them", "a"})
    EXPECT_THAT(succeed("batch-merge a/cube.v.1-of-3.jsonl b a/cube.v.3-of-3.jsonl -o " + std::string(to)).out,
                HasSubstr("10 views, 20 files"));
}

TEST_F(Merging, LeavesNothingWhereAPartIsMissingOrDamaged) {
  std::filesystem::resize_file(path("b/4.npy"), 100);
  expect_failure("batch-merge a b -o all", 1, "b/4.npy: differs from its entry in b/cube.v.2-of-3.jsonl");
  draw("b", "2/3");
  draw("b", "2/3", "--shading flat");
  expect_failure("batch-merge a b -o all", 1,
                 "b/cube.v.2-of-3.jsonl: has another model, batch file, version or other options than");
  EXPECT_FALSE(exists("all"));
  expect_failure("batch-merge cube.stl", 1, "cube.stl: line 1: this is not a manifest");
  expect_failure("batch-merge nowhere", 1, "nowhere: ");
  std::filesystem::create_directory(path("empty"));
  expect_failure("batch-merge empty", 1,
                 "empty: the folder has no manifest of a batch; give a folder in which frontmost render --shard ran");
  expect_failure("batch-merge", 2, "no PART given");
}

TEST_F(Merging, FilesInFoldersKeepThem) {
  write("v.json", R"({"views": [{"name": "x"}, {"name": "y"}], "outputs": {"depth": "sub/{view}.npy"}})");
  std::filesystem::create_directory(path("a/sub"));
  for (const char* shard : {"1/2", "2/2"}) draw("a", shard);
  succeed("batch-merge a/cube.v.1-of-2.jsonl a/cube.v.2-of-2.jsonl -o all");
  EXPECT_EQ(read("all/sub/y.npy"), read("a/sub/y.npy"));
  write("v.json", R"({"views": [{"name": "x"}], "outputs": {"depth": "../{view}.npy"}})");
  draw("a", "1/1");
  succeed("batch-merge a/cube.v.1-of-1.jsonl");
  expect_failure("batch-merge a/cube.v.1-of-1.jsonl -o other", 1, "../x.npy: lies outside the folder");
  EXPECT_FALSE(exists("other"));
}

TEST(Manifests, NamesAreTold) {
  EXPECT_EQ(cli::manifest_name("a.views", {3, 16}), "a.views.3-of-16.jsonl");
  EXPECT_EQ(cli::stem_of_manifest("a.views.3-of-16.jsonl"), "a.views");
  for (const char* other :
       {"a.jsonl", "a.3-of-.jsonl", "a.-of-3.jsonl", ".3-of-4.jsonl", "a.3-of-4.json", "a.x-of-4.jsonl"})
    EXPECT_FALSE(cli::stem_of_manifest(other)) << other;
}

}  // namespace
}  // namespace frontmost::test
