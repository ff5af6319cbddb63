#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/written_table.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "tests/folder.hpp"

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

BOOST_AUTO_TEST_SUITE_END()
