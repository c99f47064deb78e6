#include "spherical_actuator_calibration/base/csv_file.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/error_message.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

class Csv : public testing::Test {
 protected:
  CsvFile load(const std::string& text, std::size_t most_rows = 10) const {
    std::ofstream(path()) << text;
    return loadCsv(path(), most_rows);
  }
  std::string errorOf(const std::string& text) const {
    return errorMessage<ConfigError>([&] { load(text); });
  }
  std::string path() const { return folder_.path("numbers.csv"); }

 private:
  TemporaryFolder folder_;
};

TEST_F(Csv, ReadsLinesOfNumbers) {
  const CsvFile file = load("# angles\nq1, q2\n1.5,-2e-3\r\n\n 3 , 4\n");
  EXPECT_TRUE(file.has_heading);
  ASSERT_EQ(file.rows.size(), 2U);
  EXPECT_EQ(file.rows[0].values, (std::vector<double>{1.5, -2e-3}));
  EXPECT_EQ(file.rows[1].values, (std::vector<double>{3.0, 4.0}));
  EXPECT_EQ(file.rows[1].place, path() + ":5");
  EXPECT_FALSE(load("1,2").has_heading);
}

TEST_F(Csv, SkipsAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  // Of one column, the first number would be taken for a name, and lost without a word.
  for (const char* text : {"1\n2\n", "1,5\n2,6\n", "q1\n1\n2\n"}) {
    const CsvFile marked = load(mark + text);
    const CsvFile plain = load(text);
    EXPECT_EQ(marked.has_heading, plain.has_heading) << text;
    ASSERT_EQ(marked.rows.size(), 2U) << text;
    EXPECT_EQ(marked.rows[0].values, plain.rows[0].values) << text;
  }
  EXPECT_NE(errorOf(mark).find("there is no line of numbers"), std::string::npos);
  EXPECT_THROW(load("1\n" + mark + "2\n"), ConfigError);
}

TEST_F(Csv, NamesTheLineOfWhatIsNoNumber) {
  EXPECT_NE(errorOf("1,2\n1,x\n").find("numbers.csv:2: \"x\" is not a finite number"),
            std::string::npos);
  EXPECT_NE(errorOf("1,2\na,b\n").find("numbers.csv:2"), std::string::npos);
  for (const char* line : {"1,", "1;2", "nan,1", "1,inf", "1 2", "0x10,1", "1e999,0"}) {
    EXPECT_NE(errorOf(line).find("numbers.csv:1"), std::string::npos) << line;
  }
}

TEST_F(Csv, RefusesWhatHoldsNoneOrTooMany) {
  EXPECT_NE(errorOf("# only words\na,b\n").find("there is no line of numbers"), std::string::npos);
  EXPECT_NE(
      errorMessage<ConfigError>([&] { load("1\n2\n3\n", 2); }).find("numbers.csv:3: more than 2"),
      std::string::npos);
  EXPECT_THROW(loadCsv(path() + ".none", 1), ConfigError);
}

TEST_F(Csv, NamesTheLineWithAnotherNumberOfColumns) {
  const CsvFile file = load("1,2,3\n1,2\n");
  file.rows[0].requireColumns(3);
  EXPECT_NE(errorMessage<ConfigError>([&] {
              file.rows[1].requireColumns(3);
            }).find("numbers.csv:2: 2 numbers; 3 are needed"),
            std::string::npos);
}

}  // namespace
}  // namespace sac
