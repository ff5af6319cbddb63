#include <cmath>
#include <limits>

#include <boost/test/unit_test.hpp>

#include "experiments/kit/csv.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "tests/folder.hpp"

BOOST_AUTO_TEST_SUITE(written_table)

using namespace qddot;

namespace {

// The message on a file with this text, if the columns a and b are needed.
std::string complaint(const std::string& text) {
  const Folder folder;
  const std::string path = folder.write("x.csv", text);
  try {
    const WrittenTable table(path, {"a", "b"});
    for (std::size_t row = 0; row < table.size(); ++row) table.number(row, "b");
  } catch (const InvalidInput& error) {
    const std::string said = error.what();
    BOOST_TEST(said.starts_with(path));
    return said.substr(path.size());
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_a_table_wrote_reads_back) {
  const std::vector<std::string> texts = {"plain", "a,b", "\"", "\"\"", ",\"\n\",", "x\ny", ""};
  const std::vector<double> values = {0.1,
                                      1.0 / 3,
                                      -0.0,
                                      std::numeric_limits<double>::denorm_min(),
                                      std::numeric_limits<double>::max(),
                                      1e-300,
                                      7};
  Csv csv({"a", "b"});
  for (std::size_t i = 0; i < texts.size(); ++i) csv.row(texts[i], values[i]);
  csv.row("none", std::numeric_limits<double>::quiet_NaN());
  const Folder folder;
  const WrittenTable table(folder.write("x.csv", std::string(csv.text())), {"b", "a"});
  BOOST_TEST_REQUIRE(table.size() == texts.size() + 1);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    BOOST_TEST(table.text(i, "a") == texts[i]);
    BOOST_TEST(table.number(i, "b") == values[i]);
    BOOST_TEST(std::signbit(table.number(i, "b")) == std::signbit(values[i]));
  }
  BOOST_TEST(std::isnan(table.number(texts.size(), "b")));
}

BOOST_AUTO_TEST_CASE(what_is_no_such_table_is_said) {
  BOOST_TEST(complaint("a,b\nx,1\n") == "");
  BOOST_TEST(complaint("a,b\nx,1") == "");
  BOOST_TEST(complaint("") == ": it is empty");
  BOOST_TEST(complaint("a,c\n1,2\n") == ": the column b is missing");
  BOOST_TEST(complaint("a,b\n1,2\n1,2,3\n") == ": row 2 has 3 fields, and the header 2");
  BOOST_TEST(complaint("a,b\n1,2x\n") == ": row 1: b is '2x', which is no number");
}

BOOST_AUTO_TEST_CASE(a_file_that_is_not_there_is_named) {
  BOOST_CHECK_EXCEPTION(WrittenTable("nowhere/x.csv", {}), InvalidInput, [](const auto& error) {
    return error.what() == std::string("nowhere/x.csv: it cannot be read");
  });
}

BOOST_AUTO_TEST_SUITE_END()
