#include <bit>
#include <cfloat>
#include <cmath>
#include <random>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "tests/folder.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(csv)

using namespace qddot;

namespace {

// The message on a file with this text, if the columns a and b are needed.
std::string complaint(const std::string& text) {
  const Folder folder;
  const std::string path = folder.write("x.csv", text);
  const std::string said = refusal_of([&] {
    const WrittenTable table(path, {"a", "b"});
    for (std::size_t row = 0; row < table.size(); ++row) table.number(row, "b");
  });
  BOOST_TEST((said.empty() || said.starts_with(path)));
  return said.empty() ? "" : said.substr(path.size());
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_row_is_its_fields_between_commas) {
  Csv csv({"name", "count", "value"});
  csv.row("a", 3, 0.5);
  csv.row(std::string("b"), std::int64_t(-7), 2.0);
  BOOST_TEST(csv.text() == "name,count,value\na,3,0.5\nb,-7,2\n");
}

BOOST_AUTO_TEST_CASE(text_is_quoted_only_where_it_must_be) {
  const auto written = [](const char* text) {
    Csv csv({"h"});
    csv.clear();
    csv.row(text, 1);
    return std::string(csv.text());
  };
  BOOST_TEST(written("a b;c'd") == "a b;c'd,1\n");
  BOOST_TEST(written("a,b") == "\"a,b\",1\n");
  BOOST_TEST(written("say \"x\"") == "\"say \"\"x\"\"\",1\n");
  BOOST_TEST(written("\"") == "\"\"\"\",1\n");
  BOOST_TEST(written("two\nlines") == "\"two\nlines\",1\n");
  BOOST_TEST(written("a\rb") == "\"a\rb\",1\n");
  BOOST_TEST(written("") == ",1\n");
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_an_empty_field) {
  Csv csv({"a", "b", "c", "d"});
  csv.row(std::nan(""), HUGE_VAL, -HUGE_VAL, 1.0);
  csv.row(1.0, std::nan(""), 2.0, std::nan(""));
  BOOST_TEST(csv.text() == "a,b,c,d\n,,,1\n1,,2,\n");
}

BOOST_AUTO_TEST_CASE(a_file_appears_with_all_its_rows_on_commit) {
  const Folder folder;
  CsvFile csv(folder / "a.csv", {"i"});
  for (int i = 0; i < 300000; ++i) {
    csv.row(i);
    csv.flush_if_large();
  }
  BOOST_TEST(csv.text().size() < (1u << 20));  // flushed along the way
  BOOST_TEST(!std::filesystem::exists(csv.path()));
  csv.commit({{"origin", "here"}});
  BOOST_TEST(folder.listing() == "a.csv a.json ");
  BOOST_TEST(nlohmann::json::parse(read_all(folder / "a.json")).at("origin") == "here");
  const WrittenTable table(folder / "a.csv", {"i"});
  BOOST_TEST_REQUIRE(table.size() == 300000u);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.text(i, "i") != std::to_string(i)) BOOST_FAIL("row " << i);
  }
}

BOOST_AUTO_TEST_CASE(a_table_whose_sidecar_cannot_be_written_is_refused_at_once) {
  const Folder folder;
  std::filesystem::create_directories(folder / "a.json");
  BOOST_CHECK_THROW(CsvFile(folder / "a.csv", {"i"}), InvalidInput);
  BOOST_TEST(folder.listing() == "a.json ");
}

BOOST_AUTO_TEST_CASE(any_text_and_every_double_read_back) {
  const std::vector<std::string> texts = {"plain", "a,b", "\"", "\"\"", ",\"\n\",", "x\ny", ""};
  std::vector<double> values = {0.1, 1.0 / 3, 0x1.0000000000001p0, DBL_MAX, DBL_MIN, 5e-324, -0.0};
  std::mt19937_64 random(1);
  while (values.size() < 2000) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  Csv csv({"a", "b"});
  for (std::size_t i = 0; i < values.size(); ++i) csv.row(texts[i % texts.size()], values[i]);
  csv.row("none", std::nan(""));
  const Folder folder;
  const WrittenTable table(folder.write("x.csv", std::string(csv.text())), {"b", "a"});
  BOOST_TEST_REQUIRE(table.size() == values.size() + 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    BOOST_TEST(table.text(i, "a") == texts[i % texts.size()]);
    BOOST_TEST(std::bit_cast<std::uint64_t>(table.number(i, "b")) ==
               std::bit_cast<std::uint64_t>(values[i]));
  }
  BOOST_TEST(std::isnan(table.number(values.size(), "b")));
}

BOOST_AUTO_TEST_CASE(what_is_no_such_table_is_said) {
  BOOST_TEST(complaint("a,b\nx,1\n") == "");
  BOOST_TEST(complaint("a,b\nx,1") == "");
  BOOST_TEST(complaint("") == ": it is empty");
  BOOST_TEST(complaint("a,c\n1,2\n") == ": the column b is missing");
  BOOST_TEST(complaint("a,b\n1,2\n1,2,3\n") == ": row 2 has 3 fields, and the header 2");
  BOOST_TEST(complaint("a,b\n1,2x\n") == ": row 1: b is '2x', which is no number");
  BOOST_TEST(refusal_of([] { WrittenTable("nowhere/x.csv", {}); }) ==
             "nowhere/x.csv: it cannot be read");
}

BOOST_AUTO_TEST_SUITE_END()
