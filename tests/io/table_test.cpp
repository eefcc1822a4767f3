// SPDX-License-Identifier: Apache-2.0
// Tables as files: the text of CSV, the bytes of NPY, and tables that neither accepts.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "frontmost/files.h"
#include "support/scratch_folder.h"

namespace frontmost::test {
namespace {

class Tables : public testing::Test {
 protected:
  [[nodiscard]] std::string written(const Table& table, TableFormat format) const {
    save(table, path_, format);
    return load_text(path_, 1 << 24);
  }
  const test::ScratchFolder folder_;
  const std::string path_ = folder_.file("table");
  const Table table_{{{"small", std::vector<std::uint8_t>{255, 0}},
                      {"whole", std::vector<std::uint32_t>{7, 4294967295u}},
                      {"real", std::vector<double>{0.1, -1e-300}}}};
};

TEST_F(Tables, CsvHasNamesAndNumbersThatReadBackTheSame) {
  EXPECT_EQ(written(table_, TableFormat::csv), "small,whole,real\n255,7,0.1\n0,4294967295,-1e-300\n");
  EXPECT_EQ(written({{{"none", std::vector<double>{}}}}, TableFormat::csv), "none\n");
}

TEST_F(Tables, NpyIsAnArrayOfPackedRecords) {
  const std::string bytes = written(table_, TableFormat::npy);
  EXPECT_THAT(bytes, testing::HasSubstr("{'descr': [('small', '|u1'), ('whole', '<u4'), ('real', '<f8')], "
                                        "'fortran_order': False, 'shape': (2,), }"));
  constexpr std::size_t record = 1 + 4 + 8;
  ASSERT_EQ((bytes.size() - 2 * record) % 64, 0u);
  const char* const second = bytes.data() + bytes.size() - record;
  EXPECT_EQ(second[-std::ptrdiff_t(record)], '\xFF');
  EXPECT_EQ(std::string(second + 1, 4), "\xFF\xFF\xFF\xFF");
  double real = 0;
  std::memcpy(&real, second + 5, sizeof real);
  EXPECT_EQ(real, -1e-300);
}

TEST_F(Tables, LongOnesAreWhole) {
  std::vector<std::uint32_t> numbers(400'000);
  for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  const std::string text = written({{{"number", std::move(numbers)}}}, TableFormat::csv);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 400'001);
  EXPECT_TRUE(text.ends_with("\n399999\n"));
}

TEST_F(Tables, OddOnesAreRefusedAndLeaveNothing) {
  Table uneven = table_;
  std::get<std::vector<double>>(uneven.columns[2].values).pop_back();
  EXPECT_THROW(save(uneven, path_, TableFormat::csv), Error);
  for (const char* name : {"", "a,b", "it's"})
    EXPECT_THROW(save({{{name, std::vector<double>{}}}}, path_, TableFormat::npy), Error);
  EXPECT_THROW(save(table_, testing::TempDir() + "no/such/folder", TableFormat::csv), Error);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace frontmost::test
