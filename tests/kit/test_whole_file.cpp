#include <boost/test/unit_test.hpp>

#include "experiments/kit/whole_file.hpp"
#include "tests/folder.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(whole_file)

using namespace qddot;

namespace {

std::string refusal(const std::string& path) {
  return refusal_of([&] { WholeFile file(path); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(nothing_stands_at_its_place_before_the_commit) {
  const Folder folder;
  WholeFile file(folder / "a.txt");
  file.write("half");
  BOOST_TEST(!std::filesystem::exists(folder / "a.txt"));
  file.write(" and half");
  file.complete();
  BOOST_TEST(!std::filesystem::exists(folder / "a.txt"));
  file.commit();
  BOOST_TEST(folder.listing() == "a.txt ");
  BOOST_TEST(read_all(folder / "a.txt") == "half and half");
  { WholeFile(folder / "b.txt").write("half"); }  // which is not committed
  BOOST_TEST(folder.listing() == "a.txt ");
}

BOOST_AUTO_TEST_CASE(an_older_file_stays_until_the_commit_and_goes_with_it) {
  const Folder folder;
  folder.write("a.txt", "old");
  { WholeFile(folder / "a.txt", "old").write("lost"); }
  BOOST_TEST(read_all(folder / "a.txt") == "old");
  WholeFile file(folder / "a.txt", "old");
  file.write("new");
  BOOST_TEST(read_all(folder / "a.txt") == "old");
  file.commit();
  BOOST_TEST(read_all(folder / "a.txt") == "new");
  BOOST_TEST(folder.listing() == "a.txt ");
}

BOOST_AUTO_TEST_CASE(places_that_cannot_be_written_are_refused) {
  const Folder folder;
  folder.write("file", "");
  BOOST_TEST(contains(refusal(folder.path()), {folder.path(), "folder", "allowed"}));
  for (const std::string& path :
       {folder / "none/a.txt", folder / "file/a.txt", std::string("/proc/a.txt")}) {
    BOOST_TEST(contains(refusal(path), {path, "cannot be written", "allowed"}), path);
  }
  if (geteuid() != 0) {  // who may write anywhere
    std::filesystem::permissions(
        folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    BOOST_TEST(contains(refusal(folder / "a.txt"), {"cannot be written", "allowed"}));
    std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  }
  BOOST_TEST(folder.listing() == "file ");
}

BOOST_AUTO_TEST_CASE(a_commit_that_fails_throws_and_leaves_nothing_beside) {
  const Folder folder;
  WholeFile file(folder / "a.txt");
  file.write("x");
  std::filesystem::create_directories(folder / "a.txt/b");
  BOOST_CHECK_THROW(file.commit(), std::runtime_error);
  BOOST_TEST(folder.listing() == "a.txt ");
}

BOOST_AUTO_TEST_CASE(files_that_qddot_did_not_write_stay) {
  const Folder folder;
  folder.write("mine.csv", "a,b\n1,2\n");
  BOOST_TEST(contains(refusal(folder / "mine.csv"), {"mine.csv", "--force", "not one that qddot"}));
  folder.write("end.json", "{\"mine\": 1}");
  BOOST_TEST(contains(refusal(folder / "end.json"), {"end.json", "--force"}));
  BOOST_TEST(read_all(folder / "mine.csv") == "a,b\n1,2\n");
  BOOST_TEST(folder.listing() == "end.json mine.csv ");

  // Its own may go: an empty one, one of the same columns, one whose sidecar says so, a signed one.
  folder.write("empty.csv", "");
  BOOST_TEST(refusal(folder / "empty.csv") == "");
  BOOST_CHECK_NO_THROW(WholeFile(folder / "mine.csv", "a,b\n"));
  folder.write("end.json", "{\"source_hash\": 1}");
  BOOST_TEST(refusal(folder / "end.json") == "");
  BOOST_CHECK_NO_THROW(WholeFile(folder / "mine.csv", "x\n", folder / "end.json"));
  folder.write("s.toml", signed_text("name = 'a'\n"));
  BOOST_TEST(refusal(folder / "s.toml") == "");
  folder.write("s.toml", signed_text("name = 'a'\n") + "# changed since\n");
  BOOST_TEST(contains(refusal(folder / "s.toml"), {"s.toml", "--force"}));
}

BOOST_AUTO_TEST_SUITE_END()
