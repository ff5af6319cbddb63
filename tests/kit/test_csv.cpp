#include <bit>
#include <cmath>
#include <limits>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(csv)

using namespace qddot;

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

BOOST_AUTO_TEST_CASE(any_text_reads_back_from_fields_and_header) {
  const std::vector<std::string> texts = {"plain", "a,b", "\"", "\"\"", ",\"\n\",", "x\ny", ""};
  Csv csv(texts);
  for (const std::string& text : texts) csv.field(text);
  csv.end_row();
  const Table table = parse_csv(std::string(csv.text()));
  BOOST_TEST(table.names == texts, boost::test_tools::per_element());
  BOOST_TEST_REQUIRE(table.rows.size() == 1);
  BOOST_TEST(table.rows[0] == texts, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(every_double_reads_back_as_the_same_double) {
  std::mt19937_64 random(1);
  std::vector<double> values = {0.1,
                                1.0 / 3,
                                std::nextafter(1.0, 2.0),
                                std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::min(),
                                std::numeric_limits<double>::denorm_min(),
                                -0.0};
  while (values.size() < 2000) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  Csv csv({"x"});
  for (const double value : values) csv.row(value);
  const Table table = parse_csv(std::string(csv.text()));
  BOOST_TEST_REQUIRE(table.rows.size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    BOOST_TEST(std::bit_cast<std::uint64_t>(table.value(i, "x")) ==
               std::bit_cast<std::uint64_t>(values[i]));
  }
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
  const Table table = read_csv(folder / "a.csv");
  BOOST_TEST_REQUIRE(table.rows.size() == 300000u);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i][0] != std::to_string(i)) BOOST_FAIL("row " << i);
  }
}

BOOST_AUTO_TEST_CASE(a_table_whose_sidecar_cannot_be_written_is_refused_at_once) {
  const Folder folder;
  std::filesystem::create_directories(folder / "a.json");
  BOOST_CHECK_THROW(CsvFile(folder / "a.csv", {"i"}), InvalidInput);
  BOOST_TEST(folder.listing() == "a.json ");
}

BOOST_AUTO_TEST_CASE(negative_control_the_reader_refuses_what_is_not_csv) {
  for (const char* text : {"", "a,b\n1\n", "a\n1", "a\nx\"y\"\n", "a\n\"x\"y\n", "a\n\"x\n"}) {
    BOOST_CHECK_THROW(parse_csv(text), std::exception);
  }
  BOOST_CHECK_THROW(number("nan,"), std::exception);
  BOOST_CHECK_THROW(number(""), std::exception);
  BOOST_TEST(number(fmt::format("{:.16g}", std::nextafter(1.0, 2.0))) != std::nextafter(1.0, 2.0));
}

BOOST_AUTO_TEST_SUITE_END()
