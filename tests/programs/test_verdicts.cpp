#include <map>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(verdicts)

using namespace qddot;

namespace {

Exit run_verdicts(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.end(), {"--out", folder / "out"});
  return run("verdicts", words);
}

}  // namespace

BOOST_AUTO_TEST_CASE(verdicts_are_seldom_wrong_and_intervals_hold_what_is_true) {
  const Folder folder;
  const Exit result = run_verdicts(folder, {"--seeds", "3", "--cells", "512"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(listing(folder / "out") == "confusion.csv confusion.json coverage.csv coverage.json ");
  const Table confusion = read_csv(folder / "out/confusion.csv");
  BOOST_TEST(confusion.header == "kind,verdict,count,part,judgement");
  std::map<std::string, double> counts, right, judged;
  double all = 0;
  for (std::size_t i = 0; i < confusion.rows.size(); ++i) {
    const double count = confusion.value(i, "count");
    all += count;
    counts[confusion.text(i, "kind")] += count;
    judged[confusion.text(i, "judgement")] += count;
    if (confusion.text(i, "judgement") == "right") right[confusion.text(i, "kind")] += count;
  }
  for (const auto& [kind, count] : counts) BOOST_TEST(count == 3, kind);
  // One in twenty may be wrong: more than 11 of a hundred are, once in 250 times.
  BOOST_TEST(all > 100);
  BOOST_TEST(judged["wrong"] <= 11);
  // Each of these is told nearly always.
  for (const char* kind : {"noise", "sine, period T/4", "large drift over noise",
                           "loss of a third, exponential", "loss of 0.3 in the first fifth",
                           "amplitude that grows as t", "blow-up", "round-off walk"}) {
    BOOST_TEST(right[kind] >= 2, kind);
  }
  // And a walk is never claimed to be anything.
  BOOST_TEST(right["random walk"] == 0);

  const Table coverage = read_csv(folder / "out/coverage.csv");
  BOOST_TEST(coverage.header == "kind,what,said,held,part,part_low,part_high");
  double said = 0, held = 0;
  for (std::size_t i = 0; i < coverage.rows.size(); ++i) {
    said += coverage.value(i, "said");
    held += coverage.value(i, "held");
    BOOST_TEST(coverage.value(i, "part_low") <= coverage.value(i, "part"));
  }
  // Fewer than 134 of 150 that hold by 95 % come once in 300 times; there are more.
  BOOST_TEST(said > 150);
  BOOST_TEST(held > 0.89 * said);
  const auto origin = nlohmann::json::parse(read_all(folder / "out/confusion.json"));
  BOOST_TEST(origin.at("seeds") == 3);
  BOOST_TEST(origin.at("walk_size").contains("random walk"));
}

BOOST_AUTO_TEST_SUITE_END()
